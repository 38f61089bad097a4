//! Closed linearly dependent constraints: equations D t = d that eliminate open normal jumps.

use super::dependent::{DependentConstraints, Terms};

/// Size up to which a coefficient of order one that elimination should make zero is round-off.
const ROUND_OFF: f64 = 1e-10;

/// The closed rows as equations, each solved for an open normal jump of its own.
#[derive(Clone, Debug, Default)]
pub struct ActiveEqualities {
    /// The equations; none has the pivot of another.
    pub equalities: Vec<ActiveEquality>,
    /// Closed rows that follow from the others and the closed normal jumps.
    pub redundant: Vec<usize>,
}

/// t_pivot + Σ factor·t = Σ share·(d − D_C g_C), over open normal jumps and closed rows.
#[derive(Clone, Debug)]
pub struct ActiveEquality {
    /// The normal jump that follows from others.
    pub pivot: usize,
    /// The other jumps, and their factors.
    pub others: Terms,
    /// The closed rows that the equality combines, and their shares.
    shares: Terms,
}

impl ActiveEqualities {
    /// Solves the closed rows; `open` has the flags of normal jumps, then those of rows.
    pub fn new(rows: &DependentConstraints, open: &[bool]) -> Self {
        let mut equalities = Self::default();
        let m = open.len() - rows.len();
        for (j, row) in rows.iter().enumerate().filter(|&(j, _)| !open[m + j]) {
            let (mut terms, mut shares) = equalities.remainder(row, open);
            scale(&mut shares, -1.0);
            add(&mut shares, j, 1.0);
            let largest = (terms.iter().enumerate()).max_by(|(_, a), (_, b)| {
                let (a, b) = (a.1.abs(), b.1.abs());
                a.total_cmp(&b)
            });
            let Some((place, &(pivot, factor))) = largest else {
                equalities.redundant.push(j);
                continue;
            };
            terms.swap_remove(place);
            scale(&mut terms, 1.0 / factor);
            scale(&mut shares, 1.0 / factor);
            for equality in &mut equalities.equalities {
                if let Some(place) = equality.others.iter().position(|&(i, _)| i == pivot) {
                    let (_, factor) = equality.others.swap_remove(place);
                    add_multiple(&mut equality.others, &terms, -factor);
                    add_multiple(&mut equality.shares, &shares, -factor);
                }
            }
            equalities.equalities.push(ActiveEquality {
                pivot,
                others: terms,
                shares,
            });
        }
        equalities
    }

    /// Remainder of `normal` on the open normal jumps once the equalities are subtracted, and the multiple of every
    /// closed row that this takes.
    fn remainder(&self, normal: &[(usize, f64)], open: &[bool]) -> (Terms, Terms) {
        let mut left: Terms = normal.iter().copied().filter(|&(i, _)| open[i]).collect();
        let mut taken = Terms::new();
        for equality in &self.equalities {
            if let Some(place) = left.iter().position(|&(i, _)| i == equality.pivot) {
                let (_, factor) = left.swap_remove(place);
                add_multiple(&mut left, &equality.others, -factor);
                add_multiple(&mut taken, &equality.shares, factor);
            }
        }
        left.retain(|(_, c)| c.abs() > ROUND_OFF);
        (left, taken)
    }

    /// Multiples of closed rows that make up `normal` on the open normal jumps; `None` where none do.
    pub fn express(&self, normal: &[(usize, f64)], open: &[bool]) -> Option<Terms> {
        let (left, taken) = self.remainder(normal, open);
        left.is_empty().then_some(taken)
    }

    /// Sets the pivots of `t` so that the equalities hold, the other normal jumps being given; `bounds` are those of
    /// normal jumps, then those of rows.
    pub fn hold(&self, rows: &DependentConstraints, bounds: &[f64], t: &mut [f64]) {
        let m = t.len();
        for equality in &self.equalities {
            t[equality.pivot] = 0.0;
        }
        let t_free = t.to_vec();
        let held = |equality: &ActiveEquality| -> f64 {
            let of_row =
                |&(j, share): &(usize, f64)| share * (bounds[m + j] - rows.value(j, &t_free));
            equality.shares.iter().map(of_row).sum()
        };
        for equality in &self.equalities {
            t[equality.pivot] = held(equality);
        }
    }

    /// Forces μ of `count` rows that balance the residual load `left` on the pivots.
    pub fn forces(&self, count: usize, left: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut forces = vec![0.0; count];
        for equality in &self.equalities {
            let left = left(equality.pivot);
            for &(j, share) in &equality.shares {
                forces[j] += share * left;
            }
        }
        forces
    }

    /// Scale of the terms in the force of row j, from the `scale` of every normal jump.
    pub fn force_scale(&self, j: usize, scale: impl Fn(usize) -> f64) -> f64 {
        let of_equality = |equality: &ActiveEquality| -> f64 {
            let share = equality.shares.iter().find(|&&(row, _)| row == j);
            share.map_or(0.0, |(_, share)| share.abs() * scale(equality.pivot))
        };
        self.equalities.iter().map(of_equality).sum()
    }
}

fn scale(terms: &mut Terms, factor: f64) {
    for (_, c) in terms {
        *c *= factor;
    }
}

fn add(terms: &mut Terms, number: usize, factor: f64) {
    match terms.iter_mut().find(|(i, _)| *i == number) {
        Some((_, c)) => *c += factor,
        None => terms.push((number, factor)),
    }
}

fn add_multiple(terms: &mut Terms, others: &[(usize, f64)], factor: f64) {
    for &(i, c) in others {
        add(terms, i, factor * c);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(rows: &[&[(usize, f64)]]) -> DependentConstraints {
        let mut all = DependentConstraints::default();
        rows.iter().for_each(|row| all.push(row.to_vec()));
        all
    }

    #[test]
    fn eliminated_jumps_meet_every_closed_row() {
        let rows = rows(&[
            &[(0, 0.5), (1, 0.7)],
            &[(1, -0.4), (2, 1.0), (3, 0.2)],
            &[(0, 1.0), (2, 0.3)],
        ]);
        let open = [true, true, true, false, false, false, false];
        let bounds = [0.0, 0.0, 0.0, 0.6, 0.1, -0.2, 0.3];
        let equalities = ActiveEqualities::new(&rows, &open);
        assert!(equalities.redundant.is_empty());
        let mut t = [0.0, 0.0, 0.0, 0.6];
        equalities.hold(&rows, &bounds, &mut t);
        for j in 0..3 {
            assert!((rows.value(j, &t) - bounds[4 + j]).abs() < 1e-15);
        }
        let forces = [2.0, 3.0, 5.0];
        let mut left = [0.0; 4];
        rows.subtract_transposed(&forces.map(|f| -f), &mut left);
        for (found, force) in equalities.forces(3, |i| left[i]).iter().zip(forces) {
            assert!((found - force).abs() < 1e-14);
        }
    }

    #[test]
    fn a_row_that_follows_from_closed_ones_is_redundant() {
        let rows = rows(&[
            &[(0, 1.0), (1, 1.0)],
            &[(1, 1.0), (2, -1.0)],
            &[(0, 2.0), (1, 1.0), (2, 1.0)],
        ]);
        let equalities = ActiveEqualities::new(&rows, &[true, true, true, false, false, false]);
        assert_eq!(equalities.redundant, [2]);
        let mut made_of = equalities.express(rows.row(2), &[true; 3]).unwrap();
        made_of.sort_by_key(|&(j, _)| j);
        assert_eq!(made_of, [(0, 2.0), (1, -1.0)]);
        assert!(equalities.express(&[(0, 1.0)], &[true; 3]).is_none());
    }
}
