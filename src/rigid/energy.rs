//! Rigid motions cost no energy and carry the load's resultant, whatever round-off makes of it.
//!
//! A stiff body among soft ones leaves cancellation in what is condensed onto normal jumps: an energy
//! H, of either sign, of motions that have none, and a load c that drives them otherwise than the
//! load of the bodies does. Both are known exactly, from geometry.

use faer::Mat;
use serde::{Deserialize, Serialize};

use crate::vector::{axpy, dot};

/// Part of a motion, relative to all of it, that is new.
const INDEPENDENT: f64 = 1e-8;

/// Normal jumps against rigid motions: R, a row a normal jump and a column a motion, and the load Rᵀ c
/// along them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigidModes {
    /// R.
    #[serde(with = "crate::bytes::matrix")]
    pub rows: Mat<f64>,
    /// The resultant of the bodies' load along every motion.
    pub load: Vec<f64>,
}

impl Default for RigidModes {
    /// No motions.
    fn default() -> Self {
        Self {
            rows: Mat::new(),
            load: Vec::new(),
        }
    }
}

/// The motions in the scale of energies: an orthonormal basis Q of what D^½ R spans, D the diagonal of
/// the matrix that is condensed.
#[derive(Clone, Debug, Default)]
pub struct RigidBasis {
    root: Vec<f64>,
    q: Vec<Vec<f64>>,
    /// Qᵀ D^(−½) c.
    load: Vec<f64>,
}

impl RigidBasis {
    /// The basis for normal jumps with this `diagonal` D, by Gram and Schmidt, twice; soft bodies first, so
    /// that what is left for stiff ones leaves theirs alone, to which it would be far more.
    pub fn new(drive: &RigidModes, diagonal: &[f64]) -> Self {
        let root: Vec<f64> = diagonal.iter().map(|k| k.max(0.0).sqrt()).collect();
        let mut basis = Self {
            root,
            ..Self::default()
        };
        let scaled = |column: faer::ColRef<'_, f64>| -> Vec<f64> {
            let products = column.iter().zip(&basis.root);
            products.map(|(r, root)| r * root).collect()
        };
        let columns = drive.rows.col_iter().map(scaled);
        let mut motions: Vec<(f64, Vec<f64>, f64)> = (columns.zip(&drive.load))
            .map(|(v, &load)| (dot(&v, &v).sqrt(), v, load))
            .collect();
        motions.sort_by(|(one, ..), (other, ..)| one.total_cmp(other));
        for (whole, mut v, mut load) in motions {
            for _ in 0..2 {
                for (q, load_of_q) in basis.q.iter().zip(&basis.load) {
                    let along = dot(&v, q);
                    load -= along * load_of_q;
                    axpy(-along, q, &mut v);
                }
            }
            let left = dot(&v, &v).sqrt();
            if left > INDEPENDENT * whole {
                basis.q.push(v.iter().map(|v| v / left).collect());
                basis.load.push(load / left);
            }
        }
        basis
    }

    /// H ← Pᵀ H P, where P takes the motions out.
    pub fn remove_energy(&self, h: &mut Mat<f64>) {
        let (n, rank) = (h.nrows(), self.q.len());
        if rank == 0 {
            return;
        }
        // In the scale of energies P H P = H − Q Xᵀ − X Qᵀ with X = H Q − ½ Q (Qᵀ H Q).
        let q = Mat::from_fn(n, rank, |i, k| self.q[k][i]);
        let scaled = Mat::from_fn(n, n, |i, j| match self.root[i] * self.root[j] {
            0.0 => 0.0,
            product => h[(i, j)] / product,
        });
        let hq = &scaled * &q;
        let qhq = q.transpose() * &hq;
        let x = &hq - &q * &qhq * faer::Scale(0.5);
        let change = &q * x.transpose();
        for j in 0..n {
            for i in j..n {
                let of_both = change[(i, j)] + change[(j, i)];
                let value = h[(i, j)] - self.root[i] * self.root[j] * of_both;
                h[(i, j)] = value;
                h[(j, i)] = value;
            }
        }
    }

    /// Gives c the part along the motions that the bodies' load has.
    pub fn set_load(&self, c: &mut [f64]) {
        self.set(c, |k| self.load[k]);
    }

    /// Takes out of c what it has along the motions.
    pub fn remove_load(&self, c: &mut [f64]) {
        self.set(c, |_| 0.0);
    }

    fn set(&self, c: &mut [f64], exact: impl Fn(usize) -> f64) {
        for (k, q) in self.q.iter().enumerate() {
            let scaled = c.iter().zip(&self.root).zip(q);
            let found: f64 = scaled
                .map(|((c, root), q)| if *root > 0.0 { c / root * q } else { 0.0 })
                .sum();
            let missing = exact(k) - found;
            for ((c, root), q) in c.iter_mut().zip(&self.root).zip(q) {
                *c += missing * root * q;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEND: [f64; 3] = [1.0, -2.0, 1.0];
    const STIFFNESS: [f64; 3] = [1.0, 4.0, 2.0];

    /// Lifting, rocking, and both at once, of a beam on three supports.
    fn lifting_and_rocking(load: [f64; 2]) -> RigidModes {
        RigidModes {
            rows: Mat::from_fn(3, 3, |i, k| [1.0, i as f64 - 1.0, i as f64][k]),
            load: vec![load[0], load[1], load[0] + load[1]],
        }
    }

    #[test]
    fn what_round_off_left_of_a_motion_goes_and_nothing_else() {
        let exact = Mat::from_fn(3, 3, |i, j| BEND[i] * BEND[j]);
        let noise = |i: usize, j: usize| 1e-9 * ((i * j + i + j) as f64).sin();
        let mut h = Mat::from_fn(3, 3, |i, j| exact[(i, j)] + noise(i, j));
        let drive = lifting_and_rocking([0.0, 0.0]);
        RigidBasis::new(&drive, &STIFFNESS).remove_energy(&mut h);
        assert!((&h * &drive.rows).norm_max() < 1e-15);
        assert!((&h - &exact).norm_max() < 1e-8);
    }

    /// A soft body without load on a stiff one that two conditions hold: what round-off leaves of the
    /// stiff one's load would drive it.
    #[test]
    fn round_off_of_a_stiff_body_is_nothing_to_a_soft_one() {
        let drive = RigidModes {
            rows: Mat::from_fn(3, 2, |i, k| [[1.0, 0.0], [1.0, 0.0], [-1.0, 1.0]][i][k]),
            load: vec![1e10, 0.0],
        };
        let mut c = vec![0.3e10 + 7e-6, 0.7e10, 3e-9];
        RigidBasis::new(&drive, &[1e12, 3e12, 1e4]).set_load(&mut c);
        assert!((c[0] + c[1] - 1e10).abs() < 1e-5, "{c:?}");
        assert!(c[2].abs() < 1e-20, "{c:?}");
    }

    #[test]
    fn a_load_gets_the_resultant_that_it_has() {
        let drive = lifting_and_rocking([3.0, -0.5]);
        let mut c = vec![1.25 + 1e-9, 1.0 - 2e-9, 0.75];
        let basis = RigidBasis::new(&drive, &STIFFNESS);
        basis.set_load(&mut c);
        for (column, load) in drive.rows.col_iter().zip(&drive.load) {
            let found: f64 = column.iter().zip(&c).map(|(r, c)| r * c).sum();
            assert!((found - load).abs() < 1e-14, "{found}, expected {load}");
        }
        assert!((c[0] - 1.25).abs() < 1e-8);
        basis.remove_load(&mut c);
        assert!(
            c.iter()
                .zip([1.0; 3])
                .map(|(c, z)| c * z)
                .sum::<f64>()
                .abs()
                < 1e-14
        );
    }
}
