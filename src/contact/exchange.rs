//! Exchange of limits of a contact group that contradict each other where they are closed, or stick, all at once: one
//! closes in the place of another ([`super::dependence`]), or slips as others make it.

use super::active_equalities::ActiveEqualities;
use super::dependence::NO_SHARE;
use super::law::PointStatus;
use super::laws::{ContactLaws, Iterate, Statuses};
use crate::vector::largest;

/// Way beyond a bound, relative to the largest jump and bound, that is none.
const NO_WAY: f64 = 1e-12;

/// An exchange of limits of a group.
struct Exchange<'a> {
    laws: &'a ContactLaws<'a>,
    /// The forces of all limits as far as they have grown.
    forces: Vec<f64>,
    /// Which limits aren't among those that are closed, or stick, and depend on none of the others.
    open: Vec<bool>,
    /// Way beyond a bound that is none (m).
    no_way: f64,
}

impl ContactLaws<'_> {
    /// Makes limits that are to be closed or stick `now`, at an iterate, independent of each other where they contradict each
    /// other; those that were so `before` are first. A tangential limit that others make slip slips.
    pub fn exchange(&self, at: &Iterate, before: &Statuses, now: &mut Statuses) {
        if self.rows.is_empty() {
            return;
        }
        let known = self.known(now);
        let both = known.iter().zip(self.known(before));
        let mut open: Vec<bool> = both.map(|(now, before)| !(*now && before)).collect();
        self.rows.open_redundant(&mut open);
        let finite = at.jumps.iter().chain(self.bounds);
        let finite: Vec<f64> = finite.copied().filter(|x| x.is_finite()).collect();
        let mut exchange = Exchange {
            laws: self,
            forces: at.forces.clone(),
            open,
            no_way: NO_WAY * largest(&finite),
        };
        let (tangential, normal): (Vec<usize>, Vec<usize>) =
            (0..known.len()).partition(|&k| self.is_tangential[k]);
        for k in normal.into_iter().chain(tangential) {
            if known[k] && exchange.open[k] && self.known(now)[k] {
                exchange.close(k, now);
            }
        }
    }
}

impl Exchange<'_> {
    /// Closes limit k, or lets it stick, in exchange for what contradicts that.
    fn close(&mut self, k: usize, now: &mut Statuses) {
        let (laws, rows) = (self.laws, self.laws.rows);
        let equalities = ActiveEqualities::new(rows, &self.open);
        let Some(shares) = rows.shares_in(k, &self.open, &equalities) else {
            self.open[k] = false;
            return;
        };
        let way: f64 = shares.iter().map(|&(i, c)| c * laws.bounds[i]).sum();
        let beyond = way - laws.bounds[k];
        let amplified: f64 = shares.iter().map(|(_, c)| c.abs()).sum();
        let no_way = self.no_way * (1.0 + amplified);
        if laws.is_tangential[k] {
            if beyond.abs() > no_way {
                self.slip(k, beyond.signum(), now);
            }
            return;
        }
        if beyond <= no_way {
            now.closed[k] &= beyond >= -no_way;
            return;
        }
        let room = shares.iter().filter_map(|&(i, share)| {
            let room = self.room(i, share, now)?;
            Some((i, share, room))
        });
        let Some((blocking, share, growth)) = room.min_by(|(.., a), (.., b)| a.total_cmp(b)) else {
            return;
        };
        for &(i, share) in &shares {
            self.forces[i] -= growth * share;
        }
        self.forces[k] += growth;
        self.open[k] = false;
        match laws.is_tangential[blocking] {
            true => self.slip(blocking, -share.signum(), now),
            false => self.open(blocking, now),
        }
    }

    /// How far a force may grow of which limit i loses so large a `share`, until it opens or slips.
    fn room(&self, i: usize, share: f64, now: &Statuses) -> Option<f64> {
        if !self.laws.is_tangential[i] {
            return (share > NO_SHARE).then(|| self.forces[i].max(0.0) / share);
        }
        let mut points = self.laws.points.iter();
        let point = points.find(|point| point.limits().any(|t| t == i))?;
        let is_closed = point.is_closed(&now.closed);
        let bound = point
            .bound
            .at(point.normal.map_or(0.0, |n| self.forces[n]), is_closed);
        let left = bound + share.signum() * self.forces[i];
        (share.abs() > NO_SHARE).then(|| left.max(0.0) / share.abs())
    }

    /// Opens the normal limit i, and what has no friction then.
    fn open(&mut self, i: usize, now: &mut Statuses) {
        self.open[i] = true;
        now.closed[i] = false;
        for (point, status) in self.laws.points.iter().zip(&mut now.points) {
            if point.normal == Some(i) && point.has_opened(&now.closed) {
                *status = PointStatus::Open;
                point.limits().for_each(|t| self.open[t] = true);
            }
        }
    }

    /// Lets the point of the tangential limit i slip along it, ahead or back.
    fn slip(&mut self, i: usize, sign: f64, now: &mut Statuses) {
        for (point, status) in self.laws.points.iter().zip(&mut now.points) {
            if let Some(k) = point.tangents.iter().position(|t| *t == Some(i)) {
                let mut direction = [0.0; 2];
                direction[k] = sign;
                *status = PointStatus::Slips {
                    direction,
                    turning: point.turning(point.stiffness),
                };
                point.limits().for_each(|t| self.open[t] = true);
            }
        }
    }
}
