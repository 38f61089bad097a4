//! Contact problems whose answers are known or can be checked.

use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::{Mat, Side};

use super::*;

/// A reproducible number in (−1, 1).
fn noise(seed: usize) -> f64 {
    let x = (seed as f64 * 12.9898).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

/// A contact problem without a center of its own.
struct Problem {
    h: Mat<f64>,
    c: Vec<f64>,
    rows: DependentConstraints,
    bounds: Vec<f64>,
}

impl Problem {
    fn new(h: Mat<f64>, c: &[f64], bounds: &[f64]) -> Self {
        Self::with_rows(h, c, &[], bounds)
    }

    fn with_rows(h: Mat<f64>, c: &[f64], rows: &[&[(usize, f64)]], bounds: &[f64]) -> Self {
        let mut problem = Self {
            h,
            c: c.to_vec(),
            rows: DependentConstraints::default(),
            bounds: bounds.to_vec(),
        };
        rows.iter().for_each(|row| problem.rows.push(row.to_vec()));
        problem
    }

    /// A random problem of `m` normal jumps with mostly positive bounds.
    fn random(seed: usize, m: usize) -> Self {
        let a = Mat::from_fn(m, m, |i, j| noise(seed * 1000 + i * 31 + j));
        Self {
            h: &a * a.transpose() + Mat::<f64>::identity(m, m) * faer::Scale(1e-3),
            c: (0..m).map(|i| noise(seed * 77 + i + 5)).collect(),
            rows: DependentConstraints::default(),
            bounds: (0..m).map(|i| noise(seed * 13 + i).max(-0.2)).collect(),
        }
    }

    fn solve(&self) -> (ContactSolution, Vec<bool>) {
        let mut open = vec![false; self.bounds.len()];
        let m = self.c.len();
        let c_scale: Vec<f64> = self.c.iter().map(|c| c.abs()).collect();
        let diagonal: Vec<f64> = (0..m).map(|j| 1.0 + self.h[(j, j)]).collect();
        let problem = ContactProblem {
            h: self.h.as_ref(),
            diagonal: &diagonal,
            c: &self.c,
            c_scale: &c_scale,
            rows: &self.rows,
            bounds: &self.bounds,
            center: &vec![0.0; m],
            scale: 0.0,
        };
        (problem.solve(&mut open), open)
    }

    /// Fails unless the solution meets t ≤ g and D t ≤ d and is optimal; returns its open conditions.
    #[track_caller]
    fn assert_optimal(&self) -> Vec<bool> {
        let Self { h, c, rows, bounds } = self;
        let (solution, open) = self.solve();
        assert!(solution.converged);
        let m = c.len();
        let t = &solution.jumps;
        let scale: f64 = c.iter().chain(bounds).fold(1e-300, |m, c| m.max(c.abs()));
        let mut left = c.to_vec();
        rows.subtract_transposed(&solution.forces[m..], &mut left);
        for i in 0..m {
            let held: f64 = (0..m).map(|j| h[(i, j)] * t[j]).sum();
            assert!((left[i] - held - solution.forces[i]).abs() < 1e-9 * scale);
            assert!(t[i] <= bounds[i] && solution.forces[i] >= 0.0);
            assert!(t[i] == bounds[i] || solution.forces[i] == 0.0);
        }
        for j in 0..rows.len() {
            let left = bounds[m + j] - rows.value(j, t);
            assert!(left > -1e-12 * scale && solution.forces[m + j] >= 0.0);
            assert!(left < 1e-12 * scale || solution.forces[m + j] == 0.0);
        }
        open
    }
}

#[test]
fn every_random_problem_ends_optimal() {
    (0..300).for_each(|seed| drop(Problem::random(seed, 1 + seed % 17).assert_optimal()));
}

/// A beam on three rigid supports: nothing resists lifting and rocking.
#[test]
fn a_body_that_nothing_but_contact_holds_needs_no_stiffness_of_its_own() {
    let bend = [1.0, -2.0, 1.0];
    let round_off = 1e-16;
    for (c, bounds) in [
        // The load presses it into its gaps;
        ([0.2, 0.6, 0.2], [0.1, 0.3, -0.2]),
        // rocks it off its left support until nothing but its bending resists;
        ([-0.1, 1.2, 0.1], [0.0; 3]),
        // is what round-off left of one that opens all gaps at once.
        (
            [-1.0 - round_off, 2.0 - round_off, -1.0 - round_off],
            [1.0; 3],
        ),
    ] {
        let h = Mat::from_fn(3, 3, |i, j| bend[i] * bend[j]);
        Problem::new(h, &c, &bounds).assert_optimal();
    }
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
        let (solution, _) = Problem::new(h.clone(), &c, &bounds).solve();
        assert!(solution.converged, "{seed}");
        fell_back += usize::from(solution.fell_back);
        let t = &solution.jumps;
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
        let mut problem = Problem::random(seed, m);
        problem.bounds.fill(0.0);
        let (solution, open) = problem.solve();
        let diagonal: Vec<f64> = (0..m).map(|j| problem.h[(j, j)]).collect();
        let near = ConvexProblem {
            h: problem.h.as_ref(),
            c: &problem.c,
            scale: &diagonal,
            rows: &DependentConstraints::default(),
            bounds: &problem.bounds,
            points: &[],
        }
        .solve();
        assert_eq!(near.open, open);
        let mut jumps = near.jumps.iter().zip(&solution.jumps);
        assert!(jumps.all(|(near, t)| (near - t).abs() < 1e-6));
        assert!(near.steps < 30);
    }
}

/// `count` rows of up to `most` of m normal jumps.
fn random_rows(seed: usize, m: usize, count: usize, most: usize) -> DependentConstraints {
    let mut rows = DependentConstraints::default();
    for j in 0..count {
        let first = (seed * 7 + j * 3) % m;
        let terms = 1 + (seed + j) % most.min(m);
        let of_term = |k: usize| ((first + k) % m, noise(seed * 501 + j * 37 + k));
        rows.push((0..terms).map(of_term).collect());
    }
    rows
}

#[test]
fn every_random_problem_with_dependent_conditions_ends_optimal() {
    for seed in 0..600 {
        let m = 1 + seed % 17;
        let mut problem = Problem::random(seed, m);
        let rows = random_rows(seed, m, 1 + seed % (2 * m), 4);
        // Bounds that the point p meets, some of them with nothing left.
        let p: Vec<f64> = (0..m).map(|i| noise(seed * 13 + i)).collect();
        let slack = |k: usize| noise(seed * 19 + k).max(0.0);
        let of_rows = (0..rows.len()).map(|j| rows.value(j, &p) + slack(m + j));
        problem.bounds = (0..m).map(|i| p[i] + slack(i)).chain(of_rows).collect();
        problem.rows = rows;
        problem.assert_optimal();
    }
}

#[test]
fn a_vertex_of_more_conditions_than_directions_is_found() {
    // Three and more lines through one point of the plane, a load into each of the sectors.
    for count in 1..6 {
        let line = |j: usize| {
            let angle = (j as f64 + 0.5) * std::f64::consts::FRAC_PI_2 / count as f64;
            [(0, angle.cos()), (1, angle.sin())]
        };
        let lines: Vec<_> = (0..count).map(line).collect();
        let rows: Vec<&[_]> = lines.iter().map(|line| &line[..]).collect();
        for k in 0..32 {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 32.0).sin_cos();
            let h = Mat::from_fn(2, 2, |i, j| if i == j { 2.0 } else { 0.5 });
            let bounds = vec![0.0; 2 + count];
            Problem::with_rows(h, &[cos, sin], &rows, &bounds).assert_optimal();
        }
    }
}

#[test]
fn a_normal_jump_may_be_bounded_from_both_sides() {
    for (c, bounds) in [
        ([-3.0, 0.5, 0.1], [0.1, 0.2, 0.3, 0.4, 0.5]),
        ([-3.0, -9.0, -4.0], [0.1, 0.2, 0.3, 0.4, 0.5]),
        ([3.0, 0.5, -4.0], [0.1, 0.2, 0.3, -0.1, -0.3]),
    ] {
        let h = Mat::from_fn(3, 3, |i, j| if i == j { 2.0 } else { -0.5 });
        let rows: [&[_]; 2] = [&[(0, -1.0)], &[(2, -1.0)]];
        Problem::with_rows(h, &c, &rows, &bounds).assert_optimal();
    }
}

#[test]
fn a_dependent_condition_alone_holds_what_nothing_resists() {
    // H = 0 along moving both normal jumps at once, which only their sum's bound stops.
    let h = Mat::from_fn(2, 2, |i, j| if i == j { 1.0 } else { -1.0 });
    let rows: [&[_]; 1] = [&[(0, 0.6), (1, 0.8)]];
    let problem = Problem::with_rows(h, &[1.0, 0.5], &rows, &[9.0, 9.0, 0.7]);
    assert_eq!(problem.assert_optimal(), [true, true, false]);
}

#[test]
fn conditions_that_contradict_each_other_have_no_solution() {
    let h = Mat::<f64>::identity(1, 1);
    let rows: [&[_]; 1] = [&[(0, -1.0)]];
    let (solution, _) = Problem::with_rows(h, &[1.0], &rows, &[0.1, -0.2]).solve();
    assert!(!solution.converged);
}

/// A row of `bricks` between two walls, each brick `points` nodes high, free
/// to move along the row by up to `gap` and under loads that balance.
fn brick_row(seed: usize, bricks: usize, points: usize, gap: f64) -> Problem {
    let sides = 2 * points;
    let rights = (bricks - 1) * points;
    let all = rights + (bricks + 1) * points;
    // Unknowns are the right sides' displacements but the last one's, then the normal jumps.
    let right = |brick: usize, i: usize| match brick + 1 < bricks {
        true => brick * points + i,
        false => rights + bricks * points + i,
    };
    let jump = |joint: usize, i: usize| rights + joint * points + i;
    let without_mean = |a: Mat<f64>| {
        let means: Vec<f64> = (a.col_iter())
            .map(|column| column.iter().sum::<f64>() / sides as f64)
            .collect();
        Mat::from_fn(sides, a.ncols(), |i, j| a[(i, j)] - means[j])
    };
    let mut k = Mat::<f64>::zeros(all, all);
    let mut f = Mat::<f64>::zeros(all, 1);
    for brick in 0..bricks {
        let at = seed * 1000 + brick * 100;
        let root = without_mean(Mat::from_fn(sides, sides, |i, j| noise(at + i * 31 + j)));
        let load = without_mean(Mat::from_fn(sides, 1, |i, _| noise(at + 57 * i)));
        let mut of_unknowns = Mat::<f64>::zeros(sides, all);
        for i in 0..points {
            of_unknowns[(i, jump(brick, i))] -= 1.0;
            if brick > 0 {
                of_unknowns[(i, right(brick - 1, i))] += 1.0;
            }
            of_unknowns[(points + i, right(brick, i))] += 1.0;
        }
        k += of_unknowns.transpose() * &root * root.transpose() * &of_unknowns;
        f += of_unknowns.transpose() * load;
    }
    // With every joint closed the row is one piece between the walls.
    let coupling = k.submatrix(rights, 0, all - rights, rights);
    let piece = k.submatrix(0, 0, rights, rights).llt(Side::Lower).unwrap();
    let h = k.submatrix(rights, rights, all - rights, all - rights)
        - coupling * piece.solve(coupling.transpose());
    let c = f.subrows(rights, all - rights) - coupling * piece.solve(f.subrows(0, rights));
    let m = all - rights;
    let bounds: Vec<f64> = (0..m).map(|i| gap * noise(seed * 13 + i).abs()).collect();
    let symmetric = Mat::from_fn(m, m, |i, j| 0.5 * (h[(i, j)] + h[(j, i)]));
    Problem::new(symmetric, c.col_as_slice(0), &bounds)
}

#[test]
fn bricks_that_lose_their_hold_stay_between_their_neighbours() {
    // Flipping turns in circles in this row.
    brick_row(53, 8, 3, 5.0).assert_optimal();
    (0..40).for_each(|seed| drop(brick_row(seed, 8, 4, 0.2).assert_optimal()));
}
