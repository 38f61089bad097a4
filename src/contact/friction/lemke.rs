//! The way to a solution from a problem whose solution is known: Lemke's method, on jumps and forces.
//!
//! With θ p more on every normal force and θ b more on every given bound, all is closed and sticks where θ is large.
//! From there θ goes down. Wherever a force or a jump reaches its limit, one status changes, and θ goes on in the
//! direction, up or down, in which what was at its limit before moves away from it: a path of straight pieces that
//! never comes back. No piece is endless: along one that is, jumps x would have xᵀ H x ≤ 0. So it gets to θ = 0,
//! whatever the coefficients of friction, but for round-off; and where motions that nothing resists are driven.
//!
//! A. Klarbring, J.-S. Pang, *Existence of solutions to discrete semicoercive frictional contact problems*, SIAM J.
//! Optim. 8 (1998).
//!
//! In space friction has a polygon in the place of the disc, and the end of the path is near the solution: the nearer, the
//! finer polygons are where points slip. Slips that turn go from side to side of fine ones, so paths begin with few sides.
//!
//! Closed rows that depend on each other give way a little. A bound that vanishes as the contact opens, c + μ λ, falls
//! steeply to 0 with the last of the force: what ends there is about to open.

mod path;
mod polygon;
mod responses;

use self::path::{End, Path};
use self::polygon::{ATTEMPTS, Polygons};
use super::FrictionProblem;
use crate::contact::open_factor::scale_of;
use crate::contact::tangent::{Beside, TangentialLimit};

/// Refinements of the polygons in each attempt: where they have few sides at first.
const FINER: [usize; ATTEMPTS] = [3, 0, 3, 0];
/// Limits up to which the path is followed: its matrix is dense.
const MOST_LIMITS: usize = 3000;
/// Pivots between which its round-off may grow, but for that of large problems.
const MOST_UPDATES: usize = 20;
/// Pivots, whatever the problem and for each limit.
const EXCHANGES: usize = 2000;
const EXCHANGES_EACH: usize = 8;
/// Pivots in a row at one θ: round-off goes round in circles there.
const STANDS_STILL: usize = 100;

impl FrictionProblem<'_> {
    /// The end of the path with these `polygons` of friction, and the pivots that it took; `None` where it doesn't get
    /// there. Every attempt goes another way.
    fn follow(&self, polygons: &Polygons) -> (Option<End>, usize) {
        let is_prescribed =
            |tangent: &TangentialLimit| matches!(tangent.beside, Beside::Prescribed(_));
        if self.contact.bounds.len() > MOST_LIMITS || self.tangents.iter().any(is_prescribed) {
            return (None, 0);
        }
        let mut path = Path::new(self, polygons);
        let most = EXCHANGES + EXCHANGES_EACH * self.contact.bounds.len();
        let (mut theta, mut way) = (f64::INFINITY, -1.0);
        let (mut entered, mut still) = (None, 0);
        let often = (self.contact.bounds.len() / 2).max(MOST_UPDATES);
        for pivots in 0..most {
            if pivots % often == often - 1 {
                path.refresh();
            }
            if let Some(quantity) = entered {
                way = path.quantity(quantity)[1].signum();
            }
            match path.next(theta, way, entered) {
                Some((at, _)) if at <= 0.0 => return (Some(path.end()), pivots),
                None if way < 0.0 => return (Some(path.end()), pivots),
                Some((at, quantity)) => {
                    still = if at == theta { still + 1 } else { 0 };
                    if still > STANDS_STILL {
                        return (None, pivots);
                    }
                    theta = at;
                    entered = Some(path.pivot(theta, quantity));
                }
                None => return (None, pivots),
            }
        }
        (None, most)
    }

    /// Offers the ends of paths, with the pivots that each took, until one of them is taken as the beginning of a solution:
    /// in space some attempts go on with polygons that are finer where points slip in the path before.
    pub(super) fn try_paths<T>(
        &self,
        mut take: impl FnMut(Option<&End>, usize) -> Option<T>,
    ) -> Option<T> {
        for (attempt, finer) in FINER.into_iter().enumerate() {
            let mut polygons = Polygons::new(attempt);
            for _ in 0..=finer {
                let (end, pivots) = self.follow(&polygons);
                if let Some(taken) = take(end.as_ref(), pivots) {
                    return Some(taken);
                }
                let Some(finer) = end.and_then(|end| polygons.finer(end.directions)) else {
                    break;
                };
                polygons = finer;
            }
        }
        None
    }

    /// The factors of all limits' jumps in the scale of energies; forces are divided by them.
    fn scales(&self) -> Vec<f64> {
        let gap = &self.contact;
        let of_jump = |j: usize| scale_of(gap.h[(j, j)], gap.diagonal[j]).sqrt();
        let jumps = (0..gap.c.len()).map(of_jump);
        let of_row = |row: &[(usize, f64)]| {
            let squares = row.iter().map(|&(i, c)| (c / of_jump(i)).powi(2));
            1.0 / squares.sum::<f64>().sqrt()
        };
        jumps.chain(gap.rows.iter().map(of_row)).collect()
    }
}
