//! A sweep method is added.

use std::collections::BTreeMap;

use clap::ValueEnum;
use contact_dd_mpi::comm::{Comm, start};
use contact_dd_mpi::contact::pair::ContactPair;
use contact_dd_mpi::interface::problem::InterfaceProblem;
use contact_dd_mpi::interface::s_con::SCon;
use contact_dd_mpi::rigid::energy::RigidModes;
use contact_dd_mpi::sweep::{Method, Start, SweepOutcome, SweepSettings, SweepStatus, Sweeps};

use super::small::{APPROACHES, Small};
use crate::support::close::close;

const TOLERANCE: f64 = 1e-12;

/// Aitken's relaxation of the chord method: U ← U + θ (S_0 + S_CON')⁻¹ r, with S_CON' of the bilateral
/// problem and θ from how the last step changed the next one.
struct Aitken {
    theta: f64,
    last: Option<Vec<f64>>,
}

impl Aitken {
    fn step(&mut self, problem: &InterfaceProblem<'_>, mut r: Vec<f64>) -> Vec<f64> {
        problem.interface.solver.solve(&mut r);
        if let Some(last) = self.last.replace(r.clone()) {
            let change: Vec<f64> = r.iter().zip(&last).map(|(now, last)| now - last).collect();
            let product = |x: &[f64]| x.iter().zip(&change).map(|(x, d)| x * d).sum::<f64>();
            self.theta *= -product(&last) / product(&change);
        }
        r.iter().map(|r| self.theta * r).collect()
    }

    /// Sweeps until they are there, or `limit` of them are done.
    fn solve(
        mut self,
        problem: &InterfaceProblem<'_>,
        s_con: &mut SCon<'_>,
        settings: SweepSettings,
        limit: usize,
    ) -> SweepOutcome {
        let mut observer = |_: &_| {};
        let (mut sweeps, mut residual) =
            Sweeps::begin(problem, s_con, settings, Start::Bilateral, &mut observer);
        while !sweeps.is_converged(&residual) && sweeps.sweeps_done() < limit {
            let step = self.step(problem, residual.r);
            for (u, step) in sweeps.u().iter_mut().zip(step) {
                *u += step;
            }
            residual = sweeps.evaluate(None);
        }
        let status = match sweeps.is_converged(&residual) {
            true => SweepStatus::Converged,
            false => SweepStatus::NotConverged("too many sweeps".into()),
        };
        sweeps.end(status)
    }
}

/// What finds U.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// A method of the program.
    Built(Method),
    /// The one from outside, and its most sweeps.
    Added(usize),
}

/// What a way finds, and the interface dofs on Γ in its numbering.
fn solve(comm: &Comm, small: &Small, way: Way) -> (SweepOutcome, Vec<u32>) {
    let pairs = small.pairs.each_ref().map(|pair| pair.pair());
    let (interface, numbering, loads) = small.interface(&pairs);
    let motions = RigidModes::default();
    let problem = InterfaceProblem::new(&interface, &numbering, &loads, &motions);
    let mut pairs: BTreeMap<usize, ContactPair> = pairs.into_iter().enumerate().collect();
    let mut s_con = SCon::new(comm, &[0, 0], &mut pairs);
    let mut settings = SweepSettings {
        method: Method::Newton,
        tolerance: TOLERANCE,
        max_sweeps: None,
        relaxation: None,
        second_start: false,
    };
    let outcome = match way {
        Way::Added(limit) => Aitken {
            theta: 1.0,
            last: None,
        }
        .solve(&problem, &mut s_con, settings, limit),
        Way::Built(method) => {
            settings.method = method;
            let mut observer = |_: &_| {};
            let found = Sweeps::solve(
                &problem,
                &mut s_con,
                settings,
                Start::Bilateral,
                &mut observer,
            );
            found.unwrap()
        }
    };
    (outcome, numbering.interface_dofs[0].clone())
}

/// All ways lead to the solution that trying every set of contacts finds, with and without a layer
/// between the sides.
#[test]
fn every_method_finds_the_one_solution() {
    let world = start().unwrap();
    // A test that fails says so by its harness; the hook would end the process.
    let _ = std::panic::take_hook();
    let comm = world.comm();
    let ways = Method::value_variants().iter().copied().map(Way::Built);
    let mut closed = 0;
    for seed in 0..20 {
        for small in [Small::new(seed), Small::with_layers(seed)] {
            let exact = small.exact();
            closed += exact.forces.iter().filter(|&&force| force > 0.0).count();
            for way in ways.clone().chain([Way::Added(200)]) {
                let (outcome, numbers) = solve(&comm, &small, way);
                let what = format!("{seed} {way:?} {:?}", outcome.records.last());
                assert_eq!(outcome.status, SweepStatus::Converged, "{what}");
                assert!(outcome.fallbacks.is_empty(), "{what}");
                let on_interface = &exact.x[2 * APPROACHES..];
                for (&number, exact) in numbers.iter().zip(on_interface) {
                    close(outcome.u[number as usize], *exact, 1e-10);
                }
            }
        }
    }
    // Of 20 · 2 · 6 contacts.
    assert!((60..180).contains(&closed), "{closed}");
    let (short, _) = solve(&comm, &Small::new(0), Way::Added(1));
    assert!(matches!(short.status, SweepStatus::NotConverged(_)));
    assert_eq!(short.records.len(), 2);
}
