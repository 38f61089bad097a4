//! Free rigid-body motions: an error if the load drives one, fixing dofs (pins) for those without load along them.

mod many;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::forces::{Forces, slips};
use super::free_motion::FreeMotion;
use super::kinematics::Kinematics;
use super::many_bodies::MANY;
use super::null_space::null_space;
use super::proof::Loaded;
use super::scene::{BodyState, RigidRow, Scene};
use crate::error::Failure;
use crate::fem::assembly::FixingDof;
use crate::fem::body_frame::BodyFrame;

/// Load along a free motion, relative to all loads, that counts as zero.
const LOAD_TOLERANCE: f64 = 1e-10;
/// Load that contact can't balance, relative to all loads, that counts as zero.
const BALANCE_TOLERANCE: f64 = 1e-9;
/// Unbalanced load, relative to all loads, that may be more than round-off and leads to a warning.
const WARNED_IMBALANCE: f64 = 1e-12;
/// Load that friction can't balance, relative to all loads, up to which it is round-off of their sum. It is small
/// because a body on a slope slides just beyond a known angle.
const SLIDING: f64 = 2e-14;

/// The free rigid-body motions of a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RigidMotions {
    /// Free motions.
    pub free: Vec<FreeMotion>,
    /// Fixing dofs: one for each free motion, and those of absent bodies.
    pub fixing_dofs: Vec<FixingDof>,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl Scene {
    /// True if supports leave any body a rigid motion.
    pub fn is_movable(&self) -> bool {
        Kinematics::new(self.dim, &self.bodies).len > 0
    }

    /// Fixes absent bodies where they are, so that their motions don't count as free motions of the scene.
    ///
    /// # Errors
    /// An absent body under load.
    pub fn hold(&mut self, is_absent: impl Fn(usize) -> bool) -> Result<Vec<FixingDof>, Failure> {
        let mut pins = Vec::new();
        let bodies = self.bodies.iter_mut().zip(&self.names).enumerate();
        for (_, (body, name)) in bodies.filter(|(b, _)| is_absent(*b)) {
            if body.load_scale > 0.0 {
                return Err(Failure::input(format!(
                    "body '{name}' isn't there, but forces act on it; expected none in /force/value"
                )));
            }
            let alone = std::slice::from_ref(body);
            let kinematics = Kinematics::new(self.dim, alone);
            let free = DMatrix::identity(kinematics.len, kinematics.len);
            pins.extend(kinematics.fixing_dofs(alone, &free));
            let modes = BodyFrame::count(self.dim);
            // The last column is the prescribed displacement.
            let unit = |i: usize| (0..=modes).map(|k| f64::from(i == k)).collect();
            body.supports = (0..modes).map(unit).collect();
        }
        Ok(pins)
    }

    /// Finds the free motions.
    ///
    /// # Errors
    /// The load drives a motion that neither supports nor contact restrain; the message names body and motion.
    pub fn analyse(&self) -> Result<RigidMotions, Failure> {
        let Self { bodies, names, .. } = self;
        let rows = &self.two_sided_rows();
        let kinematics = Kinematics::new(self.dim, bodies);
        if kinematics.len == 0 {
            return Ok(RigidMotions::default());
        }
        let load = kinematics.load(bodies);
        let scale: f64 = bodies.iter().map(|body| body.load_scale).sum();
        if kinematics.len >= MANY
            && let Some(found) = self.analyse_many(&kinematics, scale)
        {
            return found;
        }
        let b = kinematics.rows(rows);
        let free = null_space(&b);
        let along = free.transpose() * &load;
        let driven = &free * &along;
        if along.norm() > LOAD_TOLERANCE * scale {
            return Err(kinematics.ill_posed(bodies, names, &driven, "nothing resists it"));
        }
        let held = &load - &driven;
        let balanced = |left: &DVector<f64>| left.norm() <= BALANCE_TOLERANCE * scale;
        let mut forces = Forces::new(rows, |_| true);
        let nothing = match forces.has_friction {
            true => SLIDING,
            false => WARNED_IMBALANCE,
        };
        let is_nothing = |left: &DVector<f64>| left.norm() <= nothing * scale;
        let loaded = Loaded {
            rows,
            b: &b,
            load: &held,
            scale,
        };
        let found = forces.unbalanced(&loaded, nothing * scale);
        let unbalanced = found.left;
        if let Some(proof) = &found.proof {
            let may_slide = forces.has_friction && !is_nothing(&unbalanced);
            let along = may_slide.then(|| loaded.along_sides(proof));
            if let Some(along) = along.filter(|z| slips(rows, (&b * z).as_slice())) {
                return Err(kinematics.sliding(bodies, names, &along));
            }
            if !balanced(&unbalanced) {
                let why = "contact doesn't resist it";
                return Err(kinematics.ill_posed(bodies, names, proof, why));
            }
        }
        let columns = free.column_iter();
        let list = columns.map(|x| kinematics.motion(&x.into_owned()));
        let fixing_dofs = kinematics.fixing_dofs(bodies, &free);
        let mut motions = kinematics.fix(bodies, names, list.collect(), fixing_dofs);
        if !is_nothing(&unbalanced) && found.proof.is_some() {
            (motions.warnings).push(kinematics.round_off_warning(
                bodies,
                names,
                &unbalanced,
                scale,
            ));
        }
        Ok(motions)
    }

    /// The failure of a scene whose bodies only friction could restrain, for use when the solver finds that it doesn't:
    /// elastic bodies may be pressed together less than rigid ones could be.
    pub fn unheld(&self) -> Option<Failure> {
        let normals = self.two_sided_rows().into_iter();
        let normals: Vec<RigidRow> = normals.filter(|row| row.friction.is_none()).collect();
        let kinematics = Kinematics::new(self.dim, &self.bodies);
        let load = kinematics.load(&self.bodies);
        let scale: f64 = self.bodies.iter().map(|body| body.load_scale).sum();
        let sliding =
            |unbalanced: &DVector<f64>| kinematics.sliding(&self.bodies, &self.names, unbalanced);
        if kinematics.len >= MANY {
            let unbalanced = self.unbalanced_part_many(&kinematics, scale);
            return unbalanced.as_ref().map(sliding);
        }
        let b = kinematics.rows(&normals);
        let free = null_space(&b);
        let driven = &free * (free.transpose() * &load);
        let held = &load - &driven;
        let loaded = Loaded {
            rows: &normals,
            b: &b,
            load: &held,
            scale,
        };
        let found = Forces::new(&normals, |_| true).unbalanced(&loaded, WARNED_IMBALANCE * scale);
        let unbalanced = driven + found.left;
        (unbalanced.norm() > BALANCE_TOLERANCE * scale).then(|| sliding(&unbalanced))
    }
}

impl Kinematics {
    fn ill_posed(
        &self,
        bodies: &[BodyState],
        names: &[String],
        motion: &DVector<f64>,
        why: &str,
    ) -> Failure {
        let (worst, how) = self.of_worst(bodies, motion);
        Failure::ill_posed(format!(
            "body '{}' is under-constrained: its rigid-body motion, {how}, is loaded, and {why}; expected supports or \
             contact against it",
            names[worst],
        ))
    }

    fn sliding(&self, bodies: &[BodyState], names: &[String], motion: &DVector<f64>) -> Failure {
        let (worst, how) = self.of_worst(bodies, motion);
        let along = how
            .strip_prefix("translation ")
            .map(|along| format!("slides {along}"));
        Failure::ill_posed(format!(
            "body '{}' {} under its load, and friction can't hold it; expected supports, contact against it, or \
             more friction",
            names[worst],
            along.unwrap_or_else(|| format!("slides ({how})")),
        ))
    }

    /// The warning of an unbalanced load that is taken for round-off of all loads.
    fn round_off_warning(
        &self,
        bodies: &[BodyState],
        names: &[String],
        unbalanced: &DVector<f64>,
        scale: f64,
    ) -> String {
        let share = unbalanced.norm() / scale;
        let motion = self.motion(&unbalanced.normalize());
        format!(
            "unbalanced load along {}: {share:.0e} of the total; treated as round-off",
            self.described(bodies, names, &[motion]).concat()
        )
    }

    /// The body that moves farthest in `motion`, and a description of its motion.
    fn of_worst(&self, bodies: &[BodyState], motion: &DVector<f64>) -> (usize, String) {
        let size = |b: usize| -> f64 {
            self.of_body(b, motion.as_slice())
                .iter()
                .map(|z| z * z)
                .sum()
        };
        let mut worst = 0;
        for b in 1..bodies.len() {
            if size(b) > size(worst) {
                worst = b;
            }
        }
        let z = self.of_body(worst, motion.as_slice());
        (worst, bodies[worst].describe(self.dim, &z))
    }

    /// The free `motions` with the `fixing_dofs` that stop them, and a warning of each.
    fn fix(
        &self,
        bodies: &[BodyState],
        names: &[String],
        motions: Vec<FreeMotion>,
        fixing_dofs: Vec<FixingDof>,
    ) -> RigidMotions {
        let fixed = |what: &String| {
            format!(
                "unconstrained rigid-body motion, not loaded: {what}; the mean displacement along it is set to zero"
            )
        };
        RigidMotions {
            warnings: (self.described(bodies, names, &motions).iter())
                .map(fixed)
                .collect(),
            fixing_dofs,
            free: motions,
        }
    }

    /// Motion `x` body by body.
    pub(super) fn motion(&self, x: &DVector<f64>) -> FreeMotion {
        FreeMotion {
            bodies: (0..self.bodies())
                .map(|b| (b, self.of_body(b, x.as_slice())))
                .filter(|(_, z)| z.iter().any(|z| z.abs() > 1e-12))
                .collect(),
        }
    }

    /// Fixing dofs, one for each free motion: components of candidate nodes, chosen greedily where the motions not yet
    /// stopped are largest.
    fn fixing_dofs(&self, bodies: &[BodyState], free: &DMatrix<f64>) -> Vec<FixingDof> {
        let mut candidates: Vec<(FixingDof, DVector<f64>)> = Vec::new();
        for (b, body) in bodies.iter().enumerate() {
            for &(subdomain, node, x) in &body.candidates {
                let moves: Vec<[f64; 3]> = free
                    .column_iter()
                    .map(|column| {
                        let motion: Vec<f64> = column.iter().copied().collect();
                        let z = self.of_body(b, &motion);
                        body.frame.displacement(self.dim, &x, &z)
                    })
                    .collect();
                for component in 0..self.dim {
                    let fixing_dof = FixingDof {
                        subdomain,
                        node,
                        component: component as u32,
                    };
                    let row = DVector::from_fn(moves.len(), |k, _| moves[k][component]);
                    candidates.push((fixing_dof, row));
                }
            }
        }
        let mut fixing_dofs = Vec::new();
        for _ in 0..free.ncols() {
            let mut best = 0;
            for (i, (_, row)) in candidates.iter().enumerate() {
                if row.norm() > candidates[best].1.norm() * (1.0 + 1e-9) {
                    best = i;
                }
            }
            let Some((fixing_dof, row)) = candidates.get(best).cloned() else {
                break;
            };
            fixing_dofs.push(fixing_dof);
            let unit = row.normalize();
            for (_, other) in &mut candidates {
                let along = other.dot(&unit);
                other.axpy(-along, &unit, 1.0);
            }
        }
        fixing_dofs
    }
}

#[cfg(test)]
mod tests;
