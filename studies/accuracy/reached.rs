//! The time at which a series reaches an error.

use super::timed::Timed;

/// The error in the norm of the energy that elements are compared at.
pub const GOAL: f64 = 1e-2;

/// Dofs and run times at which an error is reached.
#[derive(Clone, Copy, Debug)]
pub struct Reached {
    pub dofs: f64,
    /// The whole run on 1 rank, its solve phases, and the whole run on 2 ranks (s).
    pub seconds: [f64; 3],
    /// Whether the coarsest mesh has a smaller error, so that less would do.
    pub is_coarsest: bool,
}

/// The point at which the meshes of a series, coarse to fine, reach the goal, by straight lines between logarithms;
/// `None` where not even the finest does.
pub fn reached(meshes: &[&Timed]) -> Option<Reached> {
    let of = |mesh: &Timed| Reached {
        dofs: mesh.dofs as f64,
        seconds: [mesh.total(1), mesh.solve(), mesh.total(2)],
        is_coarsest: false,
    };
    let first = meshes.iter().position(|mesh| mesh.errors[0] <= GOAL)?;
    let (fine, error) = (of(meshes[first]), meshes[first].errors[0]);
    let Some(before) = first.checked_sub(1) else {
        return Some(Reached {
            is_coarsest: true,
            ..fine
        });
    };
    let (coarse, larger) = (of(meshes[before]), meshes[before].errors[0]);
    let way = (larger / GOAL).ln() / (larger / error).ln();
    let between = |a: f64, b: f64| a * (b / a).powf(way);
    Some(Reached {
        dofs: between(coarse.dofs, fine.dofs),
        seconds: [0, 1, 2].map(|i| between(coarse.seconds[i], fine.seconds[i])),
        is_coarsest: false,
    })
}
