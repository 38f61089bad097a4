//! The small problem of a pair: min ½ tᵀ H t − cᵀ t subject to t ≤ g.
//!
//! t are the approaches of the pair's conditions, H its Schur complement on them, c the load that
//! drives them; λ = c − H t ≥ 0 are the contact forces. Solved by a warm-started primal-dual active set with Júdice and Pires'
//! rule: flip every condition whose sign is wrong as long as their number falls, else one at a
//! time, which ends for every positive definite H. Where H is singular along a motion that opens
//! gaps without resistance, proximal steps make it definite and converge to a solution of the
//! problem itself.

use faer::linalg::solvers::{Llt, SolveCore};
use faer::{Conj, Mat, MatRef, Side};

/// How far below zero, relative to its scale, a force must be to open a contact.
const FORCE_TOLERANCE: f64 = 1e-12;
/// How far below zero, relative to the displacements, a gap must be to close a contact.
const GAP_TOLERANCE: f64 = 1e-14;
/// Attempts at flipping all wrong signs without progress before single ones are flipped.
const PATIENCE: usize = 10;
/// Stiffness of a proximal step relative to the diagonal of H.
const PROXIMITY: f64 = 1e-6;
/// Most proximal steps.
const PROXIMAL_STEPS: usize = 200;
/// Spring force of a proximal step, relative to what it's balanced with, that is round-off.
const ROUND_OFF: f64 = 1e-15;
/// Scaled pivot below which H is taken as singular.
const SINGULAR_PIVOT: f64 = 1e-13;

/// The small problem of a pair.
#[derive(Clone, Copy, Debug)]
pub struct GapProblem<'a> {
    /// H, symmetric positive semidefinite.
    pub h: MatRef<'a, f64>,
    /// c.
    pub c: &'a [f64],
    /// Scale of the terms that c is a difference of, for each condition.
    pub c_scale: &'a [f64],
    /// g, the bounds.
    pub bounds: &'a [f64],
    /// Scale of the displacements that the approaches are differences of.
    pub scale: f64,
}

/// Its solution.
#[derive(Clone, Debug, PartialEq)]
pub struct GapSolution {
    /// t ≤ g; exactly g where closed.
    pub approaches: Vec<f64>,
    /// λ ≥ 0; exactly 0 where open.
    pub forces: Vec<f64>,
    /// Linear systems solved.
    pub steps: usize,
    /// Whether all signs are right.
    pub converged: bool,
}

impl GapSolution {
    /// Every one of `m` conditions closed, before anything is known of its force.
    pub fn bilateral(m: usize) -> Self {
        Self {
            approaches: vec![0.0; m],
            forces: vec![0.0; m],
            steps: 0,
            converged: true,
        }
    }
}

impl GapProblem<'_> {
    /// Solves the problem from the conditions that are `open` at first, and leaves there which
    /// ones are open in the solution.
    pub fn solve(&self, open: &mut [bool]) -> GapSolution {
        let mut steps = 0;
        if let Some(solution) = self.pivot(open, None, &mut steps) {
            return solution;
        }
        let mut center = vec![0.0; self.c.len()];
        let mut last = GapSolution::bilateral(self.c.len());
        let mut unbalanced = f64::INFINITY;
        for _ in 0..PROXIMAL_STEPS {
            let Some(solution) = self.pivot(open, Some(&center), &mut steps) else {
                break;
            };
            // With the right set at hand the problem itself is solved where it can be.
            let mut trial = open.to_vec();
            if let Some(exact) = self.pivot(&mut trial, None, &mut steps) {
                open.copy_from_slice(&trial);
                return exact;
            }
            unbalanced = self.unbalanced(&solution.approaches, &center);
            center.clone_from(&solution.approaches);
            last = solution;
            if unbalanced <= ROUND_OFF {
                break;
            }
        }
        last.steps = steps;
        last.converged &= unbalanced <= FORCE_TOLERANCE;
        last
    }

    /// The largest spring force of a proximal step from `center` to `t`, relative to the terms of
    /// the equilibrium that it's a part of.
    fn unbalanced(&self, t: &[f64], center: &[f64]) -> f64 {
        let mut largest = 0.0;
        for i in 0..t.len() {
            let spring = (PROXIMITY * self.h[(i, i)] * (t[i] - center[i])).abs();
            if spring > 0.0 {
                largest = f64::max(largest, spring / self.scale_of(i, t));
            }
        }
        largest
    }

    /// The absolute terms of condition i's equilibrium.
    fn scale_of(&self, i: usize, t: &[f64]) -> f64 {
        let held: f64 = t
            .iter()
            .enumerate()
            .map(|(j, t)| (self.h[(i, j)] * t).abs())
            .sum();
        self.c_scale[i] + held
    }

    /// Pivots until all signs are right, proximally to `center` if there is one. `None` where H is
    /// singular on the open conditions.
    fn pivot(
        &self,
        open: &mut [bool],
        center: Option<&[f64]>,
        steps: &mut usize,
    ) -> Option<GapSolution> {
        let m = self.c.len();
        let mut fewest = usize::MAX;
        let mut patience = PATIENCE;
        let limit = *steps + 10 * m + 50;
        loop {
            *steps += 1;
            let (approaches, forces) = self.linear(open, center)?;
            let wrong = self.wrong_signs(open, &approaches, &forces);
            if wrong.is_empty() || *steps >= limit {
                return Some(GapSolution {
                    approaches: approaches
                        .iter()
                        .zip(self.bounds)
                        .map(|(t, g)| t.min(*g))
                        .collect(),
                    forces: forces.iter().map(|f| f.max(0.0)).collect(),
                    steps: *steps,
                    converged: wrong.is_empty(),
                });
            }
            if wrong.len() < fewest {
                fewest = wrong.len();
                patience = PATIENCE;
            } else {
                patience = patience.saturating_sub(1);
            }
            let flips = if patience > 0 {
                &wrong[..]
            } else {
                &wrong[wrong.len() - 1..]
            };
            for &j in flips {
                open[j] = !open[j];
            }
        }
    }

    /// t and λ for a given set of open conditions.
    fn linear(&self, open: &[bool], center: Option<&[f64]>) -> Option<(Vec<f64>, Vec<f64>)> {
        let m = self.c.len();
        let spring = |j: usize| center.map_or(0.0, |_| PROXIMITY * self.h[(j, j)]);
        let factor = OpenFactor::new(self.h, open, spring)?;
        let mut t: Vec<f64> = (0..m)
            .map(|j| if open[j] { 0.0 } else { self.bounds[j] })
            .collect();
        // What the closed conditions and the spring leave of the load.
        let mut load = self.c.to_vec();
        for j in (0..m).filter(|&j| t[j] != 0.0) {
            for (i, load) in load.iter_mut().enumerate() {
                *load -= self.h[(i, j)] * t[j];
            }
        }
        if let Some(center) = center {
            for (j, load) in load.iter_mut().enumerate() {
                *load += spring(j) * (center[j] - t[j]);
            }
        }
        let solved = factor.solve(|j| load[j]);
        for (&j, solved) in factor.open.iter().zip(solved) {
            t[j] = solved;
        }
        let forces = (0..m)
            .map(|i| {
                if open[i] {
                    return 0.0;
                }
                let held: f64 = factor.open.iter().map(|&j| self.h[(i, j)] * t[j]).sum();
                load[i] - held
            })
            .collect();
        Some((t, forces))
    }

    /// The conditions that are open with a negative gap or closed with a negative force, beyond
    /// round-off: within it a condition stays what it was.
    fn wrong_signs(&self, open: &[bool], approaches: &[f64], forces: &[f64]) -> Vec<usize> {
        let largest = maximum(approaches.iter().copied()).max(self.scale);
        (0..open.len())
            .filter(|&i| {
                if open[i] {
                    approaches[i] > self.bounds[i] + GAP_TOLERANCE * largest
                } else {
                    forces[i] < -FORCE_TOLERANCE * self.scale_of(i, approaches)
                }
            })
            .collect()
    }
}

/// max |x|.
fn maximum(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |m, x| m.max(x.abs()))
}

/// The Cholesky factor of H on the open conditions.
#[derive(Debug)]
pub struct OpenFactor {
    /// The open conditions, ascending.
    pub open: Vec<usize>,
    factor: Option<Llt<f64>>,
}

impl OpenFactor {
    /// Factorizes H_NN + `spring` on the open conditions N; `None` where it is singular.
    pub fn new(h: MatRef<'_, f64>, open: &[bool], spring: impl Fn(usize) -> f64) -> Option<Self> {
        let open: Vec<usize> = (0..open.len()).filter(|&j| open[j]).collect();
        if open.is_empty() {
            return Some(Self { open, factor: None });
        }
        let h_nn = Mat::from_fn(open.len(), open.len(), |a, b| {
            let (i, j) = (open[a], open[b]);
            h[(i, j)] + if a == b { spring(i) } else { 0.0 }
        });
        let factor = h_nn.llt(Side::Lower).ok()?;
        let l = factor.L();
        let regular =
            (0..open.len()).all(|a| l[(a, a)] * l[(a, a)] > SINGULAR_PIVOT * h_nn[(a, a)]);
        regular.then_some(Self {
            open,
            factor: Some(factor),
        })
    }

    /// The same with springs of `proximity` times the diagonal wherever H alone is singular.
    pub fn regular(h: MatRef<'_, f64>, open: &[bool]) -> Option<Self> {
        Self::new(h, open, |_| 0.0).or_else(|| Self::new(h, open, |j| PROXIMITY * h[(j, j)]))
    }

    /// H_NN⁻¹ r.
    pub fn solve(&self, r: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut x = Mat::from_fn(self.open.len(), 1, |a, _| r(self.open[a]));
        if let Some(factor) = &self.factor {
            factor.solve_in_place_with_conj(Conj::No, x.as_mut());
        }
        (0..self.open.len()).map(|a| x[(a, 0)]).collect()
    }

    /// W = L⁻¹ R for the rows of `r` that are open, so that Rᵀ H_NN⁻¹ R = Wᵀ W.
    pub fn half_solve(&self, r: MatRef<'_, f64>) -> Mat<f64> {
        let mut w = Mat::from_fn(self.open.len(), r.ncols(), |a, b| r[(self.open[a], b)]);
        if let Some(factor) = &self.factor {
            faer::linalg::triangular_solve::solve_lower_triangular_in_place(
                factor.L(),
                w.as_mut(),
                faer::Par::Seq,
            );
        }
        w
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solve(h: &Mat<f64>, c: &[f64], bounds: &[f64]) -> (GapSolution, Vec<bool>) {
        let mut open = vec![false; c.len()];
        let c_scale: Vec<f64> = c.iter().map(|c| c.abs()).collect();
        let problem = GapProblem {
            h: h.as_ref(),
            c,
            c_scale: &c_scale,
            bounds,
            scale: 0.0,
        };
        (problem.solve(&mut open), open)
    }

    /// A reproducible number in (−1, 1).
    fn noise(seed: usize) -> f64 {
        let x = (seed as f64 * 12.9898).sin() * 43758.5453;
        2.0 * (x - x.floor()) - 1.0
    }

    fn assert_optimal(h: &Mat<f64>, c: &[f64], bounds: &[f64], solution: &GapSolution) {
        let t = &solution.approaches;
        let scale: f64 = c.iter().chain(bounds).fold(1e-300, |m, c| m.max(c.abs()));
        for i in 0..c.len() {
            let held: f64 = (0..c.len()).map(|j| h[(i, j)] * t[j]).sum();
            assert!((c[i] - held - solution.forces[i]).abs() < 1e-9 * scale);
            assert!(t[i] <= bounds[i] && solution.forces[i] >= 0.0);
            assert!(t[i] == bounds[i] || solution.forces[i] == 0.0);
        }
    }

    #[test]
    fn every_random_problem_ends_optimal() {
        for seed in 0..300 {
            let m = 1 + seed % 17;
            let a = Mat::from_fn(m, m, |i, j| noise(seed * 1000 + i * 31 + j));
            let h = &a * a.transpose() + Mat::<f64>::identity(m, m) * faer::Scale(1e-3);
            let c: Vec<f64> = (0..m).map(|i| noise(seed * 77 + i + 5)).collect();
            let bounds: Vec<f64> = (0..m).map(|i| noise(seed * 13 + i).max(-0.2)).collect();
            let (solution, _) = solve(&h, &c, &bounds);
            assert!(solution.converged);
            assert_optimal(&h, &c, &bounds, &solution);
        }
    }

    #[test]
    fn a_body_that_rests_on_three_points_needs_no_stiffness_of_its_own() {
        // A beam on three rigid supports: H = 0 along lifting and rocking, the load presses it
        // into its gaps.
        let bend = [1.0, -2.0, 1.0];
        let h = Mat::from_fn(3, 3, |i, j| bend[i] * bend[j]);
        let (c, bounds) = ([0.2, 0.6, 0.2], [0.1, 0.3, -0.2]);
        let (solution, _) = solve(&h, &c, &bounds);
        assert_optimal(&h, &c, &bounds, &solution);
    }

    #[test]
    fn a_motion_without_resistance_is_stopped_by_the_gap_that_closes() {
        // The load rocks a beam off its left support until nothing but its bending resists.
        let bend = [1.0, -2.0, 1.0];
        let h = Mat::from_fn(3, 3, |i, j| bend[i] * bend[j]);
        let (c, bounds) = ([-0.1, 1.2, 0.1], [0.0; 3]);
        let (solution, _) = solve(&h, &c, &bounds);
        assert_optimal(&h, &c, &bounds, &solution);
    }

    #[test]
    fn a_body_that_only_round_off_pulls_away_is_left_where_it_is() {
        // H = 0 along opening all gaps at once; the load there is what round-off left of it.
        let bend = [1.0, -2.0, 1.0];
        let h = Mat::from_fn(3, 3, |i, j| bend[i] * bend[j]);
        let (c, bounds) = ([-1.0 - 1e-16, 2.0 - 1e-16, -1.0 - 1e-16], [1.0; 3]);
        let (solution, _) = solve(&h, &c, &bounds);
        assert!(solution.converged);
        assert_optimal(&h, &c, &bounds, &solution);
    }
}
