//! The dual basis on the covered part of a facet: ∫ φ_j N_k = δ_jk ∫ N_k.

use nalgebra::DMatrix;

use super::cover::Sample;

/// Coefficients of the dual basis in terms of the shape functions, φ_j = Σ_i A_ji N_i, with
/// ∫ φ_j N_k = δ_jk ∫ N_k over the `samples` of a facet: A = D M⁻¹ with the facet's own mass matrix
/// M_ik = ∫ N_i N_k and D_jj = ∫ N_j. Its columns sum to 1: Σ_j φ_j = 1. `None` where the samples
/// don't tell the shape functions apart.
pub(super) fn dual_basis(samples: &[Sample]) -> Option<DMatrix<f64>> {
    let count = samples.first()?.shape.len();
    let mut mass = DMatrix::<f64>::zeros(count, count);
    for sample in samples {
        for i in 0..count {
            for k in 0..count {
                mass[(i, k)] += sample.weight * sample.shape[i] * sample.shape[k];
            }
        }
    }
    // Scaled to a unit diagonal it is well-conditioned however little of the facet is covered.
    let scale: Vec<f64> = (0..count).map(|i| 1.0 / mass[(i, i)].sqrt()).collect();
    let scaled = DMatrix::from_fn(count, count, |i, k| scale[i] * mass[(i, k)] * scale[k]);
    let inverse = scaled.cholesky()?.inverse();
    let integrals: Vec<f64> = (0..count).map(|j| integral(samples, j)).collect();
    Some(DMatrix::from_fn(count, count, |j, i| {
        integrals[j] * scale[j] * inverse[(j, i)] * scale[i]
    }))
}

/// ∫ N_j over the samples of a facet.
pub(super) fn integral(samples: &[Sample], j: usize) -> f64 {
    samples.iter().map(|s| s.weight * s.shape[j]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::ElementKind::Line2;

    /// The part of the reference line from `from` to `to`, by the midpoint rule of `count` points:
    /// exact to the rule, whatever the rule.
    fn samples(from: f64, to: f64, count: usize) -> Vec<Sample> {
        let step = (to - from) / count as f64;
        let at = |i: usize| from + (i as f64 + 0.5) * step;
        (0..count)
            .map(|i| Sample {
                weight: step,
                shape: Line2.shape([at(i), 0.0, 0.0]),
                opposite: 0,
                opposite_shape: vec![],
                gap: 0.0,
            })
            .collect()
    }

    #[test]
    fn the_whole_line_has_the_dual_basis_of_the_books() {
        let basis = dual_basis(&samples(-1.0, 1.0, 20_000)).unwrap();
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
            let samples = samples(from, to, 12);
            let basis = dual_basis(&samples).unwrap();
            for j in 0..2 {
                for k in 0..2 {
                    let dual = |s: &Sample| (0..2).map(|i| basis[(j, i)] * s.shape[i]).sum::<f64>();
                    let product: f64 = samples
                        .iter()
                        .map(|s| s.weight * dual(s) * s.shape[k])
                        .sum();
                    let expected = if j == k { integral(&samples, j) } else { 0.0 };
                    assert!(
                        (product - expected).abs() < 1e-10 * (to - from),
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
        assert!(dual_basis(&samples(0.0, 0.5, 1)).is_none());
        assert!(dual_basis(&[]).is_none());
    }
}
