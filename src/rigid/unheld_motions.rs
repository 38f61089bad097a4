//! The rigid-body motions of many bodies that no constraint restrains.

use std::collections::BTreeMap;

use contact_dd_partition::disjoint_sets::DisjointSets;
use nalgebra::DMatrix;

use super::many_bodies::{MANY, ManyBodies, SparseRow};
use super::null_space::null_space;

/// An orthonormal basis of the motions x with B x = 0, where unknowns belong to bodies at these `points`. Connected
/// parts of the scene are treated separately, small ones with dense matrices. `None` if a signal stopped the
/// computation, or a part is too large.
pub(super) fn unheld_motions(points: &[[f64; 3]], rows: &[SparseRow]) -> Option<Vec<SparseRow>> {
    let n = points.len();
    let mut sets = DisjointSets::new(n);
    for row in rows {
        for pair in row.windows(2) {
            sets.unite(pair[0].0 as u32, pair[1].0 as u32);
        }
    }
    let mut part_of_root = BTreeMap::new();
    let mut parts: Vec<(Vec<usize>, Vec<SparseRow>)> = Vec::new();
    let mut place = vec![(0, 0); n];
    for (i, place) in place.iter_mut().enumerate() {
        let part = *part_of_root.entry(sets.find(i as u32)).or_insert_with(|| {
            parts.push(Default::default());
            parts.len() - 1
        });
        *place = (part, parts[part].0.len());
        parts[part].0.push(i);
    }
    for row in rows.iter().filter(|row| !row.is_empty()) {
        let own = row.iter().map(|&(i, b)| (place[i].1, b));
        parts[place[row[0].0].0].1.push(own.collect());
    }
    let mut motions = Vec::new();
    for (unknowns, rows) in parts {
        let of_part = match unknowns.len() < MANY {
            true => dense(unknowns.len(), &rows),
            false => {
                let points: Vec<[f64; 3]> = unknowns.iter().map(|&i| points[i]).collect();
                ManyBodies::new(&points, rows)?.unheld()?
            }
        };
        let numbered = |x: Vec<f64>| unknowns.iter().copied().zip(x).collect();
        motions.extend(of_part.into_iter().map(numbered));
    }
    Some(motions)
}

fn dense(unknowns: usize, rows: &[SparseRow]) -> Vec<Vec<f64>> {
    let mut b = DMatrix::zeros(rows.len(), unknowns);
    for (j, row) in rows.iter().enumerate() {
        row.iter().for_each(|&(i, entry)| b[(j, i)] += entry);
    }
    let free = null_space(&b);
    (free.column_iter().map(|x| x.iter().copied().collect())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(s: usize) -> f64 {
        ((s as f64 * 78.233).sin() * 43758.5453).fract()
    }

    /// Chains of bodies with two motions each; the rows are weighted differences within a chain, which leave two
    /// motions of each chain as a whole. Dense matrices give the same.
    #[test]
    fn chains_move_as_wholes_and_in_no_other_way() {
        for (chains, bodies) in [(1, 3), (1, 120), (3, 80), (40, 4)] {
            let n = 2 * chains * bodies;
            // Unknowns are numbered out of order; n is no multiple of 7.
            let number =
                |chain: usize, body: usize, k: usize| (2 * (chain * bodies + body) + k) * 7 % n;
            assert!(n % 7 != 0);
            let mut rows: Vec<SparseRow> = Vec::new();
            for chain in 0..chains {
                for body in 1..bodies {
                    for j in 0..3 {
                        let [a, b] = [0, 1].map(|k| noise(100 * body + 10 * j + k + chain));
                        rows.push(vec![
                            (number(chain, body, 0), a),
                            (number(chain, body, 1), b),
                            (number(chain, body - 1, 0), -a),
                            (number(chain, body - 1, 1), -b),
                        ]);
                    }
                }
            }
            let points: Vec<_> = (0..n).map(|i| [i as f64, 0.0, 0.0]).collect();
            let motions = unheld_motions(&points, &rows).unwrap();
            assert_eq!(motions.len(), 2 * chains, "{chains} {bodies}");
            for motion in &motions {
                let mut x = vec![0.0; n];
                motion.iter().for_each(|&(i, value)| x[i] = value);
                let size: f64 = x.iter().map(|x| x * x).sum();
                assert!((size - 1.0).abs() < 1e-12);
                for row in &rows {
                    let jump: f64 = row.iter().map(|&(i, b)| b * x[i]).sum();
                    assert!(jump.abs() < 1e-10, "{jump:e}");
                }
            }
            // Fixing one body of each chain fixes the chain.
            for chain in 0..chains {
                rows.push(vec![(number(chain, 0, 0), 1.0)]);
                rows.push(vec![(number(chain, 0, 1), 1.0)]);
            }
            let held = unheld_motions(&points, &rows).unwrap();
            assert!(held.is_empty(), "{chains} {bodies}");
        }
    }

    /// A tower as a beam whose joints resist shear and rotation: its smallest stiffness falls as the fourth power of
    /// the height, here to 1e-13 of the largest, and still restrains it.
    #[test]
    fn a_high_tower_is_held() {
        let high = 3000;
        let mut rows: Vec<SparseRow> = Vec::new();
        for body in 0..high {
            let (shift, turn) = (2 * body, 2 * body + 1);
            // u' = u + rotation of the body below; both joints are half a height away.
            let mut row = vec![(shift, 1.0), (turn, 0.5)];
            let mut bend = vec![(turn, 1.0)];
            if body > 0 {
                row.extend([(shift - 2, -1.0), (turn - 2, 0.5)]);
                bend.push((turn - 2, -1.0));
            }
            rows.extend([row, bend]);
        }
        let points: Vec<_> = (0..2 * high).map(|i| [0.0, 0.0, (i / 2) as f64]).collect();
        assert!(unheld_motions(&points, &rows).unwrap().is_empty());
        // On a floor that lets it slide and tip, it moves as a rigid body.
        let free = unheld_motions(&points, &rows[2..]).unwrap();
        assert_eq!(free.len(), 2);
    }
}
