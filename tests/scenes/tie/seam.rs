//! Contact across a tie: two tied blocks press on a third as one block does.

use std::f64::consts::TAU;

use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use crate::support::blocks::{Blocks, joined, moved};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solution::{ContactPoint, Solution};
use crate::support::solver::{Case, solve, solve_steps};

const SCENE: &str = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.22}
bodies.base.material = 'rock'
bodies.left.material = 'rock'
bodies.right.material = 'rock'
[[displacement]]
on = 'base bottom'
x = 0.0
y = 0.0
[[step]]
[[step.pressure]]
on = ['left top', 'right top']
value = 1e6
[[step]]
[[step.pressure]]
on = ['left top', 'right top']
value = 1e6
[[step.traction]]
on = 'left left'
value = [3e5, 1e5]
[[contact]]
name = 'rests'
sides = [['left bottom', 'right bottom'], ['base top']]
";

const SEAM: &str = "
[[tie]]
name = 'seam'
sides = ['left right', 'right left']
";

/// Fails unless every point has the pressure and the status of the known point at its position.
#[track_caller]
fn has_pressures_of(points: &[ContactPoint], known: &[ContactPoint]) {
    has_about_pressures_of(points, known, 1e-6);
}

/// The same, with errors up to a part of the largest pressure.
#[track_caller]
fn has_about_pressures_of(points: &[ContactPoint], known: &[ContactPoint], slack: f64) {
    let largest = known
        .iter()
        .fold(0.0, |m: f64, point| m.max(point.pressure));
    for point in points {
        let is_here = |other: &&ContactPoint| {
            (0..3).all(|k| (other.position[k] - point.position[k]).abs() < 1e-9)
        };
        let near = known.iter().find(is_here);
        let near = near.unwrap_or_else(|| panic!("no point at {:?}", point.position));
        close(point.pressure, near.pressure, slack * largest);
        let is_round_off = near.pressure.max(point.pressure) < 1e-9 * largest;
        assert!(
            is_round_off || point.closed == near.closed,
            "{point:?}, {near:?}"
        );
    }
}

/// Two blocks with a seam at x = 1.4, `right` of them of this many cells, and one block of the same cells; beside both a
/// base of as many cells, if any.
fn blocks(right: usize, base: Option<usize>) -> [Mesh; 2] {
    let two = Blocks::new()
        .rectangle("left", [0.6, 1.4], [1.0, 2.0], [4, 5])
        .rectangle("right", [1.4, 2.0], [1.0, 2.0], [right, 5]);
    let one = two.clone().glued(|x, _| (x - 1.4).abs() < 1e-9);
    [two, one].map(|blocks| match base {
        Some(base) => {
            blocks
                .rectangle("base", [0.0, 3.0], [0.0, 1.0], [base, 4])
                .mesh
        }
        None => blocks.mesh,
    })
}

/// Both points at the seam have the pressure and the friction of the one point of a single block, also where measured
/// gaps differ by round-off, as in a scene that is turned.
#[test]
fn both_sides_of_a_seam_carry_the_pressure_of_one_block() {
    let (sin, cos) = 0.3_f64.sin_cos();
    for turned in [false, true] {
        let [two, one] = blocks(3, Some(15));
        let turn = |mesh| match turned {
            true => moved(mesh, |[x, y]| [cos * x - sin * y, sin * x + cos * y]),
            false => mesh,
        };
        for law in [
            "friction = 0.3",
            "friction = 0.2\ncohesion = 5e4",
            "tresca = 3e5",
        ] {
            let tied = model(&format!("{SCENE}{law}\n{SEAM}"), turn(two.clone()));
            let glued = model(&format!("{SCENE}{law}\n"), turn(one.clone()));
            let expected = solve_steps(&glued, 3);
            for (solution, expected) in solve_steps(&tied, 5).iter().zip(&expected) {
                solution.check_certificate();
                let (points, known) = (&solution.contacts["rests"], &expected.contacts["rests"]);
                assert_eq!(points.len(), known.len() + 1);
                has_pressures_of(points, known);
            }
        }
    }
}

/// A facet of the base lies across the seam, and both points there have the mean of what is opposite them.
#[test]
fn a_facet_across_the_seam_carries_the_pressure_of_one_block() {
    let [two, one] = blocks(3, Some(13));
    for law in ["friction = 0.3", "friction = 0.2\ncohesion = 5e4"] {
        let tied = model(&format!("{SCENE}{law}\n{SEAM}"), two.clone());
        let glued = model(&format!("{SCENE}{law}\n"), one.clone());
        let expected = solve_steps(&glued, 3);
        for (solution, expected) in solve_steps(&tied, 5).iter().zip(&expected) {
            has_pressures_of(&solution.contacts["rests"], &expected.contacts["rests"]);
        }
    }
}

/// Both points at the seam have a law of their own; one block has their mean by areas there.
#[test]
fn friction_of_both_sides_acts_at_a_seam() {
    let [two, one] = blocks(4, None);
    let scene = |contacts: &str| {
        format!(
            "
plane = 'strain'
materials.rock = {{young = 20e9, poisson = 0.22}}
bodies.left.material = 'rock'
bodies.right.material = 'rock'
[[pressure]]
on = ['left top', 'right top']
value = 1e6
[[traction]]
on = 'left left'
value = [1.5e5, 1e5]
[[displacement]]
on = 'right right'
x = 0.0
{contacts}"
        )
    };
    let contact = |sides: &str, law: &str| {
        format!(
            "[[contact]]\nname = 'rests {}'\nsides = [{sides}]\nobstacle = {{point = [0.0, 1.0], normal = [0.0, 1.0]}}\n{law}\n",
            sides.len()
        )
    };
    let mut slipping = 0;
    // The numbers of the left law, and those of the right one: friction, cohesion, Tresca's bound.
    for [left, right] in [
        [[0.3, 0.0, 0.0], [0.2, 0.0, 0.0]],
        [[0.1, 0.0, 0.0], [0.3, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.3, 0.0, 0.0]],
        [[0.2, 4e4, 0.0], [0.3, 6e4, 0.0]],
        [[0.2, 4e4, 0.0], [0.3, 0.0, 0.0]],
        [[0.0, 0.0, 2e5], [0.0, 0.0, 1e5]],
    ] {
        let names = ["friction", "cohesion", "tresca"];
        let given = |k: usize| left[k] + right[k] > 0.0;
        let law = |value: &dyn Fn(usize) -> String| -> String {
            let keys = (0..3).filter(|&k| given(k));
            keys.map(|k| format!("{} = {}\n", names[k], value(k)))
                .collect()
        };
        let of_left = contact("['left bottom']", &law(&|k| left[k].to_string()));
        let of_right = contact("['right bottom']", &law(&|k| right[k].to_string()));
        let part = 0.075 / 0.175;
        let mean = |k: usize| {
            let step = right[k] - left[k];
            format!(
                "'{} + ({step})*min(1, max(0, {part} + 20*(x - 1.4)))'",
                left[k]
            )
        };
        let of_one = contact("['left bottom', 'right bottom']", &law(&mean));
        let tied = model(&scene(&(of_left + &of_right + SEAM)), two.clone());
        let glued = model(&scene(&of_one), one.clone());
        let (found, expected) = (solve(&tied, 4), solve(&glued, 3));
        let known = &expected.contacts["rests 31"];
        let points: Vec<ContactPoint> = ["rests 15", "rests 16"]
            .iter()
            .flat_map(|name| found.contacts[*name].clone())
            .collect();
        assert_eq!(points.len(), known.len() + 1);
        has_pressures_of(&points, known);
        slipping += known.iter().filter(|point| point.slipping).count();
        for point in known {
            let here = points
                .iter()
                .filter(|of| (of.position[0] - point.position[0]).abs() < 1e-9);
            let force: f64 = here.map(|of| of.tangential_force[0]).sum();
            close(force, point.tangential_force[0], 1e-6 * 2e5);
        }
    }
    assert!(slipping > 4, "{slipping}");
}

/// A ring of two halves, tied, shrunk onto a hub: a node at a seam has the normal of the whole ring, so that the ring turns
/// on the hub.
#[test]
fn a_ring_of_tied_halves_is_one_ring() {
    let arc = |blocks: Blocks, name: &str, [inner, outer]: [f64; 2], [from, to]: [f64; 2], n| {
        blocks.mapped(name, n, |[s, t]| {
            let (sin, cos) = (TAU * (from + (to - from) * t)).sin_cos();
            [cos, sin].map(|c| (inner + (outer - inner) * s) * c)
        })
    };
    let scene = |sides: &str, law: &str| {
        format!(
            "
plane = 'stress'
materials.steel = {{young = 20e9, poisson = 0.3}}
bodies.hub.material = 'steel'
bodies.upper = {{material = 'steel', body_force = ['4e6*x', '4e6*y']}}
bodies.lower = {{material = 'steel', body_force = ['4e6*x', '4e6*y']}}
[[displacement]]
on = 'hub left'
x = 0.0
y = 0.0
[[contact]]
name = 'rests'
sides = [{sides}]
gap = -1e-3
{law}
"
        )
    };
    let halves = "\n[[tie]]\nname = 'seams'\nsides = [['upper top', 'upper bottom'], ['lower bottom', 'lower top']]\n";
    for around in [24, 30] {
        let outer = [1.0, 1.6];
        let two = arc(Blocks::new(), "upper", outer, [0.0, 0.5], [4, 12]);
        let two = arc(two, "lower", outer, [0.5, 1.0], [4, 12]);
        let one = two.clone().glued(|_, y| y.abs() < 1e-9);
        let hub = Blocks::new().ring("hub", [0.5, 1.0], [3, around]);
        for sides in [
            "['upper left', 'lower left'], 'hub right'",
            "'hub right', ['upper left', 'lower left']",
        ] {
            for law in ["", "friction = 0.3"] {
                let text = scene(sides, law);
                let tied = model(
                    &(text.clone() + halves),
                    joined(hub.mesh.clone(), two.mesh.clone()),
                );
                let glued = model(&text, joined(hub.mesh.clone(), one.mesh.clone()));
                let (found, expected) = (solve(&tied, 6), solve(&glued, 5));
                // Facets of a hub that doesn't match are projected along normals of each half.
                let slack = if around == 24 { 1e-6 } else { 1e-3 };
                let (points, known) = (&found.contacts["rests"], &expected.contacts["rests"]);
                has_about_pressures_of(points, known, slack);
                let turns = |of: &Solution| of.report["warnings"].to_string().contains("rotation");
                assert_eq!([turns(&found), turns(&expected)], [law.is_empty(); 2]);
            }
        }
    }
}

/// Two tied beams, or one, that lie on a base and may slide.
fn beams() -> [Model; 2] {
    let two = Blocks::new()
        .rectangle("left", [-2.0, 0.1], [1.0, 1.3], [21, 3])
        .rectangle("right", [0.1, 2.0], [1.0, 1.3], [19, 3]);
    let one = two.clone().glued(|x, _| (x - 0.1).abs() < 1e-9);
    let text = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.22}
materials.soft = {young = 5e9, poisson = 0.22}
bodies.base.material = 'soft'
bodies.left.material = 'rock'
bodies.right.material = 'rock'
[[displacement]]
on = 'base bottom'
x = 0.0
y = 0.0
[[pressure]]
on = ['left top', 'right top']
value = '1e6*exp(-4*(x - 0.4)^2)'
[[contact]]
name = 'rests'
sides = [['left bottom', 'right bottom'], ['base top']]
";
    let [two, one] = [two, one].map(|blocks| {
        blocks
            .rectangle("base", [-3.0, 3.0], [0.0, 1.0], [60, 8])
            .mesh
    });
    [model(&format!("{text}{SEAM}"), two), model(text, one)]
}

/// Motions of tied bodies are motions of both; one that no contact resists has no load either.
#[test]
fn tied_bodies_that_slide_take_no_more_sweeps_than_one() {
    let [tied, glued] = beams();
    let expected = solve(&glued, 4);
    for count in [4, 12] {
        let found = solve(&tied, count);
        has_pressures_of(&found.contacts["rests"], &expected.contacts["rests"]);
        assert_eq!(found.report["fallbacks"].as_array().unwrap().len(), 0);
        assert!(
            found.sweeps() <= expected.sweeps() + 1,
            "{}",
            found.sweeps()
        );
    }
}

#[test]
fn closed_points_are_counted_one_by_one() {
    let [tied, _] = beams();
    for args in [&[][..], &["--interface", "iterative"]] {
        let case = Case::in_clusters(&tied, 12, 5);
        for ranks in [0, 1, 2, 3] {
            let ended = case.run_on(ranks, args);
            assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
            let solution = Solution::read(&case.result());
            let points = &solution.contacts["rests"];
            let closed = points.iter().filter(|point| point.closed).count();
            assert_eq!(solution.report["contacts"][0]["closed"], closed);
            assert_eq!(solution.report["active_contacts"], closed);
            let words = format!("{closed} of {} conditions are closed", points.len());
            assert!(ended.stdout.contains(&words), "{}", ended.stdout);
        }
    }
}
