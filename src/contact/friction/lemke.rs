//! Lemke's method on jumps and forces: a path to a solution from a problem with a known one.
//!
//! With θ p added to every normal force and θ b to every given bound, all limits are closed and stick for large θ. From
//! there θ decreases. Wherever a force or a jump reaches its limit, one status changes, and θ continues in the
//! direction, up or down, in which the previous quantity leaves its limit: a piecewise linear path that never returns.
//! No piece is endless: along an endless one jumps x would have xᵀ H x ≤ 0. So the path reaches θ = 0 whatever the
//! coefficients of friction, except for round-off and for loads along motions without resistance.
//!
//! A. Klarbring, J.-S. Pang, *Existence of solutions to discrete semicoercive frictional contact problems*, SIAM J.
//! Optim. 8 (1998).
//!
//! In space a polyhedral cone replaces the friction cone, and the end of the path is near the solution: the nearer, the
//! finer its polygons are in the direction of slip. Turning slips pass every side of fine ones, so paths begin with
//! few.
//!
//! Closed rows that depend on each other get a small compliance. A bound that vanishes as the contact opens, c + μ λ,
//! falls steeply to 0 with the last of the force: a point that ends there is about to open.

mod path;
mod polygon;
mod responses;
mod start;

use self::path::{End, Path};
use self::polygon::{ATTEMPTS, Polygons};
use super::FrictionProblem;
use crate::contact::open_factor::scale_of;
use crate::contact::tangent::{OtherTangent, TangentialLimit};

/// Refinements of the polygons in each attempt; those with few sides at first have some.
const FINER: [usize; ATTEMPTS] = [3, 0, 3, 0];
/// Maximum number of limits on a path: its matrix is dense.
const MOST_LIMITS: usize = 3000;
/// Pivots between two refactorizations, except in large problems: their round-off grows.
const MOST_UPDATES: usize = 20;
/// Maximum number of pivots: the constant part, and that for each limit.
const EXCHANGES: usize = 2000;
const EXCHANGES_EACH: usize = 8;
/// Maximum number of pivots in a row at one θ: round-off makes them cycle.
const STANDS_STILL: usize = 100;

impl FrictionProblem<'_> {
    /// End of the path with these friction `polygons`, and the number of pivots; `None` where the path fails. Every
    /// attempt takes another path.
    fn follow(&self, polygons: &Polygons) -> (Option<End>, usize) {
        let is_prescribed =
            |tangent: &TangentialLimit| matches!(tangent.other, OtherTangent::Prescribed(_));
        if self.contact.bounds.len() > MOST_LIMITS || self.tangents.iter().any(is_prescribed) {
            return (None, 0);
        }
        let mut path = Path::new(self, polygons);
        let most = EXCHANGES + EXCHANGES_EACH * self.contact.bounds.len();
        let (mut theta, mut sense) = (f64::INFINITY, -1.0);
        let (mut entered, mut still) = (None, 0);
        let often = (self.contact.bounds.len() / 2).max(MOST_UPDATES);
        for pivots in 0..most {
            if pivots % often == often - 1 {
                path.refresh();
            }
            if let Some(quantity) = entered {
                sense = path.quantity(quantity)[1].signum();
            }
            match path.next(theta, sense, entered) {
                Some((at, _)) if at <= 0.0 => return (Some(path.end()), pivots),
                None if sense < 0.0 => return (Some(path.end()), pivots),
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

    /// Offers ends of at most so many paths, with their numbers of pivots, until a solution is found from one: in space
    /// some attempts refine the polygons in the slip directions of the path before.
    pub(super) fn try_paths<T>(
        &self,
        most: usize,
        mut take: impl FnMut(Option<&End>, usize) -> Option<T>,
    ) -> Option<T> {
        let mut paths = 0;
        for (attempt, finer) in FINER.into_iter().enumerate() {
            let mut polygons = Polygons::new(attempt);
            for _ in 0..=finer {
                if paths == most {
                    return None;
                }
                paths += 1;
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

    /// Factors that scale all limits' jumps to energies; forces are divided by them.
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
