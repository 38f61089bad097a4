//! Forces of linearly dependent closed limits: the smallest among all that balance the same loads, so that limits share
//! what one of them could carry alone.

use faer::linalg::solvers::{Llt, Solve};
use faer::{Mat, Side};

use super::active_equalities::ActiveEqualities;
use super::dependent::{DependentConstraints, Terms};

/// Self-equilibrated combinations of forces of closed limits.
#[derive(Clone, Debug, Default)]
pub struct ForceSharing {
    /// N: combinations of forces with zero resultant on every jump, one for each redundant row.
    idle: Vec<Terms>,
    /// The factor of NᵀN.
    gram: Option<Llt<f64>>,
}

impl ForceSharing {
    /// The combinations in a group with these dependent `rows`; redundant ones among the `equalities` are `open` here.
    pub fn new(rows: &DependentConstraints, open: &[bool], equalities: &ActiveEqualities) -> Self {
        let first = open.len() - rows.len();
        let idle = equalities.redundant.iter().filter_map(|&j| {
            let mut shares = rows.shares_in(first + j, open, equalities)?;
            shares.iter_mut().for_each(|(_, share)| *share = -*share);
            shares.push((first + j, 1.0));
            Some(shares)
        });
        let idle: Vec<Terms> = idle.collect();
        let product = |a: &Terms, b: &Terms| -> f64 {
            let both = a.iter().flat_map(|&(i, x)| {
                let same = b.iter().filter(move |(j, _)| *j == i);
                same.map(move |(_, y)| x * y)
            });
            both.sum()
        };
        let gram = Mat::from_fn(idle.len(), idle.len(), |k, l| product(&idle[k], &idle[l]));
        Self {
            gram: gram.llt(Side::Lower).ok().filter(|_| !idle.is_empty()),
            idle,
        }
    }

    /// Replaces the `forces` of all limits by the smallest ones with the same effect.
    pub fn share(&self, forces: &mut [f64]) {
        let Some(gram) = &self.gram else { return };
        let along = |terms: &Terms| terms.iter().map(|&(i, c)| c * forces[i]).sum::<f64>();
        let along: Vec<f64> = self.idle.iter().map(along).collect();
        let parts = gram.solve(Mat::from_fn(along.len(), 1, |k, _| along[k]));
        for (k, terms) in self.idle.iter().enumerate() {
            for &(i, c) in terms {
                forces[i] -= c * parts[(k, 0)];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two rows, the second of which follows from the jumps and the first: forces keep their effect on every jump, and
    /// no self-equilibrated part is left.
    #[test]
    fn shared_forces_have_the_same_effect_and_are_the_least() {
        let mut rows = DependentConstraints::default();
        rows.push(vec![(0, 0.6), (2, 0.8)]);
        rows.push(vec![(1, -1.5), (2, 0.4)]);
        // The third jump follows from the first row.
        let open = [false, false, true, false, false];
        let equalities = ActiveEqualities::new(&rows, &open);
        assert_eq!(equalities.redundant, [1]);
        let mut independent = open;
        independent[4] = true;
        let sharing = ForceSharing::new(&rows, &independent, &equalities);
        let effect = |forces: &[f64]| -> Vec<f64> {
            let mut effect = forces[..3].to_vec();
            let opposite: Vec<f64> = forces[3..].iter().map(|f| -f).collect();
            rows.subtract_transposed(&opposite, &mut effect);
            effect
        };
        let before = [3.0, -2.0, 0.0, 5.0, 0.0];
        let mut forces = before.to_vec();
        sharing.share(&mut forces);
        assert!(forces[4].abs() > 0.1 && forces[2] == 0.0, "{forces:?}");
        for (a, b) in effect(&forces).iter().zip(effect(&before)) {
            assert!((a - b).abs() < 1e-14, "{forces:?}");
        }
        let along: f64 = sharing.idle[0].iter().map(|&(i, c)| c * forces[i]).sum();
        assert!(along.abs() < 1e-14, "{along:e}");
    }
}
