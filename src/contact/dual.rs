//! Contact problems with linearly dependent constraints, where closed conditions may follow from each other.
//!
//! Goldfarb and Idnani's dual method: closed conditions are independent of each other and in compression; a violated
//! one closes as its force grows from zero, and each that would come under tension meanwhile opens. The energy rises
//! with every condition that closes, so that no active set recurs.

use super::active_equalities::ActiveEqualities;
use super::active_set::{ContactProblem, ContactSolution, FORCE_TOLERANCE, Trial};
use super::dependence::first_to_vanish;

impl ContactProblem<'_> {
    /// Opens the linearly dependent constraints that follow from closed ones, which determine their gaps.
    pub(super) fn open_redundant(&self, open: &mut [bool], trial: &Trial) {
        for &j in &trial.equalities.redundant {
            open[self.c.len() + j] = true;
        }
    }

    /// Scale of the terms in the force of condition i.
    pub(super) fn force_scale(&self, i: usize, trial: &Trial) -> f64 {
        let m = self.c.len();
        let of_jump = |i: usize| self.scale_of(i, &trial.jumps);
        let of_row = |j: usize| trial.equalities.force_scale(j, of_jump);
        if i >= m {
            return of_row(i - m);
        }
        let held = (self.rows.iter().enumerate()).map(|(j, row)| {
            let share = row.iter().find(|&&(jump, _)| jump == i);
            share.map_or(0.0, |(_, share)| share.abs() * of_row(j))
        });
        of_jump(i) + held.sum::<f64>()
    }

    /// True if condition i is in compression, beyond round-off.
    fn is_in_compression(&self, i: usize, trial: &Trial) -> bool {
        trial.forces[i] > FORCE_TOLERANCE * self.force_scale(i, trial)
    }

    /// Closes violated conditions one by one until none is left, starting from the closed ones in compression; gives up
    /// after `limit` linear systems.
    pub(super) fn dual(&self, open: &mut [bool], limit: usize) -> ContactSolution {
        let mut steps = 0;
        let mut trial = loop {
            steps += 1;
            let trial = self.linear(open);
            self.open_redundant(open, &trial);
            let redundant: Vec<usize> = (0..open.len())
                .filter(|&i| !open[i] && !self.is_in_compression(i, &trial))
                .collect();
            if redundant.is_empty() {
                break trial;
            }
            for i in redundant {
                open[i] = true;
            }
        };
        loop {
            let violated = (0..open.len())
                .filter(|&i| open[i])
                .map(|i| (i, self.violation(i, open, &trial)))
                .filter(|&(_, violation)| violation > 0.0)
                .max_by(|(_, a), (_, b)| a.total_cmp(b));
            let Some((k, _)) = violated else {
                return self.solution(&trial, steps, true);
            };
            match self.close_violated(k, open, &trial, &mut steps, limit) {
                Some(next) => trial = next,
                None => return self.solution(&trial, steps, false),
            }
        }
    }

    /// Closes the violated condition k and opens those that would come under tension; `None` where the conditions
    /// contradict each other or too many systems are solved.
    fn close_violated(
        &self,
        k: usize,
        open: &mut [bool],
        from: &Trial,
        steps: &mut usize,
        limit: usize,
    ) -> Option<Trial> {
        let mut forces: Vec<f64> = from.forces.iter().map(|f| f.max(0.0)).collect();
        loop {
            let equalities = ActiveEqualities::new(self.rows, open);
            if let Some(shares) = self.rows.shares_in(k, open, &equalities) {
                let (blocking, growth) = first_to_vanish(&shares, &forces)?;
                for &(i, share) in &shares {
                    forces[i] = (forces[i] - growth * share).max(0.0);
                }
                forces[k] += growth;
                forces[blocking] = 0.0;
                open[blocking] = true;
                continue;
            }
            if *steps >= limit {
                return None;
            }
            *steps += 1;
            open[k] = false;
            let target = self.linear(open);
            let in_tension =
                (0..open.len()).filter(|&i| i != k && !open[i] && self.is_in_tension(i, &target));
            let share = |i: usize| forces[i] / (forces[i] - target.forces[i]);
            let first = in_tension
                .map(|i| (i, share(i)))
                .min_by(|(_, a), (_, b)| a.total_cmp(b));
            let Some((blocking, share)) = first else {
                return Some(target);
            };
            for (force, target) in forces.iter_mut().zip(&target.forces) {
                *force = (*force + share * (target - *force)).max(0.0);
            }
            forces[blocking] = 0.0;
            open[blocking] = true;
            open[k] = true;
        }
    }
}
