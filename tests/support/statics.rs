//! Consequences of equilibrium only.

use contact_dd_partition::mesh::Mesh;

use super::solution::ContactPoint;

/// Force on side a of a contact and its moment about the origin: (x, y, moment) [N/m, N].
pub fn reaction<'a>(points: impl IntoIterator<Item = &'a ContactPoint>) -> [f64; 3] {
    points.into_iter().fold([0.0; 3], |[x, y, m], point| {
        let force = [0, 1].map(|i| -point.force * point.normal[i]);
        let moment = point.position[0] * force[1] - point.position[1] * force[0];
        [x + force[0], y + force[1], m + moment]
    })
}

/// Area of a group of cells [m²].
pub fn area(mesh: &Mesh, group: &str) -> f64 {
    let cells = mesh.groups[group].members.iter();
    cells.map(|&cell| mesh.measure(cell as usize)).sum()
}

/// Fails unless both forces agree to within `slack`.
#[track_caller]
pub fn balanced(found: [f64; 3], expected: [f64; 3], slack: f64) {
    let close = (found.iter().zip(expected)).all(|(f, e)| (f - e).abs() <= slack);
    assert!(close, "{found:?}; expected {expected:?} ± {slack:e}");
}
