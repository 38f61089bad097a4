//! The reference with friction: the jumps of all contact points at once, by nonlinear block Gauss-Seidel.
//!
//! Displacements and supports are condensed onto the jumps d beyond the gap g and beyond the tangential jump of the
//! step before: the forces are r − S d. One contact point after the other takes the jump and the force that its law
//! asks for while the others stay, until nothing changes. Then what is closed, sticks and slips is known, and one
//! sparse system has the solution.
//!
//! After M. Jean, *The non-smooth contact dynamics method*, Comput. Methods Appl. Mech. Engrg 177 (1999), in
//! displacements instead of forces.

use std::collections::BTreeMap;

use contact_dd_partition::model::Model;
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use serde_json::Value;

use super::assembled::{Along, Assembled, Solved};
use super::scenes::at_step;
use super::solution::{ContactPoint, Solution};

/// Passes at most.
const PASSES: usize = 400_000;
/// Change of the jumps in a pass, relative to the largest, that ends them.
const SETTLED: f64 = 1e-12;
/// What may be missed of the law, relative to the largest force or jump.
const ROUND_OFF: f64 = 1e-10;

/// The solution of a load step.
pub struct Frictional {
    pub solved: Solved,
    /// Which conditions are closed.
    pub closed: Vec<bool>,
    /// What holds along the tangents.
    pub along: Vec<Along>,
    pub assembled: Assembled,
}

/// A contact point: rows of its jumps, its block of S, and its bound.
struct Point {
    normal: usize,
    tangent: Option<usize>,
    block: Matrix2<f64>,
    /// Slope and constant of the bound where it is closed, and where it is open.
    closed: (f64, f64),
    open: f64,
}

impl Frictional {
    /// All load steps, one after the other; or the only increment.
    #[track_caller]
    pub fn steps(model: &Model) -> Vec<Self> {
        let steps: Vec<Model> = match model.steps.len() {
            0 => vec![model.clone()],
            count => (0..count).map(|k| at_step(model, k)).collect(),
        };
        let mut past: Option<Vec<f64>> = None;
        let mut all = Vec::new();
        for model in &steps {
            let assembled = Assembled::new(model);
            let w = past.unwrap_or_else(|| vec![0.0; assembled.tangents.len()]);
            let step = Self::increment(assembled, &w);
            past = Some(step.jumps());
            all.push(step);
        }
        all
    }

    /// The tangential jumps.
    fn jumps(&self) -> Vec<f64> {
        let tangents = self.assembled.tangents.iter();
        tangents.map(|t| t.jump(&self.solved.u)).collect()
    }

    /// The increment from the tangential jumps `w`.
    #[track_caller]
    fn increment(assembled: Assembled, w: &[f64]) -> Self {
        let (r, s) = assembled.condensed(w);
        let points = points(&assembled, &s);
        let d = settled(&points, &r, &s);
        let count = assembled.conditions.len();
        let force = &r - &s * &d;
        let force_scale = force.amax();
        // A jump of nothing and a force of nothing are both: it is open.
        let closed: Vec<bool> = (0..count)
            .map(|j| d[j] == 0.0 && force[j] > -1e-9 * force_scale)
            .collect();
        let along: Vec<Along> = (assembled.tangents.iter().enumerate())
            .map(|(k, tangent)| match d[count + k] {
                _ if !closed[tangent.condition] && !tangent.is_given() => Along::Free,
                0.0 => Along::Stuck(w[k]),
                slip => Along::Slips(slip.signum()),
            })
            .collect();
        let solved = assembled.solve_along(&closed, &along, &[], None);
        let found = Self {
            solved,
            closed,
            along,
            assembled,
        };
        found.check(w, force_scale);
        found
    }

    /// What a result file would say.
    pub fn written(&self, model: &Model) -> Solution {
        let (assembled, solved) = (&self.assembled, &self.solved);
        let gaps = assembled.gaps(&solved.u);
        let points = model.contacts.iter().flat_map(|contact| &contact.points);
        let mut points: Vec<ContactPoint> = (points.enumerate())
            .map(|(j, point)| ContactPoint {
                tags: [point.tag_a, point.tag_b],
                position: point.position,
                normal: point.normal(),
                gap: gaps[j],
                force: solved.forces[j].max(0.0),
                pressure: solved.forces[j] / point.area,
                closed: self.closed[j],
                slipping: false,
                tangential_force: [0.0; 3],
                slip: [0.0; 3],
            })
            .collect();
        for (k, tangent) in assembled.tangents.iter().enumerate() {
            let point = &mut points[tangent.condition];
            let jump = tangent.jump(&solved.u);
            point.tangential_force = tangent.direction.map(|t| -solved.tangential[k] * t);
            point.slip = tangent.direction.map(|t| jump * t);
            point.slipping = point.closed && matches!(self.along[k], Along::Slips(_));
        }
        let mut points = points.into_iter();
        let contacts = model.contacts.iter().map(|contact| {
            let part = points.by_ref().take(contact.points.len());
            (contact.name.clone(), part.collect())
        });
        let tags = model.mesh.node_tags.iter().copied();
        let u = solved.u.chunks(2).map(|u| [u[0], u[1], 0.0]);
        Solution {
            contacts: contacts.collect(),
            displacement: tags.zip(u).collect(),
            cells: Vec::new(),
            nodal_stress: BTreeMap::new(),
            types: Vec::new(),
            report: Value::Null,
        }
    }

    /// Fails unless the law holds.
    #[track_caller]
    fn check(&self, w: &[f64], force_scale: f64) {
        let size = self.solved.u.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
        let (no_jump, no_force) = (ROUND_OFF * size, ROUND_OFF * force_scale);
        let gaps = self.assembled.gaps(&self.solved.u);
        for (j, &gap) in gaps.iter().enumerate() {
            let force = self.solved.forces[j];
            assert!(
                gap >= -no_jump && force >= -no_force,
                "{j}: {gap:e}, {force:e}"
            );
        }
        let now = self.jumps();
        for (k, tangent) in self.assembled.tangents.iter().enumerate() {
            let (grows, constant) = tangent.bound(self.closed[tangent.condition]);
            let bound = grows * self.solved.forces[tangent.condition] + constant;
            let force = self.solved.tangential[k];
            assert!(force.abs() <= bound + no_force, "{k}: {force:e}, {bound:e}");
            if let Along::Slips(sign) = self.along[k] {
                assert!(
                    (now[k] - w[k]) * sign >= -no_jump,
                    "{k}: {:e}",
                    now[k] - w[k]
                );
            }
        }
    }
}

fn points(assembled: &Assembled, s: &DMatrix<f64>) -> Vec<Point> {
    let count = assembled.conditions.len();
    let mut points: Vec<Point> = (0..count)
        .map(|normal| Point {
            normal,
            tangent: None,
            block: Matrix2::identity() * s[(normal, normal)],
            closed: (0.0, 0.0),
            open: 0.0,
        })
        .collect();
    for (k, tangent) in assembled.tangents.iter().enumerate() {
        let point = &mut points[tangent.condition];
        let rows = [point.normal, count + k];
        point.tangent = Some(rows[1]);
        point.block = Matrix2::from_fn(|i, j| s[(rows[i], rows[j])]);
        point.closed = tangent.bound(true);
        point.open = tangent.bound(false).1;
    }
    points
}

/// The jumps where every point has what its law asks for.
#[track_caller]
fn settled(points: &[Point], r: &DVector<f64>, s: &DMatrix<f64>) -> DVector<f64> {
    let mut d = DVector::zeros(r.len());
    let mut force = r.clone();
    for _ in 0..PASSES {
        let mut change: f64 = 0.0;
        for point in points {
            let rows = [Some(point.normal), point.tangent];
            let at = |values: &DVector<f64>| {
                Vector2::from_fn(|i, _| rows[i].map_or(0.0, |row| values[row]))
            };
            let old = at(&d);
            let found = point.jump(at(&force) + point.block * old);
            for (i, row) in rows.into_iter().enumerate() {
                let (Some(row), by) = (row, found[i] - old[i]) else {
                    continue;
                };
                if by != 0.0 {
                    d[row] = found[i];
                    force.axpy(-by, &s.column(row), 1.0);
                    change = change.max(by.abs());
                }
            }
        }
        // Sums of corrections collect round-off.
        force = r - s * &d;
        if change <= SETTLED * d.amax() {
            return d;
        }
    }
    panic!("the reference with friction doesn't settle");
}

impl Point {
    /// Its jumps (normal beyond the gap, tangential beyond that of the step before), with the forces `q` where both
    /// are 0 and the others stay.
    fn jump(&self, q: Vector2<f64>) -> Vector2<f64> {
        let (s, (slope, constant)) = (&self.block, self.closed);
        if self.tangent.is_none() {
            return Vector2::new((q[0] / s[(0, 0)]).min(0.0), 0.0);
        }
        // Closed and stuck, closed and slipping.
        if q[0] >= 0.0 && q[1].abs() <= slope * q[0] + constant {
            return Vector2::zeros();
        }
        for sign in [1.0, -1.0] {
            let steep = s[(1, 1)] - sign * slope * s[(0, 1)];
            let slip = (q[1] - sign * (slope * q[0] + constant)) / steep;
            if slip * sign >= 0.0 && q[0] - s[(0, 1)] * slip >= 0.0 {
                return Vector2::new(0.0, slip);
            }
        }
        // Open, with a given bound stuck or slipping.
        let alone = q[0] / s[(0, 0)];
        if (q[1] - s[(0, 1)] * alone).abs() <= self.open {
            return Vector2::new(alone.min(0.0), 0.0);
        }
        let whole = s.try_inverse().unwrap();
        let bounds = if self.open > 0.0 {
            &[1.0, -1.0][..]
        } else {
            &[0.0]
        };
        for &sign in bounds {
            let found = whole * (q - Vector2::new(0.0, sign * self.open));
            if found[0] <= 0.0 && found[1] * sign >= 0.0 {
                return found;
            }
        }
        Vector2::zeros()
    }
}
