//! Scenes with exact solutions: errors and observed orders, the short form of docs/validation.md.

use contact_dd_partition::element::ElementKind::{Hexahedron20, Hexahedron27};

use crate::support::solution::Solution;
use crate::support::solver::{Case, problem};
use crate::support::sorts::sort;
use crate::support::validation::{
    beam, crack, hertz, hole, indentation, mindlin_in_space, punch, ring, roller, signorini, space,
    uniform,
};

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
fn a_ball_around_its_axis_converges_to_hertz() {
    ring::ball().check();
}

#[test]
fn balls_around_their_axis_whose_nodes_do_not_match_converge_to_hertz() {
    ring::balls().check();
}

#[test]
fn a_round_flat_punch_goes_as_deep_as_it_should() {
    ring::punch().check();
}

#[test]
fn a_chosen_solution_with_contact_and_gap_is_found() {
    signorini::case().check();
}

#[test]
fn a_ball_on_a_plate_presses_as_hertz_says() {
    space::ball().check();
}

#[test]
fn a_ball_on_a_ball_whose_curved_sides_do_not_match_presses_as_hertz_says() {
    space::balls().check();
}

/// Where a side ends before the other one, some facets are partly covered.
#[test]
fn no_point_of_curved_sides_is_much_nearer_to_the_other_side_than_its_place() {
    for kind in [Hexahedron20, Hexahedron27] {
        let points = problem(&space::two_balls(kind, 0), Some(2)).catalog.points;
        for point in points {
            let r: f64 = point.position[0].hypot(point.position[1]);
            let apart = 13.0 - (64.0 - r * r).sqrt() - (25.0 - r * r).sqrt();
            assert!(
                point.gap > 0.25 * apart - 1e-9,
                "{kind:?}: {} at {r}",
                point.gap
            );
        }
    }
}

#[test]
fn a_ball_in_space_converges_to_hertz() {
    indentation::ball().check();
}

#[test]
fn a_round_flat_punch_in_space_goes_as_deep_as_it_should() {
    indentation::punch().check();
}

#[test]
fn far_from_a_force_a_half_space_gives_way_as_boussinesq_says() {
    indentation::force().check();
}

#[test]
fn balls_pushed_along_their_contact_stick_where_mindlin_says() {
    mindlin_in_space::case().check();
}

#[test]
fn layers_of_a_thick_sphere_that_do_not_match_converge_to_lame() {
    space::layers().check();
}

#[test]
fn a_cantilever_bends_as_beams_do() {
    beam::case().check();
}

#[test]
fn stress_beside_a_hole_is_three_times_the_tension() {
    hole::case().check();
}

#[test]
fn the_default_tolerance_leaves_the_error_to_the_mesh() {
    let quad9 = sort("quad9");
    for posed in [
        hertz::posed_on_an_obstacle(quad9, 4, hertz::GRADING),
        signorini::posed("triangle6", 24),
    ] {
        let case = Case::new(&problem(&posed.model, Some(8)));
        let error = |solution: &Solution| posed.exact.energy_error(&posed.model, solution);
        let of_mesh = error(&case.solve(&["--tolerance", "1e-14"]));
        let slow = ["--method", "anderson"];
        for method in [&[][..], &slow] {
            let usual = error(&case.solve(method));
            assert!(
                (usual / of_mesh - 1.0).abs() < 1e-2,
                "{usual:e}, {of_mesh:e}"
            );
        }
        // A run limited to these sweeps, without the subsequent refinement.
        let sweeps = Solution::read(&case.result()).sweeps().to_string();
        let limits = ["--max-sweeps", &sweeps, "--tolerance", "1e-300"];
        let code = case.run(&[&slow[..], &limits].concat()).code();
        let solution = Solution::read(&case.result());
        // If the last sweep's residual is pure round-off, further sweeps have no effect.
        let residual = solution.report["interface_residual"].as_f64().unwrap();
        assert_eq!(code, if residual <= 1e-15 { 0 } else { 3 });
        let stopped = error(&solution);
        assert!(
            (stopped / of_mesh - 1.0).abs() < 1e-2,
            "{stopped:e}, {of_mesh:e}"
        );
    }
}
