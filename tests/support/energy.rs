//! Balance of energy in load steps with friction, from mesh, scene and results only.

use contact_dd_partition::model::Model;

use super::assembled::Assembled;
use super::close::close;
use super::scenes::at_step;
use super::solution::Solution;

/// Work in a load step with the mean of the forces at both ends, the change of the bodies' energy, and the energy
/// afterwards.
#[derive(Clone, Copy, Debug, Default)]
pub struct Works {
    pub loads: f64,
    pub supports: f64,
    pub elastic: f64,
    pub energy: f64,
    pub pressure: f64,
    pub friction: f64,
    /// Work that friction dissipates with the forces at the end.
    pub dissipated: f64,
}

impl Works {
    pub fn outside(&self) -> f64 {
        self.loads + self.supports
    }
}

/// The state after a load step: displacements, jumps, and the forces that act along both.
#[derive(Default)]
struct State {
    u: Vec<f64>,
    of_loads: Vec<f64>,
    of_supports: Vec<f64>,
    jumps: Vec<f64>,
    forces: Vec<f64>,
    slips: Vec<f64>,
    tangential: Vec<f64>,
    elastic: f64,
}

impl State {
    fn new(model: &Model, solution: &Solution, assembled: &Assembled) -> Self {
        let contacts = model.contacts.iter();
        let points: Vec<_> = contacts.flat_map(|c| &solution.contacts[&c.name]).collect();
        let tangents = assembled.tangents.iter();
        let along = tangents.clone().map(|t| {
            let force = points[t.condition].tangential_force;
            -(0..3).map(|i| force[i] * t.direction[i]).sum::<f64>()
        });
        let forces: Vec<f64> = points.iter().map(|p| p.force).collect();
        let tangential: Vec<f64> = along.collect();
        let u = solution.dofs(model);
        let gaps = assembled.gaps(&u).into_iter().zip(&assembled.conditions);
        let inner = assembled.times(&u);
        Self {
            of_supports: assembled.residual(&u, &forces, &tangential).value,
            of_loads: assembled.load.clone(),
            jumps: gaps.map(|(left, (_, gap))| gap - left).collect(),
            slips: tangents.map(|t| t.jump(&u)).collect(),
            elastic: u.iter().zip(inner).map(|(u, f)| 0.5 * u * f).sum(),
            u,
            forces,
            tangential,
        }
    }
}

/// ½ (a + b)·(y − x), 0 for missing values.
fn work([a, b]: [&[f64]; 2], [x, y]: [&[f64]; 2]) -> f64 {
    let was = |values: &[f64], i: usize| values.get(i).copied().unwrap_or_default();
    let each = (0..b.len()).map(|i| 0.5 * (was(a, i) + b[i]) * (y[i] - was(x, i)));
    each.sum()
}

/// Works of every load step.
pub fn works(model: &Model, solutions: &[Solution]) -> Vec<Works> {
    let mut before = State::default();
    let one = |(k, solution): (usize, &Solution)| {
        let after = State::new(model, solution, &Assembled::new(&at_step(model, k)));
        let displacements = [&before.u[..], &after.u];
        let slips = [&before.slips[..], &after.slips];
        let works = Works {
            loads: work([&before.of_loads, &after.of_loads], displacements),
            supports: work([&before.of_supports, &after.of_supports], displacements),
            elastic: after.elastic - before.elastic,
            energy: after.elastic,
            pressure: work(
                [&before.forces, &after.forces],
                [&before.jumps, &after.jumps],
            ),
            friction: work([&before.tangential, &after.tangential], slips),
            dissipated: work([&after.tangential, &after.tangential], slips),
        };
        before = after;
        works
    };
    solutions.iter().enumerate().map(one).collect()
}

/// Fails unless every load step's report has this balance; returns it.
#[track_caller]
pub fn checked_works(model: &Model, solutions: &[Solution]) -> Vec<Works> {
    let works = works(model, solutions);
    for (solution, works) in solutions.iter().zip(&works) {
        let friction = &solution.report["friction"];
        let of = |key: &str| friction["energy"][key].as_f64().unwrap();
        let scale =
            1e-9 * (works.loads.abs() + works.supports.abs() + works.elastic.abs() + works.energy);
        close(of("work_of_loads"), works.loads, scale);
        close(of("work_of_supports"), works.supports, scale);
        close(of("elastic_energy"), works.elastic, scale);
        close(
            of("work_of_contacts"),
            works.pressure + works.friction,
            scale,
        );
        close(
            friction["dissipated_work"].as_f64().unwrap(),
            works.dissipated,
            scale,
        );
        assert!(of("imbalance") < 1e-12, "{friction}");
    }
    works
}
