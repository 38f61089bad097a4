//! Active-set update for limits of a contact group that contradict each other when all are closed or stick: one closes
//! in the place of another ([`super::dependence`]), or slips as the others determine.

use std::collections::BTreeSet;

use super::active_equalities::ActiveEqualities;
use super::dependence::NO_SHARE;
use super::law::PointStatus;
use super::laws::{ContactLaws, Iterate, Statuses};
use crate::vector::largest;

/// Overshoot of a bound, relative to the largest jump and bound, that counts as zero.
const NO_OVERSHOOT: f64 = 1e-12;
/// Bisections of the range in which a point begins to slip.
const BISECTIONS: usize = 40;

/// Active-set update of a contact group.
struct IndependentLimits<'a> {
    laws: &'a ContactLaws<'a>,
    /// The forces of all limits as far as they have grown.
    forces: Vec<f64>,
    /// False for the independent limits that are closed or stick, true for all others.
    open: Vec<bool>,
    /// Overshoot of a bound that counts as zero (m).
    no_overshoot: f64,
}

impl ContactLaws<'_> {
    /// Makes contradicting limits that are to close or stick `now`, at an iterate, independent of each other; those
    /// closed or sticking `before` take precedence. A tangential limit whose slip the others determine slips.
    pub fn make_independent(&self, at: &Iterate, before: &Statuses, now: &mut Statuses) {
        if self.rows.is_empty() {
            return;
        }
        let known = self.known(now);
        let both = known.iter().zip(self.known(before));
        let mut open: Vec<bool> = both.map(|(now, before)| !(*now && before)).collect();
        self.rows.open_redundant(&mut open);
        let finite = at.jumps.iter().chain(self.bounds);
        let finite: Vec<f64> = finite.copied().filter(|x| x.is_finite()).collect();
        let mut limits = IndependentLimits {
            laws: self,
            forces: at.forces.clone(),
            open,
            no_overshoot: NO_OVERSHOOT * largest(&finite),
        };
        // Jumps outside of all rows are independent.
        let in_rows: BTreeSet<usize> = self.rows.iter().flatten().map(|(i, _)| *i).collect();
        let m = known.len() - self.rows.len();
        let sought = (0..known.len()).filter(|k| *k >= m || in_rows.contains(k));
        let (tangential, normal): (Vec<usize>, Vec<usize>) =
            sought.partition(|&k| self.is_tangential[k]);
        for k in normal.into_iter().chain(tangential) {
            if known[k] && limits.open[k] && self.known(now)[k] {
                limits.close(k, now);
            }
        }
    }
}

/// First status change under a growing force.
struct Blocking {
    /// Growth of the force up to the change.
    growth: f64,
    change: Change,
}

/// Change of status.
enum Change {
    /// Opening of a normal limit.
    Opens(usize),
    /// Slip of a point, with the shares of its limits in the force.
    Slips(usize, [f64; 2]),
}

impl IndependentLimits<'_> {
    /// Closes limit k, or lets it stick, and releases the limit that contradicts it.
    fn close(&mut self, k: usize, now: &mut Statuses) {
        let (laws, rows) = (self.laws, self.laws.rows);
        let equalities = ActiveEqualities::new(rows, &self.open);
        let Some(shares) = rows.shares_in(k, &self.open, &equalities) else {
            self.open[k] = false;
            return;
        };
        let violation = self.violation(k, &shares);
        if laws.is_tangential[k] {
            if violation != 0.0 {
                self.slip_of(k, now);
            }
            return;
        }
        if violation <= 0.0 {
            now.closed[k] &= violation == 0.0;
            return;
        }
        let opening = shares.iter().filter(|(i, _)| !laws.is_tangential[*i]);
        let opening = opening.filter(|(_, share)| *share > NO_SHARE);
        let opening = opening.map(|&(i, share)| Blocking {
            growth: self.forces[i].max(0.0) / share,
            change: Change::Opens(i),
        });
        let slipping = (0..laws.points.len()).filter_map(|p| self.slipping(p, &shares, now));
        let all = opening.chain(slipping);
        let Some(first) = all.min_by(|a, b| a.growth.total_cmp(&b.growth)) else {
            return;
        };
        for &(i, share) in &shares {
            self.forces[i] -= first.growth * share;
        }
        self.forces[k] += first.growth;
        self.open[k] = false;
        match first.change {
            Change::Opens(normal) => self.open(normal, now),
            Change::Slips(p, shares) => {
                let force = laws.points[p]
                    .tangents
                    .map(|t| t.map_or(0.0, |t| self.forces[t]));
                let size = shares[0].hypot(shares[1]);
                let direction = match force[0].hypot(force[1]) {
                    0.0 => shares.map(|share| -share / size),
                    force_size => force.map(|f| f / force_size),
                };
                self.slip(p, direction, violation / size, now);
            }
        }
    }

    /// Violation of the bound of limit k with the limits of its `shares` at theirs (m); 0 within round-off.
    fn violation(&self, k: usize, shares: &[(usize, f64)]) -> f64 {
        let way = shares.iter().map(|&(i, c)| c * self.laws.bounds[i]);
        let violation = way.sum::<f64>() - self.laws.bounds[k];
        let amplified: f64 = shares.iter().map(|(_, c)| c.abs()).sum();
        match violation.abs() <= self.no_overshoot * (1.0 + amplified) {
            true => 0.0,
            false => violation,
        }
    }

    /// Change of point p, if it sticks and slips as its limits lose these `shares` of a growing force.
    fn slipping(&self, p: usize, shares: &[(usize, f64)], now: &Statuses) -> Option<Blocking> {
        let point = &self.laws.points[p];
        let share = |i: usize| {
            shares
                .iter()
                .find(|(j, _)| *j == i)
                .map_or(0.0, |(_, c)| *c)
        };
        let own = point.tangents.map(|t| t.map_or(0.0, share));
        if own[0].hypot(own[1]) <= NO_SHARE {
            return None;
        }
        let force = point.tangents.map(|t| t.map_or(0.0, |t| self.forces[t]));
        let is_closed = point.is_closed(&now.closed);
        let bound = |normal: f64| point.bound.at(normal, is_closed);
        let pressure = point.normal.map_or(0.0, |n| self.forces[n]);
        let loss = point.normal.map_or(0.0, share);
        let slips = |growth: f64| {
            let left = [0, 1].map(|k| force[k] - growth * own[k]);
            left[0].hypot(left[1]) > bound(pressure - growth * loss)
        };
        // The force reaches its bound at the latest where all of the bound opposes the share.
        let size = own[0].hypot(own[1]);
        let mut range = [0.0, (bound(pressure) + force[0].hypot(force[1])) / size];
        while loss < 0.0 && !slips(range[1]) {
            range[1] *= 2.0;
            if !range[1].is_normal() {
                return None;
            }
        }
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (range[0] + range[1]);
            range[usize::from(slips(middle))] = middle;
        }
        Some(Blocking {
            growth: range[1],
            change: Change::Slips(p, own),
        })
    }

    /// Opens the normal limit i and the tangential limits that lose their friction.
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

    /// Lets the point of the tangential limit k slip as the other jumps determine.
    fn slip_of(&mut self, k: usize, now: &mut Statuses) {
        let rows = self.laws.rows;
        let mut points = self.laws.points.iter();
        let Some(p) = points.position(|point| point.limits().any(|t| t == k)) else {
            return;
        };
        let equalities = ActiveEqualities::new(rows, &self.open);
        let way = |t: usize| {
            let shares = rows.shares_in(t, &self.open, &equalities);
            shares.map_or(0.0, |shares| self.violation(t, &shares))
        };
        let slip = self.laws.points[p].tangents.map(|t| t.map_or(0.0, way));
        let size = slip[0].hypot(slip[1]);
        self.slip(p, slip.map(|s| s / size), size, now);
    }

    /// Lets point p slip by `way` (m) in a direction.
    fn slip(&mut self, p: usize, direction: [f64; 2], way: f64, now: &mut Statuses) {
        let point = &self.laws.points[p];
        let is_closed = point.is_closed(&now.closed);
        let pressure = point.normal.map_or(0.0, |n| self.forces[n]);
        now.points[p] = PointStatus::Slips {
            direction,
            turning: point.turning(point.bound.at(pressure, is_closed) / way),
        };
        point.limits().for_each(|t| self.open[t] = true);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::dependent::DependentConstraints;
    use crate::contact::friction::Status;
    use crate::contact::limits::{OtherTangent, TangentialLimit};
    use crate::contact::tangent::ForceBound;

    /// Contradicting limits: t_0 + t_1 ≤ −1 with t_0 ≤ 0 and t_1 ≤ 0, or with s_1 = 0 where the second jump is a slip.
    fn contradicting() -> (Vec<f64>, DependentConstraints) {
        let mut rows = DependentConstraints::default();
        rows.push(vec![(0, 1.0), (1, 1.0)]);
        (vec![0.0, 0.0, -1.0], rows)
    }

    /// Statuses after an update in which all limits are to close or stick, under these forces.
    fn exchanged(tangents: &[TangentialLimit], forces: [f64; 3]) -> Statuses {
        let (bounds, rows) = contradicting();
        let laws = ContactLaws::new(&bounds, &rows, tangents, vec![1.0; 3]);
        let at = Iterate {
            jumps: vec![0.0; 3],
            forces: forces.to_vec(),
        };
        let before = laws.begin(&[Status::Closed, Status::Closed, Status::Open], &at);
        let mut now = laws.begin(&[Status::Closed; 3], &at);
        laws.make_independent(&at, &before, &mut now);
        now
    }

    #[test]
    fn what_is_violated_closes_in_the_place_of_the_force_that_vanishes_first() {
        assert_eq!(exchanged(&[], [3.0, 1.0, 0.0]).closed, [true, false, true]);
        assert_eq!(exchanged(&[], [1.0, 3.0, 0.0]).closed, [false, true, true]);
    }

    #[test]
    fn what_sticks_slips_where_its_force_is_at_its_bound_first() {
        let bound = ForceBound {
            coefficient: 0.0,
            cohesion: 0.5,
            only_closed: false,
        };
        let tangent = TangentialLimit {
            limit: 1,
            normal: Some(0),
            bound,
            other: OtherTangent::Nothing,
        };
        let now = exchanged(&[tangent], [3.0, 0.2, 0.0]);
        assert!(now.closed[0] && now.closed[2]);
        let slips = PointStatus::Slips {
            direction: [-1.0, 0.0],
            turning: 0.0,
        };
        assert_eq!(now.points, [slips]);
        let now = exchanged(&[tangent], [0.1, 0.2, 0.0]);
        assert!(!now.closed[0] && now.closed[2]);
        assert_eq!(now.points, [PointStatus::Sticks]);
    }
}
