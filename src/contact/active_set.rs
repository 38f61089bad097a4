//! The contact problem: min ½ tᵀ H t − cᵀ t subject to t ≤ g, D t ≤ d.
//!
//! t are the normal jumps of the conditions, of one pair or of all, H the stiffness condensed onto
//! them, c the load that drives them; λ = c − H t − Dᵀ μ ≥ 0 and μ ≥ 0 are the contact forces. D is
//! empty except where more constraints meet at a node than it has directions. Flags, bounds and
//! forces are those of normal jumps, then those of linearly dependent constraints.
//!
//! The active set, the closed conditions, is found by the first of three strategies that converges:
//!
//! 1. *Flipping*: a primal-dual active set (a semismooth Newton method) from the given set. Every
//!    condition of wrong sign flips at once. A few linear systems, but it may cycle.
//! 2. *Interior point* ([`super::interior_point`]): a set that is right or nearly so, and positions
//!    within the gaps for bodies that contact alone holds. Some twenty systems, whatever the problem.
//! 3. *Dual method* ([`super::dual`]): from that set, else from the last one of flipping, conditions close one by one.
//!    It ends for every positive definite H, with linearly dependent constraints too.

use faer::MatRef;
use serde::{Deserialize, Serialize};

use super::active_equalities::ActiveEqualities;
use super::dependent::DependentConstraints;
use super::interior_point::ConvexProblem;
use super::open_factor::{OpenFactor, scale_of};

/// Negative force, relative to its scale, at which a contact opens.
pub(super) const FORCE_TOLERANCE: f64 = 1e-12;
/// Share of the diagonal that H is condensed from, times the displacements, in that scale: H's
/// round-off is relative to it.
const DIAGONAL_SHARE: f64 = 1e-3;
/// Negative gap, relative to the displacements, at which a contact closes.
pub(super) const GAP_TOLERANCE: f64 = 1e-14;
/// Flips of all wrong signs without progress before flipping is given up.
const PATIENCE: usize = 10;
/// Most linear systems of flipping.
const FLIPPING_STEPS: usize = 25;
/// Most linear systems of the dual method: for each condition, and in total.
const DUAL_STEPS_EACH: usize = 10;
const MOST_DUAL_STEPS: usize = 1000;

/// The contact problem.
#[derive(Clone, Copy, Debug)]
pub struct ContactProblem<'a> {
    /// H, symmetric positive semidefinite.
    pub h: MatRef<'a, f64>,
    /// The diagonal of the matrix from which H is condensed; H's round-off is relative to it.
    pub diagonal: &'a [f64],
    /// c.
    pub c: &'a [f64],
    /// Scale of the terms in c, for each condition.
    pub c_scale: &'a [f64],
    /// D.
    pub rows: &'a DependentConstraints,
    /// g, then d.
    pub bounds: &'a [f64],
    /// Normal jumps at which the motion of open conditions starts, and which they keep along motions without
    /// resistance.
    pub center: &'a [f64],
    /// Scale of the displacements whose differences the normal jumps are.
    pub scale: f64,
}

/// Solution of a contact problem.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactSolution {
    /// t ≤ g; exactly g where closed.
    pub jumps: Vec<f64>,
    /// λ ≥ 0, then μ ≥ 0; exactly 0 where open.
    pub forces: Vec<f64>,
    /// Linear systems solved.
    pub steps: usize,
    /// True if more than Newton's method was needed.
    pub fell_back: bool,
    /// True if all signs are right and the open conditions balanced.
    pub converged: bool,
    /// True if a body slides without end against friction, so that there may be no solution.
    pub slides: bool,
}

impl ContactSolution {
    /// Solution with all `jumps` closed and no forces at `conditions` yet.
    pub fn bilateral(jumps: usize, conditions: usize) -> Self {
        Self {
            jumps: vec![0.0; jumps],
            forces: vec![0.0; conditions],
            steps: 0,
            fell_back: false,
            converged: true,
            slides: false,
        }
    }
}

/// t and λ for a given set of open conditions.
#[derive(Clone, Debug)]
pub struct Trial {
    /// t, exactly g where closed.
    pub jumps: Vec<f64>,
    /// λ = c − H t − Dᵀ μ, then μ; exactly 0 where open.
    pub forces: Vec<f64>,
    /// Equalities between open normal jumps by the closed linearly dependent constraints.
    pub(super) equalities: ActiveEqualities,
    /// Residual of c at open normal jumps, relative to its terms.
    unbalanced: f64,
}

impl ContactProblem<'_> {
    /// Solves the problem from an initial active set; `open` then holds that of the solution.
    pub fn solve(&self, open: &mut [bool]) -> ContactSolution {
        if let Some(at_rest) = self.at_rest(open) {
            return at_rest;
        }
        let mut set = open.to_vec();
        let mut solution = self.flip(&mut set);
        if !solution.converged {
            let before = solution.steps;
            let (mut named, center, named_in) = self.interior_point();
            // Keeps bodies without resistance within their gaps.
            let centered = ContactProblem {
                center: &center,
                ..*self
            };
            let most = FLIPPING_STEPS + (DUAL_STEPS_EACH * self.c.len()).min(MOST_DUAL_STEPS);
            solution = centered.dual(&mut named, most);
            let mut steps = before + named_in + solution.steps;
            match solution.converged {
                true => set = named,
                false => {
                    solution = self.dual(&mut set, most);
                    steps += solution.steps;
                }
            }
            solution.steps = steps;
            solution.fell_back = true;
        }
        open.copy_from_slice(&set);
        solution
    }

    /// Solution t = 0 without load and overlap: where contact alone restrains bodies the linear system is singular, and
    /// its round-off would move them up to their gaps.
    fn at_rest(&self, open: &mut [bool]) -> Option<ContactSolution> {
        let rests = self.c.iter().all(|&c| c == 0.0) && self.bounds.iter().all(|&g| g >= 0.0);
        rests.then(|| {
            for (open, &g) in open.iter_mut().zip(self.bounds) {
                *open = g > 0.0;
            }
            ContactSolution::bilateral(self.c.len(), self.bounds.len())
        })
    }

    /// Open conditions and normal jumps of the interior-point method, and the linear systems that it solved.
    fn interior_point(&self) -> (Vec<bool>, Vec<f64>, usize) {
        let scale: Vec<f64> = (0..self.c.len())
            .map(|j| scale_of(self.h[(j, j)], self.diagonal[j]))
            .collect();
        let near = ConvexProblem {
            h: self.h,
            c: self.c,
            scale: &scale,
            rows: self.rows,
            bounds: self.bounds,
            points: &[],
        }
        .solve();
        (near.open, near.jumps, near.steps)
    }

    /// Flips all wrong signs until none is left or their number no longer falls.
    fn flip(&self, open: &mut [bool]) -> ContactSolution {
        let mut fewest = usize::MAX;
        let mut patience = PATIENCE;
        let mut steps = 0;
        loop {
            steps += 1;
            let trial = self.linear(open);
            self.open_redundant(open, &trial);
            let wrong = self.wrong_signs(open, &trial);
            if wrong.len() < fewest {
                fewest = wrong.len();
                patience = PATIENCE;
            } else {
                patience -= 1;
            }
            if wrong.is_empty() || patience == 0 || steps >= FLIPPING_STEPS {
                return self.solution(&trial, steps, wrong.is_empty());
            }
            for j in wrong {
                if open[j] {
                    self.rows.close(j, open, &trial.forces, |_| true);
                } else {
                    open[j] = true;
                }
            }
        }
    }

    /// Solution of `trial`, converged if all signs are `right`.
    pub(super) fn solution(&self, trial: &Trial, steps: usize, right: bool) -> ContactSolution {
        let jumps = trial.jumps.iter().zip(self.bounds);
        ContactSolution {
            jumps: jumps.map(|(t, g)| t.min(*g)).collect(),
            forces: trial.forces.iter().map(|f| f.max(0.0)).collect(),
            steps,
            fell_back: false,
            converged: right && trial.unbalanced <= FORCE_TOLERANCE,
            slides: false,
        }
    }

    /// t and λ with closed conditions at their bounds. A closed dependent condition that follows from the others has no
    /// force.
    pub fn linear(&self, open: &[bool]) -> Trial {
        let m = self.c.len();
        let factor = OpenFactor::new(self.h, self.diagonal, self.rows, open);
        let mut t: Vec<f64> = (0..m)
            .map(|j| {
                if open[j] {
                    self.center[j]
                } else {
                    self.bounds[j]
                }
            })
            .collect();
        factor.equalities.hold(self.rows, self.bounds, &mut t);
        // The residual load beside the closed conditions.
        let mut left = self.c.to_vec();
        self.subtract(&t, &mut left);
        let mut opened: Vec<f64> = factor.open.iter().map(|&j| left[j]).collect();
        // Where motions without resistance are balanced already, round-off mustn't drive them.
        let stays = factor.singular
            && (factor.open.iter().zip(&opened))
                .all(|(&i, left)| left.abs() <= FORCE_TOLERANCE * self.scale_of(i, &t));
        if stays {
            opened.fill(0.0);
        } else {
            factor.solve(&mut opened);
        }
        let mut moved = vec![0.0; m];
        for (&j, opened) in factor.open.iter().zip(opened) {
            moved[j] = opened;
            t[j] += opened;
        }
        self.subtract(&moved, &mut left);
        let mut of_rows = factor.equalities.forces(self.rows.len(), |j| left[j]);
        let by_rows = self.rows.subtract_transposed(&of_rows, &mut left);
        let mut unbalanced = 0.0;
        for &i in &factor.open {
            if left[i] != 0.0 {
                let by_rows = by_rows.get(&i).copied().unwrap_or_default();
                let scale = self.scale_of(i, &t) + by_rows;
                unbalanced = f64::max(unbalanced, left[i].abs() / scale);
            }
            left[i] = 0.0;
        }
        left.append(&mut of_rows);
        Trial {
            jumps: t,
            forces: left,
            equalities: factor.equalities,
            unbalanced,
        }
    }

    /// left ← left − H t.
    pub(super) fn subtract(&self, t: &[f64], left: &mut [f64]) {
        for (j, &t) in t.iter().enumerate() {
            if t != 0.0 {
                for (left, h) in left.iter_mut().zip(self.h.col(j).iter()) {
                    *left -= h * t;
                }
            }
        }
    }

    /// The absolute terms of condition i's equilibrium, H's own round-off among them.
    pub(super) fn scale_of(&self, i: usize, t: &[f64]) -> f64 {
        let row = self.h.col(i);
        let held: f64 = row.iter().zip(t).map(|(h, t)| (h * t).abs()).sum();
        let displaced = self.scale.max(t[i].abs());
        self.c_scale[i] + held + DIAGONAL_SHARE * self.diagonal[i] * displaced
    }

    /// Conditions open with a negative gap or closed with a negative force, beyond round-off: within it the status is
    /// kept.
    fn wrong_signs(&self, open: &[bool], trial: &Trial) -> Vec<usize> {
        (0..open.len())
            .filter(|&i| {
                if open[i] {
                    self.violation(i, open, trial) > 0.0
                } else {
                    self.is_in_tension(i, trial)
                }
            })
            .collect()
    }

    /// Violation of the bound of the open condition i; 0 within round-off.
    pub(super) fn violation(&self, i: usize, open: &[bool], trial: &Trial) -> f64 {
        let m = self.c.len();
        let t = &trial.jumps;
        let (value, size) = if i < m {
            (t[i], 1.0)
        } else {
            (self.rows.value(i - m, t), self.rows.size(i - m).max(1.0))
        };
        if value <= self.bounds[i] {
            return 0.0;
        }
        let largest = t.iter().fold(self.scale, |m, t| m.max(t.abs()));
        let round_off = GAP_TOLERANCE * largest * size;
        if value <= self.bounds[i] + round_off
            || value <= self.bounds[i] + round_off * self.rows.amplified(i, open, &trial.equalities)
        {
            return 0.0;
        }
        (value - self.bounds[i]) / size
    }

    /// True if condition i is in tension, beyond round-off.
    pub(super) fn is_in_tension(&self, i: usize, trial: &Trial) -> bool {
        let force = trial.forces[i];
        force < 0.0 && force < -FORCE_TOLERANCE * self.force_scale(i, trial)
    }
}

#[cfg(test)]
mod tests;
