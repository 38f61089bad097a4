//! Automatically detected contacts have the solutions of contacts declared by their sides.

use contact_dd_partition::element::ElementKind::{self, Hexahedron8, Tetrahedron4, Tetrahedron10};
use contact_dd_partition::mesh::Mesh;

use crate::support::blocks::{Blocks, joined};
use crate::support::close::close;
use crate::support::scenes::{BODIES, HELD, built_in, model};
use crate::support::solids::{between, moved, solid, turned};
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve};
use crate::support::sorts::sort;
use crate::support::statics::reaction;

/// Fails unless two solutions have the same displacements within `slack`, relative to the largest.
#[track_caller]
fn move_the_same(found: &Solution, explicit: &Solution, slack: f64) {
    let size = explicit.largest_displacement();
    assert_eq!(found.displacement.len(), explicit.displacement.len());
    for (tag, u) in &found.displacement {
        (u.iter().zip(explicit.displacement[tag])).for_each(|(a, b)| close(*a, b, slack * size));
    }
}

/// The forces of all points by their nodes, in either order of the sides.
fn forces(solution: &Solution) -> Vec<([i64; 2], f64)> {
    let mut forces: Vec<([i64; 2], f64)> = (solution.points())
        .map(|point| {
            let mut tags = point.tags;
            tags.sort_unstable();
            (tags, point.force)
        })
        .collect();
    forces.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    forces
}

/// A scene with one table that detects all its contacts of two sides, with these keys.
fn without_sides(scene: &str, keys: &str) -> String {
    let tables = scene
        .split("\n[[")
        .filter(|table| !table.starts_with("contact"));
    let kept: Vec<&str> = tables.collect();
    format!(
        "{}\n[[contact]]\nname = 'joints'\nbetween = 'all'\n{keys}",
        kept.join("\n[[")
    )
}

#[test]
fn built_in_scenes_are_solved_the_same() {
    for (name, keys) in [
        ("granite-friction", "gap = 0\nfriction = 0.6"),
        ("junction", "gap = 0"),
        ("cube-crack", "gap = 0"),
        ("stack3d", "gap = 0"),
    ] {
        let (scene, mesh) = built_in(name, 0);
        let explicit = solve(&model(scene, mesh.clone()), 6);
        let found = model(&without_sides(scene, keys), mesh);
        for ranks in [1, 3] {
            let case = Case::of(&found, 6);
            let ended = case.run_on(ranks, &[]);
            assert_eq!(ended.code(), 0, "{name}: {}{}", ended.stdout, ended.stderr);
            let solution = Solution::read(&case.result());
            move_the_same(&solution, &explicit, 1e-12);
            let (forces, expected) = (forces(&solution), forces(&explicit));
            assert_eq!(forces.len(), expected.len());
            for ((tags, force), (expected_tags, expected_force)) in forces.iter().zip(&expected) {
                assert_eq!(tags, expected_tags);
                close(*force, *expected_force, 1e-11 * explicit.largest_force());
            }
        }
    }
}

/// Two blocks beside each other under a third one, and a fourth one in contact with all three, under pressure and
/// shear, with non-matching meshes; with explicit contacts, whose side a belongs to the body whose name comes first.
fn heap(kind: ElementKind, [a, b, c, d]: [&str; 4]) -> (String, Mesh) {
    let mesh = [
        solid(a, kind, [3, 2, 2], between([0.0; 3], [1.0, 1.0, 0.5])),
        solid(
            b,
            kind,
            [2, 3, 2],
            between([1.0, 0.0, 0.0], [2.0, 1.0, 0.5]),
        ),
        solid(
            c,
            kind,
            [4, 2, 1],
            between([0.3, 0.2, 0.5], [1.7, 1.0, 0.9]),
        ),
        solid(
            d,
            kind,
            [3, 1, 3],
            between([0.2, 1.0, 0.0], [1.6, 1.5, 0.8]),
        ),
    ];
    let mesh = mesh.into_iter().reduce(joined).unwrap();
    let mut text = "materials.rock = {young = 20e9, poisson = 0.25}\n".to_owned();
    for body in [a, b, c, d] {
        text += &format!("bodies.{body}.material = 'rock'\n");
    }
    text += &format!(
        "[[displacement]]\non = ['{a} z0', '{b} z0', '{d} y1']\nx = 0\ny = 0\nz = 0
        [[displacement]]\non = '{c} x0'\nx = 0
        [[pressure]]\non = '{c} z1'\nvalue = '1e6*(1 + x)'
        [[pressure]]\non = '{c} y0'\nvalue = 5e5\n"
    );
    let mut touching = [
        [(a, "x1"), (b, "x0")],
        [(a, "z1"), (c, "z0")],
        [(b, "z1"), (c, "z0")],
        [(a, "y1"), (d, "y0")],
        [(b, "y1"), (d, "y0")],
        [(c, "y1"), (d, "y0")],
    ];
    touching.iter_mut().for_each(|pair| pair.sort_unstable());
    // In the order of detection.
    touching.sort_unstable_by_key(|pair| pair.map(|(body, _)| body));
    for [(first, on_first), (second, on_second)] in touching {
        text += &format!(
            "[[contact]]\nname = '{first} {second}'\nsides = ['{first} {on_first}', '{second} {on_second}']\n"
        );
    }
    (text, moved(mesh, turned))
}

#[test]
fn blocks_in_space_that_do_not_match_are_solved_the_same() {
    for (kind, names) in [
        (Tetrahedron4, ["a", "b", "c", "d"]),
        (Tetrahedron10, ["b", "d", "a", "c"]),
        (Hexahedron8, ["d", "c", "b", "a"]),
    ] {
        let (scene, mesh) = heap(kind, names);
        let explicit = model(&scene, mesh.clone());
        let found = model(&without_sides(&scene, ""), mesh);
        assert_eq!(found.contacts.len(), 6, "{:?}", found.found);
        // The integrals over polygons are summed in another order.
        let [solution, expected] = [&found, &explicit].map(|model| solve(model, 5));
        move_the_same(&solution, &expected, 1e-11);
        // The distribution of a force between two close nodes is less accurate than the total force of the contact.
        for (one, other) in found.contacts.iter().zip(&explicit.contacts) {
            let [one, other] = [(&solution, one), (&expected, other)]
                .map(|(solution, contact)| reaction(&solution.contacts[&contact.name]));
            (0..3).for_each(|k| close(one[k], other[k], 1e-9 * expected.largest_force()));
        }
    }
}

/// Two blocks of quadratic cells with non-matching meshes, on a dome; the upper one is `clearance` above the lower one.
fn dome(clearance: f64) -> Mesh {
    let bent = |[x, y, z]: [f64; 3]| [x, y, z - 0.3 * (x * x + y * y)];
    let lower = solid(
        "lower",
        Tetrahedron10,
        [2, 3, 1],
        between([0.0; 3], [1.0; 3]),
    );
    let (low, high) = ([0.0, 0.0, 1.0 + clearance], [1.0, 1.0, 2.0]);
    let upper = solid("upper", Tetrahedron10, [3, 2, 1], between(low, high));
    joined(moved(lower, bent), moved(upper, bent))
}

const BETWEEN: &str = "
materials.steel = {young = 210e9, poisson = 0.3}
bodies.lower.material = 'steel'
bodies.upper.material = 'steel'
[[contact]]
name = 'c'
between = 'all'
";

/// A pin in half a hole, 0.05 m larger in radius, of quadratic cells with oblique and curved edges.
fn twisted_pin() -> Mesh {
    let turned = |twist: f64| {
        move |[s, t, r]: [f64; 3]| {
            let angle = std::f64::consts::PI * s + twist * t + 0.02 * (3.0 * t).sin();
            let aside = 0.3 * (5.0 * s + 20.0 * twist).sin();
            [r * angle.cos(), r * angle.sin(), t + aside]
        }
    };
    let pin = solid(
        "lower",
        Tetrahedron10,
        [6, 3, 1],
        between([0.0, 0.0, 5.0], [1.0, 20.0, 10.0]),
    );
    let (low, high) = ([0.013, -1.0, 10.05], [1.02, 21.0, 20.0]);
    let hole = solid("upper", Tetrahedron10, [9, 4, 1], between(low, high));
    joined(moved(pin, turned(0.0)), moved(hole, turned(0.02)))
}

#[test]
fn a_curved_pin_with_a_clearance_is_not_said_to_overlap_or_to_part() {
    let model = model(BETWEEN, twisted_pin());
    let found = model.found.concat();
    assert!(
        !found.contains("overlap") && found.contains(", gap up to 0.0"),
        "{found}"
    );
    assert!(
        !model.warnings.concat().contains("opens slowly"),
        "{:?}",
        model.warnings
    );
}

/// Moves the nodes on edges to the middle of their chords.
fn straightened(mut mesh: Mesh) -> Mesh {
    for e in 0..mesh.cells.len() {
        let nodes = mesh.cells.nodes_of(e).to_vec();
        for (facet, local) in mesh.cells.kind(e).facets() {
            for (_, edge) in facet.facets() {
                let [p, q, middle] = [0, 1, 2].map(|k| nodes[local[edge[k]]] as usize);
                let chord = [0, 1, 2].map(|k| 0.5 * (mesh.points[p][k] + mesh.points[q][k]));
                mesh.points[middle] = chord;
            }
        }
    }
    mesh
}

#[test]
fn quadratic_facets_that_are_straight_on_a_curve_are_named() {
    let printed = |mesh: Mesh| model(BETWEEN, mesh).warnings.join("; ");
    let expected = "the quadratic facets of side a are straight and stand off a curve by up to 0.0";
    let warnings = printed(straightened(dome(0.0)));
    assert!(warnings.contains(expected), "{warnings}");
    let warnings = printed(dome(0.0));
    assert!(!warnings.contains("straight"), "{warnings}");
}

#[test]
fn a_corner_between_flat_facets_is_no_curve() {
    let height = |bend: f64, curve: f64| {
        let mut blocks = Blocks::new()
            .rectangle("lower", [0.0, 4.0], [0.0, 1.0], [16, 2])
            .rectangle("upper", [0.0, 4.0], [1.0, 2.0], [16, 2]);
        let first = blocks.mesh.points.len() / 2;
        for x in &mut blocks.mesh.points[first..] {
            x[1] += bend * (x[0] - 2.0).max(0.0) + curve * (x[0] - 2.0).powi(2);
        }
        let mesh = sort("quad8").of(&blocks.mesh);
        let scene = format!(
            "{BODIES}{HELD}[[contact]]\nname = 'c'\nsides = ['upper bottom', 'lower top']\n"
        );
        model(&scene, mesh).warnings.join("; ")
    };
    assert!(
        !height(0.1, 0.0).contains("straight"),
        "{}",
        height(0.1, 0.0)
    );
    assert!(height(0.0, 0.02).contains("facets of side a are straight"));
}
