//! Admissible contact forces: normal pressure, and friction within its bound.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::many_bodies::SparseRow;
use super::nonnegative::{Nearest, nearest, residual, residual_in_span};
use super::null_space::{RANK_TOLERANCE, null_space};
use super::proof::Loaded;
use super::scene::{Friction, RigidRow};

/// Slip in a motion, relative to its largest jump, from which on the sides count as slipping.
const SLIPS: f64 = 0.1;
/// Remaining load, relative to the whole, that is round-off.
const NOTHING: f64 = 1e-15;
/// Ratio of the remaining load after a refinement to that before it, above which refinement ends.
const STALLED: f64 = 0.9;
/// Coefficient of friction from which on cones are nearly half spaces.
const STEEP: f64 = 1e3;
/// Ratio of the work of the load along successive motions, each proof that no forces balance it, above which refinement
/// continues: the reported motion should be the one with the most work.
const LEAST_WORK_RATIO: f64 = 1.0 + 1e-10;
/// Most refinements of the polygons that approximate the cones.
const REFINEMENTS: usize = 40;
/// Half the number of initial directions in a tangential plane.
const DIRECTIONS: usize = 4;

/// A unit force on constraints; admissible forces contain it with a factor from 0 to `largest`.
#[derive(Clone, Debug, PartialEq)]
struct Generator {
    normal: Option<usize>,
    /// Tangential constraints and their components.
    tangential: Vec<(usize, f64)>,
    largest: f64,
}

/// Part of a load that the admissible forces don't balance.
#[derive(Debug)]
pub(super) struct Unbalanced {
    /// The unbalanced load, 0 where forces balance all of it.
    pub left: DVector<f64>,
    /// A motion along which the load does more work than the forces can absorb.
    pub proof: Option<DVector<f64>>,
}

/// Admissible contact forces: non-negative combinations of generators.
#[derive(Debug, Default)]
pub(super) struct Forces {
    generators: Vec<Generator>,
    /// The circular friction cones: normal constraint, tangential constraints, and coefficient.
    cones: Vec<(usize, [usize; 2], f64)>,
    pub has_friction: bool,
}

impl Forces {
    /// The forces of the constraints `rows`, where `closed` tells whether the contact of a normal constraint is closed.
    /// In space the friction bound without pressure becomes a prism around the circular one, at most 8 % wider.
    pub fn new(rows: &[RigidRow], closed: impl Fn(usize) -> bool) -> Self {
        let mut tangents: Vec<Vec<usize>> = vec![Vec::new(); rows.len()];
        for (i, row) in rows.iter().enumerate() {
            if let Some(friction) = &row.friction {
                tangents[friction.normal].push(i);
            }
        }
        let mut forces = Self::default();
        for (j, tangents) in tangents.iter().enumerate() {
            if rows[j].friction.is_some() {
                continue;
            }
            let friction = tangents.first().and_then(|&i| rows[i].friction);
            forces.has_friction |= friction.is_some();
            forces.add_point(j, closed(j), friction, tangents);
        }
        forces
    }

    fn add_point(
        &mut self,
        normal: usize,
        closed: bool,
        friction: Option<Friction>,
        tangents: &[usize],
    ) {
        let mut add = |normal, tangential, largest| {
            self.generators.push(Generator {
                normal,
                tangential,
                largest,
            });
        };
        let along = directions(tangents);
        let [bound, slope] = friction.map_or([0.0; 2], |friction| friction.bound.line(closed));
        if closed && slope == 0.0 {
            add(Some(normal), Vec::new(), f64::INFINITY);
        } else if closed {
            if slope > STEEP {
                // The edges of a steep cone are nearly opposite: pure pressure would be a small difference of large
                // forces.
                add(Some(normal), Vec::new(), f64::INFINITY);
            }
            for direction in &along {
                let tangential = direction.iter().map(|&(i, part)| (i, slope * part));
                add(Some(normal), tangential.collect(), f64::INFINITY);
            }
            if let [first, second] = *tangents {
                self.cones.push((normal, [first, second], slope));
            }
        }
        if bound > 0.0 {
            // In space the segments sum to a polygon around the circle.
            let largest = match tangents {
                [_] => bound,
                _ => bound * half_angle().tan(),
            };
            for direction in along {
                add(None, direction, largest);
            }
        }
    }

    /// Work of the unit forces in motions whose jumps at the constraints are the columns of `b`; a column for each
    /// force.
    fn actions(&self, b: &DMatrix<f64>) -> DMatrix<f64> {
        let mut actions = DMatrix::zeros(b.ncols(), self.generators.len());
        for (generator, mut action) in self.generators.iter().zip(actions.column_iter_mut()) {
            let normal = generator.normal.map(|j| (j, 1.0));
            for (i, part) in normal.into_iter().chain(generator.tangential.clone()) {
                action.axpy(part, &b.row(i).transpose(), 1.0);
            }
        }
        actions
    }

    /// Work of the unbounded generators in motions, where `rows` are the jumps of the motions at each constraint; if
    /// `wider`, the polygons circumscribe the circular cones instead of being inscribed.
    pub fn cones(&self, rows: &[SparseRow], wider: bool) -> Vec<SparseRow> {
        let factor = match wider && !self.cones.is_empty() {
            true => 1.0 / half_angle().cos(),
            false => 1.0,
        };
        let unbounded = self.generators.iter().filter(|g| g.largest.is_infinite());
        let of_generator = |generator: &Generator| {
            let mut work: BTreeMap<usize, f64> = BTreeMap::new();
            let normal = generator.normal.map(|j| (j, 1.0));
            let tangential = generator.tangential.iter();
            let tangential = tangential.map(|&(i, part)| (i, factor * part));
            for (condition, part) in normal.into_iter().chain(tangential) {
                for &(unknown, value) in &rows[condition] {
                    *work.entry(unknown).or_default() += part * value;
                }
            }
            work.into_iter().collect()
        };
        unbounded.map(of_generator).collect()
    }

    /// λ_t of all constraints for the factors `lambda` of the inscribed [`cones`](Self::cones).
    pub fn tangential_of_cones(&self, lambda: &[f64], conditions: usize) -> DVector<f64> {
        let mut lambda = lambda.iter();
        let given = self.generators.iter().map(|g| match g.largest {
            largest if largest.is_infinite() => lambda.next().copied().unwrap_or(0.0),
            _ => 0.0,
        });
        self.tangential(&given.collect::<Vec<_>>(), conditions)
    }

    fn largest(&self) -> Vec<f64> {
        self.generators.iter().map(|g| g.largest).collect()
    }

    /// The part of a load that these forces don't balance, and a motion that proves that none do; a norm up to
    /// `nothing` counts as balance. Polygons of circular cones are refined until one of both is certain.
    pub fn unbalanced(&mut self, loaded: &Loaded<'_>, nothing: f64) -> Unbalanced {
        let Loaded { b, load, .. } = *loaded;
        let in_span = self.in_span(b, load);
        if let Some((left, _)) = &in_span
            && left.norm() <= nothing
        {
            return Unbalanced {
                left: left.clone(),
                proof: None,
            };
        }
        let mut found = nearest(&self.actions(b), load, &self.largest());
        let in_turned = || {
            let (_, along) = in_span.as_ref()?;
            loaded.proof(along, &[])
        };
        let mut proven = match self.cones.is_empty() {
            true => in_turned(),
            false => None,
        };
        proven = proven.or_else(|| loaded.proof(&found.left, &self.normal(&found.lambda, b)));
        let refinements = match self.cones.is_empty() {
            true => 0,
            false => REFINEMENTS,
        };
        for _ in 0..refinements {
            if found.left.norm() <= nothing {
                break;
            }
            self.refine(
                &self.tangential(&found.lambda, b.nrows()),
                f64::EPSILON * load.norm(),
            );
            self.refine(&(b * &found.left), f64::EPSILON * found.left.norm());
            found = nearest(&self.actions(b), load, &self.largest());
            let next = loaded.proof(&found.left, &self.normal(&found.lambda, b));
            let work = |z: &Option<DVector<f64>>| z.as_ref().map_or(0.0, |z| load.dot(z));
            let is_better = work(&next) > LEAST_WORK_RATIO * work(&proven);
            if proven.is_some() && !is_better {
                break;
            }
            proven = next.or(proven);
        }
        if found.left.norm() > nothing {
            proven = proven.or_else(in_turned);
        }
        let in_span = in_span.map(|(left, _)| left);
        Unbalanced {
            left: (in_span.filter(|left| left.norm() < found.left.norm())).unwrap_or(found.left),
            proof: proven,
        }
    }

    /// The part of a load that the forces leave unbalanced, and a motion along which the load does more work than the
    /// forces can absorb; `None` if the singular values can't be computed. Without friction the part of the load
    /// outside the span of the forces is left out; with friction only that outside the span of all constraints.
    fn in_span(
        &self,
        b: &DMatrix<f64>,
        load: &DVector<f64>,
    ) -> Option<(DVector<f64>, DVector<f64>)> {
        let (actions, largest) = (self.actions(b), self.largest());
        if !self.has_friction {
            let found = residual_in_span(&actions, load, &largest, RANK_TOLERANCE)?;
            return Some((found.left, found.drive));
        }
        // Friction, however small, doesn't change the span of the constraints, so that the reduction uses these.
        let held = null_space(&null_space(b).transpose());
        let (actions, load) = (held.tr_mul(&actions), held.tr_mul(load));
        let found = residual_in_span(&actions, &load, &largest, NOTHING)?;
        Some((&held * (found.left + found.outside), held * found.drive))
    }

    /// Part of a `load` that drives the bodies, because the forces don't balance it.
    ///
    /// With friction the bodies slide along their contacts rather than rise at the friction angle: the tangential
    /// forces of the nearest combination are subtracted from the load, and normal forces balance as much of the rest as
    /// they can.
    pub fn drive(&mut self, b: &DMatrix<f64>, load: &DVector<f64>) -> DVector<f64> {
        let Nearest { lambda, left } = self.nearest(b, load);
        if !self.has_friction {
            return left;
        }
        let rest = load - b.tr_mul(&self.tangential(&lambda, b.nrows()));
        let mut normals: Vec<usize> = self.generators.iter().filter_map(|g| g.normal).collect();
        normals.sort_unstable();
        normals.dedup();
        residual(&b.select_rows(&normals).transpose(), &rest)
    }

    /// The forces nearest to a `load`; polygons of circular cones are refined as long as that reduces the distance.
    fn nearest(&mut self, b: &DMatrix<f64>, load: &DVector<f64>) -> Nearest {
        let mut found = nearest(&self.actions(b), load, &self.largest());
        for _ in 0..REFINEMENTS {
            if self.cones.is_empty() || found.left.norm() <= NOTHING * load.norm() {
                break;
            }
            self.refine(
                &self.tangential(&found.lambda, b.nrows()),
                f64::EPSILON * load.norm(),
            );
            self.refine(&(b * &found.left), f64::EPSILON * found.left.norm());
            let nearer = nearest(&self.actions(b), load, &self.largest());
            let enough = nearer.left.norm() > STALLED * found.left.norm();
            found = nearer;
            if enough {
                break;
            }
        }
        found
    }

    /// Adds to every circular cone its generator along the tangential `parts` of its constraints, where these exceed
    /// `nothing`.
    fn refine(&mut self, parts: &DVector<f64>, nothing: f64) {
        for &(normal, [t, s], slope) in &self.cones {
            let size = parts[t].hypot(parts[s]);
            if size > nothing {
                let part = |i: usize| (i, slope * parts[i] / size);
                self.generators.push(Generator {
                    normal: Some(normal),
                    tangential: vec![part(t), part(s)],
                    largest: f64::INFINITY,
                });
            }
        }
    }

    /// λ_n of all constraints, the rows of `b`.
    fn normal(&self, lambda: &[f64], b: &DMatrix<f64>) -> Vec<f64> {
        let mut forces = vec![0.0; b.nrows()];
        for (generator, lambda) in self.generators.iter().zip(lambda) {
            if let Some(normal) = generator.normal {
                forces[normal] += lambda;
            }
        }
        forces
    }

    /// λ_t of all constraints.
    fn tangential(&self, lambda: &[f64], conditions: usize) -> DVector<f64> {
        let mut forces = DVector::zeros(conditions);
        for (generator, lambda) in self.generators.iter().zip(lambda) {
            for &(i, part) in &generator.tangential {
                forces[i] += lambda * part;
            }
        }
        forces
    }
}

/// True if sides with friction slip on each other in a motion with the jumps `moved` at the constraints.
pub(super) fn slips(rows: &[RigidRow], moved: &[f64]) -> bool {
    let far = moved
        .iter()
        .fold(0.0, |far: f64, along| far.max(along.abs()));
    rows.iter().zip(moved).any(|(row, along)| {
        row.friction.is_some_and(|friction| {
            along.abs() > SLIPS * far && moved[friction.normal].abs() < SLIPS * along.abs()
        })
    })
}

/// Directions in a tangential plane by components along `tangents`; in the plane there are two.
fn directions(tangents: &[usize]) -> Vec<Vec<(usize, f64)>> {
    match *tangents {
        [t] => vec![vec![(t, 1.0)], vec![(t, -1.0)]],
        [t, s] => (0..2 * DIRECTIONS)
            .map(|k| {
                let (sin, cos) = (2.0 * half_angle() * k as f64).sin_cos();
                vec![(t, cos), (s, sin)]
            })
            .collect(),
        _ => Vec::new(),
    }
}

/// Half the angle between neighbouring directions.
fn half_angle() -> f64 {
    std::f64::consts::PI / (2 * DIRECTIONS) as f64
}

#[cfg(test)]
mod tests;
