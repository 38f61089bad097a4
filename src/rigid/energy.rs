//! Rigid motions cost no energy, whatever round-off makes of it.
//!
//! A stiff body among soft ones leaves cancellation in a stiffness condensed onto approaches: an
//! energy, of either sign, for motions that have none. They are known, so it is taken out.

use faer::{Mat, MatRef};

/// Part of a motion, relative to all of it, that is new.
const INDEPENDENT: f64 = 1e-10;

/// H ← Pᵀ H P, where P takes out the columns of `motions`, orthogonally if displacements are
/// measured by the energy of `stiffness`, a diagonal.
pub fn remove_rigid_energy(h: &mut Mat<f64>, stiffness: &[f64], motions: MatRef<'_, f64>) {
    let root: Vec<f64> = stiffness.iter().map(|k| k.max(0.0).sqrt()).collect();
    let q = orthonormal(Mat::from_fn(h.nrows(), motions.ncols(), |i, k| {
        root[i] * motions[(i, k)]
    }));
    if q.ncols() == 0 {
        return;
    }
    // In the scale of energies H is D^(−1/2) H D^(−1/2): P H P = H − Q Xᵀ − X Qᵀ with
    // X = H Q − ½ Q (Qᵀ H Q).
    let scaled = Mat::from_fn(h.nrows(), h.ncols(), |i, j| {
        if root[i] > 0.0 && root[j] > 0.0 {
            h[(i, j)] / root[i] / root[j]
        } else {
            0.0
        }
    });
    let hq = &scaled * &q;
    let qhq = q.transpose() * &hq;
    let x = &hq - &q * &qhq * faer::Scale(0.5);
    let change = &q * x.transpose();
    for j in 0..h.ncols() {
        for i in j..h.nrows() {
            let value = h[(i, j)] - root[i] * root[j] * (change[(i, j)] + change[(j, i)]);
            h[(i, j)] = value;
            h[(j, i)] = value;
        }
    }
}

/// An orthonormal basis of what the columns of `a` span, by Gram and Schmidt, twice.
fn orthonormal(a: Mat<f64>) -> Mat<f64> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for column in a.col_iter() {
        let mut v: Vec<f64> = column.iter().copied().collect();
        let whole = norm(&v);
        for _ in 0..2 {
            for q in &basis {
                let along: f64 = v.iter().zip(q).map(|(v, q)| v * q).sum();
                for (v, q) in v.iter_mut().zip(q) {
                    *v -= along * q;
                }
            }
        }
        let left = norm(&v);
        if left > INDEPENDENT * whole && left > 0.0 {
            basis.push(v.iter().map(|v| v / left).collect());
        }
    }
    Mat::from_fn(a.nrows(), basis.len(), |i, k| basis[k][i])
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_round_off_left_of_a_motion_goes_and_nothing_else() {
        let bend = [1.0, -2.0, 1.0];
        let exact = Mat::from_fn(3, 3, |i, j| bend[i] * bend[j]);
        let noise = |i: usize, j: usize| 1e-9 * ((i * j + i + j) as f64).sin();
        let mut h = Mat::from_fn(3, 3, |i, j| exact[(i, j)] + noise(i, j));
        // Lifting, rocking, and both at once.
        let motions = Mat::from_fn(3, 3, |i, k| [1.0, i as f64 - 1.0, i as f64][k]);
        remove_rigid_energy(&mut h, &[1.0, 4.0, 2.0], motions.as_ref());
        assert!((&h * &motions).norm_max() < 1e-15);
        assert!((&h - &exact).norm_max() < 1e-8);
        remove_rigid_energy(&mut h, &[1.0, 4.0, 2.0], Mat::zeros(3, 0).as_ref());
        assert!((&h * &motions).norm_max() < 1e-15);
    }
}
