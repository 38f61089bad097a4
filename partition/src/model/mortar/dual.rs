//! The dual basis on the covered part of a facet: ∫ φ_j P_k = δ_jk ∫ P_k.

use nalgebra::DMatrix;

use super::bases::lift;
use super::cover::Cover;

/// Coefficients of the dual basis in terms of the shape functions, φ_j = Σ_i A_ji N_i, with ∫ φ_j P_k = δ_jk ∫ P_k over
/// the covered part of a facet, for the functions P of `basis`: A = D M⁻¹ P with their mass matrix M_ik = ∫ P_i P_k and
/// D_jj = ∫ P_j. Its columns sum to 1: Σ_j φ_j = 1. `None` where the functions aren't reliably independent on the
/// covered part: the least eigenvalue of M, scaled to a unit diagonal, isn't above `floor`.
pub(super) fn dual_basis(cover: &Cover, basis: &DMatrix<f64>, floor: f64) -> Option<DMatrix<f64>> {
    let mass = basis * &cover.mass * basis.transpose();
    let count = mass.nrows();
    // Scaled to a unit diagonal, M is well-conditioned even if little of the facet is covered.
    let scale: Vec<f64> = (0..count).map(|i| 1.0 / mass[(i, i)].sqrt()).collect();
    let scaled = DMatrix::from_fn(count, count, |i, k| scale[i] * mass[(i, k)] * scale[k]);
    let inverse = scaled.clone().cholesky()?.inverse();
    if floor > 0.0 && scaled.symmetric_eigenvalues().min() <= floor {
        return None;
    }
    let integrals = lift(basis, &cover.integrals);
    let dual = DMatrix::from_fn(count, count, |j, i| {
        integrals[j] * scale[j] * inverse[(j, i)] * scale[i]
    });
    Some(dual * basis)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::ElementKind::Line2;

    /// The cover of the reference line from `from` to `to`, by the midpoint rule with `count` points: the identities
    /// hold exactly for any rule.
    fn cover(from: f64, to: f64, count: usize) -> Cover {
        let step = (to - from) / count as f64;
        let mut cover = Cover::new(2);
        for i in 0..count {
            let at = from + (i as f64 + 0.5) * step;
            cover.add(step, &Line2.shape([at, 0.0, 0.0]), 0.0);
        }
        cover
    }

    fn dual(cover: &Cover) -> Option<DMatrix<f64>> {
        dual_basis(cover, &DMatrix::identity(2, 2), 0.0)
    }

    #[test]
    fn the_whole_line_has_the_dual_basis_of_the_books() {
        let basis = dual(&cover(-1.0, 1.0, 20_000)).unwrap();
        let expected = [[2.0, -1.0], [-1.0, 2.0]];
        for (j, row) in expected.iter().enumerate() {
            for (i, value) in row.iter().enumerate() {
                assert!((basis[(j, i)] - value).abs() < 1e-7, "{basis}");
            }
        }
    }

    #[test]
    fn it_is_biorthogonal_on_any_part_and_sums_to_one() {
        for (from, to) in [
            (-1.0, 1.0),
            (-0.3, 0.9),
            (0.99, 1.0),
            (-1.0, -0.7),
            (0.2, 0.21),
        ] {
            let cover = cover(from, to, 12);
            let basis = dual(&cover).unwrap();
            let products = &basis * &cover.mass;
            for j in 0..2 {
                for k in 0..2 {
                    let expected = if j == k { cover.integrals[j] } else { 0.0 };
                    assert!(
                        (products[(j, k)] - expected).abs() < 1e-10 * (to - from),
                        "{from} {to}"
                    );
                }
                assert!(
                    (basis.column(j).sum() - 1.0).abs() < 1e-11,
                    "{from} {to}: {basis}"
                );
            }
        }
    }

    #[test]
    fn one_point_doesnt_tell_two_shape_functions_apart() {
        assert!(dual(&cover(0.0, 0.5, 1)).is_none());
        assert!(dual(&Cover::new(2)).is_none());
        let nearly = cover(0.0, 0.01, 12);
        assert!(dual_basis(&nearly, &DMatrix::identity(2, 2), 1e-3).is_none());
    }
}
