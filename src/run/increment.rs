//! An increment of load: from the state before it to the state after it.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

use crate::certificate::energy::{BlockEnergy, EnergyBalance};
use crate::certificate::scales::Scales;
use crate::comm::ranks::RankSeconds;
use crate::condense::blocks::CondensedBlocks;
use crate::condense::limits::limits_of_groups;
use crate::contact::laws::Statuses;
use crate::contact::pair::ContactPair;
use crate::context::{Context, LoadPoint};
use crate::error::Failure;
use crate::interface::numbering::Numbering;
use crate::interface::operator::Interface;
use crate::interface::problem::InterfaceProblem;
use crate::recover::energy::energies;
use crate::recover::fixed_active_set::FixedActiveSet;
use crate::recover::solution::Solution;
use crate::recover::{Slips, recover, substitute_back};
use crate::report::log::RunLog;
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::rigid::scene::Scene;
use crate::run::sweeping::{sweep, sweep_active_sets};
use crate::settings::Settings;
use crate::step::Loading;
use crate::step::halving::StepHalving;
use crate::step::state::{StepState, analyse, go_on};
use crate::sweep::{Method, Start, SweepOutcome, SweepStatus};
use crate::tree::fronts::ActiveSetFronts;

/// Data that all increments share: everything made of matrices.
#[derive(Clone, Copy)]
pub struct Increments<'a> {
    /// Context of the run.
    pub context: Context<'a>,
    /// Settings.
    pub settings: &'a Settings,
    /// Log of the run.
    pub log: &'a RunLog<'a>,
    /// The factors of this rank.
    pub factors: &'a CondensedBlocks,
    /// Γ and the operators on it; on the root.
    pub interface: Option<&'a (Numbering, Interface)>,
    /// The fronts above all contact, where active sets are fixed.
    pub fronts: Option<&'a RefCell<ActiveSetFronts>>,
    /// Whether another solver takes over where this one doesn't converge.
    pub is_relieved: bool,
    /// Linear problems that were solved for contact conditions, in tries that were given up, too; on the root.
    pub linear_solves: &'a Cell<usize>,
}

/// An increment that was solved, or tried.
pub struct Increment {
    /// The clusters in contact of this rank.
    pairs: BTreeMap<usize, ContactPair>,
    /// The statuses of the contact groups of this rank, where the tree solves for them.
    statuses: BTreeMap<usize, Statuses>,
    /// Outcome of the sweeps; on the root.
    pub outcome: Option<SweepOutcome>,
    /// Solution on the blocks of this rank.
    pub solution: Solution,
    /// Slips of the tangential conditions.
    pub slips: Slips,
    /// Data for the balance of energy of the next increment.
    energies: BTreeMap<usize, BlockEnergy>,
    /// The balance of this one, and of those before it in the load step; on the root.
    pub energy: EnergyBalance,
    /// The scales of this one and those before, as far as they converged; on the root.
    scales: Scales,
}

impl Increments<'_> {
    /// Solves load step k from the state `before`; `at_end` knows its rigid motions, `earlier` are the closing motions
    /// of the step before. Where friction keeps it from converging at once, in halves. Collective.
    ///
    /// # Errors
    /// Supports that make two sides penetrate, a part that moves freely, or a signal that stopped the sweeps.
    pub fn step(
        &self,
        k: usize,
        (earlier, at_end): (&[Vec<f64>], &RigidBodyAnalysis),
        before: StepState,
        seconds: &mut RankSeconds,
    ) -> Result<Increment, Failure> {
        let end = LoadPoint::end_of(k);
        if !self.context.catalog.has_friction() || self.is_relieved {
            return self.solve(end, at_end, before, seconds);
        }
        let at_once = self.solve(end, at_end, before.clone(), seconds)?;
        if self.is_converged(&at_once) {
            return Ok(at_once);
        }
        if let Some(in_parts) = self.in_halves(k, earlier, before, seconds)? {
            return Ok(in_parts);
        }
        let slides = at_once.outcome.as_ref().is_some_and(|o| o.slides);
        let unheld = (at_end.scene.as_ref().filter(|_| slides)).and_then(Scene::unheld);
        self.context.comm.agree(unheld.map_or(Ok(()), Err))?;
        Ok(at_once)
    }

    /// Solves load step k in halves, halves of these and so on, after the closing motions `earlier`;
    /// `None` where small parts don't converge either. Collective.
    fn in_halves(
        &self,
        k: usize,
        earlier: &[Vec<f64>],
        mut state: StepState,
        seconds: &mut RankSeconds,
    ) -> Result<Option<Increment>, Failure> {
        let mut way = StepHalving::default();
        let mut work = BTreeMap::new();
        let mut energy = EnergyBalance::default();
        loop {
            let moment = LoadPoint {
                step: k,
                part: way.next(),
            };
            let analysis = analyse(&self.context, moment, earlier)?;
            let mut solved = self.solve(moment, &analysis, state.clone(), seconds)?;
            if !self.is_converged(&solved) {
                match way.halve() {
                    true => continue,
                    false => return Ok(None),
                }
            }
            solved.slips.add_work(&work);
            solved.energy = solved.energy.since(energy);
            if way.accept() {
                if let Some(outcome) = &mut solved.outcome {
                    outcome.count_increments(way.increments);
                }
                return Ok(Some(solved));
            }
            work = std::mem::take(&mut solved.slips.work);
            energy = solved.energy;
            state = solved.into_state(self.settings.method);
        }
    }

    /// Counts linear problems that were solved.
    fn count(&self, solves: usize) {
        self.linear_solves.set(self.linear_solves.get() + solves);
    }

    /// Whether the sweeps converged. Collective.
    pub fn is_converged(&self, increment: &Increment) -> bool {
        let status = increment.outcome.as_ref().map(|outcome| &outcome.status);
        (self.context.comm).decide(status == Some(&SweepStatus::Converged))
    }

    /// Solves for the loads of a moment, of which `analysis` knows the rigid motions, from the state `before`.
    /// Collective.
    ///
    /// # Errors
    /// Supports that make two sides penetrate, a part that moves freely, or a signal that stopped the sweeps.
    fn solve(
        &self,
        moment: LoadPoint,
        analysis: &RigidBodyAnalysis,
        mut before: StepState,
        seconds: &mut RankSeconds,
    ) -> Result<Increment, Failure> {
        let &Self {
            context,
            settings,
            log,
            factors,
            interface,
            fronts,
            ..
        } = self;
        let comm = context.comm;

        // F, condensed like the blocks, and the bounds on normal jumps.
        log.phase("condensing the load", None);
        let lap = comm.times();
        let (mut start, held_at) = (before.start(), before.slips.clone());
        let energies_before = std::mem::take(&mut before.energies);
        let mut statuses = std::mem::take(&mut before.statuses);
        let loads = before.loads(&context, moment, analysis);
        let loading = Loading {
            context,
            factors,
            interface,
            analysis,
        };
        let mut problem = loading.problem(loads, before)?;
        if (problem.interface.as_ref()).is_some_and(InterfaceProblem::is_unloaded) {
            start = Start::Bilateral;
        }
        let limits = match fronts {
            Some(_) => limits_of_groups(&context, &problem.loads)?,
            None => BTreeMap::new(),
        };
        seconds.add(|s| &mut s.interface, comm.times() - lap);
        go_on(&context)?;

        // S_0 U + S_CON(U) = F, (14), from the bilateral start (16)-(17) or from the state before.
        log.phase("sweeping", None);
        let lap = comm.times();
        let mut found = None;
        let mut outcome = match fronts {
            Some(fronts) => {
                let (fronts, loads) = (&mut fronts.borrow_mut(), &problem.condensed);
                let before = fronts.solves;
                let of_limits = (&limits, &statuses);
                let contact = sweep_active_sets(&context, settings, log, fronts, loads, of_limits)
                    .map_err(|failure| context.of_pivot(failure))?;
                statuses.clone_from(&contact.statuses);
                self.count(fronts.solves - before);
                let outcome = contact.outcome.clone();
                found = Some(contact);
                comm.is_root().then_some(outcome)
            }
            None => {
                let (on_gamma, pairs) = (problem.interface.as_ref(), &mut problem.pairs);
                let outcome = sweep(&context, settings, log, on_gamma, pairs, start)
                    .map_err(|failure| context.of_pivot(failure))?;
                self.count(outcome.as_ref().map_or(0, |o| o.active_set_iterations));
                outcome
            }
        };
        seconds.add(|s| &mut s.sweeps, comm.times() - lap);
        // From here on the load step is finished first: what was found is kept.
        go_on(&context)?;

        // Back-substitution, and the check of the full discrete problem.
        log.phase("recovering", None);
        let lap = comm.times();
        let fixed = FixedActiveSet::new(
            context,
            factors,
            &problem,
            analysis,
            interface,
            fronts.map(|fronts| (fronts, &limits)),
            outcome.as_ref(),
        );
        let discrete = match found {
            Some(contact) => {
                let (boundaries, conditions) = (contact.boundaries, contact.conditions);
                substitute_back(fixed.factors(), &problem, boundaries, conditions)
            }
            None => {
                let u = outcome.as_ref().map(|outcome| &outcome.u[..]);
                let numbers = interface.map(|(n, _)| &n.interface_dofs[..]);
                recover(fixed.factors(), &problem, u.zip(numbers))
            }
        };
        let stress_of = (!settings.no_stress).then_some(moment.step);
        let solution = Solution::new(&fixed, analysis, discrete, stress_of);
        let (energies, energy) = energies(&fixed, &solution, &energies_before);
        let mut scales = problem.earlier;
        if let Some(outcome) = &mut outcome {
            outcome.accept(
                &solution.certificate,
                solution.is_finite() && energy.is_finite(),
            );
            if outcome.status == SweepStatus::Converged {
                scales = scales.and(solution.certificate.scales);
            }
            outcome.name_unsettled(&unsettled_points(&context, outcome));
        }
        seconds.add(|s| &mut s.recover, comm.times() - lap);
        Ok(Increment {
            slips: solution.discrete.slips(&context, &held_at),
            pairs: problem.pairs,
            statuses,
            outcome,
            solution,
            energies,
            energy,
            scales,
        })
    }
}

/// The contact points whose status cycles, by contact and node.
fn unsettled_points(context: &Context<'_>, outcome: &SweepOutcome) -> Vec<String> {
    let catalog = context.catalog;
    let name = |j: u32| {
        let point = &catalog.points[j as usize];
        let contact = &catalog.contacts[point.contact as usize].name;
        format!("node {} of contact '{contact}'", point.tag())
    };
    let pairs = outcome.unsettled.iter().enumerate();
    let points = pairs.flat_map(|(p, conditions)| {
        let plan = context.plan;
        plan.points_of_conditions(catalog, p, conditions)
    });
    points.map(name).collect()
}

impl Increment {
    /// The state that it leaves.
    pub fn into_state(self, method: Method) -> StepState {
        let outcome = self.outcome.as_ref();
        let from = (outcome, self.scales);
        let contact = (self.pairs, self.statuses);
        StepState::after(contact, self.slips.jumps, self.energies, from, method)
    }
}
