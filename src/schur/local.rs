//! S_i of a linear subdomain, (11), and the linear part of a pair's S_kl, (12): a block condensed onto
//! its boundary.

use faer::{Mat, MatRef, Par};

use super::factor::{BoundaryLastCholesky, FactorError};
use super::pattern::SparseSymmetric;

/// Stiffness of springs on I, relative to the diagonal, tried in this order where pivots of K_II are round-off.
const SPRINGS: [f64; 3] = [1e-15, 1e-14, 1e-13];

/// S = K_BB − K_BI K_II⁻¹ K_IB, (11), with the factor that condenses loads and recovers the interior.
///
/// B contains the normal jumps first, then the interface dofs on Γ.
#[derive(Debug)]
pub struct LocalSchur {
    factor: BoundaryLastCholesky,
    interior: usize,
    /// The diagonal of K_BB (Pa), the scale of S's round-off.
    pub diagonal: Vec<f64>,
}

impl LocalSchur {
    /// Factorizes a block's stiffness, whose first `interior` unknowns are I; also returns the lower triangle of S
    /// (Pa).
    ///
    /// # Errors
    /// K_II isn't positive definite: the block has a free motion with its boundary held.
    pub fn new(
        matrix: &SparseSymmetric,
        interior: usize,
        par: Par,
    ) -> Result<(Self, Mat<f64>), FactorError> {
        Self::condensed(matrix, interior, matrix, par)
    }

    /// Factorizes a block without free motion whose pivots are round-off because it bends under very small forces:
    /// springs of the size of round-off make K_II definite.
    ///
    /// # Errors
    /// K_II isn't positive definite even with these springs.
    pub fn with_springs(
        matrix: &SparseSymmetric,
        interior: usize,
        par: Par,
    ) -> Result<(Self, Mat<f64>), FactorError> {
        let mut last = FactorError::Size;
        for spring in SPRINGS {
            let mut held = matrix.clone();
            for j in 0..interior {
                held.values[matrix.pattern.column(j).start] *= 1.0 + spring;
            }
            match Self::condensed(matrix, interior, &held, par) {
                Ok(condensed) => return Ok(condensed),
                Err(error) => last = error,
            }
        }
        Err(last)
    }

    fn condensed(
        matrix: &SparseSymmetric,
        interior: usize,
        held: &SparseSymmetric,
        par: Par,
    ) -> Result<(Self, Mat<f64>), FactorError> {
        let (factor, s) = BoundaryLastCholesky::condense(held, interior, par)?;
        let diagonal = (interior..matrix.pattern.n())
            .map(|j| matrix.values[matrix.pattern.column(j).start])
            .collect();
        let schur = Self {
            factor,
            interior,
            diagonal,
        };
        Ok((schur, s))
    }

    /// The smallest pivot of K_II relative to its diagonal.
    pub fn smallest_pivot(&self) -> f64 {
        self.factor.smallest_pivot()
    }

    /// Condenses a load: y_I = L_II⁻¹ f_I, y_B = f_B − K_BI K_II⁻¹ f_I.
    pub fn condense(&self, mut load: Vec<f64>) -> CondensedLoad {
        self.factor.forward(&mut load);
        CondensedLoad {
            y: load,
            interior: self.interior,
            tied: TiedLoad::default(),
        }
    }

    /// The unknowns of the whole block from the unknowns `x_b` on its boundary.
    pub fn recover(&self, load: &CondensedLoad, x_b: &[f64]) -> Vec<f64> {
        let mut x = load.y.clone();
        x[self.interior..].copy_from_slice(x_b);
        self.factor.backward(&mut x);
        x
    }
}

/// A load condensed onto B, with its reduced part on I for back-substitution.
#[derive(Clone, Debug)]
pub struct CondensedLoad {
    y: Vec<f64>,
    interior: usize,
    /// Jumps of ties, and the loads on them.
    pub tied: TiedLoad,
}

/// The jumps of the ties of a front (m), and the loads on them (N/m).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TiedLoad {
    /// The jumps.
    pub jumps: Vec<f64>,
    /// The loads.
    pub loads: Vec<f64>,
}

impl CondensedLoad {
    /// A condensed load whose first `interior` entries belong to I.
    pub fn new(y: Vec<f64>, interior: usize) -> Self {
        Self {
            y,
            interior,
            tied: TiedLoad::default(),
        }
    }

    /// The reduced load on I.
    pub fn interior(&self) -> &[f64] {
        &self.y[..self.interior]
    }

    /// The load on B.
    pub fn boundary(&self) -> &[f64] {
        &self.y[self.interior..]
    }
}

/// y ← y + A x.
pub fn multiply_add(a: MatRef<'_, f64>, x: &[f64], y: &mut [f64]) {
    for (column, x_j) in a.col_iter().zip(x) {
        for (y_i, a_ij) in y.iter_mut().zip(column.iter()) {
            *y_i += a_ij * x_j;
        }
    }
}
