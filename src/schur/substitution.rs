//! Substitution of displacements by normal jumps, in the front where a contact point's nodes meet.
//!
//! With u_p = Σ β u_s + Σ γ t, the displacements p replaced by normal jumps t in terms of the remaining ones s, x = T
//! y, where y contains t instead of u_p. The front becomes Tᵀ A T, a load Tᵀ f.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

use super::condensed::InterfaceDof;

/// Mean number of terms per replaced displacement up to which updating single columns is as fast as dense products.
const FEW_TERMS: usize = 16;
/// Columns of a front that are transformed together.
const AT_A_TIME: usize = 256;

/// A displacement that is replaced by a normal jump.
#[derive(Clone, Debug, PartialEq)]
pub struct Replaced {
    /// The displacement.
    pub dof: InterfaceDof,
    /// Remaining displacements, and β.
    pub staying: Vec<(InterfaceDof, f64)>,
    /// Normal jumps, including the one that replaces it, and γ.
    pub jumps: Vec<(usize, f64)>,
    /// True if this jump is that of a tie, which is known; known jumps come last.
    pub is_tied: bool,
}

/// T of a front.
#[derive(Clone, Debug, Default)]
pub(super) struct Substitution {
    /// Places in the front of the traces that normal jumps replace.
    places: Vec<usize>,
    /// Places of the remaining traces, and β, for each.
    staying: Vec<Vec<(usize, f64)>>,
    /// Normal jumps and γ, for each.
    jumps: Vec<Vec<(usize, f64)>>,
}

impl Substitution {
    /// T of a front in which displacements have the places `place`.
    pub fn new(replaced: &[Replaced], place: impl Fn(&InterfaceDof) -> usize) -> Self {
        let staying = |r: &Replaced| r.staying.iter().map(|(dof, c)| (place(dof), *c)).collect();
        Self {
            places: replaced.iter().map(|r| place(&r.dof)).collect(),
            staying: replaced.iter().map(staying).collect(),
            jumps: replaced.iter().map(|r| r.jumps.clone()).collect(),
        }
    }

    /// A ← Tᵀ A T, column by column if there are few terms, as in the plane, else by dense products.
    pub fn transform(&self, a: &mut Front<'_>) {
        let terms: usize = self.staying.iter().map(Vec::len).sum();
        match terms <= FEW_TERMS * self.places.len() {
            true => self.transform_columns(a),
            false => self.multiply(a),
        }
    }

    fn transform_columns(&self, a: &mut Front<'_>) {
        let n = a.len();
        for (&p, staying) in self.places.iter().zip(&self.staying) {
            for &(s, beta) in staying {
                let (of_both, of_p) = (a.get(s, p), a.get(p, p));
                for i in (0..n).filter(|&i| i != s && i != p) {
                    let change = beta * a.get(i, p);
                    a.add(i, s, change);
                }
                a.add(p, s, beta * of_p);
                a.add(s, s, beta * (2.0 * of_both + beta * of_p));
            }
        }
        let m = self.places.len();
        let columns = Mat::from_fn(n, m, |i, k| a.get(i, self.places[k]));
        let mut turned = Mat::<f64>::zeros(n, m);
        for (k, jumps) in self.jumps.iter().enumerate() {
            for &(l, gamma) in jumps {
                for i in 0..n {
                    turned[(i, l)] += gamma * columns[(i, k)];
                }
            }
        }
        let mut both = Mat::<f64>::zeros(m, m);
        for (k, jumps) in self.jumps.iter().enumerate() {
            for &(j, gamma) in jumps {
                for l in 0..m {
                    both[(j, l)] += gamma * turned[(self.places[k], l)];
                }
            }
        }
        for (l, &p) in self.places.iter().enumerate() {
            for i in 0..n {
                a.set(i, p, turned[(i, l)]);
            }
        }
        for (l, &p) in self.places.iter().enumerate() {
            for (j, &q) in self.places.iter().enumerate().skip(l) {
                a.set(q, p, both[(j, l)]);
            }
        }
    }

    /// Tᵀ A T = E A E + W B + Bᵀ Wᵀ with W = E A P + ½ Bᵀ (Pᵀ A P) and T = E + P B, where P contains the unit vectors
    /// of the replaced unknowns, x_P = B y, and E sets these unknowns to 0.
    fn multiply(&self, a: &mut Front<'_>) {
        let (n, m) = (a.len(), self.places.len());
        let mut columns: Vec<usize> = self.rows().flatten().map(|(place, _)| place).collect();
        columns.sort_unstable();
        columns.dedup();
        let mut b = Mat::<f64>::zeros(m, columns.len());
        for (k, row) in self.rows().enumerate() {
            for (place, coefficient) in row {
                // All places of a row are among the columns.
                let column = columns.partition_point(|&column| column < place);
                b[(k, column)] += coefficient;
            }
        }
        let mut w = Mat::from_fn(n, m, |i, k| a.get(i, self.places[k]));
        let of_places = Mat::from_fn(m, m, |k, l| w[(self.places[k], l)]);
        for &place in &self.places {
            (0..m).for_each(|k| w[(place, k)] = 0.0);
            (0..n).for_each(|i| a.set(i, place, 0.0));
        }
        let mut beside = Mat::<f64>::zeros(columns.len(), m);
        matmul(
            &mut beside,
            Accum::Replace,
            b.transpose(),
            &of_places,
            0.5,
            Par::Seq,
        );
        for (row, &place) in columns.iter().enumerate() {
            (0..m).for_each(|k| w[(place, k)] += beside[(row, k)]);
        }
        let mut change = Mat::<f64>::zeros(n, AT_A_TIME.min(columns.len()));
        for (part, places) in columns.chunks(AT_A_TIME).enumerate() {
            let of_part = b.subcols(part * AT_A_TIME, places.len());
            let mut change = change.subcols_mut(0, places.len());
            matmul(&mut change, Accum::Replace, &w, of_part, 1.0, Par::Seq);
            for (column, &place) in places.iter().enumerate() {
                let change = change.as_ref().col(column);
                (0..n).for_each(|i| a.add(i, place, change[i]));
                a.add(place, place, change[place]);
            }
        }
    }

    /// Places and factors in the row of every replaced unknown.
    fn rows(&self) -> impl Iterator<Item = impl Iterator<Item = (usize, f64)>> {
        self.staying
            .iter()
            .zip(&self.jumps)
            .map(|(staying, jumps)| {
                let of_jumps = jumps.iter().map(|&(l, gamma)| (self.places[l], gamma));
                staying.iter().copied().chain(of_jumps)
            })
    }

    /// f ← Tᵀ f.
    pub fn transform_load(&self, f: &mut [f64]) {
        let on_replaced: Vec<f64> = self.places.iter().map(|&p| f[p]).collect();
        self.places.iter().for_each(|&p| f[p] = 0.0);
        for (k, &f_p) in on_replaced.iter().enumerate() {
            for &(s, beta) in &self.staying[k] {
                f[s] += beta * f_p;
            }
            for &(l, gamma) in &self.jumps[k] {
                f[self.places[l]] += gamma * f_p;
            }
        }
    }

    /// Diagonal of the matrix whose round-off Tᵀ A T has, transformed from that of A.
    pub fn transform_diagonal(&self, d: &mut [f64]) {
        let of_replaced: Vec<f64> = self.places.iter().map(|&p| d[p]).collect();
        self.places.iter().for_each(|&p| d[p] = 0.0);
        for (k, &d_p) in of_replaced.iter().enumerate() {
            for &(s, beta) in &self.staying[k] {
                d[s] += beta * beta * d_p;
            }
            for &(l, gamma) in &self.jumps[k] {
                d[self.places[l]] += gamma * gamma * d_p;
            }
        }
    }

    /// The normal jumps of y.
    pub fn jumps(&self, y: &[f64]) -> Vec<f64> {
        self.places.iter().map(|&p| y[p]).collect()
    }

    /// x = T y.
    pub fn resolve(&self, y: &mut [f64]) {
        let jumps = self.jumps(y);
        for (k, &p) in self.places.iter().enumerate() {
            let staying = self.staying[k].iter().map(|&(s, beta)| beta * y[s]);
            let of_jumps = self.jumps[k].iter().map(|&(l, gamma)| gamma * jumps[l]);
            y[p] = staying.chain(of_jumps).sum();
        }
    }
}

/// The lower triangle of a front, [A_EE; A_KE] and A_KK.
pub(super) struct Front<'a> {
    pub columns: &'a mut Mat<f64>,
    pub s: &'a mut Mat<f64>,
}

impl Front<'_> {
    fn len(&self) -> usize {
        self.columns.ncols() + self.s.ncols()
    }

    fn entry(&mut self, i: usize, j: usize) -> &mut f64 {
        let (i, j) = (i.max(j), i.min(j));
        let e = self.columns.ncols();
        match j < e {
            true => &mut self.columns[(i, j)],
            false => &mut self.s[(i - e, j - e)],
        }
    }

    fn get(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.max(j), i.min(j));
        let e = self.columns.ncols();
        match j < e {
            true => self.columns[(i, j)],
            false => self.s[(i - e, j - e)],
        }
    }

    fn add(&mut self, i: usize, j: usize, value: f64) {
        *self.entry(i, j) += value;
    }

    fn set(&mut self, i: usize, j: usize, value: f64) {
        *self.entry(i, j) = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Displacements 1 and 3 of five are replaced, one of them in terms of both normal jumps.
    #[test]
    fn a_front_and_a_load_are_those_of_the_new_unknowns() {
        let substitution = Substitution {
            places: vec![3, 1],
            staying: vec![vec![(0, 0.5), (4, -1.0)], vec![(4, 2.0)]],
            jumps: vec![vec![(0, 1.5)], vec![(0, -0.25), (1, 0.8)]],
        };
        let mut t = Mat::<f64>::identity(5, 5);
        for (k, &p) in substitution.places.iter().enumerate() {
            t[(p, p)] = 0.0;
            for &(s, beta) in &substitution.staying[k] {
                t[(p, s)] = beta;
            }
            for &(l, gamma) in &substitution.jumps[k] {
                t[(p, substitution.places[l])] = gamma;
            }
        }
        let noise = |i: usize, j: usize| ((7 * i * j + i + j) as f64).sin();
        let a = Mat::from_fn(5, 5, noise);
        let expected = t.transpose() * &a * &t;
        for transform in [Substitution::transform_columns, Substitution::multiply] {
            let (mut columns, mut s) = (Mat::zeros(5, 2), Mat::zeros(3, 3));
            for j in 0..5 {
                for i in j..5 {
                    match j < 2 {
                        true => columns[(i, j)] = a[(i, j)],
                        false => s[(i - 2, j - 2)] = a[(i, j)],
                    }
                }
            }
            let mut front = Front {
                columns: &mut columns,
                s: &mut s,
            };
            transform(&substitution, &mut front);
            for j in 0..5 {
                for i in j..5 {
                    assert!((front.get(i, j) - expected[(i, j)]).abs() < 1e-14);
                }
            }
        }
        let f = Mat::from_fn(5, 1, |i, _| noise(i, 3));
        let mut load: Vec<f64> = (0..5).map(|i| f[(i, 0)]).collect();
        substitution.transform_load(&mut load);
        let of_new = t.transpose() * &f;
        assert!((0..5).all(|i| (load[i] - of_new[(i, 0)]).abs() < 1e-14));
        let mut x: Vec<f64> = (0..5).map(|i| f[(i, 0)]).collect();
        substitution.resolve(&mut x);
        let old = &t * &f;
        assert!((0..5).all(|i| (x[i] - old[(i, 0)]).abs() < 1e-14));
    }
}
