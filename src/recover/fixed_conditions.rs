//! What the conditions of a contact group do in the linear problem of a fixed active set, and what its solution changes.
//!
//! A point that slips in a plane has λ_t = b e. With the slip s, whatever r > 0 and ξ = λ_t + r s, Newton's method has
//!
//! ```text
//! e = ξ/|ξ|,    λ_t = b e + κ P s,    P = I − e eᵀ,    κ = r b/(|ξ| − b)
//! ```
//!
//! at the next place, where κ P s is what is left of its direction.

use crate::contact::friction::{Status, TangentialCondition};
use crate::fem::contact_group::ContactGroup;
use crate::recover::GroupSolution;
use crate::tree::slip_law::AT_BOUND;

/// Angle between force and slip, about, beyond which the slip is too small to tell its direction.
const TOLD: f64 = 0.1;

/// The statuses of the conditions of a group, what the closed ones lack (m), and what slipping ones have of their point's
/// bound, and κ; the forces of what slips in a plane become those that its slip says.
pub fn conditions(
    group: &ContactGroup,
    solution: &mut GroupSolution,
    prescribed: &[bool],
) -> Vec<(Status, [f64; 2])> {
    let both = solution.closed.iter().zip(&solution.gaps);
    let mut conditions: Vec<(Status, [f64; 2])> = both
        .map(|(&closed, gap)| (Status::new(!closed), [if closed { *gap } else { 0.0 }, 0.0]))
        .collect();
    for of_point in group.friction().chunk_by(|a, b| a.normal == b.normal) {
        let TangentialCondition { normal, bound, .. } = of_point[0];
        let size = size(of_point, solution);
        let is_closed = solution.closed[normal];
        let bound = bound.at(solution.forces[normal], is_closed);
        let parts = is_closed && size < AT_BOUND * bound;
        if let [first, second] = of_point
            && let pair = [first.number, second.number]
            && pair.iter().all(|&j| !solution.closed[j] && !prescribed[j])
            && size > 0.0
            && !parts
        {
            let r = group.stiffness_at(normal);
            let (direction, turns) = turned(solution, pair, bound, r);
            for (j, e) in pair.into_iter().zip(direction) {
                conditions[j] = (Status::Forward, [e, turns]);
            }
            continue;
        }
        for one in of_point.iter().filter(|one| !solution.closed[one.number]) {
            let force = solution.forces[one.number];
            conditions[one.number] = match force {
                0.0 => continue,
                _ if parts && of_point.len() == 1 => (Status::Parting, [0.0; 2]),
                _ if parts => continue,
                ahead if ahead > 0.0 => (Status::Forward, [ahead / size, 0.0]),
                back => (Status::Backward, [-back / size, 0.0]),
            };
        }
    }
    conditions
}

/// e and κ of a point that slips along both tangents, under a force that becomes b e + κ P s; as it is, with κ = 0, where the
/// slip doesn't tell.
fn turned(solution: &mut GroupSolution, pair: [usize; 2], bound: f64, r: f64) -> ([f64; 2], f64) {
    let force = pair.map(|j| solution.forces[j]);
    let slip = pair.map(|j| -solution.gaps[j]);
    let xi = [0, 1].map(|k| force[k] + r * slip[k]);
    let size = xi[0].hypot(xi[1]);
    let e = xi.map(|xi| xi / size);
    let along = slip[0] * e[0] + slip[1] * e[1];
    let across = [0, 1].map(|k| slip[k] - along * e[k]);
    let turns = r * bound / (size - bound);
    if !(turns > 0.0 && turns * across[0].hypot(across[1]) <= TOLD * bound) {
        let size = force[0].hypot(force[1]);
        return (force.map(|force| force / size), 0.0);
    }
    for k in 0..2 {
        solution.forces[pair[k]] = bound * e[k] + turns * across[k];
    }
    (e, turns)
}

/// Changes the forces of a contact group, whose conditions have these statuses: none holds its sides together, and
/// friction stays at its bound.
pub fn change_forces(
    group: &ContactGroup,
    solution: &mut GroupSolution,
    conditions: &[(Status, [f64; 2])],
    prescribed: &[bool],
    changes: &[f64],
) {
    let normals = group.points.len();
    for (j, (force, change)) in solution.forces.iter_mut().zip(changes).enumerate() {
        if j < normals {
            *force = (*force + change).max(0.0);
        } else if group.dim == 2 || !prescribed[j] {
            *force += change;
        }
    }
    for of_point in group.friction().chunk_by(|a, b| a.normal == b.normal) {
        let TangentialCondition { normal, bound, .. } = of_point[0];
        let slips = of_point.iter().any(|one| !solution.closed[one.number]);
        let parts =
            group.dim == 3 && (of_point.iter()).all(|one| conditions[one.number].0 == Status::Open);
        let bound = bound.at(solution.forces[normal], solution.closed[normal]);
        let size = size(of_point, solution);
        for one in of_point.iter().filter(|_| slips && !parts && size != 0.0) {
            solution.forces[one.number] *= bound / size;
        }
    }
}

/// |λ_t| of a point.
fn size(of_point: &[TangentialCondition], solution: &GroupSolution) -> f64 {
    let forces = of_point.iter().map(|one| solution.forces[one.number]);
    match of_point {
        [one] => solution.forces[one.number].abs(),
        _ => forces.map(|force| force.powi(2)).sum::<f64>().sqrt(),
    }
}
