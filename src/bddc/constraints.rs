//! The coarse unknowns of a class, and how its clusters share a residual there.
//!
//! With S_FF of every cluster on a class F and S̃ what is left of it on F where all else is free, a jump between the
//! clusters that scaling makes a mistake of has at least the energy of the parallel sum of all S̃, (Σ S̃⁻¹)⁻¹, and the
//! mistake has that of all S_FF. What the ratio of the two is large for becomes coarse, rigid motions among it (Mandel
//! and Sousedík, Comput. Methods Appl. Mech. Engrg 196, 2007; for any number of clusters after Pechstein and Dohrmann,
//! ETNA 46, 2017; deluxe scaling after Dohrmann and Widlund).

use faer::Side::Lower;
use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Mat, Par};
use serde::{Deserialize, Serialize};

use crate::bddc::local::{Moves, product};

/// Ratio of the energies above which what has it becomes coarse: about the condition number of what is left.
const THRESHOLD: f64 = 10.0;

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
    /// W = D Q: of r it has Wᵀ r, and it corrects by W x.
    Part(#[serde(with = "crate::bytes::matrix")] Mat<f64>),
}

/// S_FF of a cluster and S̃⁻¹.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Side {
    /// S_FF.
    #[serde(with = "crate::bytes::symmetric")]
    pub s: Mat<f64>,
    /// S̃⁻¹.
    #[serde(with = "crate::bytes::symmetric")]
    pub compliance: Mat<f64>,
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

    /// That of a class, for each of the clusters that have these `sides` of it.
    ///
    /// # Errors
    /// It can move although all else is held.
    pub fn adaptive(sides: &[Side]) -> Result<Vec<Self>, Moves> {
        let n = sides.first().map_or(0, |side| side.s.nrows());
        let mut sum = Mat::<f64>::zeros(n, n);
        let (mut held, mut free) = (sum.clone(), sum.clone());
        for side in sides {
            sum += &side.s;
            held += side.s.llt(Lower).map_err(|_| Moves)?.inverse();
            free += &side.compliance;
        }
        let (coarse, q) = coarse_first(held, free)?;
        let sum = sum.llt(Lower).map_err(|_| Moves)?;
        let of = |side: &Side| Self {
            coarse,
            q: q.clone(),
            share: Share::Part(sum.solve(&side.s * &q)),
        };
        Ok(sides.iter().map(of).collect())
    }

    /// The basis, a column each, where it isn't the unknowns of the class.
    pub fn q(&self) -> Option<&Mat<f64>> {
        (self.q.ncols() > 0).then_some(&self.q)
    }

    /// The correction of the unknowns of the class for one in the basis.
    pub fn correct(&self, x: &[f64]) -> Vec<f64> {
        match &self.share {
            Share::All => x.to_vec(),
            Share::Nothing => vec![0.0; x.len()],
            Share::Part(w) => product(w.as_ref(), x),
        }
    }

    /// The share of a residual, in the basis.
    pub fn share(&self, r: &[f64]) -> Vec<f64> {
        match &self.share {
            Share::Part(w) => product(w.transpose(), r),
            _ => self.correct(r),
        }
    }
}

/// How many combinations of unknowns have far more energy where all else is `held` than where it is `free`, by the
/// inverses of both, and an orthogonal matrix whose first columns span the weights of these.
fn coarse_first(mut held: Mat<f64>, mut free: Mat<f64>) -> Result<(usize, Mat<f64>), Moves> {
    make_symmetric(&mut held);
    let factor = held.llt(Lower).map_err(|_| Moves)?;
    let l = factor.L();
    solve_lower_triangular_in_place(l, free.as_mut(), Par::Seq);
    solve_lower_triangular_in_place(l, free.as_mut().transpose_mut(), Par::Seq);
    make_symmetric(&mut free);
    let eigen = free.self_adjoint_eigen(Lower).map_err(|_| Moves)?;
    let ratios = eigen.S().column_vector();
    let n = free.nrows();
    // Ascending.
    let first = (0..n).take_while(|&i| ratios[i] <= THRESHOLD).count();
    let mut weights = eigen.U().subcols(first, n - first).to_owned();
    solve_upper_triangular_in_place(l.transpose(), weights.as_mut(), Par::Seq);
    Ok((n - first, weights.qr().compute_Q()))
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
