//! Rigid-body motions in condensed operators: they have no energy, and the load along them is the resultant of the
//! loads.
//!
//! A stiff body among soft ones causes cancellation in the condensation onto normal jumps: motions without energy get
//! an energy in H, of either sign, and the load c along them differs from the bodies' load. Both are known exactly,
//! from geometry.

use std::collections::BTreeMap;

use contact_dd_partition::disjoint_sets::DisjointSets;
use faer::Mat;
use serde::{Deserialize, Serialize};

use crate::comm::is_asked_to_stop;
use crate::vector::{axpy, dot};

/// Part of a motion orthogonal to the others, relative to the motion, above which it is independent.
const INDEPENDENT: f64 = 1e-8;
/// Number of motions from which on sets without common normal jumps are treated separately.
const MANY: usize = 100;

/// Normal jumps in rigid motions: R, with a row for each normal jump and a column for each motion, and the load Rᵀ c
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

/// The motions in the scale of energies: an orthonormal basis Q of the range of D^½ R, with D the diagonal of the
/// condensed matrix.
#[derive(Clone, Debug, Default)]
pub struct RigidBasis {
    root: Vec<f64>,
    /// The normal jumps of every set connected by motions, ascending.
    parts: Vec<Vec<usize>>,
    q: Vec<Direction>,
    /// Qᵀ D^(−½) c.
    load: Vec<f64>,
}

/// A column of Q, zero outside one set of normal jumps.
#[derive(Clone, Debug)]
struct Direction {
    part: usize,
    /// Its entries in that set.
    values: Vec<f64>,
}

impl RigidBasis {
    /// The basis for normal jumps with this `diagonal` D, by two passes of Gram-Schmidt. Soft bodies are first: the
    /// remainders of stiff bodies' motions then leave the small loads along the soft ones unchanged.
    pub fn new(drive: &RigidModes, diagonal: &[f64]) -> Self {
        let root: Vec<f64> = diagonal.iter().map(|k| k.max(0.0).sqrt()).collect();
        let (parts, part_of_row) = parts(&drive.rows, root.len());
        let mut basis = Self {
            root,
            parts,
            ..Self::default()
        };
        let scaled = |column: faer::ColRef<'_, f64>| -> Option<Direction> {
            let first = column.iter().position(|r| *r != 0.0)?;
            let part = *part_of_row.get(first)?;
            let rows = basis.parts[part].iter();
            let values = rows.map(|&row| column[row] * basis.root[row]);
            Some(Direction {
                part,
                values: values.collect(),
            })
        };
        let columns = drive.rows.col_iter().zip(&drive.load);
        let mut motions: Vec<(f64, Direction, f64)> = columns
            .filter_map(|(column, &load)| {
                let v = scaled(column)?;
                Some((dot(&v.values, &v.values).sqrt(), v, load))
            })
            .collect();
        motions.sort_by(|(one, ..), (other, ..)| one.total_cmp(other));
        let mut of_part: Vec<Vec<usize>> = vec![Vec::new(); basis.parts.len()];
        for (whole, mut v, mut load) in motions {
            // After a signal no result is needed.
            if is_asked_to_stop() {
                break;
            }
            for _ in 0..2 {
                for &k in &of_part[v.part] {
                    let (q, load_of_q) = (&basis.q[k].values, basis.load[k]);
                    let along = dot(&v.values, q);
                    load -= along * load_of_q;
                    axpy(-along, q, &mut v.values);
                }
            }
            let left = dot(&v.values, &v.values).sqrt();
            if left > INDEPENDENT * whole {
                v.values.iter_mut().for_each(|v| *v /= left);
                of_part[v.part].push(basis.q.len());
                basis.q.push(v);
                basis.load.push(load / left);
            }
        }
        basis
    }

    /// H ← Pᵀ H P, where P projects the motions out.
    ///
    /// In the scale of energies P H P = H − Q Xᵀ − X Qᵀ with X = H Q − ½ Q (Qᵀ H Q).
    pub fn remove_energy(&self, h: &mut Mat<f64>) {
        let rank = self.q.len();
        if rank == 0 {
            return;
        }
        let scaled = |i: usize, j: usize| match self.root[i] * self.root[j] {
            0.0 => 0.0,
            product => h[(i, j)] / product,
        };
        let n = h.nrows();
        let scaled = Mat::from_fn(n, n, scaled);
        let change = match rank >= MANY && self.parts.len() > 1 {
            true => self.change_by_parts(&scaled),
            false => self.change_at_once(&scaled),
        };
        for j in 0..n {
            for i in j..n {
                let of_both = change[(i, j)] + change[(j, i)];
                let value = h[(i, j)] - self.root[i] * self.root[j] * of_both;
                h[(i, j)] = value;
                h[(j, i)] = value;
            }
        }
    }

    /// Q Xᵀ, with dense matrices.
    fn change_at_once(&self, scaled: &Mat<f64>) -> Mat<f64> {
        let n = self.root.len();
        let mut q = Mat::zeros(n, self.q.len());
        for (k, Direction { part, values }) in self.q.iter().enumerate() {
            for (&row, value) in self.parts[*part].iter().zip(values) {
                q[(row, k)] = *value;
            }
        }
        let hq = scaled * &q;
        let qhq = q.transpose() * &hq;
        let x = &hq - &q * &qhq * faer::Scale(0.5);
        &q * x.transpose()
    }

    /// X Qᵀ, where every motion involves one set of normal jumps only, with dense matrices for each set.
    fn change_by_parts(&self, scaled: &Mat<f64>) -> Mat<f64> {
        let n = self.root.len();
        let q = self.of_parts();
        let mut change = Mat::zeros(n, n);
        for (rows, own) in &q {
            let mut x = Mat::from_fn(n, rows.len(), |i, j| scaled[(i, rows[j])]) * own;
            let hq = x.clone();
            for (rows, other) in &q {
                let there = Mat::from_fn(rows.len(), hq.ncols(), |i, k| hq[(rows[i], k)]);
                let part = other * (other.transpose() * there);
                for k in 0..part.ncols() {
                    let entries = rows.iter().zip(part.col(k).iter());
                    entries.for_each(|(&row, part)| x[(row, k)] -= 0.5 * part);
                }
            }
            let columns = x * own.transpose();
            for (&row, column) in rows.iter().zip(columns.col_iter()) {
                let to = change.col_mut(row);
                (to.iter_mut().zip(column.iter())).for_each(|(to, x)| *to = *x);
            }
        }
        change
    }

    /// The normal jumps of every set with motions, and the motions' entries there.
    fn of_parts(&self) -> Vec<(&[usize], Mat<f64>)> {
        let mut motions: Vec<Vec<&[f64]>> = vec![Vec::new(); self.parts.len()];
        for Direction { part, values } in &self.q {
            motions[*part].push(values);
        }
        let parts = self.parts.iter().zip(motions);
        let moving = parts.filter(|(_, motions)| !motions.is_empty());
        moving
            .map(|(rows, motions)| {
                let q = Mat::from_fn(rows.len(), motions.len(), |i, k| motions[k][i]);
                (&rows[..], q)
            })
            .collect()
    }

    /// Sets the part of c along the motions to the bodies' load.
    pub fn set_load(&self, c: &mut [f64]) {
        self.set(c, |k| self.load[k]);
    }

    /// Removes the part of c along the motions.
    pub fn remove_load(&self, c: &mut [f64]) {
        self.set(c, |_| 0.0);
    }

    fn set(&self, c: &mut [f64], exact: impl Fn(usize) -> f64) {
        for (k, Direction { part, values }) in self.q.iter().enumerate() {
            let entries = || self.parts[*part].iter().zip(values);
            let term = |(&row, q): (&usize, &f64)| match self.root[row] {
                root if root > 0.0 => c[row] / root * q,
                _ => 0.0,
            };
            let found: f64 = entries().map(term).sum();
            let missing = exact(k) - found;
            for (&row, q) in entries() {
                c[row] += missing * self.root[row] * q;
            }
        }
    }
}

/// Sets of rows connected by columns, and the set of every row.
fn parts(matrix: &Mat<f64>, rows: usize) -> (Vec<Vec<usize>>, Vec<usize>) {
    let mut sets = DisjointSets::new(rows);
    for column in matrix.col_iter() {
        let mut own = (0..rows.min(column.nrows())).filter(|&row| column[row] != 0.0);
        if let Some(first) = own.next() {
            own.for_each(|row| sets.unite(first as u32, row as u32));
        }
    }
    let mut of_root = BTreeMap::new();
    let mut parts: Vec<Vec<usize>> = Vec::new();
    let mut part_of_row = Vec::with_capacity(rows);
    for row in 0..rows {
        let part = *of_root.entry(sets.find(row as u32)).or_insert(parts.len());
        if part == parts.len() {
            parts.push(Vec::new());
        }
        parts[part].push(row);
        part_of_row.push(part);
    }
    (parts, part_of_row)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEND: [f64; 3] = [1.0, -2.0, 1.0];
    const STIFFNESS: [f64; 3] = [1.0, 4.0, 2.0];

    /// Translation and rotation of a beam on three supports, and the sum of both.
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

    /// Motions on disjoint sets of rows, in arbitrary order, and a matrix that connects all rows.
    #[test]
    fn parts_by_themselves_lose_the_same_energy() {
        let noise = |s: usize| ((s as f64 * 78.233).sin() * 43758.5453).fract();
        let n = 15;
        let rows = Mat::from_fn(n, 6, |i, k| match i % 3 == k % 3 {
            true => noise(10 * i + k + 1),
            false => 0.0,
        });
        let drive = RigidModes {
            load: vec![0.0; rows.ncols()],
            rows,
        };
        let diagonal: Vec<f64> = (0..n).map(|i| 1.0 + i as f64).collect();
        let basis = RigidBasis::new(&drive, &diagonal);
        assert_eq!((basis.parts.len(), basis.q.len()), (3, 6));
        let h = Mat::from_fn(n, n, |i, j| noise(i.min(j) * 40 + i.max(j) + 3));
        let root = &basis.root;
        let scaled = Mat::from_fn(n, n, |i, j| h[(i, j)] / (root[i] * root[j]));
        let at_once = basis.change_at_once(&scaled);
        let by_parts = basis.change_by_parts(&scaled);
        assert!((by_parts.transpose() - at_once).norm_max() < 1e-15);
        let mut without = h.clone();
        basis.remove_energy(&mut without);
        assert!((&without * &drive.rows).norm_max() < 1e-13);
    }

    /// A soft body without load on a stiff one held by two constraints: the round-off of the stiff body's load would
    /// move the soft one.
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
