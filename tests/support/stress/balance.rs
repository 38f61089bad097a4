//! Balance of the load by contact forces: a linear program, solved by the simplex method.
//!
//! There is an equilibrium if λ ≥ 0 and support forces μ exist with Rᵀ (f − Bᵀ λ − Dᵀ μ) = 0 for the rigid motions R of
//! all bodies. Either they do, or a motion z exists that supports and contact allow, D R z = 0 and B R z ≤ 0, and that
//! the load drives, fᵀ R z > 0; both are checked.
//!
//! Friction adds tangential forces: |λ_t| ≤ μ λ + b, with b > 0 for a Tresca bound and for cohesion, where all contacts
//! count as closed. In space discs are replaced by polygons: an inner one to show balance, an outer one to show
//! failure. Elastic bodies can't balance more than rigid ones; they may balance less, as their normal forces can't be
//! chosen freely.

use std::f64::consts::PI;

use contact_dd_partition::model::Model;
use nalgebra::{DMatrix, DVector};

use super::super::assembled::{Assembled, Row, Tangent};
use super::rigid::Bodies;

/// Unbalanced part of the load, relative to it, up to which it is balanced, and from which on it isn't.
const BALANCED: f64 = 1e-11;
const UNBALANCED: f64 = 1e-7;

/// Corners of the polygon for a disc.
const CORNERS: usize = 12;

/// Result of the linear program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Balance {
    Holds,
    Fails,
    /// Within round-off of the border between the two.
    Unclear,
}

impl Balance {
    /// The balance with the scene's friction.
    pub fn new(model: &Model, assembled: &Assembled) -> Self {
        let inside = Self::with(model, assembled, &assembled.tangents, 1.0);
        if model.mesh.dim == 2 || inside == Self::Holds {
            return inside;
        }
        let around = 1.0 / (PI / CORNERS as f64).cos();
        match Self::with(model, assembled, &assembled.tangents, around) {
            Self::Fails => Self::Fails,
            _ => Self::Unclear,
        }
    }

    pub fn without_friction(model: &Model, assembled: &Assembled) -> Self {
        Self::with(model, assembled, &[], 1.0)
    }

    /// The balance with bounds at the corners `reach` times those of the law.
    fn with(model: &Model, assembled: &Assembled, tangents: &[Tangent], reach: f64) -> Self {
        let bodies = Bodies::new(model);
        let load: Vec<(usize, f64)> = assembled.load.iter().copied().enumerate().collect();
        let load = bodies.act(&load);
        let scale: f64 = assembled.load.iter().map(|f| f.abs()).sum();
        if scale == 0.0 {
            return Self::Holds;
        }
        let load = load / scale;
        let supports: Vec<_> = assembled.supports.iter().map(|(row, _)| row).collect();
        // Motions that supports allow, and that contacts and loads act on.
        let allowed = bodies.unseen(supports.into_iter());
        if allowed.is_empty() {
            return Self::Holds;
        }
        let allowed = DMatrix::from_columns(&allowed).transpose();
        let act = |row: &Row| -> DVector<f64> { &allowed * bodies.act(row) };
        let mut columns = Vec::new();
        let mut bounded = Vec::new();
        let mut slopes = vec![(0.0, Vec::new()); assembled.conditions.len()];
        for of_point in tangents.chunk_by(|a, b| a.condition == b.condition) {
            let (grows, constant) = of_point[0].bound(true);
            let rows: Vec<_> = of_point.iter().map(|tangent| act(&tangent.row)).collect();
            let corners = corners(&rows, reach);
            if constant > 0.0 {
                bounded.push((corners.clone(), constant / scale));
            }
            slopes[of_point[0].condition] = (grows, corners);
        }
        for ((row, _), (grows, corners)) in assembled.conditions.iter().zip(slopes) {
            let normal = act(row);
            match grows > 0.0 {
                // The edges of the cone.
                true => columns.extend(corners.iter().map(|along| &normal + along * grows)),
                false => columns.push(normal),
            }
        }
        Self::bounded(columns, &bounded, &allowed * load)
    }

    /// Balance of `load`: is it a combination of `columns` with coefficients ≥ 0 and of points of polygons, given by
    /// their corners and a factor for these?
    fn bounded(
        columns: Vec<DVector<f64>>,
        bounded: &[(Vec<DVector<f64>>, f64)],
        load: DVector<f64>,
    ) -> Self {
        // A bound beyond the sum of all loads has no effect.
        let most = 10.0 * (1.0 + load.norm());
        let (rows, extra) = (load.len(), bounded.len());
        let lifted = |top: &DVector<f64>, at: Option<usize>| {
            let mut lifted = DVector::zeros(rows + extra);
            lifted.rows_mut(0, rows).copy_from(top);
            if let Some(at) = at {
                lifted[rows + at] = 1.0;
            }
            lifted
        };
        let mut all: Vec<DVector<f64>> = columns.iter().map(|c| lifted(c, None)).collect();
        let mut rhs = lifted(&load, None);
        for (i, (corners, bound)) in bounded.iter().enumerate() {
            // The shares of a polygon's corners and of its centre add up to 1.
            rhs[rows + i] = 1.0;
            let bound = bound.min(most);
            all.extend((corners.iter()).map(|corner| lifted(&(corner * bound), Some(i))));
            all.push(lifted(&DVector::zeros(rows), Some(i)));
        }
        Self::of(&all, &rhs)
    }

    /// Balance of `load`: is it a combination of `columns` with coefficients ≥ 0?
    fn of(columns: &[DVector<f64>], load: &DVector<f64>) -> Self {
        let (left, dual) = Simplex::new(columns, load).solve();
        let grows = columns.iter().all(|column| {
            let along = dual.dot(column);
            along <= 1e-9 * dual.norm() * column.norm()
        });
        match left {
            left if left <= BALANCED => Self::Holds,
            left if left >= UNBALANCED && grows => Self::Fails,
            _ => Self::Unclear,
        }
    }
}

/// Both ends along a single tangent, or the corners of a polygon in the disc of two tangents.
fn corners(tangents: &[DVector<f64>], reach: f64) -> Vec<DVector<f64>> {
    match tangents {
        [a, b] => (0..CORNERS)
            .map(|k| (2.0 * PI / CORNERS as f64 * k as f64).sin_cos())
            .map(|(sin, cos)| (a * cos + b * sin) * reach)
            .collect(),
        _ => (tangents.iter()).flat_map(|a| [a.clone(), -a]).collect(),
    }
}

/// The least Σ|r| with Σ x_j c_j + r = b, x ≥ 0: a basis of columns and slack, by Bland's rule.
struct Simplex<'a> {
    columns: &'a [DVector<f64>],
    load: &'a DVector<f64>,
    /// Column of each basic variable; from `columns.len()` on, slacks.
    basis: Vec<usize>,
    sign: Vec<f64>,
}

impl<'a> Simplex<'a> {
    fn new(columns: &'a [DVector<f64>], load: &'a DVector<f64>) -> Self {
        Self {
            columns,
            load,
            basis: (columns.len()..columns.len() + load.len()).collect(),
            sign: (load.iter())
                .map(|b| if *b < 0.0 { -1.0 } else { 1.0 })
                .collect(),
        }
    }

    fn column(&self, j: usize) -> DVector<f64> {
        match j.checked_sub(self.columns.len()) {
            None => self.columns[j].clone(),
            Some(row) => {
                let mut unit = DVector::zeros(self.load.len());
                unit[row] = self.sign[row];
                unit
            }
        }
    }

    fn cost(&self, j: usize) -> f64 {
        if j < self.columns.len() { 0.0 } else { 1.0 }
    }

    /// The unbalanced part of the load, and the dual that proves it.
    fn solve(&mut self) -> (f64, DVector<f64>) {
        let m = self.load.len();
        let mut dual = DVector::zeros(m);
        let mut left = f64::INFINITY;
        for step in 0..5000 {
            // The basis is small: a fresh factorization in every step accumulates no round-off.
            let columns: Vec<_> = self.basis.iter().map(|&j| self.column(j)).collect();
            let basis = DMatrix::from_columns(&columns);
            let lu = basis.clone().lu();
            let Some(x) = lu.solve(self.load) else { break };
            let cost = DVector::from_iterator(m, self.basis.iter().map(|&j| self.cost(j)));
            let Some(y) = basis.transpose().lu().solve(&cost) else {
                break;
            };
            left = (self.basis.iter().zip(x.iter()))
                .filter(|(j, _)| **j >= self.columns.len())
                .map(|(_, x)| x.abs())
                .sum();
            dual = y;
            let gain = |j: &usize| {
                let column = &self.columns[*j];
                dual.dot(column) / (dual.norm() * column.norm()).max(1e-300)
            };
            let outside = (0..self.columns.len()).filter(|j| !self.basis.contains(j));
            // The largest gain is fast, the first one can't cycle.
            let entering = match step < 500 {
                true => outside
                    .filter(|j| gain(j) > 1e-11)
                    .max_by(|a, b| gain(a).total_cmp(&gain(b))),
                false => outside.into_iter().find(|j| gain(j) > 1e-11),
            };
            let Some(entering) = entering else { break };
            let Some(change) = lu.solve(&self.columns[entering]) else {
                break;
            };
            let size = change.amax();
            let leaving = (0..m)
                .filter(|&i| change[i] > 1e-10 * size)
                .min_by(|&a, &b| {
                    let ratio = |i: usize| x[i].max(0.0) / change[i];
                    (ratio(a).total_cmp(&ratio(b))).then(self.basis[a].cmp(&self.basis[b]))
                });
            let Some(leaving) = leaving else { break };
            self.basis[leaving] = entering;
        }
        (left, dual)
    }
}
