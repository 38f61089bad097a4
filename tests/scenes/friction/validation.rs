//! Scenes with friction and exact or well-known solutions; docs/validation.md has the long form.

use crate::support::close::close;
use crate::support::solver::solve;
use crate::support::validation::{crack, mindlin, raous, roller};

#[test]
fn raous_plate_is_open_slips_and_sticks_where_it_should() {
    raous::case().check();
}

#[test]
fn cylinders_pushed_to_and_fro_follow_cattaneo_mindlin_and_deresiewicz() {
    mindlin::case().check();
}

#[test]
fn a_closed_crack_with_friction_slips_as_much_less_as_it_should() {
    crack::with_friction().check();
}

#[test]
fn the_nafems_roller_with_friction_presses_as_it_should() {
    roller::with_friction().check();
}

/// cot 20° = 2.747: below it the crack slips slightly, above not at all.
#[test]
fn a_closed_crack_sticks_above_its_threshold() {
    for (friction, sticks) in [(2.74, false), (2.75, true), (5.0, true)] {
        let (model, exact) = crack::stuck(friction);
        let solution = solve(&model, 5);
        let slipping = solution.points().filter(|point| point.slipping).count();
        let count = solution.points().count();
        assert_eq!(slipping, if sticks { 0 } else { count }, "{friction}");
        if sticks {
            close(exact.energy_error(&model, &solution), 0.0, 1e-10);
        }
    }
}
