//! Points on the path: zero quantities of a point that sticks, slips along a side or at a corner of its polygon, or
//! opens.

use super::{Path, Place, Quantity};
use crate::contact::friction::lemke::polygon::SlipPart;

impl Path {
    /// Position of a point's tangential force in its polygon.
    pub(super) fn place(&self, point: usize) -> Place {
        let mut sides = Vec::new();
        for k in self.points[point].limits() {
            if let Quantity::Bound { side, steep, .. } = self.zero[k] {
                sides.push((side, steep));
            }
        }
        match sides[..] {
            [(side, steep)] => Place::Side(side, steep),
            [(a, steep), (b, _)] => Place::Corner([a, b], steep),
            _ => Place::Sticks,
        }
    }

    /// Non-negative quantities of a point.
    pub(super) fn bounded_at(&self, point: usize) -> Vec<Quantity> {
        let polygon = &self.points[point];
        let mut bounded = Vec::new();
        if polygon.is_free || self.has_opened(polygon) {
            return bounded;
        }
        let falls = polygon.steep.is_some();
        let bound = |side, steep| Quantity::Bound { point, side, steep };
        let slip = |part| Quantity::Slip { point, part };
        match self.place(point) {
            Place::Sticks => {
                bounded.extend(polygon.sides().map(|side| bound(side, false)));
                let steep = polygon.sides().filter(|_| falls);
                bounded.extend(steep.map(|side| bound(side, true)));
            }
            Place::Side(side, steep) => {
                bounded.push(slip(SlipPart::Along(side)));
                bounded.extend(falls.then(|| bound(side, !steep)));
                let beside = polygon.neighbours(side).into_iter();
                let beside = beside.filter(|_| !polygon.is_line());
                bounded.extend(beside.map(|side| bound(side, steep)));
            }
            Place::Corner([a, b], steep) => {
                bounded.push(slip(SlipPart::Beside(a, b)));
                bounded.push(slip(SlipPart::Beside(b, a)));
                bounded.extend(falls.then(|| bound(a, !steep)));
            }
        }
        bounded
    }

    /// Makes exactly these quantities of a point 0.
    fn arrange(&mut self, point: usize, wanted: &[Quantity]) {
        let polygon = self.points[point].clone();
        for &quantity in wanted {
            if polygon.limits().any(|k| self.zero[k] == quantity) {
                continue;
            }
            let (terms, _) = self.terms(quantity);
            let free = polygon
                .limits()
                .filter(|&k| !wanted.contains(&self.zero[k]));
            let pivots = free.map(|k| (k, self.responses.share(k, &terms).abs()));
            if let Some((k, _)) = pivots.max_by(|a, b| a.1.total_cmp(&b.1)) {
                self.replace(k, quantity);
            }
        }
    }

    /// Changes the status of a point whose friction vanishes with a normal force: it slips as it opens, and on closing
    /// continues in the direction of its slip.
    pub(super) fn turn(&mut self, theta: f64, point: usize, quantity: Quantity) {
        let polygon = self.points[point].clone();
        let sides = match (quantity, self.place(point)) {
            (Quantity::Force(_), Place::Corner(sides, _)) => sides.to_vec(),
            (Quantity::Force(_), Place::Side(side, _)) if polygon.is_line() => vec![side],
            (Quantity::Force(_), _) => polygon.sides_towards(self.force_at(theta, point)),
            _ => polygon.sides_towards(self.vector(theta, point, |k, limit| {
                (limit, 1.0 / polygon.weights[k], self.bounds[limit])
            })),
        };
        let steep = polygon.steep.is_some();
        let bound = |side| Quantity::Bound { point, side, steep };
        let wanted: Vec<Quantity> = sides.into_iter().map(bound).collect();
        self.arrange(point, &wanted);
    }

    /// Tangential force of a point at θ.
    pub(super) fn force_at(&self, theta: f64, point: usize) -> [f64; 2] {
        let (count, weights) = (self.bounds.len(), self.points[point].weights);
        self.vector(theta, point, |k, limit| (count + limit, weights[k], 0.0))
    }

    /// Force or slip of a point at θ, from the index, factor and offset of its k-th limit's jump or force.
    fn vector(
        &self,
        theta: f64,
        point: usize,
        of: impl Fn(usize, usize) -> (usize, f64, f64),
    ) -> [f64; 2] {
        let mut vector = [0.0; 2];
        for (k, limit) in self.points[point].limits().enumerate() {
            let (j, factor, bound) = of(k, limit);
            vector[k] = factor * (self.value[0][j] + theta * self.value[1][j] - bound);
        }
        vector
    }

    /// Moves the force of a point onto another side, or onto the same one by its other bound.
    pub(super) fn reach(&mut self, point: usize, side: usize, steep: bool) -> Quantity {
        let bound = |side, steep| Quantity::Bound { point, side, steep };
        let slip = |part| Quantity::Slip { point, part };
        let across = (!self.points[point].is_line()).then(|| slip(SlipPart::Across(side)));
        let on_side: Vec<Quantity> = [bound(side, steep)].into_iter().chain(across).collect();
        let (wanted, left) = match self.place(point) {
            Place::Sticks => (on_side, slip(SlipPart::Along(side))),
            Place::Side(was, _) if was == side => (on_side, bound(side, !steep)),
            Place::Side(was, _) => {
                let left = slip(SlipPart::Beside(side, was));
                (vec![bound(was, steep), bound(side, steep)], left)
            }
            Place::Corner(sides, _) => {
                let wanted = sides.map(|side| bound(side, steep)).to_vec();
                (wanted, bound(side, !steep))
            }
        };
        self.arrange(point, &wanted);
        left
    }

    /// Takes the force of a point off the side along whose normal it doesn't slip any more.
    pub(super) fn leave(&mut self, point: usize, part: SlipPart) -> Quantity {
        let steep = match self.place(point) {
            Place::Side(_, steep) | Place::Corner(_, steep) => steep,
            Place::Sticks => false,
        };
        let bound = |side| Quantity::Bound { point, side, steep };
        let (side, wanted) = match part {
            SlipPart::Beside(side, other) => {
                let part = SlipPart::Across(other);
                (side, vec![bound(other), Quantity::Slip { point, part }])
            }
            SlipPart::Along(side) | SlipPart::Across(side) => {
                let limits = self.points[point].limits();
                (side, limits.map(Quantity::Gap).collect())
            }
        };
        self.arrange(point, &wanted);
        bound(side)
    }
}
