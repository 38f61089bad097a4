//! The way to an increment that no search finds at once: in parts of its load, one after the other.

use super::{FrictionProblem, Status};
use crate::contact::active_set::{GapProblem, GapSolution};

/// Parts of the load that are tried.
const TRIES: usize = 10;

impl FrictionProblem<'_> {
    /// Solves the problem from statuses as [`solve`](Self::solve) does, and where that finds no solution, from those
    /// that the load's growth from `before` leads to.
    pub fn solve_along(&self, before: &[f64], status: &mut [Status]) -> GapSolution {
        let start = status.to_vec();
        let solution = self.solve(status);
        if solution.converged || self.tangents.is_empty() {
            return solution;
        }
        let (mut reached, more) = self.follow(before, start);
        let mut found = self.solve(&mut reached);
        found.steps += solution.steps + more;
        found.fell_back = true;
        status.copy_from_slice(&reached);
        found
    }

    /// The statuses that the load's growth from `before` leads to as far as it can be followed, and the linear
    /// systems solved.
    fn follow(&self, before: &[f64], mut status: Vec<Status>) -> (Vec<Status>, usize) {
        let mut bounds = self.gap.bounds.to_vec();
        let (mut done, mut part, mut steps) = (0.0, 0.5, 0);
        for _ in 0..TRIES {
            let to = f64::min(1.0, done + part);
            let c: Vec<f64> = (before.iter().zip(self.gap.c))
                .map(|(before, now)| before + to * (now - before))
                .collect();
            let partly = FrictionProblem {
                gap: GapProblem {
                    c: &c,
                    bounds: &bounds,
                    ..self.gap
                },
                ..*self
            };
            let mut reached = status.clone();
            let solution = partly.solve(&mut reached);
            steps += solution.steps;
            if !solution.converged {
                part *= 0.5;
                continue;
            }
            (status, done, part) = (reached, to, 2.0 * part);
            if done >= 1.0 {
                break;
            }
            for tangent in self.tangents {
                bounds[tangent.limit] = self.value(tangent.limit, &solution.jumps);
            }
        }
        (status, steps)
    }
}
