//! Dependence of closed limits on each other: a violated limit that follows from closed ones replaces the one whose
//! force vanishes first as its own grows.
//!
//! D. Goldfarb, A. Idnani, *A numerically stable dual method for solving strictly convex quadratic programs*, Math.
//! Programming 27 (1983).

use super::active_equalities::ActiveEqualities;
use super::dependent::{DependentConstraints, Terms};

/// Share of a limit's normal in another's that counts as zero.
pub(super) const NO_SHARE: f64 = 1e-10;

impl DependentConstraints {
    /// Opens the closed rows that follow from other closed limits, which determine their gaps.
    pub fn open_redundant(&self, open: &mut [bool]) {
        if self.is_empty() {
            return;
        }
        let first = open.len() - self.len();
        for j in ActiveEqualities::new(self, open).redundant {
            open[first + j] = true;
        }
    }

    /// Multiples of closed limits' normals that make up the normal of limit k; `None` where none do.
    pub fn shares_in(
        &self,
        k: usize,
        open: &[bool],
        equalities: &ActiveEqualities,
    ) -> Option<Terms> {
        let m = open.len() - self.len();
        let own = [(k, 1.0)];
        let normal = if k < m { &own } else { self.row(k - m) };
        let of_rows = equalities.express(normal, open)?;
        let mut of_jumps = vec![0.0; m];
        for &(i, c) in normal {
            of_jumps[i] += c;
        }
        for &(j, share) in &of_rows {
            for &(i, c) in self.row(j) {
                of_jumps[i] -= share * c;
            }
        }
        let closed = (0..m).filter(|&i| !open[i] && of_jumps[i].abs() > NO_SHARE);
        let mut shares: Terms = closed.map(|i| (i, of_jumps[i])).collect();
        shares.extend(of_rows.into_iter().map(|(j, share)| (m + j, share)));
        Some(shares)
    }

    /// Closes limit k under these `forces`; where it follows from closed ones, opens the one of them that `may_open`
    /// and whose force vanishes first.
    pub fn close(
        &self,
        k: usize,
        open: &mut [bool],
        forces: &[f64],
        may_open: impl Fn(usize) -> bool,
    ) {
        if !self.is_empty()
            && let Some(mut shares) = self.shares_in(k, open, &ActiveEqualities::new(self, open))
        {
            shares.retain(|&(i, _)| may_open(i));
            if let Some((blocking, _)) = first_to_vanish(&shares, forces) {
                open[blocking] = true;
            }
        }
        open[k] = false;
    }

    /// Amplification in limit k of the round-off of closed limits from which it follows.
    pub fn amplified(&self, k: usize, open: &[bool], equalities: &ActiveEqualities) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let shares = self.shares_in(k, open, equalities).unwrap_or_default();
        shares.iter().map(|(_, share)| share.abs()).sum()
    }
}

/// The limit whose force vanishes first as each loses its share of a growing force, and that force; `None` if none
/// vanishes.
pub fn first_to_vanish(shares: &[(usize, f64)], forces: &[f64]) -> Option<(usize, f64)> {
    let losing = shares.iter().filter(|(_, share)| *share > NO_SHARE);
    let growth = |&(i, share): &(usize, f64)| (i, forces[i].max(0.0) / share);
    losing.map(growth).min_by(|(_, a), (_, b)| a.total_cmp(b))
}
