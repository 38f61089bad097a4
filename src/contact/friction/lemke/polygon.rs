//! Polygonal friction cone of a point on the path: dᵀ λ_t ≤ b for the normals d of its sides instead of |λ_t| ≤ b;
//! along one tangent both are the same.
//!
//! D. E. Stewart, J. C. Trinkle, *An implicit time-stepping scheme for rigid body dynamics with inelastic collisions and
//! Coulomb friction*, Int. J. Numer. Methods Engrg 39 (1996).

use std::f64::consts::TAU;
use std::rc::Rc;

use crate::contact::tangent::TangentialLimit;

/// Number of attempts, each on another path.
pub(super) const ATTEMPTS: usize = 4;
/// Cohesion over the normal force below which a vanishing bound falls to 0, for every attempt: a steep one ends at the
/// solution, but its path is longer.
const STEEP: [f64; ATTEMPTS] = [1e2, 1e4, 1e3, 1e6];
/// Number of sides in space before refinement, for every attempt.
const SIDES: [usize; ATTEMPTS] = [16, 96, 24, 48];
/// Rotation of the first side, as part of the angle of a side: keeps normals off the axes.
const FIRST_ANGLE: [f64; ATTEMPTS] = [0.27, 0.41, 0.63, 0.21];
/// Number of fine sides on either side of a refined direction.
const BESIDE: usize = 6;
const REST: usize = 14;
/// Half of the refined angle, over the previous angle between sides.
const FINE: f64 = 1.5;
/// Most cohesion, relative to the largest force with all limits closed: compliant rows would move far otherwise.
const MOST_COHESION: f64 = 10.0;

/// The friction of a point, in the scale of energies of its first tangent.
#[derive(Clone, Debug)]
pub(super) struct FrictionPolygon {
    /// The limit of its normal jump.
    pub normal: Option<usize>,
    /// The limits of its tangential jumps.
    pub tangents: [Option<usize>; 2],
    /// Factors of the forces of both limits in that scale; slips are divided by them.
    pub weights: [f64; 2],
    /// The coefficient of friction.
    pub coefficient: f64,
    /// The bound without normal force.
    pub cohesion: f64,
    /// Part of the bound in proportion to θ.
    pub added: f64,
    /// Slope of the bound to 0 just before the contact opens, where it vanishes then.
    pub steep: Option<f64>,
    /// True if the bound vanishes where the contact is open.
    pub only_closed: bool,
    /// True if there is no friction.
    pub is_free: bool,
    /// The normals d of its sides.
    normals: Rc<[[f64; 2]]>,
}

/// The polygons of all points.
#[derive(Clone, Debug)]
pub(super) struct Polygons {
    /// Number of the attempt.
    pub attempt: usize,
    /// Refined directions in space, in the order of points; none at first.
    directions: Vec<Option<[f64; 2]>>,
    /// Angle between sides near the refined directions.
    angle: f64,
    line: Rc<[[f64; 2]]>,
    /// Normals of equal sides in space.
    equal: Rc<[[f64; 2]]>,
}

impl Polygons {
    /// Polygons at the start of an attempt.
    pub(super) fn new(attempt: usize) -> Self {
        let angle = TAU / SIDES[attempt] as f64;
        let equal =
            (0..SIDES[attempt]).map(|side| unit((side as f64 + FIRST_ANGLE[attempt]) * angle));
        Self {
            attempt,
            directions: Vec::new(),
            angle,
            line: Rc::new([[1.0, 0.0], [-1.0, 0.0]]),
            equal: equal.collect(),
        }
    }

    /// Polygons refined near the `directions` of slipping points; `None` where none slips in space.
    pub(super) fn finer(&self, directions: Vec<Option<[f64; 2]>>) -> Option<Self> {
        directions.iter().any(Option::is_some).then(|| Self {
            directions,
            angle: FINE * self.angle / BESIDE as f64,
            ..self.clone()
        })
    }

    /// Normals of the sides of a point, on a line or in space.
    fn normals(&self, point: usize, in_space: bool) -> Rc<[[f64; 2]]> {
        match self.directions.get(point) {
            _ if !in_space => Rc::clone(&self.line),
            Some(&Some([x, y])) => {
                let (middle, beside) = (y.atan2(x), BESIDE as f64);
                let turned = FIRST_ANGLE[self.attempt];
                let fine = (0..2 * BESIDE + 1).map(|k| self.angle * (k as f64 - beside + turned));
                let half = self.angle * beside;
                let rest = (1..=REST).map(|k| {
                    let part = k as f64 / (REST + 1) as f64;
                    self.angle * turned + half + part * (TAU - 2.0 * half)
                });
                fine.chain(rest).map(|angle| unit(middle + angle)).collect()
            }
            _ => Rc::clone(&self.equal),
        }
    }
}

fn unit(angle: f64) -> [f64; 2] {
    [angle.cos(), angle.sin()]
}

/// Component of a slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SlipPart {
    /// Along the normal of a side.
    Along(usize),
    /// Across the normal of a side.
    Across(usize),
    /// Along the normal of a side, in the basis of two.
    Beside(usize, usize),
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

impl FrictionPolygon {
    /// Polygon of the next `point` with this first tangential limit; `None` for the second one. `unit` is the largest
    /// force with all limits closed, `added` the part of θ in a given bound.
    pub(super) fn new(
        limit: &TangentialLimit,
        scale: &[f64],
        [unit, added]: [f64; 2],
        (point, polygons): (usize, &Polygons),
    ) -> Option<Self> {
        let (tangents, _) = limit.of_point()?;
        let (own, bound) = (scale[limit.limit], limit.bound);
        let scaled = bound.scaled(limit.normal.map(|n| scale[n]), own);
        let coefficient = scaled.coefficient;
        let cohesion = match limit.normal {
            Some(_) => scaled.cohesion,
            None => scaled.at(0.0, false),
        }
        .min(MOST_COHESION * unit);
        let falls = bound.only_closed && cohesion > 0.0;
        Some(Self {
            normal: limit.normal,
            tangents,
            weights: tangents.map(|i| i.map_or(1.0, |i| scale[i] / own)),
            coefficient,
            cohesion,
            added: if cohesion > 0.0 { added } else { 0.0 },
            steep: falls.then(|| coefficient + STEEP[polygons.attempt]),
            only_closed: bound.only_closed,
            is_free: cohesion == 0.0 && coefficient == 0.0,
            normals: polygons.normals(point, tangents[1].is_some()),
        })
    }

    /// Tangential limits of the polygon.
    pub(super) fn limits(&self) -> impl Iterator<Item = usize> + use<> {
        self.tangents.into_iter().flatten()
    }

    /// True for a single tangent.
    pub(super) fn is_line(&self) -> bool {
        self.tangents[1].is_none()
    }

    /// Numbers of the polygon's sides.
    pub(super) fn sides(&self) -> std::ops::Range<usize> {
        0..self.normals.len()
    }

    /// The two neighbours of a side.
    pub(super) fn neighbours(&self, side: usize) -> [usize; 2] {
        let sides = self.normals.len();
        [sides - 1, 1].map(|step| (side + step) % sides)
    }

    /// The normal d of a side.
    pub(super) fn normal_of(&self, side: usize) -> [f64; 2] {
        self.normals[side]
    }

    /// Sides between whose normals a vector lies; on a line the one in its direction.
    pub(super) fn sides_towards(&self, v: [f64; 2]) -> Vec<usize> {
        if self.is_line() {
            return vec![usize::from(v[0] < 0.0)];
        }
        let after = |side: usize| (side + 1) % self.normals.len();
        let is_between = |side: &usize| {
            let [own, next] = [*side, after(*side)].map(|side| self.normals[side]);
            cross(own, v) >= 0.0 && cross(v, next) > 0.0
        };
        let side = self.sides().find(is_between).unwrap_or(0);
        vec![side, after(side)]
    }

    /// Vector whose scalar product with a slip is its component `part`.
    pub(super) fn direction(&self, part: SlipPart) -> [f64; 2] {
        match part {
            SlipPart::Along(side) => self.normal_of(side),
            SlipPart::Across(side) => {
                let [x, y] = self.normal_of(side);
                [-y, x]
            }
            SlipPart::Beside(side, other) => {
                let (own, other) = (self.normal_of(side), self.normal_of(other));
                let size = cross(own, other);
                [other[1] / size, -other[0] / size]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::friction::points::COULOMB;
    use crate::contact::tangent::OtherTangent;

    #[test]
    fn a_slip_is_between_the_normals_that_it_is_a_sum_of() {
        let limit = TangentialLimit {
            limit: 1,
            normal: Some(0),
            bound: COULOMB,
            other: OtherTangent::Limit(2),
        };
        let finer = Polygons::new(0).finer(vec![Some([-0.6, 0.8])]).unwrap();
        let finest = finer.finer(vec![Some([0.8, -0.6])]).unwrap();
        for polygons in (0..ATTEMPTS).map(Polygons::new).chain([finer, finest]) {
            let polygon =
                FrictionPolygon::new(&limit, &[1.0; 3], [1.0; 2], (0, &polygons)).unwrap();
            for k in 0..1000 {
                let angle = 0.1 * f64::from(k);
                let slip = [angle.cos(), angle.sin()];
                let [a, b] = polygon.sides_towards(slip)[..] else {
                    panic!("{slip:?}");
                };
                let part = |side, other| {
                    let direction = polygon.direction(SlipPart::Beside(side, other));
                    direction[0] * slip[0] + direction[1] * slip[1]
                };
                let parts = [part(a, b), part(b, a)];
                assert!(parts.iter().all(|&part| part > -1e-12), "{angle}");
                let normals = [polygon.normal_of(a), polygon.normal_of(b)];
                for (axis, slip) in slip.iter().enumerate() {
                    let sum = parts[0] * normals[0][axis] + parts[1] * normals[1][axis];
                    assert!((sum - slip).abs() < 1e-12, "{angle}");
                }
            }
        }
    }
}
