//! A solution against the reference.

use contact_dd_partition::model::Model;

use super::assembled::Along;
use super::frictional::Frictional;
use super::monolithic::Monolithic;
use super::solution::{ContactPoint, Solution};

/// Fails unless displacement, forces, pressures, gaps and status are those of the reference.
#[track_caller]
pub fn compare(model: &Model, reference: &Monolithic, solution: &Solution) {
    let difference = reference.energy_difference(&solution.dofs(model));
    assert!(difference <= 1e-11, "energy difference {difference:e}");
    let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let (size, force) = (largest(&reference.u), largest(&reference.forces));
    let mut row = 0;
    for contact in &model.contacts {
        let points = &solution.contacts[&contact.name];
        assert_eq!(points.len(), contact.points.len(), "{}", contact.name);
        for (point, condition) in points.iter().zip(&contact.points) {
            let (gap_ref, force_ref) = (reference.gaps[row], reference.forces[row]);
            let at = format!("{} at {:?}", contact.name, point.position);
            assert_eq!(point.tags, [condition.tag_a, condition.tag_b], "{at}");
            close(point.gap, gap_ref, 1e-11 * size, &at);
            close(point.force, force_ref, 1e-10 * force, &at);
            let pressure = force_ref / condition.area;
            close(
                point.pressure,
                pressure,
                1e-10 * force / condition.area,
                &at,
            );
            // What carries neither gap nor force may be either.
            if gap_ref > 1e-11 * size || force_ref > 1e-10 * force {
                assert_eq!(point.closed, force_ref > 0.0, "{at}: {point:?}");
            }
            row += 1;
        }
    }
}

/// Fails unless every increment is that of the reference with friction.
#[track_caller]
pub fn compare_friction(model: &Model, reference: &[Frictional], solutions: &[Solution]) {
    assert_eq!(reference.len(), solutions.len());
    for (k, (expected, solution)) in reference.iter().zip(solutions).enumerate() {
        let (assembled, solved) = (&expected.assembled, &expected.solved);
        let u = solution.dofs(model);
        let difference = assembled.energy_difference(&solved.u, &u);
        assert!(difference <= 1e-11, "{k}: energy difference {difference:e}");
        let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let (size, force) = (largest(&solved.u), largest(&solved.forces));
        let points = model
            .contacts
            .iter()
            .flat_map(|c| &solution.contacts[&c.name]);
        let points: Vec<&ContactPoint> = points.collect();
        for (point, expected) in points.iter().zip(&solved.forces) {
            let at = format!("{k}, normal, {:?}", point.position);
            close(point.force, *expected, 1e-10 * force, &at);
        }
        for (t, tangent) in assembled.tangents.iter().enumerate() {
            let point = points[tangent.condition];
            let at = format!("{k}, tangential, {:?}", point.position);
            for axis in 0..2 {
                let along = tangent.direction[axis];
                let [expected, slip] = [-solved.tangential[t], tangent.jump(&solved.u)];
                close(
                    point.tangential_force[axis],
                    expected * along,
                    1e-10 * force,
                    &at,
                );
                close(point.slip[axis], slip * along, 1e-11 * size, &at);
            }
            assert_eq!(point.closed, expected.closed[tangent.condition], "{at}");
            let slips = matches!(expected.along[t], Along::Slips(_));
            assert_eq!(point.slipping, slips && point.closed, "{at}: {point:?}");
        }
    }
}

#[track_caller]
fn close(a: f64, b: f64, slack: f64, at: &str) {
    assert!((a - b).abs() <= slack, "{at}: {a:e}; expected {b:e}");
}
