//! An iterate of the interior-point method, or a step between two.

use super::cone::Cone;
use crate::vector::{axpy, dot};

/// Length of a step relative to that which reaches the next bound.
pub const SHARE: f64 = 0.995;

/// Jumps, gaps and forces of normal limits, and the cones of points, or a step of them.
#[derive(Clone)]
pub struct Iterate {
    /// t.
    pub t: Vec<f64>,
    /// s of normal limits.
    pub s: Vec<f64>,
    /// w of normal limits.
    pub w: Vec<f64>,
    /// Slips and forces of points.
    pub cones: Vec<Cone>,
}

impl Iterate {
    /// μ.
    pub fn mean_product(&self) -> f64 {
        let cones = self.cones.iter().map(Cone::product);
        let sum = dot(&self.s, &self.w) + cones.sum::<f64>();
        sum / (self.s.len() + self.cones.len()) as f64
    }

    /// Length of a step to the first bound, at most 1/[`SHARE`].
    pub fn reach(&self, step: &Self) -> f64 {
        let gaps = self.s.iter().zip(&step.s);
        let forces = self.w.iter().zip(&step.w);
        let bounds = gaps.chain(forces).filter(|(_, dx)| **dx < 0.0);
        let cones = self.cones.iter().zip(&step.cones);
        (bounds.map(|(x, dx)| -x / dx))
            .chain(cones.map(|(cone, step)| cone.reach(step)))
            .fold(1.0 / SHARE, f64::min)
    }

    /// The iterate after this share of a step.
    pub fn moved(&self, step: &Self, share: f64) -> Self {
        let positive = |x: &[f64], dx: &[f64]| {
            let moved = |(x, dx): (&f64, &f64)| (x + share * dx).max(f64::MIN_POSITIVE);
            x.iter().zip(dx).map(moved).collect()
        };
        let mut t = self.t.clone();
        axpy(share, &step.t, &mut t);
        let cones = self.cones.iter().zip(&step.cones);
        Self {
            t,
            s: positive(&self.s, &step.s),
            w: positive(&self.w, &step.w),
            cones: cones.map(|(cone, step)| cone.moved(step, share)).collect(),
        }
    }
}
