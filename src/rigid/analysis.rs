//! Which rigid motions are free, whether the load drives one, and where to pin those it doesn't.

use nalgebra::{DMatrix, DVector};

use super::kinematics::{Kinematics, null_space};
use super::motion::BodyFrame;
use super::nonnegative;
use crate::error::Failure;

/// Load along a free motion, relative to all loads, that counts as none.
const LOAD_TOLERANCE: f64 = 1e-10;
/// Load that contact can't balance, relative to all loads, that counts as none.
const BALANCE_TOLERANCE: f64 = 1e-9;

/// A body as the analysis sees it.
#[derive(Clone, Debug)]
pub struct BodyState {
    /// Frame of its rigid motions.
    pub frame: BodyFrame,
    /// Rows of its supports against its rigid motions, what they prescribe last (m).
    pub supports: Vec<Vec<f64>>,
    /// Resultant of its load against its rigid motions.
    pub load: Vec<f64>,
    /// Sum of its absolute nodal forces.
    pub load_scale: f64,
    /// Nodes at which it may be pinned: subdomain, node, position.
    pub candidates: Vec<(u32, u32, [f64; 3])>,
}

/// A contact condition against the rigid motions of the bodies it touches.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidRow {
    /// Bodies, and the row against their motions.
    pub bodies: Vec<(usize, Vec<f64>)>,
    /// g (m).
    pub gap: f64,
}

/// A spring on one node of a body that can move freely: u·direction = 0 there. It carries no force
/// because the load has no component along the motion that it stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// Subdomain.
    pub subdomain: u32,
    /// Node of the subdomain.
    pub node: u32,
    /// Component that is held.
    pub component: u32,
}

/// A free rigid motion without load along it: for each body that takes part its coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeMotion {
    /// Bodies and their coefficients.
    pub bodies: Vec<(usize, Vec<f64>)>,
}

/// The rigid motions of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RigidMotions {
    /// Free ones.
    pub free: Vec<FreeMotion>,
    /// As many pins as there are free motions.
    pub pins: Vec<Pin>,
    /// What a user should know.
    pub warnings: Vec<String>,
}

/// What the rigid motions of a scene follow from. On the root.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Dimension of space.
    pub dim: usize,
    /// Bodies.
    pub bodies: Vec<BodyState>,
    /// Their names.
    pub names: Vec<String>,
    /// Conditions, pair by pair.
    pub rows: Vec<RigidRow>,
    /// Number of conditions of every pair.
    pub conditions: Vec<usize>,
}

impl Scene {
    /// Whether supports leave any rigid motion to any body.
    pub fn is_movable(&self) -> bool {
        Kinematics::new(self.dim, &self.bodies).len > 0
    }

    /// Finds the free motions.
    ///
    /// # Errors
    /// The load drives a motion that neither supports nor contact hold: body and motion are named.
    pub fn analyse(&self) -> Result<RigidMotions, Failure> {
        let Self {
            bodies,
            names,
            rows,
            ..
        } = self;
        let kinematics = Kinematics::new(self.dim, bodies);
        if kinematics.len == 0 {
            return Ok(RigidMotions::default());
        }
        let b = kinematics.rows(rows);
        let load = kinematics.load(bodies);
        let scale: f64 = bodies.iter().map(|body| body.load_scale).sum();
        let free = null_space(&b);
        let along = free.transpose() * &load;
        let driven = &free * &along;
        if along.norm() > LOAD_TOLERANCE * scale {
            return Err(kinematics.ill_posed(bodies, names, &driven, "nothing holds it"));
        }
        let held = &load - &driven;
        let unbalanced = nonnegative::residual(&b.transpose(), &held);
        if unbalanced.norm() > BALANCE_TOLERANCE * scale {
            let why = "contact can't hold it";
            return Err(kinematics.ill_posed(bodies, names, &unbalanced, why));
        }
        Ok(kinematics.fix(bodies, names, &free))
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
        Failure::ill_posed(format!(
            "body '{}' can move freely under its load: {}, and {why}; expected supports or contact \
             against it",
            names[worst],
            bodies[worst].frame.describe(self.dim, &z)
        ))
    }

    /// Pins the free motions, the columns of `free`, and says so.
    fn fix(&self, bodies: &[BodyState], names: &[String], free: &DMatrix<f64>) -> RigidMotions {
        let columns = free.column_iter();
        let motions: Vec<FreeMotion> = columns.map(|x| self.motion(&x.into_owned())).collect();
        let fixed = |what: &String| {
            format!(
                "nothing holds {what}; without load along it, this is fixed so that the mean \
                 displacement has no component along it"
            )
        };
        RigidMotions {
            warnings: (self.described(bodies, names, &motions).iter())
                .map(fixed)
                .collect(),
            pins: self.pins(bodies, free),
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

    /// As many components of candidate nodes as there are free motions, chosen one after the other
    /// where the motions not yet stopped are largest.
    fn pins(&self, bodies: &[BodyState], free: &DMatrix<f64>) -> Vec<Pin> {
        let mut candidates: Vec<(Pin, DVector<f64>)> = Vec::new();
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
                    let pin = Pin {
                        subdomain,
                        node,
                        component: component as u32,
                    };
                    let row = DVector::from_fn(moves.len(), |k, _| moves[k][component]);
                    candidates.push((pin, row));
                }
            }
        }
        let mut pins = Vec::new();
        for _ in 0..free.ncols() {
            let mut best = 0;
            for (i, (_, row)) in candidates.iter().enumerate() {
                if row.norm() > candidates[best].1.norm() * (1.0 + 1e-9) {
                    best = i;
                }
            }
            let Some((pin, row)) = candidates.get(best).cloned() else {
                break;
            };
            pins.push(pin);
            let unit = row.normalize();
            for (_, other) in &mut candidates {
                let along = other.dot(&unit);
                other.axpy(-along, &unit, 1.0);
            }
        }
        pins
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(at: f64, load: [f64; 3], supports: Vec<Vec<f64>>) -> BodyState {
        let frame = BodyFrame::new([at, 0.0, 0.0], [at + 1.0, 1.0, 0.0]);
        BodyState {
            frame,
            supports,
            load: load.to_vec(),
            load_scale: load.iter().map(|f| f.abs()).sum(),
            candidates: vec![(0, 0, [at, 0.0, 0.0]), (0, 1, [at + 1.0, 1.0, 0.0])],
        }
    }

    fn floor(body: &BodyState, b: usize, xs: &[f64]) -> Vec<RigidRow> {
        xs.iter()
            .map(|&x| {
                let action = body.frame.action(2, &[x, 0.0, 0.0], &[0.0, -1.0, 0.0]);
                RigidRow {
                    bodies: vec![(b, action)],
                    gap: 0.0,
                }
            })
            .collect()
    }

    fn analyse(body: BodyState, rows: Vec<RigidRow>) -> Result<RigidMotions, Failure> {
        let scene = Scene {
            dim: 2,
            bodies: vec![body],
            names: vec!["block".into()],
            conditions: vec![rows.len()],
            rows,
        };
        scene.analyse()
    }

    #[test]
    fn a_block_on_the_floor_slides_freely_and_is_pinned_once() {
        let block = square(0.0, [0.0, -3.0, 0.0], vec![]);
        let rows = floor(&block, 0, &[0.0, 0.5, 1.0]);
        let motions = analyse(block, rows).unwrap();
        assert_eq!(motions.pins.len(), 1);
        assert_eq!(motions.pins[0].component, 0);
        assert!(motions.warnings[0].contains("'block'"));
    }

    #[test]
    fn a_pushed_block_slides_and_is_named() {
        let block = square(0.0, [0.1, -3.0, 0.0], vec![]);
        let rows = floor(&block, 0, &[0.0, 1.0]);
        let failure = analyse(block, rows).unwrap_err();
        assert!(failure.message.contains("'block'"), "{failure}");
        assert!(
            failure
                .message
                .contains("translation along (1.0000, 0.0000)")
        );
    }

    #[test]
    fn a_lifted_block_and_a_toppling_one_have_no_equilibrium() {
        let lifted = square(0.0, [0.0, 1.0, 0.0], vec![]);
        let rows = floor(&lifted, 0, &[0.0, 1.0]);
        assert!(analyse(lifted, rows.clone()).is_err());
        let toppling = square(0.0, [0.0, -1.0, -3.0], vec![]);
        assert!(analyse(toppling, rows.clone()).is_err());
        let steady = square(0.0, [0.0, -1.0, -0.5], vec![]);
        assert!(analyse(steady, rows).is_ok());
    }

    #[test]
    fn a_supported_body_is_left_alone() {
        let frame = BodyFrame::new([0.0; 3], [1.0, 1.0, 0.0]);
        let rows = [([0.0; 3], 0), ([0.0; 3], 1), ([1.0, 0.0, 0.0], 1)];
        let supports = (rows.iter())
            .map(|(x, axis)| {
                let mut direction = [0.0; 3];
                direction[*axis] = 1.0;
                let mut row = frame.action(2, x, &direction);
                row.push(0.0);
                row
            })
            .collect();
        let body = square(0.0, [5.0, 1.0, 2.0], supports);
        let motions = analyse(body, vec![]).unwrap();
        assert_eq!(motions, RigidMotions::default());
    }
}
