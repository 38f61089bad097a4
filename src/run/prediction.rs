//! Prediction of the contacts that close in a stage with friction, from the same problem without friction, which is
//! convex and has a third of the constraints.

use std::cell::Cell;

use contact_dd_partition::problem::stage::Stage;

use crate::comm::ranks::RankSeconds;
use crate::context::LoadPoint;
use crate::error::{Failure, FailureKind};
use crate::run::increment::Increments;
use crate::run::operators::Operators;
use crate::run::stage::Stages;
use crate::settings::Settings;
use crate::step::state::{StepState, analyse_steps, stop_if_asked};
use crate::step::working_set::{ClosestApproaches, WorkingSet};

impl Stages<'_> {
    /// The working set of a stage with friction: the points that close without friction, and those nearest to closing;
    /// `None` if that problem isn't solved, or if these are most points. Collective.
    ///
    /// # Errors
    /// A signal stopped the run.
    pub fn predict_working_set(
        &self,
        whole: &Stage<'_>,
        seconds: &mut RankSeconds,
    ) -> Result<Option<WorkingSet>, Failure> {
        self.log.phase("predicting which contacts close", None);
        match self.close_without_friction(&whole.frictionless(), seconds) {
            Ok(found) => {
                let set = found.and_then(|found| WorkingSet::predicted(&whole.catalog, &found));
                Ok(set)
            }
            Err(failure) if failure.kind == FailureKind::IllPosed => Ok(None),
            Err(failure) => Err(failure),
        }
    }

    /// The closest approaches of the points of a stage without friction; `None` if a load step isn't solved.
    /// Collective.
    ///
    /// # Errors
    /// Errors of the whole run.
    fn close_without_friction(
        &self,
        stage: &Stage<'_>,
        seconds: &mut RankSeconds,
    ) -> Result<Option<ClosestApproaches>, Failure> {
        let settings = &Settings {
            no_stress: true,
            ..self.settings.clone()
        };
        let parts = self.parts(stage, None, false)?;
        let context = self.context(stage, &parts);
        let analyses = analyse_steps(&context, stage.steps.clone(), &[])?;
        let mut state = StepState::default();
        let loads = state.loads(&context, LoadPoint::end_of(stage.steps.start), &analyses[0]);
        let operators = &Operators::new(context, self.log, &loads, &analyses[0], seconds)?;
        let mut approaches = ClosestApproaches::new(stage.points.len());
        let mut earlier: &[Vec<f64>] = &[];
        for (k, analysis) in stage.steps.clone().zip(&analyses) {
            stop_if_asked(&context, settings, 0)?;
            let increments = Increments {
                context,
                settings,
                log: self.log,
                operators,
                is_relieved: false,
                has_derivatives: false,
                linear_solves: &Cell::default(),
            };
            let solved = increments.step(k, (earlier, analysis), state, seconds)?;
            if !increments.is_converged(&solved) {
                return Ok(None);
            }
            solved
                .solution
                .discrete
                .add_approaches(&context, &mut approaches);
            earlier = &analysis.closing_motions;
            state = solved.into_state(settings.method);
        }
        self.comm.broadcast(&mut approaches);
        Ok(Some(approaches))
    }
}
