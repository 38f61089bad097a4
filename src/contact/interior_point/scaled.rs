//! The linear system of an interior-point step, in the scale of energies.

use faer::linalg::solvers::{Llt, SolveCore};
use faer::{Conj, Mat, MatMut, Side};

use super::cone::{Cone, Scaling};
use super::iterate::{Iterate, SHARE};
use super::problem::{ConvexProblem, GivenFriction};
use crate::contact::dependent::DependentConstraints;
use crate::schur::local::multiply_add;
use crate::vector::{axpy, largest};

/// Shortest step.
const SHORTEST: f64 = 1e-10;
/// Stiffness, relative to the diagonal, that bounds motions without resistance.
const SPRING: f64 = 1e-15;

/// The problem with gaps and forces as square roots of energies, relative to the load, so that units don't matter.
pub struct Scaled {
    h: Mat<f64>,
    c: Vec<f64>,
    /// \[I; D\].
    limits: DependentConstraints,
    bounds: Vec<f64>,
    /// The normal limits.
    pub normals: Vec<usize>,
    /// Points that friction holds, without those whose bound is 0.
    points: Vec<GivenFriction>,
    /// Factor of every limit's value.
    pub size: Vec<f64>,
    /// Factor of all values and forces.
    pub load: f64,
}

impl Scaled {
    /// The scaled form of a problem; `None` without load.
    pub fn new(problem: &ConvexProblem<'_>) -> Option<Self> {
        let (n, all) = (problem.c.len(), problem.bounds.len());
        let mut scale = problem.scale.to_vec();
        for row in problem.rows.iter() {
            let compliance = row.iter().map(|&(i, c)| c * c / problem.scale[i]);
            scale.push(1.0 / compliance.sum::<f64>());
        }
        let mut is_normal = vec![true; all];
        for point in problem.points {
            let limits = || point.limits.into_iter().flatten();
            let mean = limits().map(|i| scale[i]).sum::<f64>() / limits().count() as f64;
            for i in limits() {
                (scale[i], is_normal[i]) = (mean, false);
            }
        }
        let size: Vec<f64> = scale.iter().map(|scale| scale.sqrt()).collect();
        let mut limits = DependentConstraints::default();
        (0..n).for_each(|i| limits.push(vec![(i, 1.0)]));
        for (row, own) in problem.rows.iter().zip(&size[n..]) {
            limits.push(row.iter().map(|&(i, c)| (i, c * own / size[i])).collect());
        }
        let mut bounds: Vec<f64> = (problem.bounds.iter().zip(&size))
            .map(|(bound, size)| bound * size)
            .collect();
        let mut c: Vec<f64> = (problem.c.iter().zip(&size))
            .map(|(c, size)| c / size)
            .collect();
        let h = Mat::from_fn(n, n, |i, j| problem.h[(i, j)] / size[i] / size[j]);
        let mut acting = c.clone();
        let held: Vec<f64> = bounds[..n].iter().map(|g| -g).collect();
        multiply_add(h.as_ref(), &held, &mut acting);
        acting.extend((n..all).map(|j| bounds[j] - limits.value(j, &bounds)));
        let load = largest(&acting);
        if load == 0.0 || !load.is_finite() {
            return None;
        }
        bounds.iter_mut().for_each(|bound| *bound /= load);
        c.iter_mut().for_each(|c| *c /= load);
        let scaled = |point: &GivenFriction| {
            let first = point.limits.into_iter().flatten().next()?;
            (point.bound > 0.0).then_some(GivenFriction {
                prescribed: point.prescribed * size[first] / load,
                bound: point.bound / size[first] / load,
                ..*point
            })
        };
        Some(Self {
            points: problem.points.iter().filter_map(scaled).collect(),
            h: Mat::from_fn(n, n, |i, j| h[(i, j)] + if i == j { SPRING } else { 0.0 }),
            c,
            limits,
            bounds,
            normals: (0..all).filter(|&i| is_normal[i]).collect(),
            size,
            load,
        })
    }

    /// The first iterate: jumps at their bounds, all products of gaps and forces 1.
    pub fn start(&self) -> Iterate {
        let cone = |point: &GivenFriction| Cone {
            x: [1.0 / point.bound, 0.0, 0.0],
            z: [point.bound, 0.0, 0.0],
        };
        Iterate {
            t: self.bounds[..self.c.len()].to_vec(),
            s: vec![1.0; self.normals.len()],
            w: vec![1.0; self.normals.len()],
            cones: self.points.iter().map(cone).collect(),
        }
    }

    /// v of limit i.
    fn value(&self, i: usize, t: &[f64]) -> f64 {
        self.limits.value(i, t) - self.bounds[i]
    }

    /// Forces of all limits.
    pub fn forces(&self, at: &Iterate) -> Vec<f64> {
        let mut forces = vec![0.0; self.bounds.len()];
        for (&i, w) in self.normals.iter().zip(&at.w) {
            forces[i] = *w;
        }
        for (point, cone) in self.points.iter().zip(&at.cones) {
            for (k, i) in point.limits.into_iter().enumerate() {
                if let Some(i) = i {
                    forces[i] = -cone.z[1 + k];
                }
            }
        }
        forces
    }

    /// Values along both tangents of a point of a function of its limits, and `prescribed` along one without limit.
    fn of_point(point: &GivenFriction, prescribed: f64, value: impl Fn(usize) -> f64) -> [f64; 2] {
        let [first, second] = point.limits;
        [first.map_or(0.0, &value), second.map_or(prescribed, &value)]
    }

    /// The residuals of equilibrium, gaps and slips.
    fn residual(&self, at: &Iterate) -> Residual {
        let mut forces = self.c.clone();
        let negative: Vec<f64> = at.t.iter().map(|t| -t).collect();
        multiply_add(self.h.as_ref(), &negative, &mut forces);
        self.limits
            .subtract_transposed(&self.forces(at), &mut forces);
        let gaps = (self.normals.iter().zip(&at.s)).map(|(&i, s)| -self.value(i, &at.t) - s);
        let slip = |(point, cone): (&GivenFriction, &Cone)| {
            let [first, second] = Self::of_point(point, point.prescribed, |i| self.value(i, &at.t));
            [first - cone.x[1], second - cone.x[2]]
        };
        Residual {
            forces,
            gaps: gaps.collect(),
            slips: self.points.iter().zip(&at.cones).map(slip).collect(),
        }
    }

    /// H with the stiffness w/s of all normal limits and that of all cones.
    fn matrix(&self, at: &Iterate, scalings: &[Scaling]) -> Mat<f64> {
        let mut matrix = self.h.clone();
        let mut add = |left: &[(usize, f64)], right: &[(usize, f64)], stiffness: f64| {
            for &(b, d_b) in right {
                for &(a, d_a) in left {
                    matrix[(a, b)] += stiffness * d_a * d_b;
                }
            }
        };
        for (&i, (s, w)) in self.normals.iter().zip(at.s.iter().zip(&at.w)) {
            add(self.limits.row(i), self.limits.row(i), w / s);
        }
        for (point, scaling) in self.points.iter().zip(scalings) {
            for (k, i) in point.limits.into_iter().enumerate() {
                for (l, j) in point.limits.into_iter().enumerate() {
                    if let (Some(i), Some(j)) = (i, j) {
                        let stiffness = scaling.stiffness[k][l];
                        add(self.limits.row(i), self.limits.row(j), stiffness);
                    }
                }
            }
        }
        matrix
    }

    /// The iterate after a predictor and a corrector step; `None` where round-off leaves no step.
    pub fn step(&self, at: &Iterate) -> Option<Iterate> {
        let scalings: Vec<Scaling> = at.cones.iter().map(Cone::scaling).collect();
        let matrix = self.matrix(at, &scalings);
        let system = System {
            factor: matrix.llt(Side::Lower).ok()?,
            matrix,
            residual: self.residual(at),
            scalings,
        };
        let products: Vec<f64> = at.s.iter().zip(&at.w).map(|(s, w)| s * w).collect();
        let predicted = system.direction(
            self,
            at,
            &Target {
                products: products.iter().map(|sw| -sw).collect(),
                cones: system.scalings.iter().map(Scaling::predictor).collect(),
            },
        );
        let mu = at.mean_product();
        let there = at.moved(&predicted, at.reach(&predicted).min(1.0));
        let aim = mu * (there.mean_product() / mu).min(1.0).powi(3);
        let second = predicted.s.iter().zip(&predicted.w).map(|(s, w)| s * w);
        let corrected = system.direction(
            self,
            at,
            &Target {
                products: (products.iter().zip(second))
                    .map(|(sw, second)| aim - sw - second)
                    .collect(),
                cones: (system.scalings.iter().zip(&predicted.cones))
                    .map(|(scaling, step)| scaling.corrector(aim, step))
                    .collect(),
            },
        );
        let reach = at.reach(&corrected);
        (reach >= SHORTEST).then(|| at.moved(&corrected, (SHARE * reach).min(1.0)))
    }
}

/// The residuals, or their change in a step.
struct Residual {
    /// c − H t − Σ forces.
    forces: Vec<f64>,
    /// −v − s.
    gaps: Vec<f64>,
    /// v − x₁₂.
    slips: Vec<[f64; 2]>,
}

/// The aim of a step: s dw + w ds of normal limits, and W r of cones.
struct Target {
    products: Vec<f64>,
    cones: Vec<[f64; 3]>,
}

/// The linear system of a step.
struct System {
    matrix: Mat<f64>,
    factor: Llt<f64>,
    residual: Residual,
    scalings: Vec<Scaling>,
}

impl System {
    /// The step with this target.
    fn direction(&self, problem: &Scaled, at: &Iterate, target: &Target) -> Iterate {
        let Residual {
            forces,
            gaps,
            slips,
        } = &self.residual;
        let mut pushes = vec![0.0; problem.bounds.len()];
        for (k, &i) in problem.normals.iter().enumerate() {
            pushes[i] = (target.products[k] - at.w[k] * gaps[k]) / at.s[k];
        }
        let cones = || problem.points.iter().zip(&self.scalings);
        for ((point, scaling), (target, slip)) in cones().zip(target.cones.iter().zip(slips)) {
            let force = scaling.pushed([target[1] - slip[0], target[2] - slip[1]]);
            for (i, force) in point.limits.into_iter().zip(force) {
                if let Some(i) = i {
                    pushes[i] = -force;
                }
            }
        }
        let mut left = forces.clone();
        problem.limits.subtract_transposed(&pushes, &mut left);
        let t = self.solved(&left);
        let s: Vec<f64> = (problem.normals.iter().zip(gaps))
            .map(|(&i, gap)| gap - problem.limits.value(i, &t))
            .collect();
        let w = (s.iter().enumerate())
            .map(|(k, ds)| (target.products[k] - at.w[k] * ds) / at.s[k])
            .collect();
        let cone = |((point, scaling), (target, slip)): (_, (&[f64; 3], &[f64; 2]))| {
            let scaling: &Scaling = scaling;
            let moved = Scaled::of_point(point, 0.0, |i| problem.limits.value(i, &t));
            scaling.step(target, [slip[0] + moved[0], slip[1] + moved[1]])
        };
        Iterate {
            cones: cones()
                .zip(target.cones.iter().zip(slips))
                .map(cone)
                .collect(),
            t,
            s,
            w,
        }
    }

    /// Solution for a right-hand side, refined once.
    fn solved(&self, right: &[f64]) -> Vec<f64> {
        let n = right.len();
        let solve = |mut x: Vec<f64>| {
            let column = MatMut::from_column_major_slice_mut(&mut x, n, 1);
            self.factor.solve_in_place_with_conj(Conj::No, column);
            x
        };
        let mut x = solve(right.to_vec());
        let negative: Vec<f64> = x.iter().map(|x| -x).collect();
        let mut left = right.to_vec();
        multiply_add(self.matrix.as_ref(), &negative, &mut left);
        axpy(1.0, &solve(left), &mut x);
        x
    }
}
