//! State of the path: jumps and forces with as many zero quantities as limits, at θ = 0 and for every unit of θ.

mod points;

use faer::Mat;

use super::polygon::{FrictionPolygon, Polygons, SlipPart};
use super::responses::{Responses, Terms};
use super::start::{Equation, Start};
use crate::contact::friction::{FrictionProblem, Status};
use crate::vector::{axpy, largest};

/// The end of the path.
pub(in crate::contact::friction) struct End {
    pub status: Vec<Status>,
    /// Jumps at the end (m).
    pub jumps: Vec<f64>,
    /// Forces of dependent rows at the end (N/m).
    pub of_rows: Vec<f64>,
    /// Directions of the forces of points that slip in space, in the scale of energies.
    pub directions: Vec<Option<[f64; 2]>>,
}

/// Non-negative quantity of a limit or a point, which may be 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Quantity {
    /// Gap of a limit, or its slip.
    Gap(usize),
    /// Normal force of a limit, with the part of θ.
    Force(usize),
    /// Missing part of the bound of a tangential force along the normal of a side; `steep` for the steep one of two
    /// bounds.
    Bound {
        point: usize,
        side: usize,
        steep: bool,
    },
    /// Component of the slip of a point.
    Slip { point: usize, part: SlipPart },
}

/// Position of a point's tangential force in its polygon.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// A position inside the polygon: the point sticks.
    Sticks,
    /// A position on a side of the polygon, with the steep bound or the other one.
    Side(usize, bool),
    /// A corner between two sides of the polygon, with the steep bound or the other one.
    Corner([usize; 2], bool),
}

/// State of the path, in the scale of energies.
pub(super) struct Path {
    /// Jumps of all limits, then their forces, for a unit of each zero quantity.
    responses: Responses,
    /// Jumps and forces with all zero quantities at 0: at θ = 0, and their growth with θ.
    value: [Vec<f64>; 2],
    /// The system from which pivots start.
    start: Start,
    /// Zero quantities: one for a normal limit, as many for a point as it has tangents.
    zero: Vec<Quantity>,
    bounds: Vec<f64>,
    /// Factors of jumps in the scale of energies.
    scale: Vec<f64>,
    /// Parts of normal forces in proportion to θ.
    added: Vec<f64>,
    points: Vec<FrictionPolygon>,
    /// Limits that aren't tangential.
    normals: Vec<usize>,
    /// Points of each normal limit whose friction vanishes with its force.
    of_normal: Vec<Vec<usize>>,
}

/// Number from 0.5 to 1.5 by which forces differ, so that no two vanish at once.
fn perturbation(i: usize, attempt: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    0.5 + ((i + 1) as f64 * GOLDEN + attempt as f64 * 0.37).fract()
}

impl Path {
    /// Start of the path, with all limits closed.
    pub(super) fn new(problem: &FrictionProblem<'_>, polygons: &Polygons) -> Self {
        let contact = &problem.contact;
        let count = contact.bounds.len();
        let scale = problem.scales();
        let bounds: Vec<f64> = (contact.bounds.iter().zip(&scale))
            .map(|(bound, scale)| bound * scale)
            .collect();
        let start = Start::new(problem, &scale, &bounds);
        let unit = largest(start.forces()).max(f64::MIN_POSITIVE);
        let mut path = Self {
            responses: Responses::new(Mat::new()),
            value: [Vec::new(), Vec::new()],
            start,
            zero: (0..count).map(Quantity::Gap).collect(),
            bounds,
            added: (0..count)
                .map(|i| unit * perturbation(i, polygons.attempt))
                .collect(),
            points: Vec::new(),
            normals: Vec::new(),
            of_normal: vec![Vec::new(); count],
            scale,
        };
        let mut is_tangential = vec![false; count];
        for limit in problem.tangents {
            is_tangential[limit.limit] = true;
            let added = [unit, path.added[limit.limit]];
            let next = (path.points.len(), polygons);
            let polygon = FrictionPolygon::new(limit, &path.scale, added, next);
            path.points.extend(polygon);
        }
        path.normals = (0..count).filter(|&i| !is_tangential[i]).collect();
        for (i, added) in path.added.iter_mut().enumerate() {
            *added = if is_tangential[i] { 0.0 } else { *added };
        }
        path.place_free_points();
        path.refresh();
        path
    }

    /// Makes bounds the zero quantities of frictionless points, and lists the points whose friction vanishes with a
    /// normal limit.
    fn place_free_points(&mut self) {
        for point in 0..self.points.len() {
            let polygon = self.points[point].clone();
            if polygon.is_free {
                for (side, limit) in polygon.limits().enumerate() {
                    self.zero[limit] = Quantity::Bound {
                        point,
                        side,
                        steep: false,
                    };
                }
            } else if let (Some(n), true) = (polygon.normal, polygon.only_closed) {
                self.of_normal[n].push(point);
            }
        }
    }

    /// Quantity as a combination of jumps and forces, and its remainder at θ = 0 and for a unit of θ.
    fn terms(&self, quantity: Quantity) -> (Terms, [f64; 2]) {
        let count = self.bounds.len();
        let none = (0, 0.0);
        match quantity {
            Quantity::Gap(i) => ([(i, -1.0), none, none], [self.bounds[i], 0.0]),
            Quantity::Force(i) => {
                let own = (count + i, 1.0);
                ([own, none, none], [0.0, self.added[i]])
            }
            Quantity::Slip { point, part } => {
                let polygon = &self.points[point];
                let direction = polygon.direction(part);
                let (mut terms, mut rest) = ([none; 3], 0.0);
                for (k, limit) in polygon.limits().enumerate() {
                    let share = direction[k] / polygon.weights[k];
                    terms[k] = (limit, share);
                    rest -= share * self.bounds[limit];
                }
                (terms, [rest, 0.0])
            }
            Quantity::Bound { point, side, steep } => {
                let polygon = &self.points[point];
                let (share, mut rest) = match (steep, polygon.steep) {
                    (true, Some(steep)) => (steep, [0.0; 2]),
                    _ => (polygon.coefficient, [polygon.cohesion, polygon.added]),
                };
                // Scales steep bounds to the size of the others.
                let size = share.max(1.0);
                let direction = polygon.normal_of(side);
                let mut terms = [none; 3];
                for (k, limit) in polygon.limits().enumerate() {
                    terms[k] = (count + limit, -direction[k] * polygon.weights[k] / size);
                }
                if let Some(n) = polygon.normal {
                    rest[1] += share * self.added[n];
                    terms[2] = (count + n, share / size);
                }
                (terms, rest.map(|x| x / size))
            }
        }
    }

    /// Value of a quantity at θ = 0, and its growth with θ.
    pub(super) fn quantity(&self, quantity: Quantity) -> [f64; 2] {
        let (terms, rest) = self.terms(quantity);
        let of = |k: usize| {
            let terms = terms.iter().map(|&(j, c)| c * self.value[k][j]);
            rest[k] + terms.sum::<f64>()
        };
        [of(0), of(1)]
    }

    /// Computes responses and values anew from the start, without the round-off of pivots.
    pub(super) fn refresh(&mut self) {
        self.value = self.start.values();
        let equation = |&zero: &Quantity| match zero {
            Quantity::Gap(i) if i < self.start.independent => Equation::Jump(i),
            _ => Equation::Combination(self.terms(zero).0, self.quantity(zero)),
        };
        let equations: Vec<Equation> = self.zero.iter().map(equation).collect();
        self.responses = Responses::new(self.start.solved(&equations, &mut self.value));
    }

    /// Replaces the k-th zero quantity.
    fn replace(&mut self, k: usize, quantity: Quantity) {
        let of_value = self.quantity(quantity);
        let (terms, _) = self.terms(quantity);
        let column = self.responses.pivot(k, terms);
        for (value, of_value) in self.value.iter_mut().zip(of_value) {
            axpy(-of_value, column, value);
        }
        self.zero[k] = quantity;
    }

    fn is_open(&self, normal: usize) -> bool {
        self.zero[normal] == Quantity::Force(normal)
    }

    /// True if the friction of a point has vanished with its contact.
    fn has_opened(&self, polygon: &FrictionPolygon) -> bool {
        polygon.only_closed && polygon.normal.is_some_and(|n| self.is_open(n))
    }

    /// The quantities that may not be negative.
    fn bounded(&self) -> Vec<Quantity> {
        let of_normal = |&i: &usize| match self.is_open(i) {
            true => Quantity::Gap(i),
            false => Quantity::Force(i),
        };
        let mut bounded: Vec<Quantity> = self.normals.iter().map(of_normal).collect();
        (0..self.points.len()).for_each(|point| bounded.extend(self.bounded_at(point)));
        bounded
    }

    /// The next θ from `theta` in the direction `sense` at which a quantity other than the one just left becomes 0, and
    /// that quantity.
    pub(super) fn next(
        &self,
        theta: f64,
        sense: f64,
        left: Option<Quantity>,
    ) -> Option<(f64, Quantity)> {
        let mut nearest: Option<(f64, Quantity)> = None;
        for quantity in self.bounded() {
            let [value, slope] = self.quantity(quantity);
            if slope * sense >= 0.0 || slope.is_nan() || left == Some(quantity) {
                continue;
            }
            // Round-off mustn't reverse the direction.
            let at = -value / slope;
            let at = if sense > 0.0 {
                at.max(theta)
            } else {
                at.min(theta)
            };
            if nearest.is_none_or(|(nearest, _)| (at - nearest) * sense < 0.0) {
                nearest = Some((at, quantity));
            }
        }
        nearest
    }

    /// Changes a status at a `quantity` that has become 0; returns the one that is free now.
    pub(super) fn pivot(&mut self, theta: f64, quantity: Quantity) -> Quantity {
        match quantity {
            Quantity::Gap(n) | Quantity::Force(n) => {
                let was = self.zero[n];
                for point in self.of_normal[n].clone() {
                    self.turn(theta, point, quantity);
                }
                self.replace(n, quantity);
                was
            }
            Quantity::Bound { point, side, steep } => self.reach(point, side, steep),
            Quantity::Slip { point, part } => self.leave(point, part),
        }
    }

    /// The statuses, jumps and forces at θ = 0.
    pub(super) fn end(&self) -> End {
        let of_normal = |i: usize| Status::new(self.is_open(i));
        let mut status: Vec<Status> = (0..self.bounds.len()).map(of_normal).collect();
        let mut directions = Vec::with_capacity(self.points.len());
        for (point, polygon) in self.points.iter().enumerate() {
            let slips = |side: usize| match polygon.is_line() {
                true => Status::of_slip(polygon.normal_of(side)[0]),
                false => Status::Slipping,
            };
            let own = match self.place(point) {
                _ if self.has_opened(polygon) => Status::Open,
                Place::Sticks => Status::Closed,
                Place::Side(side, _) if polygon.is_line() && polygon.is_free => {
                    let part = SlipPart::Along(side);
                    Status::of_slip(self.quantity(Quantity::Slip { point, part })[0])
                }
                Place::Side(_, true) | Place::Corner(_, true) => Status::Parting,
                Place::Side(side, false) | Place::Corner([side, _], false) => slips(side),
            };
            polygon.limits().for_each(|i| status[i] = own);
            let slips = matches!(own, Status::Slipping | Status::Parting) && !polygon.is_line();
            directions.push(slips.then(|| self.force_at(0.0, point)));
        }
        let (m, count) = (self.start.independent, self.bounds.len());
        let jumps = self.value[0].iter().zip(&self.scale).take(m);
        let of_rows = self.value[0][count + m..].iter().zip(&self.scale[m..]);
        End {
            status,
            jumps: jumps.map(|(jump, scale)| jump / scale).collect(),
            of_rows: of_rows.map(|(force, scale)| force * scale).collect(),
            directions,
        }
    }
}
