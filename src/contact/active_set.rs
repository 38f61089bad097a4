//! The contact problem: min ½ tᵀ H t − cᵀ t subject to t ≤ g.
//!
//! t are the approaches of the conditions, of one pair or of all, H the stiffness condensed onto
//! them, c the load that drives them; λ = c − H t ≥ 0 are the contact forces. A warm-started
//! primal-dual active set flips every condition whose sign is wrong. Where that turns in circles or
//! opens conditions one by one, an interior-point method names the set to start from, and from there
//! Júdice and Pires' rule ends for every positive definite H: flip all as long as their number
//! falls, else one at a time.

use faer::MatRef;

use super::interior_point::open_conditions;
use super::open_factor::{OpenFactor, scale_of};

/// How far below zero, relative to its scale, a force must be to open a contact.
const FORCE_TOLERANCE: f64 = 1e-12;
/// The same relative to the stiffness that H is condensed from times the displacements: the round-off
/// of H itself.
const STIFFNESS_TOLERANCE: f64 = 1e-15;
/// How far below zero, relative to the displacements, a gap must be to close a contact.
const GAP_TOLERANCE: f64 = 1e-14;
/// Attempts at flipping all wrong signs without progress before that is given up.
const PATIENCE: usize = 10;
/// Linear systems solved from the start that is given before the interior-point method is asked.
const QUICK_STEPS: usize = 25;
/// Single flips at most, for each condition up to [`SINGLE_FLIPS`] of them.
const FLIPS_EACH: usize = 10;
/// Conditions for which every single flip that may be needed is tried.
const SINGLE_FLIPS: usize = 100;

/// The contact problem.
#[derive(Clone, Copy, Debug)]
pub struct GapProblem<'a> {
    /// H, symmetric positive semidefinite.
    pub h: MatRef<'a, f64>,
    /// The diagonal of the matrix that H is condensed from: what H's round-off is relative to.
    pub stiffness: &'a [f64],
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
    /// Whether the interior-point method was needed.
    pub fell_back: bool,
    /// Whether all signs are right and the open conditions balanced.
    pub converged: bool,
}

impl GapSolution {
    /// Every one of `m` conditions closed, before anything is known of its force.
    pub fn bilateral(m: usize) -> Self {
        Self {
            approaches: vec![0.0; m],
            forces: vec![0.0; m],
            steps: 0,
            fell_back: false,
            converged: true,
        }
    }
}

/// t and λ for a given set of open conditions.
#[derive(Clone, Debug)]
pub struct Trial {
    /// t, exactly g where closed.
    pub approaches: Vec<f64>,
    /// λ = c − H t, exactly 0 where open.
    pub forces: Vec<f64>,
    /// Whether H t leaves nothing but round-off of c at open conditions.
    balanced: bool,
}

impl GapProblem<'_> {
    /// Solves the problem from the conditions that are `open` at first, and leaves there which
    /// ones are open in the solution.
    pub fn solve(&self, open: &mut [bool]) -> GapSolution {
        let mut set = open.to_vec();
        let mut solution = self.pivot(&mut set, QUICK_STEPS, false);
        if !solution.converged {
            let quick = solution.steps;
            let (mut named, named_in) = self.interior_point();
            solution = self.pivot(&mut named, self.most_steps(), true);
            solution.steps += quick + named_in;
            solution.fell_back = true;
            set = named;
        }
        open.copy_from_slice(&set);
        solution
    }

    fn interior_point(&self) -> (Vec<bool>, usize) {
        let m = self.c.len();
        let mut q = self.c.to_vec();
        for (column, &g) in self.h.col_iter().zip(self.bounds) {
            for (q, h) in q.iter_mut().zip(column.iter()) {
                *q -= h * g;
            }
        }
        let scale: Vec<f64> = (0..m)
            .map(|j| scale_of(self.h[(j, j)], self.stiffness[j]))
            .collect();
        open_conditions(self.h, &q, &scale)
    }

    fn most_steps(&self) -> usize {
        QUICK_STEPS + FLIPS_EACH * self.c.len().min(SINGLE_FLIPS)
    }

    /// Pivots until all signs are right, or `limit` systems are solved, or flipping all wrong
    /// signs gets nowhere and single flips aren't asked for.
    fn pivot(&self, open: &mut [bool], limit: usize, single_flips: bool) -> GapSolution {
        let mut fewest = usize::MAX;
        let mut patience = PATIENCE;
        let mut steps = 0;
        loop {
            steps += 1;
            let trial = self.linear(open);
            let wrong = self.wrong_signs(open, &trial);
            if wrong.len() < fewest {
                fewest = wrong.len();
                patience = PATIENCE;
            } else {
                patience = patience.saturating_sub(1);
            }
            let stuck = patience == 0 && !single_flips;
            if wrong.is_empty() || stuck || steps >= limit {
                let approaches = trial.approaches.iter().zip(self.bounds);
                return GapSolution {
                    approaches: approaches.map(|(t, g)| t.min(*g)).collect(),
                    forces: trial.forces.iter().map(|f| f.max(0.0)).collect(),
                    steps,
                    fell_back: false,
                    converged: wrong.is_empty() && trial.balanced,
                };
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

    /// t and λ with the conditions that aren't `open` held at their bounds.
    pub fn linear(&self, open: &[bool]) -> Trial {
        let m = self.c.len();
        let factor = OpenFactor::new(self.h, self.stiffness, open);
        let mut t: Vec<f64> = (0..m)
            .map(|j| if open[j] { 0.0 } else { self.bounds[j] })
            .collect();
        // What the closed conditions leave of the load.
        let mut left = self.c.to_vec();
        self.subtract(&t, |j| !open[j], &mut left);
        let mut opened: Vec<f64> = factor.open.iter().map(|&j| left[j]).collect();
        factor.solve(&mut opened);
        for (&j, opened) in factor.open.iter().zip(opened) {
            t[j] = opened;
        }
        self.subtract(&t, |j| open[j], &mut left);
        let largest = self.largest(&t);
        let mut balanced = true;
        for &i in &factor.open {
            balanced &= left[i].abs() <= self.round_off(i, &t, largest);
            left[i] = 0.0;
        }
        Trial {
            approaches: t,
            forces: left,
            balanced,
        }
    }

    /// left ← left − H t over the conditions that are `asked` for.
    fn subtract(&self, t: &[f64], asked: impl Fn(usize) -> bool, left: &mut [f64]) {
        for (j, &t) in t.iter().enumerate() {
            if t != 0.0 && asked(j) {
                for (left, h) in left.iter_mut().zip(self.h.col(j).iter()) {
                    *left -= h * t;
                }
            }
        }
    }

    /// The largest displacement, approaches `t` among them.
    fn largest(&self, t: &[f64]) -> f64 {
        t.iter().fold(self.scale, |m, t| m.max(t.abs()))
    }

    /// The force that is round-off at condition i, where displacements are up to `largest`.
    fn round_off(&self, i: usize, t: &[f64], largest: f64) -> f64 {
        let row = self.h.col(i);
        let held: f64 = row.iter().zip(t).map(|(h, t)| (h * t).abs()).sum();
        FORCE_TOLERANCE * (self.c_scale[i] + held)
            + STIFFNESS_TOLERANCE * self.stiffness[i] * largest
    }

    /// The conditions that are open with a negative gap or closed with a negative force, beyond
    /// round-off: within it a condition stays what it was.
    fn wrong_signs(&self, open: &[bool], trial: &Trial) -> Vec<usize> {
        let Trial {
            approaches, forces, ..
        } = trial;
        let largest = self.largest(approaches);
        (0..open.len())
            .filter(|&i| {
                if open[i] {
                    approaches[i] > self.bounds[i] + GAP_TOLERANCE * largest
                } else {
                    forces[i] < 0.0 && forces[i] < -self.round_off(i, approaches, largest)
                }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use faer::linalg::solvers::DenseSolveCore;
    use faer::{Mat, Side};

    use super::*;

    fn solve(h: &Mat<f64>, c: &[f64], bounds: &[f64]) -> (GapSolution, Vec<bool>) {
        let mut open = vec![false; c.len()];
        let c_scale: Vec<f64> = c.iter().map(|c| c.abs()).collect();
        let stiffness: Vec<f64> = (0..c.len()).map(|j| 1.0 + h[(j, j)]).collect();
        let problem = GapProblem {
            h: h.as_ref(),
            stiffness: &stiffness,
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

    /// H of a thin cantilever with `m` conditions along it: the inverse of its flexibility
    /// x²(3y − x)/6 for x ≤ y.
    fn cantilever(m: usize) -> Mat<f64> {
        let flexibility = Mat::from_fn(m, m, |i, j| {
            let (x, y) = ((i.min(j) + 1) as f64, (i.max(j) + 1) as f64);
            x * x * (3.0 * y - x) / 6.0
        });
        let inverse = flexibility.llt(Side::Lower).unwrap().inverse();
        Mat::from_fn(m, m, |i, j| 0.5 * (inverse[(i, j)] + inverse[(j, i)]))
    }

    #[test]
    fn a_thin_cantilever_over_a_rough_floor_never_cycles() {
        let m = 24;
        let h = cantilever(m);
        let mut fell_back = 0;
        for seed in 240..310 {
            let c: Vec<f64> = (0..m).map(|i| 1e-4 * noise(seed * 91 + i)).collect();
            let bounds: Vec<f64> = (0..m).map(|i| 0.1 * noise(seed * 17 + i).abs()).collect();
            let (solution, _) = solve(&h, &c, &bounds);
            assert!(solution.converged, "{seed}");
            fell_back += usize::from(solution.fell_back);
            let t = &solution.approaches;
            for i in 0..m {
                let terms = (0..m).map(|j| h[(i, j)] * t[j]);
                let scale: f64 = terms.clone().map(f64::abs).sum();
                let left = c[i] - terms.sum::<f64>() - solution.forces[i];
                assert!(left.abs() <= 1e-10 * (scale + c[i].abs()));
                assert!(t[i] == bounds[i] || solution.forces[i] == 0.0);
            }
        }
        assert!(fell_back > 0, "no draw asks for the interior-point method");
    }

    #[test]
    fn the_interior_point_method_names_the_closed_conditions() {
        for seed in 0..100 {
            let m = 2 + seed % 30;
            let a = Mat::from_fn(m, m, |i, j| noise(seed * 1000 + i * 31 + j));
            let h = &a * a.transpose() + Mat::<f64>::identity(m, m) * faer::Scale(1e-3);
            let c: Vec<f64> = (0..m).map(|i| noise(seed * 77 + i + 5)).collect();
            let (_, open) = solve(&h, &c, &vec![0.0; m]);
            let diagonal: Vec<f64> = (0..m).map(|j| h[(j, j)]).collect();
            let (named, steps) = open_conditions(h.as_ref(), &c, &diagonal);
            assert_eq!(named, open);
            assert!(steps < 30);
        }
    }
}
