use faer::Mat;

use super::*;
use crate::contact::dependent::DependentConstraints;
use crate::contact::friction::ForceBound;

fn noise(seed: usize) -> f64 {
    2.0 * ((seed as f64 * 78.233).sin() * 43758.5453).fract().abs() - 1.0
}

/// Points with a normal and two tangential jumps each, normals first, on a random stiffness.
struct Points {
    h: Mat<f64>,
    c: Vec<f64>,
    bounds: Vec<f64>,
    rows: DependentConstraints,
    tangents: Vec<TangentialLimit>,
}

impl Points {
    fn new(points: usize, seed: usize, bound: ForceBound) -> Self {
        let m = 3 * points;
        let a = Mat::from_fn(m, m, |i, j| noise(seed + 7 * i + 131 * j));
        let mut h = a.transpose() * &a;
        for i in 0..m {
            h[(i, i)] += 2.0;
        }
        let tangent = |k: usize| TangentialLimit {
            limit: points + k,
            normal: Some(k / 2),
            bound,
            beside: Beside::Limit(points + (k ^ 1)),
        };
        Self {
            h,
            c: (0..m).map(|i| 3.0 * noise(seed + 1000 + i)).collect(),
            bounds: (0..m).map(|i| 0.1 * noise(seed + 2000 + i)).collect(),
            rows: DependentConstraints::default(),
            tangents: (0..2 * points).map(tangent).collect(),
        }
    }

    fn solve(&self, status: &mut [Status]) -> ContactSolution {
        let m = self.c.len();
        let diagonal: Vec<f64> = (0..m).map(|i| self.h[(i, i)]).collect();
        let c_scale: Vec<f64> = self.c.iter().map(|c| c.abs()).collect();
        let problem = FrictionProblem {
            contact: ContactProblem {
                h: self.h.as_ref(),
                diagonal: &diagonal,
                c: &self.c,
                c_scale: &c_scale,
                rows: &self.rows,
                bounds: &self.bounds,
                center: &vec![0.0; m],
                scale: 1.0,
            },
            tangents: &self.tangents,
        };
        problem.solve(status)
    }

    /// The largest violation of equilibrium and of the laws.
    fn violation(&self, solution: &ContactSolution) -> f64 {
        let (t, forces) = (&solution.jumps, &solution.forces);
        let m = t.len();
        let mut left = self.c.clone();
        self.rows.subtract_transposed(&forces[m..], &mut left);
        let held = |i: usize| (0..m).map(|j| self.h[(i, j)] * t[j]).sum::<f64>();
        let unbalanced = (0..m).map(|i| (left[i] - held(i) - forces[i]).abs());
        let mut worst = unbalanced.fold(0.0, f64::max);
        let rows = (0..self.rows.len()).map(|j| self.rows.value(j, t));
        let values: Vec<f64> = t.iter().copied().chain(rows).collect();
        let beyond = |i: usize| values[i] - self.bounds[i];
        let is_tangential = |i: usize| self.tangents.iter().any(|tangent| tangent.limit == i);
        for i in (0..values.len()).filter(|&i| !is_tangential(i)) {
            let product = (beyond(i) * forces[i]).abs();
            worst = worst.max(beyond(i)).max(-forces[i]).max(product);
        }
        for tangent in &self.tangents {
            let (other, slip) = match tangent.beside {
                Beside::Limit(other) => (forces[other], beyond(other)),
                Beside::Prescribed(slip) => (0.0, slip),
                Beside::Nothing => (0.0, 0.0),
            };
            let normal = tangent.normal.map_or(0.0, |n| forces[n]);
            let bound = tangent.bound.at(normal, normal > 0.0);
            let (force, own) = (forces[tangent.limit], beyond(tangent.limit));
            let size = own.hypot(slip);
            worst = worst.max(match tangent.beside {
                Beside::Prescribed(_) => (force * size - bound * own).abs(),
                _ => {
                    let opposed = bound * size - force * own - other * slip;
                    (force.hypot(other) - bound).max(opposed.abs())
                }
            });
        }
        worst
    }
}

const COULOMB: ForceBound = ForceBound {
    coefficient: 0.3,
    cohesion: 0.0,
    only_closed: true,
};
const GIVEN: ForceBound = ForceBound {
    coefficient: 0.0,
    cohesion: 0.4,
    only_closed: false,
};

#[test]
fn equilibrium_and_every_law_hold_at_random_points_in_space() {
    let (mut seen, mut steps) = ([0; 3], 0);
    for seed in 0..200 {
        let steep = ForceBound {
            coefficient: 1.2,
            ..COULOMB
        };
        let points = Points::new(1 + seed % 9, 17 * seed, [COULOMB, GIVEN, steep][seed % 3]);
        let mut status = vec![Status::Closed; points.c.len()];
        let solution = points.solve(&mut status);
        assert!(solution.converged, "seed {seed}");
        let violation = points.violation(&solution);
        assert!(violation < 1e-11, "seed {seed}: {violation:e}");
        for tangent in &points.tangents {
            seen[match status[tangent.limit] {
                Status::Open => 0,
                Status::Closed => 1,
                _ => 2,
            }] += 1;
        }
        steps = steps.max(solution.steps);
        // From its own statuses it stays where it is.
        let known = status.clone();
        let again = points.solve(&mut status);
        assert!(again.converged && status == known, "seed {seed}");
    }
    assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
}

#[test]
fn a_slip_that_supports_prescribe_along_one_tangent_turns_the_force_along_the_other() {
    for seed in 0..60 {
        let mut points = Points::new(3, 13 * seed, [COULOMB, GIVEN][seed % 2]);
        // The second tangents have no unknowns any more.
        points.tangents.retain(|tangent| tangent.limit % 2 == 1);
        let kept: Vec<usize> = [0, 1, 2].into_iter().chain([3, 5, 7]).collect();
        points.h = Mat::from_fn(6, 6, |i, j| points.h[(kept[i], kept[j])]);
        points.c = kept.iter().map(|&i| points.c[i]).collect();
        points.bounds = kept.iter().map(|&i| points.bounds[i]).collect();
        for (k, tangent) in points.tangents.iter_mut().enumerate() {
            tangent.limit = 3 + k;
            tangent.beside = match k {
                0 => Beside::Nothing,
                _ => Beside::Prescribed(0.2 * noise(seed + k)),
            };
        }
        let solution = points.solve(&mut [Status::Closed; 6]);
        assert!(solution.converged, "seed {seed}");
        let violation = points.violation(&solution);
        assert!(violation < 1e-10, "seed {seed}: {violation:e}");
    }
}

/// The tangential jumps of the last point are sums of those of two others, as at a node of several contacts.
#[test]
fn tangential_jumps_that_depend_on_others_have_their_laws_too() {
    let mut converged = 0;
    for seed in 0..60 {
        let mut points = Points::new(3, 29 * seed, GIVEN);
        points.rows.push(vec![(3, 0.6), (5, 0.8)]);
        points.rows.push(vec![(4, 0.6), (6, 0.8)]);
        points
            .bounds
            .extend([noise(seed), noise(seed + 1)].map(|x| 0.1 * x));
        points.tangents.extend([9, 10].map(|limit| TangentialLimit {
            limit,
            normal: Some(2),
            bound: GIVEN,
            beside: Beside::Limit(19 - limit),
        }));
        let solution = points.solve(&mut [Status::Closed; 11]);
        if solution.converged {
            let violation = points.violation(&solution);
            assert!(violation < 1e-10, "seed {seed}: {violation:e}");
            converged += 1;
        }
    }
    assert!(converged > 55, "{converged}");
}
