//! The friction limit: a rigid motion that only friction at its bound resists. As friction stays at the bound wherever
//! the bodies slide, their position is indeterminate.

use nalgebra::{DMatrix, DVector};

use super::kinematics::Kinematics;
use super::released_modes::ConditionState;
use super::scene::{RigidRow, Scene};

/// Ratio of the work of friction to its bound from which on it counts as being at its limit.
const AT_LIMIT: f64 = 1.0 - 1e-6;
/// Singular value, relative to the largest, that counts as zero.
const RANK: f64 = 1e-9;

/// A point whose friction is at its bound.
struct AtBound {
    /// Tangential constraints.
    tangents: Vec<usize>,
    bound: f64,
}

/// Resistance of a solution's contacts to rigid motions.
#[derive(Default)]
struct Resistance {
    /// Points under pressure, and points that stick below their bound.
    rows: Vec<RigidRow>,
    at_bound: Vec<AtBound>,
}

impl Scene {
    /// Descriptions of motions along which bodies may slide under the same forces: no pressure or sticking contact
    /// resists them, and friction does all of its largest possible work but a millionth. Only sides that have slipped
    /// and carry friction are considered.
    pub fn friction_limit(&self, conditions: &[ConditionState]) -> Vec<String> {
        let kinematics = Kinematics::new(self.dim, &self.bodies);
        let Resistance { rows, at_bound } = self.resistance(conditions);
        if kinematics.len == 0 || at_bound.is_empty() {
            return Vec::new();
        }
        let Some(free) = kinematics.unheld(&rows, &[]) else {
            return Vec::new();
        };
        if free.ncols() == 0 {
            return Vec::new();
        }
        let tangents = at_bound.iter().flat_map(|point| &point.tangents);
        let tangents: Vec<RigidRow> = tangents.map(|&j| self.rows[j].clone()).collect();
        let slips = kinematics.jumps(&tangents, &free);
        let of_points = |value: &dyn Fn(&AtBound, usize) -> f64| {
            let values = at_bound.iter().flat_map(|point| {
                let of_point = point.tangents.iter();
                of_point.map(|&j| value(point, j)).collect::<Vec<f64>>()
            });
            DVector::from_iterator(tangents.len(), values)
        };
        let weights = of_points(&|point, _| point.bound);
        let forces = of_points(&|_, j| conditions[j].force);
        let targets = [
            of_points(&|_, j| -conditions[j].gap),
            of_points(&|point, j| conditions[j].force / point.bound),
        ];
        let motion = targets.into_iter().find_map(|target| {
            let along = nearest(&slips, &weights, &target)?;
            let moved = &slips * &along;
            let mut left = moved.as_slice();
            let most = at_bound.iter().map(|point| {
                let (own, others) = left.split_at(point.tangents.len());
                left = others;
                point.bound * own.iter().map(|x| x * x).sum::<f64>().sqrt()
            });
            let most: f64 = most.sum();
            let is_at_limit = most > 0.0 && forces.dot(&moved) >= AT_LIMIT * most;
            is_at_limit.then(|| (&free * along).normalize())
        });
        let motions: Vec<_> = motion.iter().map(|x| kinematics.motion(x)).collect();
        kinematics.described(&self.bodies, &self.names, &motions)
    }

    fn resistance(&self, conditions: &[ConditionState]) -> Resistance {
        let mut resistance = Resistance::default();
        let mut tangents: Vec<Vec<usize>> = vec![Vec::new(); self.rows.len()];
        for (j, row) in self.rows.iter().enumerate() {
            if let Some(friction) = &row.friction {
                tangents[friction.normal].push(j);
            }
        }
        for (normal, tangents) in tangents.into_iter().enumerate() {
            let pressed = conditions[normal];
            if self.rows[normal].friction.is_none() && pressed.carrying {
                resistance.rows.push(self.rows[normal].clone());
            }
            let Some(friction) = tangents.first().and_then(|&j| self.rows[j].friction) else {
                continue;
            };
            let bound = friction.bound.at(pressed.force, pressed.closed);
            let squares = tangents.iter().map(|&j| conditions[j].force.powi(2));
            let size = squares.sum::<f64>().sqrt();
            if bound <= 0.0
                || !(pressed.carrying || friction.holds_without_pressure(pressed.closed))
            {
                continue;
            }
            if size < AT_LIMIT * bound {
                let rows = tangents.iter().map(|&j| self.rows[j].clone());
                resistance.rows.extend(rows);
            } else {
                resistance.at_bound.push(AtBound { tangents, bound });
            }
        }
        resistance
    }
}

/// The combination of motions nearest to a `target`, where the columns of `slips` are the slips of the motions.
fn nearest(
    slips: &DMatrix<f64>,
    weights: &DVector<f64>,
    target: &DVector<f64>,
) -> Option<DVector<f64>> {
    let weighted = DMatrix::from_fn(slips.nrows(), slips.ncols(), |i, k| {
        weights[i] * slips[(i, k)]
    });
    if !weighted.iter().chain(target).all(|x| x.is_finite()) {
        return None;
    }
    let svd = weighted.svd(true, true);
    let least = RANK * svd.singular_values.max();
    svd.solve(&weights.component_mul(target), least).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::squares::{coulomb, scene, square};

    /// The description for a square on a floor with these normal and tangential forces at its lower corners.
    fn messages(forces: [[f64; 2]; 2], sticks: bool) -> Vec<String> {
        let body = square([0.0; 3]);
        let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]];
        let mut rows = corners.map(|x| body.row(0, x, [0.0, -1.0, 0.0])).to_vec();
        for (normal, x) in corners.into_iter().enumerate() {
            rows.push(body.row(0, x, [1.0, 0.0, 0.0]).rough(normal, coulomb(0.5)));
        }
        let scene = scene(2, vec![body], rows);
        let state = |force: f64, closed| ConditionState {
            carrying: force != 0.0,
            closed,
            gap: if closed { 0.0 } else { -3.0 * force },
            force,
        };
        let conditions: Vec<ConditionState> = (forces.iter().map(|f| state(f[0], true)))
            .chain(forces.iter().map(|f| state(f[1], sticks)))
            .collect();
        scene.friction_limit(&conditions)
    }

    #[test]
    fn a_block_that_all_its_friction_holds_is_at_the_limit() {
        for (forces, sticks, is_at_limit) in [
            ([[2.0, 1.0], [4.0, 2.0]], false, true),
            ([[2.0, 1.0], [4.0, 2.0]], true, true),
            // The friction forces are opposite.
            ([[2.0, 1.0], [4.0, -2.0]], false, false),
            ([[2.0, 1.0], [4.0, 2.0 * (1.0 - 1e-9)]], false, true),
            ([[2.0, 1.0], [4.0, 1.9]], false, false),
            ([[0.0, 0.0], [4.0, 0.0]], true, false),
        ] {
            let found = messages(forces, sticks);
            let expected = match is_at_limit {
                true => vec!["'brick 0' (translation along (1.0000, 0.0000))".to_owned()],
                false => Vec::new(),
            };
            assert_eq!(found, expected, "{forces:?} {sticks}");
        }
    }
}
