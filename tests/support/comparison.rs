//! Comparison of a solution with the reference.

use contact_dd_partition::model::Model;

use super::assembled::Assembled;
use super::monolithic::Monolithic;
use super::scenes::at_step;
use super::solution::Solution;
use super::stress::judge::Findings;

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
            // The status is arbitrary at a point with neither gap nor force.
            if gap_ref > 1e-11 * size || force_ref > 1e-10 * force {
                assert_eq!(point.closed, force_ref > 0.0, "{at}: {point:?}");
            }
            row += 1;
        }
    }
}

/// The judge's worst findings in the increments of a model: each increment has to fulfil the laws of contact and
/// friction, and to be the solution for its own statuses.
pub fn judged(model: &Model, increments: &[Solution]) -> Findings {
    assert_eq!(increments.len(), model.steps.len().max(1));
    let of_step = |(k, solution): (usize, &Solution)| {
        let model = match model.steps.is_empty() {
            true => model.clone(),
            false => at_step(model, k),
        };
        let before = k.checked_sub(1).map(|k| &increments[k]);
        Findings::after(before, &model, &Assembled::new(&model), solution, true)
    };
    let all = increments.iter().enumerate().map(of_step);
    all.reduce(Findings::or).unwrap()
}

#[track_caller]
fn close(a: f64, b: f64, slack: f64, at: &str) {
    assert!((a - b).abs() <= slack, "{at}: {a:e}; expected {b:e}");
}
