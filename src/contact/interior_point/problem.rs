//! A convex contact problem: open or closed along normals, given friction along tangents.

use faer::MatRef;

use crate::contact::dependent::DependentConstraints;

/// The problem.
#[derive(Clone, Copy, Debug)]
pub struct ConvexProblem<'a> {
    /// H.
    pub h: MatRef<'a, f64>,
    /// c.
    pub c: &'a [f64],
    /// Scales of the diagonal of H.
    pub scale: &'a [f64],
    /// D.
    pub rows: &'a DependentConstraints,
    /// g, then d; for tangential limits the sticking positions.
    pub bounds: &'a [f64],
    /// Points with given friction.
    pub points: &'a [GivenFriction],
}

/// A point with given friction.
#[derive(Clone, Copy, Debug)]
pub struct GivenFriction {
    /// Its tangential limits.
    pub limits: [Option<usize>; 2],
    /// Slip along the second tangent where that has no limit (m).
    pub prescribed: f64,
    /// b (N/m).
    pub bound: f64,
}
