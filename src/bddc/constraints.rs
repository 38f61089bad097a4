//! The coarse unknowns of a class, and how its clusters share a residual there.
//!
//! With S_FF of every cluster on a class F and S̃ what is left of it on F where all else is free, a jump between the
//! clusters that scaling makes a mistake of has at least the energy of the parallel sum of all S̃, (Σ S̃⁻¹)⁻¹, and the
//! mistake has that of all S_FF. What the ratio of the two is large for becomes coarse, rigid motions among it (Mandel
//! and Sousedík, Comput. Methods Appl. Mech. Engrg 196, 2007; for any number of clusters after Pechstein and Dohrmann,
//! ETNA 46, 2017; deluxe scaling after Dohrmann and Widlund).

use faer::Side::Lower;
use faer::linalg::matmul::matmul;
use faer::linalg::solvers::{DenseSolveCore, Solve};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, ColMut, ColRef, Mat, MatRef, Par};
use serde::{Deserialize, Serialize};

use crate::bddc::local::Moves;
use crate::bddc::reflections::Reflections;

/// Ratio of the energies above which what has it becomes coarse: about the condition number of what is left.
const THRESHOLD: f64 = 10.0;

/// The basis of a class, coarse unknowns first, and the share that a cluster has of what is there.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Basis {
    /// Number of coarse unknowns.
    pub coarse: usize,
    /// The basis; nothing where it is the unknowns of the class.
    pub q: Option<Reflections>,
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
    /// S̃⁻¹, where the class is looked into; without unknowns elsewhere.
    #[serde(with = "crate::bytes::symmetric")]
    pub compliance: Mat<f64>,
}

impl Basis {
    /// That of a class all of whose unknowns are coarse; its first cluster has all of what is there.
    pub fn coarse(count: usize, is_first: bool) -> Self {
        Self {
            coarse: count,
            q: None,
            share: if is_first { Share::All } else { Share::Nothing },
        }
    }

    /// That of a class, for each of the clusters that have these `sides` of it: its rigid `motions` are coarse, or what
    /// the sides say where they are looked into.
    ///
    /// # Errors
    /// It can move although all else is held.
    pub fn new(sides: &[Side], motions: impl FnOnce() -> Mat<f64>) -> Result<Vec<Self>, Moves> {
        let n = sides.first().map_or(0, |side| side.s.nrows());
        let mut sum = Mat::<f64>::zeros(n, n);
        sides.iter().for_each(|side| sum += &side.s);
        let weights = match sides.iter().all(|side| side.compliance.nrows() == n) {
            true => adaptive(sides)?,
            false => motions(),
        };
        let q = Reflections::new(&weights);
        let sum = sum.llt(Lower).map_err(|_| Moves)?;
        let of = |side: &Side| {
            let mut w = sum.solve(&side.s);
            q.multiply_right(w.as_mut());
            Self {
                coarse: weights.ncols(),
                q: Some(q.clone()),
                share: Share::Part(w),
            }
        };
        Ok(sides.iter().map(of).collect())
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

/// The weights of combinations of unknowns that have far more energy where all else is held than where it is free, a
/// column each.
fn adaptive(sides: &[Side]) -> Result<Mat<f64>, Moves> {
    let n = sides.first().map_or(0, |side| side.s.nrows());
    let (mut held, mut free) = (Mat::<f64>::zeros(n, n), Mat::<f64>::zeros(n, n));
    for side in sides {
        held += side.s.llt(Lower).map_err(|_| Moves)?.inverse();
        free += &side.compliance;
    }
    make_symmetric(&mut held);
    let factor = held.llt(Lower).map_err(|_| Moves)?;
    let l = factor.L();
    solve_lower_triangular_in_place(l, free.as_mut(), Par::Seq);
    solve_lower_triangular_in_place(l, free.as_mut().transpose_mut(), Par::Seq);
    make_symmetric(&mut free);
    let eigen = free.self_adjoint_eigen(Lower).map_err(|_| Moves)?;
    let ratios = eigen.S().column_vector();
    // Ascending.
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
