//! Projection of jumps onto limits some of which depend on others.

use std::collections::BTreeMap;

use contact_dd_partition::disjoint_sets::DisjointSets;
use faer::Mat;

use super::active_set::ContactProblem;
use super::dependent::DependentConstraints;
use crate::vector::largest;

/// Moves those `jumps` of a group that occur in its dependent `rows` to the nearest ones within these `bounds`, and
/// closes or opens their limits accordingly; returns how many changed. The values of the rows follow those of the
/// jumps.
pub fn project(
    rows: &DependentConstraints,
    bounds: &[f64],
    jumps: &mut [f64],
    open: &mut [bool],
) -> usize {
    let m = bounds.len() - rows.len();
    let mut sets = DisjointSets::new(m);
    for row in rows.iter() {
        for pair in row.windows(2) {
            sets.unite(pair[0].0 as u32, pair[1].0 as u32);
        }
    }
    let mut parts: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (j, row) in rows.iter().enumerate().filter(|(_, row)| !row.is_empty()) {
        parts.entry(sets.find(row[0].0 as u32)).or_default().push(j);
    }
    let mut changed = 0;
    for of_part in parts.values() {
        let mut own: Vec<usize> = (of_part.iter())
            .flat_map(|&j| rows.row(j).iter().map(|&(i, _)| i))
            .collect();
        own.sort_unstable();
        own.dedup();
        let limits: Vec<usize> = own
            .iter()
            .copied()
            .chain(of_part.iter().map(|j| m + j))
            .collect();
        let mut of_limits: Vec<bool> = limits.iter().map(|&i| open[i]).collect();
        let nearest = nearest(rows, (&own, of_part), bounds, jumps, &mut of_limits);
        for (&i, t) in own.iter().zip(nearest) {
            jumps[i] = t;
        }
        for (&i, is_open) in limits.iter().zip(of_limits) {
            changed += usize::from(open[i] != is_open);
            open[i] = is_open;
        }
        for &j in of_part {
            let value = rows.value(j, jumps);
            jumps[m + j] = if open[m + j] { value } else { bounds[m + j] };
        }
    }
    changed
}

/// Projection of these `own` jumps onto their bounds and those of some rows: min ½ |t − t₀|².
fn nearest(
    rows: &DependentConstraints,
    (own, of_part): (&[usize], &[usize]),
    bounds: &[f64],
    jumps: &[f64],
    open: &mut [bool],
) -> Vec<f64> {
    let n = own.len();
    let m = bounds.len() - rows.len();
    let mut of_own = DependentConstraints::default();
    for &j in of_part {
        // Every jump of a row is among those of its part.
        let renamed = |&(i, c): &(usize, f64)| (own.partition_point(|&known| known < i), c);
        of_own.push(rows.row(j).iter().map(renamed).collect());
    }
    let limits = own.iter().copied().chain(of_part.iter().map(|j| m + j));
    let bounds: Vec<f64> = limits.map(|i| bounds[i]).collect();
    let from: Vec<f64> = own.iter().map(|&i| jumps[i]).collect();
    let sizes: Vec<f64> = from.iter().map(|t| t.abs()).collect();
    let h = Mat::<f64>::identity(n, n);
    let problem = ContactProblem {
        h: h.as_ref(),
        diagonal: &vec![1.0; n],
        c: &from,
        c_scale: &sizes,
        rows: &of_own,
        bounds: &bounds,
        center: &vec![0.0; n],
        scale: largest(&from),
    };
    problem.solve(open).jumps
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two jumps below 0 whose sum is to be below −1, and one that occurs in no row.
    #[test]
    fn jumps_go_to_the_nearest_within_limits() {
        let mut rows = DependentConstraints::default();
        rows.push(vec![(0, 1.0), (1, 1.0)]);
        let bounds = [0.0, 0.0, 0.0, -1.0];
        for (from, to, closed) in [
            ([1.0, -0.25, 3.0], [0.0, -1.0], [true, false, true]),
            ([-0.25, -0.25, 3.0], [-0.5, -0.5], [false, false, true]),
            ([-1.0, -2.0, 3.0], [-1.0, -2.0], [false, false, false]),
        ] {
            let mut jumps = from.to_vec();
            jumps.push(from[0] + from[1]);
            let mut open = [true; 4];
            let changed = project(&rows, &bounds, &mut jumps, &mut open);
            for (found, expected) in jumps.iter().zip(to) {
                assert!((found - expected).abs() < 1e-14, "{jumps:?}");
            }
            assert_eq!(jumps[2], 3.0);
            assert_eq!([open[0], open[1], open[3]], closed.map(|closed| !closed));
            assert_eq!(changed, closed.iter().filter(|closed| **closed).count());
        }
    }
}
