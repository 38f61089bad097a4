//! Rigid-body motions that are free in a solution because no remaining contact force resists them.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::free_motion::FreeMotion;
use super::kinematics::Kinematics;
use super::many_bodies::{MANY, SparseRow};
use super::nonnegative;
use super::projection::MotionProducts;
use super::scene::{Friction, RigidRow, Scene};
use crate::vector::largest;

/// Largest contact force that counts as round-off, over the residual of a body's equilibrium.
const ROUND_OFF_FORCE: f64 = 4.0;

/// Work of loads along a motion, relative to the sum of the magnitudes, that is more than round-off.
const DRIVEN: f64 = 1e-7;

/// State of a constraint in a solution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConditionState {
    /// True if it carries a force.
    pub carrying: bool,
    /// True if it is closed or, if tangential, sticks.
    pub closed: bool,
    /// The remaining gap (m).
    pub gap: f64,
    /// Force (N/m).
    pub force: f64,
}

/// The released modes of a solution.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReleasedModes {
    /// The released modes; those that are free even with all contacts closed come first.
    pub motions: Vec<FreeMotion>,
    /// B of the constraints without force, in these modes.
    rows: DMatrix<f64>,
    /// g − B u of these constraints (m).
    gaps: Vec<f64>,
    /// Normal constraints whose forces are round-off of the equilibrium of nodes or of rigid bodies, and restrain
    /// nothing.
    pub unneeded: Vec<usize>,
    /// True if loads do work along unrestrained motions, so that there is no solution; `motions` then doesn't contain
    /// these.
    pub is_driven: bool,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl Scene {
    /// The motions that neither supports nor contact forces restrain, nor could restrain; `free` ones are known
    /// already.
    pub fn released_modes(
        &self,
        free: &[FreeMotion],
        conditions: &[ConditionState],
    ) -> ReleasedModes {
        let kinematics = Kinematics::new(self.dim, &self.bodies);
        if kinematics.len == 0 {
            return ReleasedModes::default();
        }
        let unneeded = self.unneeded_forces(&kinematics, conditions);
        let mut needed = conditions.to_vec();
        unneeded.iter().for_each(|&j| needed[j].carrying = false);
        let conditions = &needed;
        let (held, mut redundant): (Vec<usize>, Vec<usize>) =
            (0..conditions.len()).partition(|&j| self.holds(j, conditions));
        redundant.retain(|&j| self.rows[j].friction.is_none());
        let of_conditions = |numbers: &[usize]| -> Vec<RigidRow> {
            numbers.iter().map(|&j| self.rows[j].clone()).collect()
        };
        // Motions that are free anyway come first; the others are orthogonal to them. After a signal the run ends
        // before the result matters.
        let found = kinematics.unheld(&of_conditions(&held), free);
        let found = found.unwrap_or_else(|| DMatrix::zeros(kinematics.len, 0));
        let mut motions = free.to_vec();
        let work = found.tr_mul(&kinematics.load(&self.bodies)).norm();
        let all: f64 = self.bodies.iter().map(|body| body.load_scale).sum();
        let is_driven = work > DRIVEN * all;
        if is_driven || found.is_empty() && kinematics.len >= MANY {
            return ReleasedModes {
                motions,
                rows: DMatrix::zeros(0, free.len()),
                is_driven,
                ..ReleasedModes::default()
            };
        }
        let mut columns: Vec<DVector<f64>> =
            free.iter().map(|m| kinematics.unknowns_of(m)).collect();
        for x in found.column_iter() {
            let x = x.into_owned();
            motions.push(kinematics.motion(&x));
            columns.push(x);
        }
        let released = kinematics.described(&self.bodies, &self.names, &motions[free.len()..]);
        let z = DMatrix::from_fn(kinematics.len, columns.len(), |i, k| columns[k][i]);
        ReleasedModes {
            motions,
            rows: kinematics.jumps(&of_conditions(&redundant), &z),
            gaps: redundant.iter().map(|&j| conditions[j].gap).collect(),
            unneeded: (redundant.into_iter())
                .filter(|&j| conditions[j].force != 0.0)
                .collect(),
            is_driven,
            warnings: (released.iter())
                .map(|what| format!("position not unique, as no contact force resists {what}"))
                .collect(),
        }
    }

    /// The constraints whose forces are at most the residual Rᵀ f − (B R)ᵀ λ of some rigid body, and whose removal
    /// increases no body's residual: their forces are round-off on bodies that are pushed elsewhere, or were before.
    fn unneeded_forces(
        &self,
        kinematics: &Kinematics,
        conditions: &[ConditionState],
    ) -> Vec<usize> {
        let mut missing = kinematics.load(&self.bodies);
        let mut rows = Vec::new();
        for (j, condition) in conditions.iter().enumerate() {
            if condition.force != 0.0 {
                let row = kinematics.sparse_row(&self.rows[j]);
                (row.iter()).for_each(|&(i, b)| missing[i] -= b * condition.force);
                rows.push((j, row));
            }
        }
        let bodies = 0..kinematics.bodies();
        let of_bodies = |missing: &DVector<f64>| -> Vec<f64> {
            let size = |b| -> f64 { kinematics.unknowns(b).map(|i| missing[i].powi(2)).sum() };
            bodies.clone().map(|b| size(b).sqrt()).collect()
        };
        let before = of_bodies(&missing);
        let in_doubt = ROUND_OFF_FORCE * largest(&before);
        let is_in_doubt = |&(j, ref row): &(usize, SparseRow)| {
            let size = row.iter().map(|(_, b)| b * b).sum::<f64>().sqrt();
            let presses = self.rows[j].friction.is_none() && !self.rows[j].is_tied;
            presses && size * conditions[j].force <= in_doubt
        };
        rows.retain(|condition| is_in_doubt(condition));
        loop {
            let mut without = missing.clone();
            for (j, row) in &rows {
                (row.iter()).for_each(|&(i, b)| without[i] += b * conditions[*j].force);
            }
            let pressed: Vec<bool> = (of_bodies(&without).iter().zip(&before))
                .map(|(without, before)| *without > 2.0 * before)
                .collect();
            let conditions = rows.len();
            rows.retain(|(j, _)| !self.rows[*j].bodies.iter().any(|&(b, _)| pressed[b]));
            if rows.len() == conditions {
                return rows.into_iter().map(|(j, _)| j).collect();
            }
        }
    }

    /// True if constraint j restrains motions. A tangential one does if friction can carry any force: sticking sides
    /// stay in place, and the position of slipping ones is determined by their load path.
    fn holds(&self, j: usize, conditions: &[ConditionState]) -> bool {
        let can_resist = |friction: &Friction| {
            let ConditionState {
                carrying, closed, ..
            } = conditions[friction.normal];
            friction.bound.coefficient > 0.0 && carrying || friction.holds_without_pressure(closed)
        };
        conditions[j].carrying || self.rows[j].friction.as_ref().is_some_and(can_resist)
    }
}

impl ReleasedModes {
    /// Coefficients of the motions to subtract from a displacement u so that it becomes the smallest one with
    /// non-negative gaps: min ‖u − Z c‖ subject to g − B u + B Z c ≥ 0, by Lawson and Hanson's least-distance
    /// programming.
    pub fn coefficients(&self, products: &MotionProducts) -> Vec<f64> {
        let free = products.coefficients();
        let n = free.len();
        let reached = &self.rows * DVector::from_column_slice(&free);
        let missing: Vec<f64> = (self.gaps.iter().zip(reached.iter()))
            .map(|(gap, opened)| -gap - opened)
            .collect();
        let most = missing.iter().fold(0.0, |m: f64, x| m.max(*x));
        if most <= 0.0 {
            return free;
        }
        let Some(factor) = products.gram().cholesky() else {
            return free;
        };
        // With c = free + L⁻ᵀ y the problem is to minimize ‖y‖.
        let Some(rows) = factor.l().solve_lower_triangular(&self.rows.transpose()) else {
            return free;
        };
        let mut e = rows.insert_row(n, 0.0);
        for (e, missing) in e.row_mut(n).iter_mut().zip(&missing) {
            *e = missing / most;
        }
        // Feasible gaps can be large against the infeasible ones; columns are normalized, as only their directions
        // count.
        for mut column in e.column_iter_mut() {
            column.try_normalize_mut(0.0);
        }
        let mut f = DVector::zeros(n + 1);
        f[n] = 1.0;
        let r = nonnegative::residual(&e, &f);
        let y = DVector::from_fn(n, |i, _| -r[i] / r[n] * most);
        let change = factor.l().transpose().solve_upper_triangular(&y);
        match change {
            Some(change) if change.iter().all(|c| c.is_finite()) => {
                free.iter().zip(change.iter()).map(|(c, d)| c + d).collect()
            }
            // The constraints are contradictory: u stays as it is.
            _ => vec![0.0; n],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::friction::ForceBound;
    use crate::rigid::projection::BodyProducts;
    use crate::rigid::squares::{coulomb, scene, square};

    /// The displacement of one node in the motions along x and y.
    fn products(u: [f64; 2]) -> MotionProducts {
        let mut of_node = BodyProducts::zeros(2);
        let moves = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        of_node.add_node(&moves);
        of_node.add_value(&moves, &u);
        let mut products = MotionProducts::zeros(2);
        products.add_body(&[(0, &[1.0, 0.0]), (1, &[0.0, 1.0])], &of_node);
        products
    }

    fn released(rows: &[[f64; 2]], gaps: &[f64]) -> ReleasedModes {
        ReleasedModes {
            rows: DMatrix::from_fn(rows.len(), 2, |i, j| rows[i][j]),
            gaps: gaps.to_vec(),
            ..ReleasedModes::default()
        }
    }

    #[track_caller]
    fn close(c: &[f64], expected: [f64; 2]) {
        for (c, e) in c.iter().zip(expected) {
            assert!((c - e).abs() < 1e-14, "{c}, expected {e}");
        }
    }

    #[test]
    fn what_nothing_stops_goes_back_to_where_it_was() {
        close(
            &released(&[], &[]).coefficients(&products([3.0, -1.0])),
            [3.0, -1.0],
        );
    }

    #[test]
    fn a_gap_that_would_close_stops_it() {
        // Subtracting c opens the gap by −c_x: at most 2 of x.
        let c = released(&[[-1.0, 0.0]], &[2.0]).coefficients(&products([3.0, -1.0]));
        close(&c, [2.0, -1.0]);
    }

    #[test]
    fn along_a_slope_it_slides_to_the_nearest_place() {
        let c = released(&[[-0.6, -0.8]], &[0.0]).coefficients(&products([3.0, 4.0]));
        close(&c, [0.0, 0.0]);
        let c =
            released(&[[-1.0, 0.0], [0.0, -1.0]], &[0.0, 1.0]).coefficients(&products([3.0, 4.0]));
        close(&c, [0.0, 1.0]);
    }

    #[test]
    fn wide_gaps_elsewhere_hide_no_narrow_one() {
        let rows = [[-1.0, 0.0], [0.0, 1.0]];
        let c = released(&rows, &[2.0, 1e15]).coefficients(&products([3.0, -1.0]));
        close(&c, [2.0, -1.0]);
    }

    #[test]
    fn forces_that_balance_nothing_hold_nothing() {
        let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]];
        let left = |force: f64, weight: f64| {
            let mut body = square([0.0; 3]);
            body.load[1] = -weight;
            let rows = corners.map(|x| body.row(0, x, [0.0, -1.0, 0.0])).to_vec();
            let pressed = ConditionState {
                carrying: true,
                closed: true,
                gap: 0.0,
                force,
            };
            let scene = scene(2, vec![body], rows);
            let found = scene.released_modes(&[], &[pressed; 2]);
            (found.motions.len(), found.unneeded)
        };
        // It slides under its weight, however small that is.
        assert_eq!(left(0.5, 1.0), (1, vec![]));
        assert_eq!(left(0.5e-9, 1e-9), (1, vec![]));
        assert_eq!(left(1e-9, 0.0), (3, vec![0, 1]));
        // The residual is a millionth of the weight.
        assert_eq!(left(0.5 * (1.0 - 1e-6), 1.0), (1, vec![]));
    }

    #[test]
    fn a_motion_that_loads_drive_is_none_of_many_places() {
        let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]];
        for (sideways, is_driven, motions) in [(1e-9, false, 1), (1e-3, true, 0)] {
            let body = square([sideways, -1.0, 0.0]);
            let rows = corners.map(|x| body.row(0, x, [0.0, -1.0, 0.0])).to_vec();
            let pressed = ConditionState {
                carrying: true,
                closed: true,
                gap: 0.0,
                force: 0.5,
            };
            let found = scene(2, vec![body], rows).released_modes(&[], &[pressed; 2]);
            assert_eq!(found.is_driven, is_driven, "{sideways:e}");
            assert_eq!(found.motions.len(), motions, "{sideways:e}");
        }
    }

    /// Number of motions left to a square on a floor where the constraints at its lower corners carry forces as in
    /// `carrying`, and are closed or not.
    fn motions_left(bound: Option<ForceBound>, carrying: [bool; 2], closed: bool) -> usize {
        let body = square([0.0; 3]);
        let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]];
        let mut rows = corners.map(|x| body.row(0, x, [0.0, -1.0, 0.0])).to_vec();
        for (normal, x) in corners.into_iter().enumerate() {
            let along = body.row(0, x, [1.0, 0.0, 0.0]);
            rows.extend(bound.map(|bound| along.rough(normal, bound)));
        }
        let scene = scene(2, vec![body], rows);
        let condition = |j: usize| ConditionState {
            carrying: carrying[j / 2],
            closed,
            gap: 0.0,
            force: 0.0,
        };
        let conditions: Vec<ConditionState> = (0..scene.rows.len()).map(condition).collect();
        scene.released_modes(&[], &conditions).motions.len()
    }

    #[test]
    fn what_friction_can_hold_is_not_released() {
        let coulomb = |coefficient, cohesion| {
            Some(ForceBound {
                cohesion,
                ..coulomb(coefficient)
            })
        };
        let given = Some(ForceBound {
            coefficient: 0.0,
            cohesion: 1.0,
            only_closed: false,
        });
        for (law, carrying, closed, left) in [
            (None, [true, false], true, 1),
            (None, [false, false], true, 3),
            // Under its weight alone, without a push that friction would resist.
            (coulomb(0.3, 0.0), [true, false], true, 0),
            (coulomb(0.3, 0.0), [false, false], true, 3),
            // Both tangential constraints are along the floor.
            (coulomb(0.3, 2.0), [false, false], true, 2),
            (coulomb(0.3, 2.0), [false, false], false, 3),
            (coulomb(0.0, 2.0), [true, true], true, 0),
            (given, [false, false], false, 2),
        ] {
            let found = motions_left(law, carrying, closed);
            assert_eq!(found, left, "{law:?} {carrying:?} {closed}");
        }
    }
}
