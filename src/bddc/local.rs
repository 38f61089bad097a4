//! A cluster: its unknowns [own | shared], own ones eliminated, and what the preconditioner inverts of it.

use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, Mat, MatMut, MatRef, Par};

use crate::bddc::classes::Classes;
use crate::bddc::closed::Ties;
use crate::bddc::constraints::{Basis, Side};
use crate::schur::condensed::{Condensed, InterfaceDof};
use crate::schur::front::partial_cholesky;
use crate::schur::local::multiply_add;

/// A cluster can move although what it shares with others is held.
#[derive(Clone, Copy, Debug)]
pub struct Moves;

/// A matrix some of whose unknowns, the first ones, are eliminated.
#[derive(Debug)]
pub struct Eliminated {
    /// L above P.
    columns: Mat<f64>,
}

impl Eliminated {
    /// Eliminates the first `count` unknowns of a symmetric matrix, both of whose triangles are given, and returns
    /// what they leave to the others, its lower triangle.
    pub fn new(matrix: MatRef<'_, f64>, count: usize, par: Par) -> Result<(Self, Mat<f64>), Moves> {
        let n = matrix.nrows();
        let mut columns = matrix.subcols(0, count).to_owned();
        let rest = n - count;
        let mut s = matrix.submatrix(count, count, rest, rest).to_owned();
        partial_cholesky(columns.as_mut(), s.as_mut(), par).map_err(|_| Moves)?;
        Ok((Self { columns }, s))
    }

    /// Carries a load on the first unknowns to the others.
    fn forward(&self, x: &mut [f64]) {
        let (l, p) = self.columns.as_ref().split_at_row(self.columns.ncols());
        let (mut first, others) = column_of(x).split_at_row_mut(l.ncols());
        solve_lower_triangular_in_place(l, first.as_mut(), Par::Seq);
        matmul(others, Accum::Add, p, first, -1.0, Par::Seq);
    }

    /// Solves for the first unknowns where the others are known.
    fn backward(&self, x: &mut [f64]) {
        let (l, p) = self.columns.as_ref().split_at_row(self.columns.ncols());
        let (mut first, others) = column_of(x).split_at_row_mut(l.ncols());
        matmul(
            first.as_mut(),
            Accum::Add,
            p.transpose(),
            others,
            -1.0,
            Par::Seq,
        );
        solve_upper_triangular_in_place(l.transpose(), first, Par::Seq);
    }
}

fn column_of(x: &mut [f64]) -> MatMut<'_, f64> {
    let rows = x.len();
    MatMut::from_column_major_slice_mut(x, rows, 1)
}

/// Makes both triangles of a symmetric matrix count.
pub fn fill_upper_triangle(s: &mut Mat<f64>) {
    for j in 0..s.ncols() {
        for i in j + 1..s.nrows() {
            s[(j, i)] = s[(i, j)];
        }
    }
}

/// A cluster condensed onto what it shares with others, class after class.
#[derive(Debug)]
pub struct Shared {
    /// What each unknown of the cluster is in terms of [own | shared], but for constants.
    terms: Vec<Vec<(usize, f64)>>,
    own: Eliminated,
    /// S on what is shared, both triangles.
    pub s: Mat<f64>,
    /// Where its classes are.
    pub ranges: Vec<Range<usize>>,
}

impl Shared {
    /// Cluster c, with a `spring`, relative to the diagonal, on what open conditions have let go.
    ///
    /// # Errors
    /// It can move although what it shares is held.
    pub fn new(
        c: usize,
        condensed: &Condensed,
        classes: &Classes,
        ties: &Ties,
        spring: f64,
        par: Par,
    ) -> Result<Self, Moves> {
        let mut places: HashMap<InterfaceDof, Vec<(usize, f64)>> = HashMap::new();
        let mut own = classes.own[c].len();
        for (i, &dof) in classes.own[c].iter().enumerate() {
            places.insert(dof, vec![(i, 1.0)]);
        }
        for &k in &classes.of_clusters[c] {
            let class = &classes.list[k];
            if let Some(turned) = &class.turned {
                let which = 1 + usize::from(class.clusters[0] != c);
                let alone = turned.ends[which]..turned.ends[which + 1];
                for (i, &dof) in class.dofs.iter().enumerate() {
                    let terms = alone.clone().enumerate();
                    let terms = terms.map(|(at, j)| (own + at, turned.q[(i, j)]));
                    places.insert(dof, terms.filter(|(_, q)| *q != 0.0).collect());
                }
                own += alone.len();
            }
        }
        let mut ranges = Vec::new();
        let mut first = 0;
        for &k in &classes.of_clusters[c] {
            let class = &classes.list[k];
            for (i, &dof) in class.dofs.iter().enumerate() {
                let place = places.entry(dof).or_default();
                match &class.turned {
                    None => place.push((own + first + i, 1.0)),
                    Some(turned) => {
                        let both = (0..turned.ends[1]).map(|j| (own + first + j, turned.q[(i, j)]));
                        place.extend(both.filter(|(_, q)| *q != 0.0));
                    }
                }
            }
            ranges.push(first..first + class.size());
            first += class.size();
        }
        let in_place = |dof: &InterfaceDof| -> Vec<(usize, f64)> {
            let terms = ties.terms(dof).into_iter();
            terms
                .flat_map(|(dof, c)| places[&dof].iter().map(move |&(i, q)| (i, c * q)))
                .collect()
        };
        let terms: Vec<_> = condensed.interface_dofs.iter().map(in_place).collect();
        let mut s = transformed(&condensed.s, &terms, own + first);
        for (i, dof) in condensed.interface_dofs.iter().enumerate() {
            if spring > 0.0 && ties.is_open(dof) {
                for &(a, c) in &terms[i] {
                    s[(a, a)] += c * c * spring * condensed.diagonal[i];
                }
            }
        }
        let (own, mut s) = Eliminated::new(s.as_ref(), own, par)?;
        fill_upper_triangle(&mut s);
        Ok(Self {
            terms,
            own,
            s,
            ranges,
        })
    }

    /// S on a class, and what is left of S there where all else that is shared is free.
    pub fn on(&self, range: &Range<usize>, par: Par) -> Result<Side, Moves> {
        let others = (0..self.s.nrows()).filter(|i| !range.contains(i));
        let order: Vec<usize> = others.chain(range.clone()).collect();
        let free = order.len() - range.len();
        let mut s = Mat::from_fn(order.len(), order.len(), |i, j| {
            self.s[(order[i], order[j])]
        });
        // A class of few unknowns may not hold all motions of the others, and of some the cluster has not all.
        let mut places = order.iter().enumerate().take(free);
        for of_others in self.ranges.iter().filter(|of| *of != range) {
            let largest = of_others
                .clone()
                .fold(0.0, |m: f64, i| m.max(self.s[(i, i)]));
            for (place, _) in places.by_ref().take(of_others.len()) {
                s[(place, place)] += HOLD * largest;
            }
        }
        let of_class = s.submatrix(free, free, range.len(), range.len()).to_owned();
        let (_, mut left) = Eliminated::new(s.as_ref(), free, par)?;
        fill_upper_triangle(&mut left);
        Ok(Side { s: of_class, left })
    }
}

/// Share of the diagonal that is added where unknowns may be free.
const HOLD: f64 = 1e-11;

/// Tᵀ S T, of which the lower triangle is given and both are returned; T has a row of terms for every unknown of S.
fn transformed(s: &Mat<f64>, terms: &[Vec<(usize, f64)>], n: usize) -> Mat<f64> {
    let mut new = Mat::<f64>::zeros(n, n);
    for j in 0..s.ncols() {
        for i in j..s.nrows() {
            for &(a, c) in &terms[i] {
                for &(b, d) in &terms[j] {
                    let value = c * d * s[(i, j)];
                    new[(a, b)] += value;
                    if i != j {
                        new[(b, a)] += value;
                    }
                }
            }
        }
    }
    new
}

/// A cluster as conjugate gradients see it, in the basis of coarse and other unknowns of its classes.
#[derive(Debug)]
pub struct Local {
    shared: Rc<Shared>,
    /// S in that basis.
    s: Mat<f64>,
    /// The basis and the scaling of every class.
    bases: Vec<Basis>,
    /// Where [others | coarse] are found.
    order: Vec<usize>,
    others: Eliminated,
    /// What the others leave to the coarse unknowns.
    pub coarse: Mat<f64>,
}

impl Local {
    /// A cluster with the bases of its classes.
    ///
    /// # Errors
    /// It can move although its coarse unknowns are held.
    pub fn new(shared: Rc<Shared>, bases: Vec<Basis>, par: Par) -> Result<Self, Moves> {
        let mut s = shared.s.clone();
        let (mut others, mut coarse) = (Vec::new(), Vec::new());
        for (range, basis) in shared.ranges.iter().zip(&bases) {
            if let Some(q) = basis.q() {
                let (n, len) = (s.nrows(), range.len());
                let columns = s.submatrix(0, range.start, n, len) * q;
                s.submatrix_mut(0, range.start, n, len).copy_from(columns);
                let rows = q.transpose() * s.submatrix(range.start, 0, len, n);
                s.submatrix_mut(range.start, 0, len, n).copy_from(rows);
            }
            coarse.extend(range.start..range.start + basis.coarse);
            others.extend(range.start + basis.coarse..range.end);
        }
        let count = others.len();
        others.extend(coarse);
        let order = others;
        let n = order.len();
        let permuted = Mat::from_fn(n, n, |i, j| s[(order[i], order[j])]);
        let (others, mut coarse) = Eliminated::new(permuted.as_ref(), count, par)?;
        fill_upper_triangle(&mut coarse);
        Ok(Self {
            shared,
            s,
            bases,
            order,
            others,
            coarse,
        })
    }

    /// Where its classes are.
    pub fn ranges(&self) -> &[Range<usize>] {
        &self.shared.ranges
    }

    /// The bases of its classes.
    pub fn bases(&self) -> &[Basis] {
        &self.bases
    }

    /// Condenses a load on the cluster's unknowns: what stays on the own ones, and the load on the shared ones.
    pub fn condense(&self, load: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let own = self.shared.own.columns.ncols();
        let mut f = vec![0.0; own + self.s.nrows()];
        for (terms, load) in self.shared.terms.iter().zip(load) {
            terms.iter().for_each(|&(i, c)| f[i] += c * load);
        }
        self.shared.own.forward(&mut f);
        let mut shared = f.split_off(own);
        self.turn(&mut shared);
        (f, shared)
    }

    /// The unknowns of the cluster, but for constants, for the shared ones.
    pub fn recover(&self, own: &[f64], shared: &[f64]) -> Vec<f64> {
        let mut shared = shared.to_vec();
        for (q, range) in self.turns() {
            let turned = product(q.as_ref(), &shared[range.clone()]);
            shared[range].copy_from_slice(&turned);
        }
        let mut x = own.to_vec();
        x.extend(shared);
        self.shared.own.backward(&mut x);
        let of = |terms: &Vec<(usize, f64)>| terms.iter().map(|&(i, c)| c * x[i]).sum();
        self.shared.terms.iter().map(of).collect()
    }

    /// Turns a vector on the shared unknowns into the basis of the classes.
    pub fn turn(&self, shared: &mut [f64]) {
        for (q, range) in self.turns() {
            let turned = product(q.transpose(), &shared[range.clone()]);
            shared[range].copy_from_slice(&turned);
        }
    }

    fn turns(&self) -> impl Iterator<Item = (&Mat<f64>, Range<usize>)> {
        let classes = self.shared.ranges.iter().zip(&self.bases);
        classes.filter_map(|(range, basis)| Some((basis.q()?, range.clone())))
    }

    /// S x.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        product(self.s.as_ref(), x)
    }

    /// The cluster's share of a residual: what stays on the other unknowns, and the load on the coarse ones.
    pub fn share(&self, r: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut scaled = vec![0.0; r.len()];
        for (range, basis) in self.shared.ranges.iter().zip(&self.bases) {
            scaled[range.clone()].copy_from_slice(&basis.scale_back(&r[range.clone()]));
        }
        let mut load: Vec<f64> = self.order.iter().map(|&i| scaled[i]).collect();
        self.others.forward(&mut load);
        let coarse = load.split_off(self.others.columns.ncols());
        (load, coarse)
    }

    /// The cluster's share of a correction, where its coarse unknowns are known.
    pub fn correct(&self, mut others: Vec<f64>, coarse: &[f64]) -> Vec<f64> {
        others.extend(coarse);
        self.others.backward(&mut others);
        let mut x = vec![0.0; others.len()];
        self.order
            .iter()
            .zip(others)
            .for_each(|(&i, value)| x[i] = value);
        for (range, basis) in self.shared.ranges.iter().zip(&self.bases) {
            let scaled = basis.scale(&x[range.clone()]);
            x[range.clone()].copy_from_slice(&scaled);
        }
        x
    }
}

/// A x.
pub fn product(a: MatRef<'_, f64>, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; a.nrows()];
    multiply_add(a, x, &mut y);
    y
}
