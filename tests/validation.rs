//! Scenes with exact answers: errors and observed orders, the short form of docs/validation.md.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod support;

use support::validation::{beam, crack, hertz, hole, punch, roller, signorini, uniform};

#[test]
fn uniform_compression_passes_through_matching_nodes() {
    uniform::patch().check();
}

#[test]
fn a_uniform_pressure_passes_between_cells_of_all_kinds_that_do_not_match() {
    uniform::uneven().check();
}

#[test]
fn uniform_compression_passes_through_three_contacts_that_meet() {
    uniform::junction().check();
}

#[test]
fn a_cylinder_on_a_plane_converges_to_hertz() {
    hertz::on_an_obstacle().check();
}

#[test]
fn a_cylinder_on_a_cylinder_converges_to_hertz() {
    hertz::body_on_body().check();
}

#[test]
fn a_cylinder_on_a_cylinder_whose_nodes_do_not_match_converges_to_hertz() {
    hertz::uneven_bodies().check();
}

#[test]
fn the_nafems_roller_presses_as_it_should() {
    roller::case().check();
}

#[test]
fn a_closed_crack_slips_as_much_as_it_should() {
    crack::case().check();
}

#[test]
fn a_flat_punch_presses_most_at_its_corners() {
    punch::case().check();
}

#[test]
fn a_chosen_solution_with_contact_and_gap_is_found() {
    signorini::case().check();
}

#[test]
fn a_cantilever_bends_as_beams_do() {
    beam::case().check();
}

#[test]
fn stress_beside_a_hole_is_three_times_the_tension() {
    hole::case().check();
}
