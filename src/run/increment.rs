//! Load increment: from the state before it to the state after it.

use std::cell::Cell;
use std::collections::BTreeMap;

use contact_dd_partition::id::{OnBlocks, OnGroups, OnPairs};

use crate::certificate::energy::{BlockEnergy, EnergyBalance};
use crate::certificate::scales::Scales;
use crate::comm::ranks::RankSeconds;
use crate::condense::limits::limits_of_groups;
use crate::contact::laws::Statuses;
use crate::contact::limits::Limits;
use crate::contact::pair::ContactPair;
use crate::context::{Context, LoadPoint};
use crate::error::Failure;
use crate::recover::Slips;
use crate::recover::adjoint::quantities_at;
use crate::recover::against_law::names_against_law;
use crate::recover::energy::energies;
use crate::recover::fixed_active_set::FixedActiveSet;
use crate::recover::solution::Solution;
use crate::report::log::RunLog;
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::rigid::scene::Scene;
use crate::run::operators::Operators;
use crate::run::swept::Swept;
use crate::settings::Settings;
use crate::step::StepProblem;
use crate::step::halving::{SMALLEST, StepHalving};
use crate::step::state::{StepState, analyse, check_interrupt};
use crate::sweep::{Method, SweepOutcome, SweepStatus};

/// Ratio of closing motions to displacements from which on the digits that their difference loses matter.
const LARGE_CLOSING_MOTION: f64 = 1e3;

/// Data common to all increments, including all factorized matrices.
#[derive(Clone, Copy)]
pub struct Increments<'a> {
    /// Context of the run.
    pub context: Context<'a>,
    /// Settings.
    pub settings: &'a Settings,
    /// Log of the run.
    pub log: &'a RunLog<'a>,
    /// Operators of the stage.
    pub operators: &'a Operators,
    /// True if another solver takes over if this one doesn't converge.
    pub is_relieved: bool,
    /// True if derivatives of quantities are computed.
    pub has_derivatives: bool,
    /// Number of linear systems solved for contact constraints, including abandoned attempts; on the root.
    pub linear_solves: &'a Cell<usize>,
}

/// An attempted increment, converged or not.
pub struct Increment {
    /// The clusters in contact of this rank.
    pairs: OnPairs<ContactPair>,
    /// The statuses of the contact groups of this rank, if the tree solver is used.
    statuses: OnGroups<Statuses>,
    /// Outcome of the sweeps; on the root.
    pub outcome: Option<SweepOutcome>,
    /// Solution on the blocks of this rank.
    pub solution: Solution,
    /// Slips at the tangential constraints.
    pub slips: Slips,
    /// Data for the energy balance of the next increment.
    energies: OnBlocks<BlockEnergy>,
    /// The energy balance of the load step up to the end of this increment; on the root.
    pub energy: EnergyBalance,
    /// The scales of this increment and of those before, as far as they converged; on the root.
    scales: Scales,
}

impl Increments<'_> {
    /// Solves load step k from the state `before`; `at_end` is the rigid-body analysis at its end, `earlier` are the
    /// closing motions of the step before. If friction prevents convergence in one increment, the step is halved.
    /// Collective.
    ///
    /// # Errors
    /// Prescribed displacements by which two sides penetrate, a part with a free rigid-body motion, or a signal that
    /// stopped the run.
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
        let unheld = unheld(at_once.outcome.as_ref(), at_end);
        let may_start = !self.context.comm.decide(unheld.is_some())
            || self.starts(k, earlier, before.clone(), seconds)?;
        if may_start && let Some(in_parts) = self.in_halves(k, earlier, before, seconds)? {
            return Ok(in_parts);
        }
        self.context.comm.agree(unheld.map_or(Ok(()), Err))?;
        Ok(at_once)
    }

    /// True if the smallest increment of load step k converges: bodies that slide at once under the whole load mostly
    /// do so under any part of it, and then no other increment needs to be tried. Collective.
    fn starts(
        &self,
        k: usize,
        earlier: &[Vec<f64>],
        before: StepState,
        seconds: &mut RankSeconds,
    ) -> Result<bool, Failure> {
        let load_point = LoadPoint {
            step: k,
            part: SMALLEST,
        };
        let analysis = analyse(&self.context, load_point, earlier)?;
        let solved = self.solve(load_point, &analysis, before, seconds)?;
        Ok(self.is_converged(&solved))
    }

    /// Solves load step k in successively halved increments, starting from the closing motions `earlier`; `None` if the
    /// smallest increment doesn't converge either. Collective.
    fn in_halves(
        &self,
        k: usize,
        earlier: &[Vec<f64>],
        mut state: StepState,
        seconds: &mut RankSeconds,
    ) -> Result<Option<Increment>, Failure> {
        let mut halving = StepHalving::default();
        let mut work = BTreeMap::new();
        let mut energy = EnergyBalance::default();
        loop {
            let load_point = LoadPoint {
                step: k,
                part: halving.next(),
            };
            let analysis = analyse(&self.context, load_point, earlier)?;
            let mut solved = self.solve(load_point, &analysis, state.clone(), seconds)?;
            if !self.is_converged(&solved) {
                match halving.halve() {
                    true => continue,
                    false => return Ok(None),
                }
            }
            solved.slips.add_work(&work);
            solved.energy = solved.energy.since(energy);
            if halving.accept() {
                if let Some(outcome) = &mut solved.outcome {
                    outcome.count_increments(halving.increments);
                }
                return Ok(Some(solved));
            }
            work = std::mem::take(&mut solved.slips.work);
            energy = solved.energy;
            state = solved.into_state(self.settings.method);
        }
    }

    /// Adds a number of linear systems.
    fn count(&self, solves: usize) {
        self.linear_solves.set(self.linear_solves.get() + solves);
    }

    /// Result of a load step's sweeps: convergence and the outcome, which the root has, or the failure. Collective.
    pub fn ended<'s>(
        &self,
        solved: &'s Result<Increment, Failure>,
    ) -> Result<(bool, Option<&'s SweepOutcome>), &'s Failure> {
        let solved = solved.as_ref()?;
        Ok((self.is_converged(solved), solved.outcome.as_ref()))
    }

    /// True if the sweeps converged. Collective.
    pub fn is_converged(&self, increment: &Increment) -> bool {
        let status = increment.outcome.as_ref().map(|outcome| &outcome.status);
        (self.context.comm).decide(status == Some(&SweepStatus::Converged))
    }

    /// Solves for the loads at a point of the load path, whose rigid-body analysis is `analysis`, from the state
    /// `before`. Where friction holds bodies far from where their closing motions led, digits are lost in the difference:
    /// such an increment is solved again without these motions. Collective.
    ///
    /// # Errors
    /// Prescribed displacements by which two sides penetrate, a part with a free rigid-body motion, or a signal that
    /// stopped the run.
    fn solve(
        &self,
        load_point: LoadPoint,
        analysis: &RigidBodyAnalysis,
        before: StepState,
        seconds: &mut RankSeconds,
    ) -> Result<Increment, Failure> {
        let closing = analysis.longest_closing_motion();
        if closing == 0.0 {
            return self.solve_after(load_point, analysis, before, seconds);
        }
        let found = self.solve_after(load_point, analysis, before.clone(), seconds)?;
        let moved = found.solution.displacement.values().flatten();
        if closing <= LARGE_CLOSING_MOTION * self.context.comm.largest(moved) {
            return Ok(found);
        }
        let stays = analysis.without_closing_motions();
        // Without them the contacts that hold the bodies may not be found at all.
        Ok(
            match self.solve_after(load_point, &stays, before, seconds) {
                Ok(again) if self.is_converged(&again) => again,
                _ => found,
            },
        )
    }

    /// Solves for these loads after the closing motions of an `analysis`. Collective.
    ///
    /// # Errors
    /// As [`solve`](Self::solve).
    fn solve_after(
        &self,
        load_point: LoadPoint,
        analysis: &RigidBodyAnalysis,
        mut before: StepState,
        seconds: &mut RankSeconds,
    ) -> Result<Increment, Failure> {
        let (context, log, comm) = (self.context, self.log, self.context.comm);

        // F, condensed like the blocks, and the bounds on normal jumps.
        log.phase("condensing the load", None);
        let lap = comm.times();
        let (start, held_at) = (before.start(), before.slips.clone());
        let energies_before = std::mem::take(&mut before.energies);
        let statuses = std::mem::take(&mut before.statuses);
        let loads = before.loads(&context, load_point, analysis);
        let mut problem = self
            .operators
            .loading(context, analysis)
            .problem(loads, before)?;
        let limits = match self.operators.fronts {
            Some(_) => limits_of_groups(&context, &problem.loads)?,
            None => BTreeMap::new(),
        };
        seconds.add(|s| &mut s.interface, comm.times() - lap);
        check_interrupt(&context)?;

        // S_0 U + S_CON(U) = F, (14), from the bilateral start (16)-(17) or from the state before.
        log.phase("sweeping", None);
        let lap = comm.times();
        let swept = match &self.operators.fronts {
            Some(fronts) => {
                let constraints = (&limits, &statuses);
                Swept::in_tree(&context, log, self.settings, fronts, &problem, constraints)
            }
            None => Swept::on_interface(&context, log, self.settings, &mut problem, start),
        };
        let mut swept = swept.map_err(|failure| context.of_pivot(failure))?;
        self.count(swept.linear_solves);
        seconds.add(|s| &mut s.sweeps, comm.times() - lap);
        if let Some(outcome) = &mut swept.outcome {
            outcome.is_settled &= self.settings.max_sweeps.is_none();
            // Refinement doesn't find what holds a body that slides without end.
            outcome.is_settled &= unheld(Some(outcome), analysis).is_none();
        }
        // From here on the load step is finished before the run stops, so that its solution is kept.
        check_interrupt(&context)?;

        // Back-substitution, and the check of the full discrete problem.
        log.phase("recovering", None);
        let lap = comm.times();
        let fixed = self.fixed(&problem, analysis, &limits, swept.outcome.as_ref());
        let discrete = swept.substituted_back(&fixed, &problem, self.operators);
        let stress_of = (!self.settings.no_stress).then_some(load_point.step);
        let mut solution = Solution::new(&fixed, analysis, discrete, stress_of);
        let slips_before = self.has_derivatives.then_some(&held_at);
        solution.quantities = quantities_at(load_point, &fixed, &solution, slips_before);
        let (energies, energy) = energies(&fixed, &solution, &energies_before);
        let scales = self.accept(&mut swept.outcome, &solution, &energy, problem.earlier);
        seconds.add(|s| &mut s.recover, comm.times() - lap);
        Ok(Increment {
            slips: solution.discrete.slips(&context, &held_at),
            pairs: problem.pairs,
            statuses: swept.statuses,
            outcome: swept.outcome,
            solution,
            energies,
            energy,
            scales,
        })
    }

    /// The problem of a load step with the active sets fixed by the `outcome` of the sweeps.
    fn fixed<'a>(
        &'a self,
        step: &'a StepProblem<'a>,
        analysis: &'a RigidBodyAnalysis,
        limits: &'a OnGroups<Limits>,
        outcome: Option<&SweepOutcome>,
    ) -> FixedActiveSet<'a> {
        let Operators {
            condensed,
            interface,
            fronts,
        } = self.operators;
        FixedActiveSet::new(
            self.context,
            condensed,
            step,
            analysis,
            interface.as_ref(),
            fronts.as_ref().map(|fronts| (fronts, limits)),
            outcome,
        )
    }

    /// Checks the `outcome` of the sweeps against the certificate of the `solution`; returns the scales of this
    /// increment and the `earlier` ones, as far as they converged; on the root. Collective.
    fn accept(
        &self,
        outcome: &mut Option<SweepOutcome>,
        solution: &Solution,
        energy: &EnergyBalance,
        earlier: Scales,
    ) -> Scales {
        if let Some(outcome) = outcome {
            let is_finite = solution.is_finite() && energy.is_finite();
            outcome.accept(&solution.certificate, is_finite);
        }
        let failed = |outcome: &SweepOutcome| outcome.status != SweepStatus::Converged;
        if !(self.context.comm).decide(outcome.as_ref().is_some_and(failed)) {
            return earlier.and(solution.certificate.scales);
        }
        let names = names_against_law(&self.context, &solution.discrete, outcome.as_ref());
        if let Some(outcome) = outcome {
            outcome.name_points(&names);
        }
        earlier
    }
}

/// The failure of a scene in which a body slides without end that only friction could hold; on the root.
fn unheld(outcome: Option<&SweepOutcome>, analysis: &RigidBodyAnalysis) -> Option<Failure> {
    let scene = (analysis.scene.as_ref()).filter(|_| outcome.is_some_and(|o| o.slides));
    scene.and_then(Scene::unheld)
}

impl Increment {
    /// The state after the increment.
    pub fn into_state(self, method: Method) -> StepState {
        let outcome = self.outcome.as_ref();
        let from = (outcome, self.scales);
        let contact = (self.pairs, self.statuses);
        StepState::after(contact, self.slips.jumps, self.energies, from, method)
    }
}
