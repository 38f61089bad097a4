//! Squares and cubes for tests.

use contact_dd_partition::scene::units::Units;

use super::scene::{BodyState, Friction, RigidRow, Scene};
use crate::contact::friction::ForceBound;
use crate::fem::body_frame::BodyFrame;

/// A body in this bounding box: plane if its load has three components, spatial if it has six.
pub fn body(low: [f64; 3], high: [f64; 3], load: &[f64]) -> BodyState {
    BodyState {
        frame: BodyFrame::new(low, high),
        units: Units::Metre,
        supports: Vec::new(),
        has_springs: false,
        load: load.to_vec(),
        load_scale: load.iter().map(|f| f.abs()).sum(),
        candidates: vec![(0, 0, low), (0, 1, high)],
    }
}

/// A square with sides of 2 about the origin.
pub fn square(load: [f64; 3]) -> BodyState {
    body([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0], &load)
}

impl BodyState {
    /// This body, supported at `x` along an axis with the prescribed displacement `value`.
    pub fn held(mut self, x: [f64; 3], along: [f64; 3], value: f64) -> Self {
        let mut row = self.frame.action(2, &x, &along);
        row.push(value);
        self.supports.push(row);
        self
    }

    /// A closed constraint of this body, number `b`, along a direction at `x`.
    pub fn row(&self, b: usize, x: [f64; 3], along: [f64; 3]) -> RigidRow {
        let dim = if self.load.len() == 6 { 3 } else { 2 };
        RigidRow {
            is_tied: false,
            bodies: vec![(b, self.frame.action(dim, &x, &along))],
            gap: 0.0,
            friction: None,
        }
    }
}

impl RigidRow {
    /// This constraint with a gap.
    pub fn open(self, gap: f64) -> Self {
        Self { gap, ..self }
    }

    /// This constraint as the tangential one of a point whose normal constraint has this number.
    pub fn rough(self, normal: usize, bound: ForceBound) -> Self {
        let friction = Some(Friction { normal, bound });
        Self { friction, ..self }
    }
}

/// Bodies named brick 0, brick 1 and so on, with their constraints.
pub fn scene(dim: usize, bodies: Vec<BodyState>, rows: Vec<RigidRow>) -> Scene {
    Scene {
        dim,
        names: (0..bodies.len()).map(|b| format!("brick {b}")).collect(),
        conditions: vec![rows.len()],
        bodies,
        rows,
    }
}

/// Coulomb's bound.
pub fn coulomb(coefficient: f64) -> ForceBound {
    ForceBound {
        coefficient,
        cohesion: 0.0,
        only_closed: true,
    }
}
