//! The coarse unknowns of a class, and how its clusters share a residual there.
//!
//! With S_FF on a class F of two clusters a and b, and S̃ what is left of S on F where all else is free, a jump w
//! between them that scaling makes a mistake of has at least the energy wᵀ (S̃_a : S̃_b) w, and the mistake has
//! wᵀ (S_a : S_b) w; A : B = A (A + B)⁻¹ B is the parallel sum. What the ratio of the two is large for becomes
//! coarse, rigid motions of either side among it (Mandel and Sousedík, Comput. Methods Appl. Mech. Engrg 196, 2007;
//! deluxe scaling after Dohrmann and Widlund).

use faer::Side::Lower;
use faer::linalg::solvers::Solve;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par};
use serde::{Deserialize, Serialize};

use crate::bddc::local::{Moves, product};

/// Ratio of the energies above which what has it becomes coarse: about the condition number of what is left.
const THRESHOLD: f64 = 10.0;
/// Share of S that is added where it may be singular.
const HOLD: f64 = 1e-9;

/// The basis of a class, coarse unknowns first, and the share that a cluster has of what is there.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Basis {
    /// Number of coarse unknowns.
    pub coarse: usize,
    /// The basis, a column each; nothing where it is the unknowns of the class.
    #[serde(with = "crate::bytes::matrix")]
    q: Mat<f64>,
    share: Share,
}

/// The share that a cluster has of a residual, and its correction in the sum of all.
#[derive(Clone, Debug, Serialize, Deserialize)]
enum Share {
    All,
    Nothing,
    /// D: it has Dᵀ r and D x.
    Part(#[serde(with = "crate::bytes::matrix")] Mat<f64>),
}

/// S_FF of a cluster and its S̃.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Side {
    /// S_FF.
    #[serde(with = "crate::bytes::symmetric")]
    pub s: Mat<f64>,
    /// S̃.
    #[serde(with = "crate::bytes::symmetric")]
    pub left: Mat<f64>,
}

impl Basis {
    /// That of a class all of whose unknowns are coarse; its first cluster has all of what is there.
    pub fn coarse(count: usize, is_first: bool) -> Self {
        Self {
            coarse: count,
            q: Mat::new(),
            share: if is_first { Share::All } else { Share::Nothing },
        }
    }

    /// That of a class of two clusters, for each of them.
    ///
    /// # Errors
    /// It can move although all else is held.
    pub fn adaptive(sides: [&Side; 2]) -> Result<[Self; 2], Moves> {
        let [a, b] = sides;
        let sum = &a.s + &b.s;
        let shares = sum.llt(Lower).map_err(|_| Moves)?.solve(&a.s);
        let mut whole = b.s.transpose() * &shares;
        let mut held = &a.left + &b.left;
        for j in 0..sum.ncols() {
            for i in 0..sum.nrows() {
                whole[(i, j)] += HOLD * sum[(i, j)];
                held[(i, j)] += HOLD * sum[(i, j)];
            }
        }
        let left = b.left.transpose() * held.llt(Lower).map_err(|_| Moves)?.solve(&a.left);
        let (coarse, q) = coarse_first(whole, left)?;
        let n = sum.nrows();
        let d_a = q.transpose() * &shares * &q;
        let d_b = Mat::from_fn(n, n, |i, j| f64::from(i == j) - d_a[(i, j)]);
        let of = |d: Mat<f64>| Self {
            coarse,
            q: q.clone(),
            share: Share::Part(d),
        };
        Ok([of(d_a), of(d_b)])
    }

    /// The basis, a column each, where it isn't the unknowns of the class.
    pub fn q(&self) -> Option<&Mat<f64>> {
        (self.q.ncols() > 0).then_some(&self.q)
    }

    /// D x.
    pub fn scale(&self, x: &[f64]) -> Vec<f64> {
        match &self.share {
            Share::All => x.to_vec(),
            Share::Nothing => vec![0.0; x.len()],
            Share::Part(d) => product(d.as_ref(), x),
        }
    }

    /// Dᵀ r.
    pub fn scale_back(&self, r: &[f64]) -> Vec<f64> {
        match &self.share {
            Share::Part(d) => product(d.transpose(), r),
            _ => self.scale(r),
        }
    }
}

/// How many combinations of unknowns have `whole` energy far above what is `left`, and an orthogonal matrix whose first
/// columns span the weights of these.
fn coarse_first(mut whole: Mat<f64>, mut left: Mat<f64>) -> Result<(usize, Mat<f64>), Moves> {
    make_symmetric(&mut whole);
    make_symmetric(&mut left);
    let factor = whole.llt(Lower).map_err(|_| Moves)?;
    let l = factor.L();
    solve_lower_triangular_in_place(l, left.as_mut(), Par::Seq);
    solve_lower_triangular_in_place(l, left.as_mut().transpose_mut(), Par::Seq);
    make_symmetric(&mut left);
    let eigen = left.self_adjoint_eigen(Lower).map_err(|_| Moves)?;
    let ratios = eigen.S().column_vector();
    // Ascending.
    let coarse = (0..left.nrows())
        .take_while(|&i| ratios[i] * THRESHOLD < 1.0)
        .count();
    let weights = l * eigen.U().subcols(0, coarse);
    Ok((coarse, weights.qr().compute_Q()))
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
