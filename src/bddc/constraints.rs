//! The coarse unknowns of a class, and the weights by which its clusters share a residual there.
//!
//! With S_FF of every cluster on a class F and S̃ the Schur complement on F with all else free, a jump between the
//! clusters that scaling distributes wrongly has at least the energy of the parallel sum of all S̃, (Σ S̃⁻¹)⁻¹, and the
//! error has that of all S_FF. Modes with a large ratio of the two become coarse, rigid motions among them (Mandel and
//! Sousedík, Comput. Methods Appl. Mech. Engrg 196, 2007; for any number of clusters after Pechstein and Dohrmann, ETNA
//! 46, 2017; deluxe scaling after Dohrmann and Widlund).

use faer::Side::Lower;
use faer::linalg::matmul::matmul;
use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, ColMut, ColRef, Mat, MatRef, Par};
use serde::{Deserialize, Serialize};

use crate::bddc::householder::Householder;
use crate::schur::trapezoid::NotDefinite;

/// Ratio of the energies above which modes become coarse: about the remaining condition number.
const THRESHOLD: f64 = 10.0;

/// Error: a cluster can move although its shared unknowns are held.
#[derive(Clone, Copy, Debug)]
pub struct Mechanism;

impl From<NotDefinite> for Mechanism {
    fn from(_: NotDefinite) -> Self {
        Self
    }
}

/// The basis of a class, coarse unknowns first, and a cluster's share of its residual.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Basis {
    /// Number of coarse unknowns.
    pub coarse: usize,
    /// The basis; `None` for the unknowns of the class themselves.
    pub q: Option<Householder>,
    share: Share,
}

/// The share that a cluster has of a residual, and of a correction in the sum over clusters.
#[derive(Clone, Debug, Serialize, Deserialize)]
enum Share {
    All,
    Nothing,
    /// W = D Q with this diagonal D: its share of r is Wᵀ r, its correction W x.
    Diagonal(#[serde(with = "crate::bytes")] Vec<f64>),
    /// W.
    Part(#[serde(with = "crate::bytes::matrix")] Mat<f64>),
}

/// The stiffness of a class in a cluster.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Side {
    /// The stiffness of each unknown.
    Diagonal(#[serde(with = "crate::bytes")] Vec<f64>),
    /// The stiffness with all other unknowns held, and with them free.
    Whole {
        /// S_FF.
        #[serde(with = "crate::bytes::symmetric")]
        s: Mat<f64>,
        /// S̃⁻¹, if the class is examined for its modes; else empty.
        #[serde(with = "crate::bytes::symmetric")]
        compliance: Mat<f64>,
    },
}

impl Basis {
    /// The basis of a class with coarse unknowns only; its first cluster has the whole share.
    pub fn coarse(count: usize, is_first: bool) -> Self {
        Self {
            coarse: count,
            q: None,
            share: if is_first { Share::All } else { Share::Nothing },
        }
    }

    /// The basis of a class, for each of the clusters that have these `sides` of it: its rigid `motions` are coarse, or
    /// if the sides are examined, their modes.
    ///
    /// # Errors
    /// The class can move although all else is held.
    pub fn new(sides: &[Side], motions: impl FnOnce() -> Mat<f64>) -> Result<Vec<Self>, Mechanism> {
        let (mut whole, mut diagonals) = (Vec::new(), Vec::new());
        for side in sides {
            match side {
                Side::Diagonal(diagonal) => diagonals.push(diagonal),
                Side::Whole { s, compliance } => whole.push((s, compliance)),
            }
        }
        let uses_energies =
            |(s, compliance): &(&Mat<f64>, &Mat<f64>)| compliance.nrows() == s.nrows();
        let weights = match !whole.is_empty() && whole.iter().all(uses_energies) {
            true => adaptive(&whole)?,
            false => motions(),
        };
        let q = Householder::new(&weights);
        let basis = |share| Self {
            coarse: weights.ncols(),
            q: Some(q.clone()),
            share,
        };
        if whole.is_empty() {
            let sum = |i: usize| diagonals.iter().map(|diagonal| diagonal[i]).sum::<f64>();
            let part = |diagonal: &&Vec<f64>| {
                let parts = diagonal.iter().enumerate();
                Share::Diagonal(parts.map(|(i, d)| d / sum(i)).collect())
            };
            return Ok(diagonals.iter().map(part).map(basis).collect());
        }
        let n = weights.nrows();
        let mut sum = Mat::<f64>::zeros(n, n);
        whole.iter().for_each(|(s, _)| sum += *s);
        let sum = sum.llt(Lower).map_err(|_| Mechanism)?;
        let of = |(s, _): &(&Mat<f64>, _)| {
            let mut w = sum.solve(*s);
            q.multiply_right(w.as_mut());
            basis(Share::Part(w))
        };
        Ok(whole.iter().map(of).collect())
    }

    /// The correction of the class's unknowns from one in the basis.
    pub fn correct(&self, x: &[f64]) -> Vec<f64> {
        match (&self.share, &self.q) {
            (Share::Nothing, _) => vec![0.0; x.len()],
            (Share::Part(w), _) => product(w.as_ref(), x),
            (Share::Diagonal(d), Some(q)) => {
                let mut x = x.to_vec();
                q.turn(&mut x);
                x.iter_mut().zip(d).for_each(|(x, d)| *x *= d);
                x
            }
            _ => x.to_vec(),
        }
    }

    /// The share of a residual, in the basis.
    pub fn share(&self, r: &[f64]) -> Vec<f64> {
        match (&self.share, &self.q) {
            (Share::Part(w), _) => product(w.transpose(), r),
            (Share::Diagonal(d), Some(q)) => {
                let mut r: Vec<f64> = r.iter().zip(d).map(|(r, d)| d * r).collect();
                q.turn_back(&mut r);
                r
            }
            _ => self.correct(r),
        }
    }
}

/// A x.
fn product(a: MatRef<'_, f64>, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; a.nrows()];
    let x = ColRef::from_slice(x);
    matmul(
        ColMut::from_slice_mut(&mut y).as_mat_mut(),
        Accum::Replace,
        a,
        x.as_mat(),
        1.0,
        Par::Seq,
    );
    y
}

/// Weights of modes, one per column, that have far more energy with all other unknowns held than with them free.
fn adaptive(sides: &[(&Mat<f64>, &Mat<f64>)]) -> Result<Mat<f64>, Mechanism> {
    let n = sides.first().map_or(0, |(s, _)| s.nrows());
    let (mut held, mut free) = (Mat::<f64>::zeros(n, n), Mat::<f64>::zeros(n, n));
    for (s, compliance) in sides {
        held += s.llt(Lower).map_err(|_| Mechanism)?.inverse();
        free += *compliance;
    }
    make_symmetric(&mut held);
    let factor = held.llt(Lower).map_err(|_| Mechanism)?;
    let l = factor.L();
    solve_lower_triangular_in_place(l, free.as_mut(), Par::Seq);
    solve_lower_triangular_in_place(l, free.as_mut().transpose_mut(), Par::Seq);
    make_symmetric(&mut free);
    let eigen = free.self_adjoint_eigen(Lower).map_err(|_| Mechanism)?;
    let ratios = eigen.S().column_vector();
    // The ratios ascend.
    let first = (0..n).take_while(|&i| ratios[i] <= THRESHOLD).count();
    let mut weights = eigen.U().subcols(first, n - first).to_owned();
    solve_upper_triangular_in_place(l.transpose(), weights.as_mut(), Par::Seq);
    Ok(weights)
}

fn make_symmetric(a: &mut Mat<f64>) {
    for j in 0..a.ncols() {
        for i in j + 1..a.nrows() {
            let mean = 0.5 * (a[(i, j)] + a[(j, i)]);
            a[(i, j)] = mean;
            a[(j, i)] = mean;
        }
    }
}
