//! Merge: the Schur complements of a node's children in the hierarchy give its own.
//!
//! With the children's S assembled over [E | K], E the eliminated and K the kept unknowns,
//!
//! ```text
//! A = Σ R_cᵀ S_c R_c,    A_EE = L_E L_Eᵀ,    P = A_KE L_E⁻ᵀ,    S = A_KK − P Pᵀ
//! ```
//!
//! are dense matrices: the multifrontal method of Duff and Reid with the blocks as leaves.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, Mat, MatMut, Par};

use super::condensed::Condensed;
use super::front::partial_cholesky;
use super::front_order::{FrontOrder, OwnJumps};
use super::local::{CondensedLoad, TiedLoad, multiply_add};
use super::substitution::{Front, Replaced, Substitution};
use crate::schur::condensed::InterfaceDof;

/// The factor of a merge, for loads and back-substitution.
#[derive(Debug)]
pub struct Merge {
    eliminated: usize,
    /// L_E above P.
    columns: Mat<f64>,
    /// Places of the boundary of every child among [E | K].
    places: Vec<Vec<u32>>,
    /// Substitution of traces by normal jumps at this node.
    substitution: Substitution,
    /// Columns of A at the known jumps of ties, with rows [E | K], then these jumps.
    tied: Mat<f64>,
}

/// Square matrices for reuse: new memory costs a page fault every 4 KiB, more than the arithmetic on it.
#[derive(Debug, Default)]
pub struct MatrixPool(Vec<Mat<f64>>);

/// Most matrices kept, about as many as are in use at once in a deep hierarchy.
const MOST_SPARE: usize = 8;
/// Most entries kept in all, 256 MB: for larger matrices page faults are negligible against the arithmetic, and several
/// of them would take most of the memory of a run.
const MOST_SPARE_ENTRIES: usize = 1 << 25;

impl MatrixPool {
    /// Zeros in the smallest kept matrix that is large enough, else in a new one.
    fn zeros(&mut self, n: usize) -> Mat<f64> {
        let fitting = (0..self.0.len()).filter(|&i| self.0[i].nrows() >= n);
        let Some(place) = fitting.min_by_key(|&i| self.0[i].nrows()) else {
            return Mat::zeros(n, n);
        };
        let mut matrix = self.0.swap_remove(place);
        matrix.truncate(0, 0);
        matrix.resize_with(n, n, |_, _| 0.0);
        matrix
    }

    /// Keeps a matrix for reuse.
    pub fn keep(&mut self, matrix: Mat<f64>) {
        self.0.push(matrix);
        self.0.sort_by_key(Mat::nrows);
        if self.0.len() > MOST_SPARE {
            self.0.remove(0);
        }
        let entries = |all: &[Mat<f64>]| all.iter().map(|one| one.nrows().pow(2)).sum::<usize>();
        while entries(&self.0) > MOST_SPARE_ENTRIES {
            self.0.pop();
        }
    }
}

/// Unknown with a free motion although all kept unknowns are held, so that Schur complements can't be merged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FreeInterfaceDof(pub InterfaceDof);

/// Indices of a child's boundary that are consecutive in [E | K], too.
struct Run {
    from: usize,
    to: usize,
    len: usize,
}

impl Merge {
    /// Merges `children`, in their order, replaces the `replaced` displacements by normal jumps, and eliminates the
    /// other unknowns at the `eliminated` nodes of Γ, ascending. Memory comes from `spare` matrices, to which the
    /// children's S are added.
    ///
    /// # Errors
    /// A_EE isn't positive definite.
    pub fn new(
        children: Vec<Condensed>,
        eliminated: &[u32],
        replaced: &[Replaced],
        spare: &mut MatrixPool,
        par: Par,
    ) -> Result<(Self, Condensed), FreeInterfaceDof> {
        let own = OwnJumps {
            replaced,
            ..OwnJumps::default()
        };
        let merged = Self::of(
            &children.iter().collect::<Vec<_>>(),
            eliminated,
            own,
            spare,
            par,
        );
        children.into_iter().for_each(|child| spare.keep(child.s));
        merged
    }

    /// Merges `children` as [`new`](Self::new) does, and eliminates some of the front's `own` normal jumps; those
    /// kept come after the children's jumps.
    ///
    /// # Errors
    /// A_EE isn't positive definite.
    pub fn of(
        children: &[&Condensed],
        eliminated: &[u32],
        own: OwnJumps<'_>,
        spare: &mut MatrixPool,
        par: Par,
    ) -> Result<(Self, Condensed), FreeInterfaceDof> {
        let order = FrontOrder::new(children, eliminated, own);
        let (e, k, n) = order.sizes();
        let mut columns = Mat::<f64>::zeros(n, e);
        let mut s = spare.zeros(n - e);
        let mut diagonal = vec![0.0; n];
        let (mut places, mut first_jump) = (Vec::with_capacity(children.len()), e);
        let place = |dof: &InterfaceDof| order.place(dof);
        for child in children {
            let place = child.places(first_jump, place);
            first_jump += child.jumps;
            for (&to, d) in place.iter().zip(&child.diagonal) {
                diagonal[to as usize] += d;
            }
            add(&child.s, &place, e, &mut columns, &mut s);
            places.push(place);
        }
        let substitution = Substitution::new(own.replaced, place);
        substitution.transform(&mut Front {
            columns: &mut columns,
            s: &mut s,
        });
        substitution.transform_diagonal(&mut diagonal);
        let tied = known_columns(&mut columns, &mut s, e + k);
        for j in order.eliminated.len()..e {
            columns[(j, j)] += own.spring * diagonal[j];
        }
        let mut merge = Self {
            eliminated: e,
            columns,
            places,
            substitution,
            tied,
        };
        partial_cholesky(merge.columns.as_mut(), s.as_mut(), par)
            .map_err(|j| FreeInterfaceDof(order.dof(j, own)))?;
        let pivots = diagonal[..e].iter().enumerate();
        let pivots = pivots.map(|(j, d)| merge.columns[(j, j)].powi(2) / d);
        let below = children.iter().map(|child| child.smallest_pivot);
        let condensed = Condensed {
            jumps: order.jumps,
            interface_dofs: order.kept,
            s,
            diagonal: diagonal[e..e + k].to_vec(),
            smallest_pivot: below.chain(pivots).fold(f64::INFINITY, f64::min),
        };
        Ok((merge, condensed))
    }

    /// Condenses the loads on the children's boundaries, in their order. `forces` act on the front's own eliminated
    /// normal jumps, if there are any; `known` are the jumps of ties, 0 if empty.
    pub fn condense(&self, loads: &[&[f64]], forces: &[f64], known: &[f64]) -> CondensedLoad {
        let n = self.columns.nrows();
        let mut load = vec![0.0; n + self.tied.ncols()];
        for (place, of_child) in self.places.iter().zip(loads) {
            for (&to, f) in place.iter().zip(*of_child) {
                load[to as usize] += f;
            }
        }
        self.substitution.transform_load(&mut load);
        let first = self.eliminated - forces.len();
        for (load, force) in load[first..].iter_mut().zip(forces) {
            *load -= force;
        }
        let back: Vec<f64> = known.iter().map(|jump| -jump).collect();
        multiply_add(self.tied.as_ref(), &back, &mut load);
        let loads = load.split_off(n);
        self.forward(&mut load);
        let mut condensed = CondensedLoad::new(load, self.eliminated);
        condensed.tied = TiedLoad {
            jumps: match known.is_empty() {
                true => vec![0.0; loads.len()],
                false => known.to_vec(),
            },
            loads,
        };
        condensed
    }

    /// The unknowns on the children's boundaries from the kept unknowns `x_k`, and the front's own jumps.
    pub fn recover(&self, load: &CondensedLoad, x_k: &[f64]) -> Recovered {
        let e = self.eliminated;
        let mut x = load.interior().to_vec();
        x.extend_from_slice(x_k);
        let (l_e, p) = self.columns.as_ref().split_at_row(e);
        let (x_e, x_k) = column_of(&mut x).split_at_row_mut(e);
        let mut x_e = x_e;
        matmul(x_e.as_mut(), Accum::Add, p.transpose(), x_k, -1.0, Par::Seq);
        solve_upper_triangular_in_place(l_e.transpose(), x_e, Par::Seq);
        let taken = |j: usize| -> f64 {
            let column = self.tied.col_as_slice(j).iter();
            column.zip(&x).map(|(a, x)| a * x).sum()
        };
        let forces = load.tied.loads.iter().enumerate();
        let forces = forces.map(|(j, load)| load - taken(j)).collect();
        x.extend(&load.tied.jumps);
        let mut jumps = self.substitution.jumps(&x);
        jumps.truncate(jumps.len() - load.tied.jumps.len());
        self.substitution.resolve(&mut x);
        let of_child = |place: &Vec<u32>| place.iter().map(|&i| x[i as usize]).collect();
        Recovered {
            children: self.places.iter().map(of_child).collect(),
            jumps,
            forces,
        }
    }

    /// x_E ← L_E⁻¹ x_E and x_K ← x_K − P x_E.
    fn forward(&self, x: &mut [f64]) {
        let (l_e, p) = self.columns.as_ref().split_at_row(self.eliminated);
        let (mut x_e, x_k) = column_of(x).split_at_row_mut(self.eliminated);
        solve_lower_triangular_in_place(l_e, x_e.as_mut(), Par::Seq);
        matmul(x_k, Accum::Add, p, x_e, -1.0, Par::Seq);
    }
}

/// The recovered unknowns of a front.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recovered {
    /// The unknowns on the boundary of every child.
    pub children: Vec<Vec<f64>>,
    /// The front's own unknown jumps.
    pub jumps: Vec<f64>,
    /// The forces at the jumps of its ties.
    pub forces: Vec<f64>,
}

/// Splits off the columns of a front at the known jumps, from `first` on.
fn known_columns(columns: &mut Mat<f64>, s: &mut Mat<f64>, first: usize) -> Mat<f64> {
    let (n, e) = (columns.nrows(), columns.ncols());
    let entry = |i: usize, j: usize| match i.min(j) < e {
        true => columns[(i.max(j), i.min(j))],
        false => s[(i.max(j) - e, i.min(j) - e)],
    };
    let known = Mat::from_fn(n, n - first, |i, j| entry(i, first + j));
    columns.truncate(first, e);
    s.truncate(first - e, first - e);
    known
}

fn column_of(x: &mut [f64]) -> MatMut<'_, f64> {
    let rows = x.len();
    MatMut::from_column_major_slice_mut(x, rows, 1)
}

/// Maximal runs of consecutive places, none of which extends across index `e`.
fn runs(place: &[u32], e: usize) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (from, &to) in place.iter().enumerate() {
        let to = to as usize;
        match runs.last_mut() {
            Some(run) if run.to + run.len == to && to != e => run.len += 1,
            _ => runs.push(Run { from, to, len: 1 }),
        }
    }
    runs
}

/// Adds the lower triangle of a child's S to the lower triangle of A.
fn add(of_child: &Mat<f64>, place: &[u32], e: usize, columns: &mut Mat<f64>, s: &mut Mat<f64>) {
    let runs = runs(place, e);
    for (j, &to) in place.iter().enumerate() {
        let from = of_child.col_as_slice(j);
        let to = to as usize;
        for run in runs.iter().filter(|run| run.from + run.len > j) {
            // The part of the run on and below the diagonal of S.
            let skipped = j.saturating_sub(run.from);
            let values = &from[run.from + skipped..run.from + run.len];
            let row = run.to + skipped;
            if row < to {
                // These entries are above the diagonal of A: they go to the transposed places.
                for (row, value) in (row..).zip(values) {
                    match row < e {
                        true => columns[(to, row)] += value,
                        false => s[(to - e, row - e)] += value,
                    }
                }
                continue;
            }
            let target = match to < e {
                true => &mut columns.col_as_slice_mut(to)[row..],
                false => &mut s.col_as_slice_mut(to - e)[row - e..],
            };
            for (a, value) in target.iter_mut().zip(values) {
                *a += value;
            }
        }
    }
}

#[cfg(test)]
mod tests;
