//! The path as it stands: jumps and forces where some quantity of every limit is 0, at θ = 0 and for every unit of θ.

use faer::Mat;
use faer::linalg::solvers::Solve;

use super::responses::{Responses, Terms};
use crate::contact::friction::{ATTEMPTS, FrictionProblem, Status, TangentialLimit};
use crate::vector::{axpy, largest};

/// The end of the path.
pub(in crate::contact::friction) struct End {
    pub status: Vec<Status>,
    /// The jumps there (m).
    pub jumps: Vec<f64>,
}

/// Force, relative to the largest, below which a bound that vanishes with it falls to 0, one attempt after the other:
/// where it is steep the path ends at the solution, but has further to go.
const STEEP: [f64; ATTEMPTS] = [1e-10, 1e-6, 1e-8];
/// How much closed rows that depend on each other give way.
const YIELD: f64 = 1e-8;
/// Stiffness of springs on all jumps, for motions that nothing resists.
const SPRING: f64 = 1e-10;
/// Force, relative to the largest where all is closed, that nothing exceeds: rows that give way would be far away.
const MOST_COHESION: f64 = 10.0;

/// What is 0 at a limit, or may not be negative there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Quantity {
    /// The gap, or the way back to where it sticks.
    Way,
    /// The normal force, with what θ adds.
    Force,
    /// What a tangential force lacks of the bound in the direction of its sign; the steep one of two or not.
    Bound { sign: f64, steep: bool },
    /// The slip in the direction of a sign.
    Slip(f64),
}

/// A tangential limit in the scale of energies.
#[derive(Clone, Copy, Debug, Default)]
struct Tangent {
    normal: Option<usize>,
    coefficient: f64,
    cohesion: f64,
    /// What θ adds to the bound.
    added: f64,
    /// How the bound falls to 0 where it does before the contact opens.
    steep: Option<f64>,
    /// Whether it vanishes where the contact is open.
    only_closed: bool,
    /// Whether it never holds anything.
    is_free: bool,
}

/// Where the path is: all in the scale of energies.
pub(super) struct Path {
    /// The jumps of all limits, then their forces, for a unit of what is 0 at each of the limits.
    responses: Responses,
    /// The same where all these are 0: at θ = 0, and for every unit of θ.
    value: [Vec<f64>; 2],
    /// Both for the ways of independent jumps and the forces of dependent rows, whatever θ is.
    start: Mat<f64>,
    at_start: Vec<f64>,
    /// Number of independent jumps.
    independent: usize,
    /// What is 0 at each.
    zero: Vec<Quantity>,
    bounds: Vec<f64>,
    /// What jumps are multiplied by in that scale.
    scale: Vec<f64>,
    /// What θ adds to normal forces.
    added: Vec<f64>,
    tangents: Vec<Option<Tangent>>,
    /// The tangential limits of each normal one that vanish with it.
    of_normal: Vec<Vec<usize>>,
}

/// Between half of one and one and a half, so that no two forces vanish at once.
fn spread(i: usize, attempt: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    0.5 + ((i + 1) as f64 * GOLDEN + attempt as f64 * 0.37).fract()
}

impl Path {
    /// Its beginning, where all is closed.
    pub(super) fn new(problem: &FrictionProblem<'_>, attempt: usize) -> Self {
        let contact = &problem.contact;
        let (m, count) = (contact.c.len(), contact.bounds.len());
        let scale = problem.scales();
        let bounds: Vec<f64> = (contact.bounds.iter().zip(&scale))
            .map(|(bound, scale)| bound * scale)
            .collect();
        let mut start = Mat::zeros(2 * count, count);
        let mut at_start = vec![0.0; 2 * count];
        at_start[..m].copy_from_slice(&bounds[..m]);
        for i in 0..m {
            let stiffness = |j: usize| contact.h[(i, j)] / (scale[i] * scale[j]);
            let held: f64 = (0..m).map(|j| stiffness(j) * bounds[j]).sum();
            at_start[count + i] = contact.c[i] / scale[i] - held;
            (0..m).for_each(|j| start[(count + i, j)] = stiffness(j));
            start[(count + i, i)] += SPRING;
            start[(i, i)] = -1.0;
        }
        let unit = largest(&at_start[count..]).max(f64::MIN_POSITIVE);
        for (k, row) in (m..).zip(contact.rows.iter()) {
            for &(i, c) in row {
                let c = c * scale[k] / scale[i];
                at_start[k] += c * bounds[i];
                start[(k, i)] -= c;
                start[(count + i, k)] -= c;
            }
            start[(k, k)] = -YIELD;
            start[(count + k, k)] = 1.0;
        }
        let mut path = Self {
            responses: Responses::new(Mat::new()),
            value: [Vec::new(), Vec::new()],
            start,
            at_start,
            independent: m,
            zero: vec![Quantity::Way; count],
            bounds,
            added: (0..count).map(|i| unit * spread(i, attempt)).collect(),
            tangents: vec![None; count],
            of_normal: vec![Vec::new(); count],
            scale,
        };
        for limit in problem.tangents {
            path.add(limit, unit, attempt);
        }
        path.refresh();
        path
    }

    fn add(&mut self, limit: &TangentialLimit, unit: f64, attempt: usize) {
        let scale = &self.scale;
        let (i, bound) = (limit.limit, limit.bound);
        let own = bound.scaled(limit.normal.map(|n| scale[n]), scale[i]);
        let coefficient = own.coefficient;
        let cohesion = match limit.normal {
            Some(_) => own.cohesion,
            None => own.at(0.0, false),
        }
        .min(MOST_COHESION * unit);
        let falls = bound.only_closed && cohesion > 0.0;
        let tangent = Tangent {
            normal: limit.normal,
            coefficient,
            cohesion,
            added: if cohesion > 0.0 { self.added[i] } else { 0.0 },
            steep: falls.then(|| coefficient + cohesion / (STEEP[attempt] * unit)),
            only_closed: bound.only_closed,
            is_free: cohesion == 0.0 && coefficient == 0.0,
        };
        self.added[i] = 0.0;
        self.tangents[i] = Some(tangent);
        if tangent.is_free {
            let (sign, steep) = (1.0, false);
            self.zero[i] = Quantity::Bound { sign, steep };
        } else if let (Some(n), true) = (limit.normal, bound.only_closed) {
            self.of_normal[n].push(i);
        }
    }

    /// A quantity as a sum of jumps and forces, and the rest of it.
    fn terms(&self, i: usize, quantity: Quantity) -> (Terms, [f64; 2]) {
        let count = self.bounds.len();
        let none = (i, 0.0);
        match quantity {
            Quantity::Way => ([(i, -1.0), none], [self.bounds[i], 0.0]),
            Quantity::Slip(sign) => ([(i, sign), none], [-sign * self.bounds[i], 0.0]),
            Quantity::Force => ([(count + i, 1.0), none], [0.0, self.added[i]]),
            Quantity::Bound { sign, steep } => {
                let tangent = self.tangents[i].unwrap_or_default();
                let (share, rest) = match (steep, tangent.steep) {
                    (true, Some(steep)) => (steep, [0.0; 2]),
                    _ => (tangent.coefficient, [tangent.cohesion, tangent.added]),
                };
                // Steep ones are of the size of the others.
                let size = share.max(1.0);
                let own = (count + i, -sign / size);
                match tangent.normal {
                    Some(n) => {
                        let rest = [rest[0], rest[1] + share * self.added[n]];
                        ([own, (count + n, share / size)], rest.map(|x| x / size))
                    }
                    None => ([own, none], rest),
                }
            }
        }
    }

    /// Its value at θ = 0, and how it grows with θ.
    pub(super) fn quantity(&self, i: usize, quantity: Quantity) -> [f64; 2] {
        let (terms, rest) = self.terms(i, quantity);
        let of = |k: usize| {
            rest[k]
                + terms
                    .iter()
                    .map(|&(j, c)| c * self.value[k][j])
                    .sum::<f64>()
        };
        [of(0), of(1)]
    }

    /// Computes responses and values anew from the start, without the round-off of pivots.
    pub(super) fn refresh(&mut self) {
        let count = self.bounds.len();
        self.value = [self.at_start.clone(), vec![0.0; 2 * count]];
        let is_given = |i: usize| i < self.independent && self.zero[i] == Quantity::Way;
        let unknown: Vec<usize> = (0..count).filter(|&i| !is_given(i)).collect();
        // For every quantity that is 0, and for both values.
        let mut change = Mat::zeros(unknown.len(), count + 2);
        let mut matrix = Mat::zeros(unknown.len(), unknown.len());
        for (k, &i) in unknown.iter().enumerate() {
            let (terms, _) = self.terms(i, self.zero[i]);
            let of = |j: usize| {
                terms
                    .iter()
                    .map(|&(t, c)| c * self.start[(t, j)])
                    .sum::<f64>()
            };
            (unknown.iter().enumerate()).for_each(|(l, &j)| matrix[(k, l)] = of(j));
            (0..count)
                .filter(|&j| is_given(j))
                .for_each(|j| change[(k, j)] = -of(j));
            change[(k, i)] = 1.0;
            let value = self.quantity(i, self.zero[i]);
            change[(k, count)] = -value[0];
            change[(k, count + 1)] = -value[1];
        }
        matrix.partial_piv_lu().solve_in_place(&mut change);
        let of_unknown = Mat::from_fn(2 * count, unknown.len(), |i, l| self.start[(i, unknown[l])]);
        let mut all = of_unknown * change;
        for (k, value) in self.value.iter_mut().enumerate() {
            axpy(1.0, all.col_as_slice(count + k), value);
        }
        for j in (0..count).filter(|&j| is_given(j)) {
            axpy(1.0, self.start.col_as_slice(j), all.col_as_slice_mut(j));
        }
        all.resize_with(2 * count, count, |_, _| 0.0);
        self.responses = Responses::new(all);
    }

    /// Makes another quantity of limit i 0.
    fn replace(&mut self, i: usize, quantity: Quantity) {
        let of_value = self.quantity(i, quantity);
        let (terms, _) = self.terms(i, quantity);
        let column = self.responses.pivot(i, terms);
        for (value, of_value) in self.value.iter_mut().zip(of_value) {
            axpy(-of_value, column, value);
        }
        self.zero[i] = quantity;
    }

    fn is_open(&self, normal: usize) -> bool {
        self.zero[normal] == Quantity::Force
    }

    /// What may not be negative at limit i.
    fn bounded(&self, i: usize) -> Vec<Quantity> {
        let Some(tangent) = self.tangents[i] else {
            return match self.is_open(i) {
                true => vec![Quantity::Way],
                false => vec![Quantity::Force],
            };
        };
        if tangent.is_free || tangent.only_closed && tangent.normal.is_some_and(|n| self.is_open(n))
        {
            return Vec::new();
        }
        let falls = tangent.steep.is_some();
        let mut bounded = match self.zero[i] {
            Quantity::Bound { sign, steep } => {
                let steep = !steep;
                vec![Quantity::Slip(sign), Quantity::Bound { sign, steep }]
            }
            _ => {
                let all = [(1.0, false), (-1.0, false), (1.0, true), (-1.0, true)];
                let bound = |(sign, steep)| Quantity::Bound { sign, steep };
                all.map(bound).to_vec()
            }
        };
        if !falls {
            bounded.truncate(bounded.len() / 2);
        }
        bounded
    }

    /// Where the path, on its `way` from `theta`, meets the next limit that isn't the one that it has just left.
    pub(super) fn next(
        &self,
        theta: f64,
        way: f64,
        left: Option<(usize, Quantity)>,
    ) -> Option<(f64, usize, Quantity)> {
        let mut nearest: Option<(f64, usize, Quantity)> = None;
        for i in 0..self.bounds.len() {
            for quantity in self.bounded(i) {
                let [value, slope] = self.quantity(i, quantity);
                if slope * way >= 0.0 || slope.is_nan() || left == Some((i, quantity)) {
                    continue;
                }
                // Round-off doesn't turn it back.
                let at = -value / slope;
                let at = if way > 0.0 {
                    at.max(theta)
                } else {
                    at.min(theta)
                };
                if nearest.is_none_or(|(nearest, _, _)| (at - nearest) * way < 0.0) {
                    nearest = Some((at, i, quantity));
                }
            }
        }
        nearest
    }

    /// Changes the status of limit i, one of whose quantities has become 0; what isn't any more.
    pub(super) fn pivot(&mut self, theta: f64, i: usize, quantity: Quantity) -> (usize, Quantity) {
        let was = self.zero[i];
        let at = |[value, slope]: [f64; 2]| value + theta * slope;
        // What vanishes with a normal force slips as it opens, and from where it closes towards its slip.
        if self.tangents[i].is_none() {
            for k in self.of_normal[i].clone() {
                let sense = match (quantity, self.zero[k]) {
                    (Quantity::Force, Quantity::Bound { sign, .. }) => sign,
                    (Quantity::Force, _) => at(self.quantity(k, Quantity::Force)),
                    _ => at(self.quantity(k, Quantity::Slip(1.0))),
                };
                let right = Quantity::Bound {
                    sign: sense.signum(),
                    steep: self.tangents[k].is_some_and(|tangent| tangent.steep.is_some()),
                };
                if self.zero[k] != right {
                    self.replace(k, right);
                }
            }
        }
        match quantity {
            Quantity::Slip(_) => self.replace(i, Quantity::Way),
            _ => self.replace(i, quantity),
        }
        match (was, quantity) {
            (Quantity::Way, Quantity::Bound { sign, .. }) => (i, Quantity::Slip(sign)),
            _ => (i, was),
        }
    }

    /// The statuses and jumps at θ = 0.
    pub(super) fn end(&self) -> End {
        let of_limit = |i: usize| match (self.tangents[i], self.zero[i]) {
            (
                Some(Tangent {
                    normal,
                    only_closed: true,
                    ..
                }),
                _,
            ) if normal.is_none_or(|n| self.is_open(n)) => Status::Open,
            (Some(tangent), _) if tangent.is_free => {
                Status::of_slip(self.quantity(i, Quantity::Slip(1.0))[0])
            }
            (Some(Tangent { steep: Some(_), .. }), Quantity::Bound { steep: true, .. }) => {
                Status::Parting
            }
            (_, Quantity::Bound { sign, .. }) => Status::of_slip(sign),
            (_, Quantity::Force) => Status::Open,
            _ => Status::Closed,
        };
        let jumps = self.value[0].iter().zip(&self.scale).take(self.independent);
        End {
            status: (0..self.bounds.len()).map(of_limit).collect(),
            jumps: jumps.map(|(jump, scale)| jump / scale).collect(),
        }
    }
}
