//! Rigid motions that are free in a solution, because no contact force is left that resists them.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::analysis::Scene;
use super::forces::Friction;
use super::free_motion::FreeMotion;
use super::kinematics::{Kinematics, null_space};
use super::many_bodies::{MANY, ManyBodies, SparseRow};
use super::nonnegative;
use super::projection::MotionProducts;

/// A condition in a solution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConditionState {
    /// Whether it carries force.
    pub carrying: bool,
    /// Whether it is closed; a tangential one: sticks.
    pub closed: bool,
    /// What it has left (m).
    pub gap: f64,
}

/// The released modes of a solution.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReleasedModes {
    /// Them, first those that are free with every contact closed.
    pub motions: Vec<FreeMotion>,
    /// B of the conditions without force against them.
    rows: DMatrix<f64>,
    /// g − B u of these conditions (m).
    gaps: Vec<f64>,
    /// What a user should know.
    pub warnings: Vec<String>,
}

impl Scene {
    /// The motions that no support and no contact force resists, nor could resist, where `free` ones are known
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
        let (held, mut redundant): (Vec<usize>, Vec<usize>) =
            (0..conditions.len()).partition(|&j| self.holds(j, conditions));
        redundant.retain(|&j| self.rows[j].friction.is_none());
        let row = |&j: &usize| kinematics.sparse_row(&self.rows[j]);
        let held: Vec<SparseRow> = held.iter().map(row).collect();
        if free.is_empty() && kinematics.len >= MANY {
            let bodies = ManyBodies::new(&kinematics.centers, held.clone());
            if bodies.is_some_and(|bodies| bodies.hold_all()) {
                return ReleasedModes::default();
            }
        }
        // What is free anyway comes first; the rest is orthogonal to it.
        let known: Vec<DVector<f64>> = free.iter().map(|m| kinematics.unknowns_of(m)).collect();
        let mut resisted = folded(&held, kinematics.len).insert_rows(0, known.len(), 0.0);
        for (i, x) in known.iter().enumerate() {
            resisted.row_mut(i).copy_from(&x.normalize().transpose());
        }
        let found = null_space(&resisted);
        let mut motions = free.to_vec();
        let mut columns = known;
        for x in found.column_iter() {
            let x = x.into_owned();
            motions.push(kinematics.motion(&x));
            columns.push(x);
        }
        let released = kinematics.described(&self.bodies, &self.names, &motions[free.len()..]);
        let rows: Vec<SparseRow> = redundant.iter().map(row).collect();
        let along = |row: &SparseRow, x: &DVector<f64>| row.iter().map(|&(i, b)| b * x[i]).sum();
        ReleasedModes {
            motions,
            rows: DMatrix::from_fn(rows.len(), columns.len(), |j, k| {
                along(&rows[j], &columns[k])
            }),
            gaps: (redundant.iter())
                .map(|&j| conditions[j].gap.max(0.0))
                .collect(),
            warnings: (released.iter())
                .map(|what| format!("no contact force holds {what}"))
                .collect(),
        }
    }

    /// Whether condition j holds what moves it. A tangential one does where friction can give any force: sides that
    /// stick stay, and sides that slip came where they are by their path, not to one of many places.
    fn holds(&self, j: usize, conditions: &[ConditionState]) -> bool {
        let can_resist = |friction: &Friction| {
            let ConditionState {
                carrying, closed, ..
            } = conditions[friction.normal];
            friction.bound.coefficient > 0.0 && carrying || friction.holds_unpressed(closed)
        };
        conditions[j].carrying || self.rows[j].friction.as_ref().is_some_and(can_resist)
    }
}

/// A matrix of `len` columns that resists what all of these `rows` resist: the many between two bodies become as few
/// as these have unknowns.
fn folded(rows: &[SparseRow], len: usize) -> DMatrix<f64> {
    let mut alike: BTreeMap<Vec<usize>, Vec<&SparseRow>> = BTreeMap::new();
    for row in rows {
        let unknowns = row.iter().map(|&(i, _)| i).collect();
        alike.entry(unknowns).or_default().push(row);
    }
    let mut folded: Vec<(&[usize], DMatrix<f64>)> = Vec::new();
    for (unknowns, rows) in &alike {
        let of_rows = DMatrix::from_fn(rows.len(), unknowns.len(), |i, k| rows[i][k].1);
        folded.push((
            unknowns,
            match rows.len() > unknowns.len() {
                true => of_rows.qr().r(),
                false => of_rows,
            },
        ));
    }
    let count = folded.iter().map(|(_, of_rows)| of_rows.nrows()).sum();
    let mut all = DMatrix::zeros(count, len);
    let mut first = 0;
    for (unknowns, of_rows) in folded {
        for (k, &i) in unknowns.iter().enumerate() {
            let mut column = all.column_mut(i);
            column
                .rows_mut(first, of_rows.nrows())
                .copy_from(&of_rows.column(k));
        }
        first += of_rows.nrows();
    }
    all
}

impl ReleasedModes {
    /// How much of each motion to take out of a displacement u to make it the smallest one that
    /// leaves no gap negative: min ‖u − Z c‖ subject to g − B u + B Z c ≥ 0, by Lawson and Hanson's
    /// least-distance programming.
    pub fn coefficients(&self, products: &MotionProducts) -> Vec<f64> {
        let free = products.coefficients();
        let n = free.len();
        let reached = &self.rows * DVector::from_column_slice(&free);
        let missing: Vec<f64> = (self.gaps.iter().zip(reached.iter()))
            .map(|(gap, opened)| -gap - opened)
            .collect();
        let most = missing.iter().fold(0.0, |m: f64, x| m.max(*x));
        let gram = DMatrix::from_row_slice(n, n, &products.gram);
        let Some(factor) = gram.cholesky().filter(|_| most > 0.0) else {
            return free;
        };
        // With c = free + L⁻ᵀ y, ‖y‖ is to be least.
        let Some(rows) = factor.l().solve_lower_triangular(&self.rows.transpose()) else {
            return free;
        };
        let mut e = rows.insert_row(n, 0.0);
        for (e, missing) in e.row_mut(n).iter_mut().zip(&missing) {
            *e = missing / most;
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
            // Nothing is nearer than where it is.
            _ => vec![0.0; n],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::friction::ForceBound;
    use crate::rigid::squares::{coulomb, scene, square};

    /// A displacement of one node along two motions, x and y.
    fn products(u: [f64; 2]) -> MotionProducts {
        let mut products = MotionProducts::zeros(2);
        let moves = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        products.add_node(&moves);
        products.add_value(&moves, &u);
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
    fn many_rows_between_two_bodies_resist_no_more_when_they_are_folded() {
        // Twenty rows of rank 2 against unknowns 0 to 3, two against 3 to 5, twenty of rank 3 against 6 to 8.
        let wave = |i: usize, k: usize| ((3 * i + 7 * k) as f64).sin();
        let mut rows: Vec<SparseRow> = Vec::new();
        rows.extend((0..20).map(|i| (0..4).map(|k| (k, wave(i, k))).collect::<SparseRow>()));
        rows.extend((0..2).map(|i| (3..6).map(|k| (k, (i * k) as f64 + 1.0)).collect()));
        rows.extend((0..20).map(|i| (6..9).map(|k| (k, ((i * k * k) as f64).cos())).collect()));
        let dense = DMatrix::from_fn(rows.len(), 10, |j, i| {
            let at = rows[j].iter().find(|(k, _)| *k == i);
            at.map_or(0.0, |(_, b)| *b)
        });
        let folded = folded(&rows, 10);
        assert_eq!(folded.shape(), (4 + 2 + 3, 10));
        let free = null_space(&folded);
        assert_eq!(free.ncols(), null_space(&dense).ncols());
        assert_eq!(free.ncols(), 10 - 2 - 2 - 3);
        assert!((dense * free).amax() < 1e-13);
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
        // Taking out c opens the gap by −c_x: at most 2 of x.
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

    /// A square on a floor below its corners: what is left to it where their normal and tangential conditions carry
    /// force or not, and are closed or not.
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
            // On its weight alone, without a push that friction would answer.
            (coulomb(0.3, 0.0), [true, false], true, 0),
            (coulomb(0.3, 0.0), [false, false], true, 3),
            // Both tangential conditions are along the floor.
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
