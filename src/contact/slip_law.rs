//! A slipping point whose force follows the pressure, and turns with the slip.

use crate::contact::law::{LinearLaw, PointLaw, PointState, PointStatus};
use crate::contact::limits::{Limits, TangentialLimit};
use crate::contact::status::FixedStatus;

/// Part of its bound below which a slipping force is off it: the contact is about to open.
pub const AT_BOUND: f64 = 1.0 - 1e-9;

/// A slipping point.
#[derive(Clone, Debug)]
pub struct SlipLaw {
    point: PointLaw,
    /// True if its contact is closed.
    is_closed: bool,
    /// True if the contact is about to open.
    parts: bool,
    /// e.
    direction: [f64; 2],
    /// κ (N/m).
    turning: f64,
    laws: Vec<LinearLaw>,
}

impl SlipLaw {
    /// The law of a point with this status in a closed or open contact; `None` if it doesn't slip.
    pub fn new(point: &PointLaw, status: &PointStatus, is_closed: bool) -> Option<Self> {
        let (direction, turning, parts) = match *status {
            PointStatus::Slips { direction, turning } => (direction, turning, false),
            PointStatus::Parts { direction, turning } => (direction, turning, true),
            PointStatus::Open | PointStatus::Sticks => return None,
        };
        Some(Self {
            point: *point,
            is_closed,
            parts,
            direction,
            turning,
            laws: point.linear(status, is_closed),
        })
    }

    /// The laws of the points within `limits` that slip by these statuses of limits, under these `forces` of their
    /// conditions, each of which has a `stiffness` r (N/m); the constant part of the bound is the distance of forces to
    /// it, and where that is more than round-off the contact is about to open.
    pub fn of_slipping(
        limits: &Limits,
        stiffness: impl Fn(usize) -> f64,
        fixed: &[FixedStatus],
        forces: &[f64],
    ) -> Vec<Self> {
        let of_limits = limits.conditions_of_limits();
        let forces = limits.of_limits(forces);
        let closed: Vec<bool> = fixed.iter().map(FixedStatus::is_closed).collect();
        let law = |tangent: &TangentialLimit| {
            let mut point = PointLaw::new(tangent, stiffness(of_limits[tangent.limit]))?;
            let PointState { force, bound, .. } = point.at(|_| 0.0, &forces, &closed);
            let size = match point.prescribed == 0.0 {
                true => force[0].hypot(force[1]),
                false => bound,
            };
            let is_closed = point.is_closed(&closed);
            let direction = force.map(|e| e / size);
            let [_, turning] = fixed[point.first].slip().unwrap_or_default();
            let status = match is_closed && size < AT_BOUND * bound {
                true => PointStatus::Parts { direction, turning },
                false => PointStatus::Slips { direction, turning },
            };
            point.prescribed = 0.0;
            point.bound.only_closed = false;
            point.bound.cohesion = bound - size;
            let slips = size > 0.0 && point.limits().all(|t| !closed[t]);
            Self::new(&point, &status, is_closed).filter(|_| slips)
        };
        limits.tangents.iter().filter_map(law).collect()
    }

    /// Adds to `residuals` the law's residual for these `forces` and slips of limits, for a change without the constant.
    pub fn add_residual(
        &self,
        forces: &[f64],
        slip: impl Fn(usize) -> f64,
        is_change: bool,
        residuals: &mut [f64],
    ) {
        for law in &self.laws {
            let of_forces: f64 = law.forces.iter().map(|&(i, c)| c * forces[i]).sum();
            let of_slips: f64 = law.slips.iter().map(|&(i, c)| c * slip(i)).sum();
            let constant = if is_change { 0.0 } else { law.constant };
            residuals[law.limit] += of_forces + of_slips - constant;
        }
    }

    /// κ (N/m).
    pub fn turning(&self) -> f64 {
        self.turning
    }

    /// The force of the point under this pressure (N/m) for a slip along e.
    pub fn set_force(&self, forces: &[f64], own: &mut [f64]) {
        let e = self.direction;
        let known = self.point.tangents.map(|t| t.map_or(0.0, |t| forces[t]));
        let pressure = self.point.normal.map_or(0.0, |n| forces[n]);
        let size = match self.parts {
            true => known[0] * e[0] + known[1] * e[1],
            false => self.point.bound.at(pressure, self.is_closed),
        };
        for (t, e) in self.limits().zip(e) {
            own[t] = size * e;
        }
    }

    /// The forces that would cause these slips against the point's own stiffness.
    pub fn set_holding(&self, slip: impl Fn(usize) -> f64, forces: &mut [f64]) {
        for t in self.limits() {
            forces[t] = self.point.stiffness * slip(t);
        }
    }

    /// Adds to `slips` those that `forces` on the jumps of the point would cause against its own stiffness.
    pub fn add_slips(&self, forces: &[f64], slips: &mut [f64]) {
        for t in self.limits() {
            slips[t] += forces[t] / self.point.stiffness;
        }
    }

    /// Its part of a product of two vectors of forces, a·b / r (J).
    pub fn product(&self, a: &[f64], b: &[f64]) -> f64 {
        let sum: f64 = self.limits().map(|t| a[t] * b[t]).sum();
        sum / self.point.stiffness
    }

    /// The limits of its tangential jumps.
    pub fn limits(&self) -> impl Iterator<Item = usize> {
        self.point.limits()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::tangent::ForceBound;

    const POINT: PointLaw = PointLaw {
        normal: Some(0),
        first: 1,
        tangents: [Some(1), Some(2)],
        prescribed: 0.0,
        bound: ForceBound {
            coefficient: 0.4,
            cohesion: 0.1,
            only_closed: true,
        },
        stiffness: 3.0,
    };

    fn at(forces: [f64; 3], slips: [f64; 2]) -> PointState {
        POINT.at(|t| slips[t - 1], &forces, &[true; 3])
    }

    /// λ_t − b ξ/|ξ|, the residual of the nonlinear law.
    fn natural_map(forces: [f64; 3], slips: [f64; 2]) -> [f64; 2] {
        let here = at(forces, slips);
        let xi = POINT.reach(&here);
        let size = xi[0].hypot(xi[1]);
        [0, 1].map(|k| forces[k + 1] - here.bound * xi[k] / size)
    }

    #[test]
    fn what_the_linear_law_misses_changes_as_what_the_law_misses() {
        let (forces, slips, step) = ([2.0, 0.5, -0.9], [0.3, -0.7], 1e-6);
        let status = POINT.status(&at(forces, slips), 0.0);
        let law = SlipLaw::new(&POINT, &status, true).unwrap();
        for direction in 0..5 {
            let mut unit = [0.0; 5];
            unit[direction] = 1.0;
            let mut change = [0.0; 3];
            let slip = |t: usize| unit[2 + t];
            law.add_residual(&unit[..3], slip, true, &mut change);
            let moved = |by: f64| {
                let forces = [0, 1, 2].map(|i| forces[i] + by * unit[i]);
                natural_map(forces, [0, 1].map(|k| slips[k] + by * unit[3 + k]))
            };
            let (ahead, back) = (moved(step), moved(-step));
            for k in 0..2 {
                let slope = (ahead[k] - back[k]) / (2.0 * step);
                assert!((change[k + 1] - slope).abs() < 1e-8, "{direction} {k}");
            }
        }
    }

    #[test]
    fn a_change_of_forces_against_the_compliance_of_the_point_itself_is_its_residual() {
        let status = POINT.status(&at([2.0, 0.5, -0.9], [0.3, -0.7]), 0.0);
        let law = SlipLaw::new(&POINT, &status, true).unwrap();
        assert!(law.turning() > 0.0);
        let (forces, mut residual) = ([0.0, 0.4, -1.3], [0.0; 3]);
        let slip = |t: usize| -forces[t] / POINT.stiffness;
        law.add_residual(&forces, slip, true, &mut residual);
        for t in 1..3 {
            assert!((forces[t] - residual[t]).abs() < 1e-14, "{t}: {residual:?}");
        }
    }
}
