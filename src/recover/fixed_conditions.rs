//! Contact constraints of a group in the linear problem of a fixed active set, and the change of its solution.
//!
//! A point that slips in a plane has λ_t = b e. With the slip s, any r > 0 and ξ = λ_t + r s, Newton's method has
//!
//! ```text
//! e = ξ/|ξ|,    λ_t = b e + κ P s,    P = I − e eᵀ,    κ = r b/(|ξ| − b)
//! ```
//!
//! at the next iterate, where κ P s is the remaining error of its direction.

use crate::contact::law::{PointLaw, PointState, PointStatus};
use crate::contact::status::FixedStatus;
use crate::fem::contact_group::ContactGroup;
use crate::recover::GroupSolution;

/// Approximate angle between force and slip beyond which the slip is too small to determine its direction.
const RELIABLE_ANGLE: f64 = 0.1;

/// The conditions of a group in the linear problem; forces of points that slip in a plane are aligned with their slips.
pub fn conditions(
    group: &ContactGroup,
    solution: &mut GroupSolution,
    prescribed: &[bool],
) -> Vec<FixedStatus> {
    let mut conditions = solution.fixed_statuses();
    for point in group.point_laws() {
        let here = solution.point(&point);
        let size = here.size();
        let parts = solution.parts(&point);
        let in_a_plane = !point.is_along_a_line();
        let turns = in_a_plane
            && point
                .limits()
                .all(|j| !solution.closed[j] && !prescribed[j]);
        if turns && size > 0.0 && !parts {
            let (direction, turning) = turned(solution, &point, here);
            for (share, j) in direction.into_iter().zip(point.limits()) {
                conditions[j] = FixedStatus::Slips { share, turning };
            }
            continue;
        }
        for j in point.limits().filter(|&j| !solution.closed[j]) {
            conditions[j] = match solution.forces[j] {
                0.0 => continue,
                force if !parts => FixedStatus::Slips {
                    share: force / size,
                    turning: 0.0,
                },
                _ if in_a_plane => continue,
                _ => FixedStatus::Parts,
            };
        }
    }
    conditions
}

/// e and κ of a point that slips along both tangents, whose force becomes b e + κ P s; if the slip doesn't determine
/// the direction, the force stays and κ = 0.
fn turned(solution: &mut GroupSolution, point: &PointLaw, here: PointState) -> ([f64; 2], f64) {
    let PointState { slip, force, bound } = here;
    if let PointStatus::Slips {
        direction: e,
        turning,
    } = point.status(&here, 0.0)
    {
        let along = slip[0] * e[0] + slip[1] * e[1];
        let across = [0, 1].map(|k| slip[k] - along * e[k]);
        if turning > 0.0 && turning * across[0].hypot(across[1]) <= RELIABLE_ANGLE * bound {
            for (k, j) in point.limits().enumerate() {
                solution.forces[j] = bound * e[k] + turning * across[k];
            }
            return (e, turning);
        }
    }
    (force.map(|force| force / here.size()), 0.0)
}

/// Changes the forces of a contact group whose conditions have these statuses: only a tie's may be tensile, and
/// friction stays at its bound.
pub fn change_forces(
    group: &ContactGroup,
    solution: &mut GroupSolution,
    conditions: &[FixedStatus],
    prescribed: &[bool],
    changes: &[f64],
) {
    let normals = group.points.len();
    let all = solution.forces.iter_mut().zip(changes).enumerate();
    for ((j, (force, change)), condition) in all.zip(group.conditions()) {
        if condition.is_tied {
            *force += change;
        } else if j < normals {
            *force = (*force + change).max(0.0);
        } else if group.dim == 2 || !prescribed[j] {
            *force += change;
        }
    }
    for point in group.point_laws() {
        let here = solution.point(&point);
        let slips = point.limits().any(|j| !solution.closed[j]);
        let is_open = |j: usize| conditions[j] == FixedStatus::Open;
        let parts = group.dim == 3 && point.limits().all(is_open);
        if slips && !parts && here.size() != 0.0 {
            let part = here.bound / here.size();
            point.limits().for_each(|j| solution.forces[j] *= part);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recover::group_solution::tests::{COULOMB, group, pressed};

    /// A force of constant size b along the slip s turns by b/|s| times the slip's change across it.
    #[test]
    fn a_force_turns_with_the_slip_as_one_of_constant_size() {
        let (group, slip) = (group(COULOMB), [-3e-3, -4e-3]);
        let mut solution = pressed([1.2, 1.6], slip, false);
        let fixed = conditions(&group, &mut solution, &[false; 3]);
        assert_eq!(fixed[0], FixedStatus::Closed { distance: 0.0 });
        for (fixed, (share, force)) in fixed[1..].iter().zip([(0.6, 1.2), (0.8, 1.6)]) {
            let [e, turning] = fixed.slip().unwrap();
            assert!((e - share).abs() < 1e-13, "{e}");
            assert!((turning - 2.0 / 5e-3).abs() < 1e-9, "{turning}");
            assert!((solution.forces.iter().any(|f| (f - force).abs() < 1e-13)));
        }
        change_forces(&group, &mut solution, &fixed, &[false; 3], &[2.0, 0.0, 0.0]);
        let size = solution.forces[1].hypot(solution.forces[2]);
        assert!((size - 3.0).abs() < 1e-13, "{size}");
    }
}
