//! Shapes of single examples.

use std::collections::BTreeSet;

use contact_dd_partition::example;
use contact_dd_partition::scene::Scene;
use contact_dd_partition::scene::contact::Declaration;

use super::{key, length, mesh_of, nodes_of};

#[test]
fn the_granite_block_is_the_papers_and_its_own_mirror_image() {
    let mesh = mesh_of("granite", 0);
    assert_eq!(mesh.cells.len(), 4880);
    for (side, exact) in [
        ("bottom", 10.0),
        ("lower right", 6.5),
        ("upper right", 3.5),
        ("top", 10.0),
        ("upper left", 3.5),
        ("lower left", 6.5),
        ("left crack lower", 11.25_f64.sqrt()),
        ("right crack upper", 11.25_f64.sqrt()),
    ] {
        assert!((length(&mesh, side) - exact).abs() < 1e-12, "{side}");
    }
    let triangle = |cell: usize, mirror: bool| {
        let nodes = mesh.cells.nodes_of(cell).iter();
        let mut corners: Vec<[i64; 2]> = nodes
            .map(|&n| {
                let [x, y, z] = mesh.points[n as usize];
                key([if mirror { 10.0 - x } else { x }, y, z])
            })
            .collect();
        corners.sort_unstable();
        corners
    };
    let all = |mirror| -> BTreeSet<_> { (0..4880).map(|c| triangle(c, mirror)).collect() };
    assert_eq!(all(false), all(true));
}

#[test]
fn every_joint_of_the_wall_has_bricks_on_both_sides() {
    let mesh = mesh_of("wall", 0);
    let places = |side: &str| -> BTreeSet<[i64; 2]> {
        let nodes = nodes_of(&mesh, side).into_iter();
        nodes.map(|n| key(mesh.points[n as usize])).collect()
    };
    for course in 1..=5 {
        let sides = ["above", "below"].map(|side| format!("bed joint {course} {side}"));
        assert_eq!(places(&sides[0]), places(&sides[1]));
        assert!((length(&mesh, &sides[0]) - 1.25).abs() < 1e-12);
    }
    for course in 1..=6 {
        let sides = ["left", "right"].map(|side| format!("head joints {course} {side}"));
        assert_eq!(places(&sides[0]), places(&sides[1]));
        let joints = if course % 2 == 1 { 4.0 } else { 5.0 };
        assert!((length(&mesh, &sides[0]) - 0.125 * joints).abs() < 1e-12);
    }
}

/// An involute of the base circle r_b that passes a point keeps φ ± (tan a − a), where φ is the angle of
/// a point as seen from the axis and cos a = r_b/r. Gmsh's spline is off by some nanometres, most at the base
/// circle, where the curvature of an involute has no bound.
#[test]
fn flanks_of_the_gears_are_involutes_that_touch_on_the_line_of_action() {
    let (module, alpha) = (5e-3, 20_f64.to_radians());
    let radii = [17.0, 24.0].map(|teeth| 0.5 * module * teeth);
    let base_pitch = std::f64::consts::PI * module * alpha.cos();
    let mesh = mesh_of("gears", 0);
    for (side, along) in [
        ("approach", -0.5 * base_pitch),
        ("recess", 0.5 * base_pitch),
    ] {
        let touching = [radii[0] + along * alpha.sin(), along * alpha.cos()];
        for (gear, axis, radius) in [
            ("pinion", 0.0, radii[0]),
            ("wheel", radii[0] + radii[1], radii[1]),
        ] {
            let base = radius * alpha.cos();
            let start = |x: f64, y: f64| {
                // The wheel turned by half a turn looks as the pinion does.
                let (x, y) = if axis > 0.0 { (axis - x, -y) } else { (x, y) };
                let a = (base / x.hypot(y)).min(1.0).acos();
                (y.atan2(x) + a.tan() - a, x.hypot(y))
            };
            let (expected, _) = start(touching[0], touching[1]);
            let flank = nodes_of(&mesh, &format!("{gear} flank in {side}"));
            for &node in &flank {
                let [x, y, _] = mesh.points[node as usize];
                let (found, r) = start(x, y);
                assert!(
                    ((found - expected) * base).abs() < 3e-8,
                    "{gear} in {side} at radius {r}: {}",
                    (found - expected) * base
                );
            }
            assert!(flank.len() > 40);
        }
    }
}

#[test]
fn the_granite_block_with_friction_is_the_granite_block_but_for_friction() {
    let [plain, rough] = ["granite", "granite-friction"].map(|name| example::find(name).unwrap());
    assert_eq!(plain.mesh(1).unwrap(), rough.mesh(1).unwrap());
    let mut scene = Scene::parse(rough.scene).unwrap();
    for contact in &mut scene.contact {
        let Declaration::Contact(contact) = contact else {
            panic!("told by its sides");
        };
        assert!(contact.friction.take().is_some());
    }
    let expected = Scene::parse(plain.scene).unwrap();
    scene.title.clone_from(&expected.title);
    assert_eq!(scene, expected);
}
