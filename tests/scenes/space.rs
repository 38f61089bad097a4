//! Scenes in space.

pub mod contact;
mod crack_front;
mod friction;
mod invariance;
mod patch_test;

use std::collections::HashMap;

use contact_dd_partition::element::ElementKind::{self, *};
use contact_dd_partition::element::geometry::{advance, cross, dot, length};
use contact_dd_partition::mesh::Mesh;

use crate::support::blocks::{jittered, joined};
use crate::support::close::close;
use crate::support::extruded::extruded;
use crate::support::scenes::{model, two_block_scene, two_blocks as plane_blocks};
use crate::support::solids::{SOLIDS, between, moved, shaken, solid, turned};
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve};
use crate::support::sorts::sort;

const YOUNG: f64 = 20e9;
const POISSON: f64 = 0.25;

const BODY: &str = "
materials.rock = {young = 20e9, poisson = 0.25}
bodies.block.material = 'rock'
";

/// A general symmetric stress (Pa): XX YY ZZ XY YZ XZ.
const STRESS: [f64; 6] = [1e6, -2e6, 3e6, 0.5e6, -0.7e6, 0.9e6];

/// σ n.
fn traction([xx, yy, zz, xy, yz, xz]: [f64; 6], n: [f64; 3]) -> [f64; 3] {
    [
        dot([xx, xy, xz], n),
        dot([xy, yy, yz], n),
        dot([xz, yz, zz], n),
    ]
}

/// ε of a stress by Hooke's law, as the matrix ∂u/∂x without a rotation.
fn strain(stress: [f64; 6]) -> [[f64; 3]; 3] {
    let [xx, yy, zz, xy, yz, xz] = stress;
    let trace = xx + yy + zz;
    let axial = |s: f64| ((1.0 + POISSON) * s - POISSON * trace) / YOUNG;
    let [xy, yz, xz] = [xy, yz, xz].map(|s| (1.0 + POISSON) * s / YOUNG);
    [
        [axial(xx), xy, xz],
        [xy, axial(yy), yz],
        [xz, yz, axial(zz)],
    ]
}

fn is_near(found: &[f64], expected: &[f64], slack: f64) {
    assert_eq!(found.len(), expected.len());
    (found.iter().zip(expected)).for_each(|(a, b)| close(*a, *b, slack));
}

/// The tractions of a stress on the faces of a rotated cube.
fn tractions(stress: [f64; 6]) -> String {
    let faces = (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]);
    let face = |(axis, end): (usize, usize)| {
        let mut n = [0.0; 3];
        n[axis] = if end == 0 { -1.0 } else { 1.0 };
        let letter = ["x", "y", "z"][axis];
        let value = traction(stress, turned(n));
        format!("[[traction]]\non = 'block {letter}{end}'\nvalue = {value:?}\n")
    };
    faces.map(face).collect()
}

#[test]
fn a_uniform_stress_passes_through_a_free_body_of_any_cells_in_any_position() {
    let e = strain(STRESS);
    for kind in SOLIDS {
        let mesh = shaken(solid("block", kind, [3, 2, 2], |x| x), 0.015);
        let model = model(&format!("{BODY}{}", tractions(STRESS)), moved(mesh, turned));
        for count in [1, 4] {
            let solution = solve(&model, count);
            solution.check_stress(STRESS, 1e-10 * 3e6);
            // The average displacement and rotation of the nodes are fixed: u − ε x is a rigid-body motion.
            let (mut moved, mut turned) = ([0.0; 3], [0.0; 3]);
            let mut at = Vec::new();
            for (tag, &x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
                let u = solution.displacement[tag];
                moved = advance(moved, 1.0, u);
                turned = advance(turned, 1.0, cross(x, u));
                at.push((x, [0, 1, 2].map(|i| u[i] - dot(e[i], x))));
            }
            for sum in [moved, turned] {
                assert!(length(sum) < 1e-13 * at.len() as f64, "{kind:?}: {sum:?}");
            }
            let (x0, u0) = at[0];
            for (x, u) in &at {
                // A rigid-body motion preserves distances.
                let (way, change) = (advance(*x, -1.0, x0), advance(*u, -1.0, u0));
                assert!(dot(way, change).abs() < 1e-14, "{kind:?}");
            }
            assert_eq!(solution.report["warnings"].as_array().unwrap().len(), 1);
        }
    }
}

/// Two blocks on a floor, both under pressure from above and from the side.
const PRESSED: &str = "
materials.rock = {young = 20e9, poisson = 0.25}
bodies.lower.material = 'rock'
bodies.upper.material = 'rock'
[[bilateral]]
on = ['lower x0', 'upper x0', 'lower y0', 'upper y0']
[[pressure]]
on = ['upper z1', 'lower x1', 'upper x1']
value = 1e6
[[pressure]]
on = ['lower y1', 'upper y1']
value = 2e6
[[contact]]
name = 'joint'
sides = ['lower z1', 'upper z0']
";

/// Two blocks that meet in an inclined face, in irregular cells.
fn two_blocks(kind: ElementKind, upper: [usize; 3]) -> Mesh {
    let joint = |x: f64, y: f64| 0.9 + 0.2 * x - 0.1 * y;
    let lower = shaken(solid("lower", kind, [3, 2, 2], |x| x), 0.015);
    let lower = moved(lower, |[x, y, z]| [x, y, z * joint(x, y)]);
    let above = shaken(solid("upper", kind, upper, |x| x), 0.015);
    let above = moved(above, |[x, y, z]| [x, y, (1.0 - z) * joint(x, y) + 2.0 * z]);
    joined(lower, above)
}

#[test]
fn uniform_compression_goes_through_contacts_of_any_cells_in_any_position() {
    let floor = "[[contact]]\nname = 'floor'\nsides = ['lower z0']\n";
    let normal = turned([0.0, 0.0, 1.0]);
    let floor = format!("{floor}obstacle = {{point = [0, 0, 0], normal = {normal:?}}}\n");
    // With three equal pressures the joint may be inclined.
    let text = format!("{}{floor}", PRESSED.replace("2e6", "1e6"));
    let strain = -1e6 * (1.0 - 2.0 * POISSON) / YOUNG;
    for kind in SOLIDS {
        for upper in [[3, 2, 2], [2, 3, 2]] {
            let model = model(&text, moved(two_blocks(kind, upper), turned));
            for count in [2, 6] {
                let solution = solve(&model, count);
                solution.check_stress([-1e6, -1e6, -1e6, 0.0, 0.0, 0.0], 1e-10 * 1e6);
                for (tag, x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
                    is_near(
                        &solution.displacement[tag],
                        &x.map(|c| strain * c),
                        1e-10 * strain.abs(),
                    );
                }
                for point in solution.points() {
                    assert!(point.closed, "{kind:?}");
                    close(point.pressure, 1e6, 1e-9 * 1e6);
                }
            }
        }
    }
}

#[test]
fn quadratic_cells_bend_exactly() {
    // Pure bending about y: u = κ (x z, 0, −x²/2) + ν κ (0, −y z, …) under moments at the ends only.
    let k = 1e-4;
    let exact = |[x, y, z]: [f64; 3]| {
        [
            k * x * z,
            -POISSON * k * y * z,
            -0.5 * k * (x * x + POISSON * (z * z - y * y)),
        ]
    };
    let text = format!(
        "{BODY}
[[displacement]]
on = 'block x0'
x = '0'
y = '-0.25*1e-4*y*z'
z = '-0.5e-4*0.25*(z^2-y^2)'
[[traction]]
on = 'block x1'
value = ['20e9*1e-4*z', '0', '0']
"
    );
    for kind in [Tetrahedron10, Hexahedron20, Hexahedron27] {
        let mesh = solid(
            "block",
            kind,
            [4, 2, 2],
            between([0.0, -0.5, -0.5], [3.0, 0.5, 0.5]),
        );
        let model = model(&text, mesh);
        let solution = solve(&model, 3);
        for (tag, x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
            is_near(&solution.displacement[tag], &exact(*x), 1e-10 * 4.5e-4);
            let mut stress = [0.0; 6];
            stress[0] = YOUNG * k * x[2];
            is_near(&solution.nodal_stress[tag], &stress, 1e-8 * YOUNG * k);
        }
    }
}

#[test]
fn a_body_that_nothing_holds_turns_about_an_axis() {
    // Held at one edge against translations, with a load that rotates it about the edge.
    let text = format!(
        "{BODY}
[[displacement]]
on = 'block x0'
x = 0
[[bilateral]]
on = ['block y0', 'block z0']
[[traction]]
on = 'block x1'
value = [1e6, 0, 0]
"
    );
    let mesh = solid("block", Hexahedron8, [2, 2, 2], |x| x);
    solve(&model(&text, mesh.clone()), 2);
    // On rollers below, with a load that rotates it about z.
    let text = format!(
        "{BODY}
[[bilateral]]
on = 'block z0'
[[traction]]
on = 'block x1'
value = [0, 1e6, 0]
[[traction]]
on = 'block x0'
value = [0, -1e6, 0]
"
    );
    let ended = Case::of(&model(&text, mesh), 2).run(&[]);
    assert_eq!(ended.code(), 4, "{}", ended.stderr);
    for words in [
        "'block'",
        "rotation about the axis through (0.50000, 0.50000, ",
        "along (0.0000, 0.0000, 1.0000)",
    ] {
        assert!(ended.stderr.contains(words), "{}", ended.stderr);
    }
}

/// Supports that make a scene in space a plane one, without displacement along z.
const FLAT: &str = "
[[bilateral]]
on = ['lower back', 'lower front', 'upper back', 'upper front']
";

#[test]
fn an_extruded_scene_is_that_of_plane_strain() {
    for (name, solid) in [
        ("quad4", Hexahedron8),
        ("quad8", Hexahedron20),
        ("quad9", Hexahedron27),
    ] {
        let plane = sort(name).of(&plane_blocks().mesh);
        let plane = jittered(plane, 0.01, 3);
        let heights = [0.0, 0.3];
        let mesh = extruded(&plane, &heights).unwrap();
        assert!(mesh.cells.iter().all(|(kind, _)| kind == solid));
        // The constraints on faces of eight nodes differ from those on lines of three; the solutions agree where all
        // are closed.
        let all_closed = solid == Hexahedron20;
        let text = match all_closed {
            true => two_block_scene().replace("1.95-1.9*x", "1.2-0.2*x"),
            false => two_block_scene(),
        };
        let in_plane = model(&text, plane);
        let in_space = model(
            &format!("{}{FLAT}", text.replace("plane = 'strain'\n", "")),
            mesh,
        );
        let (flat, deep) = (solve(&in_plane, 6), solve(&in_space, 6));
        let size = flat.largest_displacement();
        let key = |x: [f64; 3]| [x[0], x[1]].map(f64::to_bits);
        // Two nodes on the joint coincide.
        let mut of_plane: HashMap<_, Vec<[f64; 3]>> = HashMap::new();
        for (tag, &x) in in_plane.mesh.node_tags.iter().zip(&in_plane.mesh.points) {
            of_plane
                .entry(key(x))
                .or_default()
                .push(flat.displacement[tag]);
        }
        for (tag, &x) in in_space.mesh.node_tags.iter().zip(&in_space.mesh.points) {
            let found = deep.displacement[tag];
            let is_same = |u: &[f64; 3]| length(advance(found, -1.0, *u)) <= 1e-10 * size;
            assert!(
                of_plane[&key(x)].iter().any(is_same),
                "{name}: {found:?} at {x:?}"
            );
        }
        let force = |solution: &Solution, holds: &dyn Fn(f64) -> bool| -> f64 {
            let points = solution.points().filter(|point| holds(point.position[0]));
            points.map(|point| point.force).sum()
        };
        let slack = 1e-10 * flat.largest_force();
        close(
            force(&deep, &|_| true),
            0.3 * force(&flat, &|_| true),
            10.0 * slack,
        );
        for point in flat.points().filter(|_| !all_closed) {
            let there = |x: f64| x == point.position[0];
            close(force(&deep, &there), 0.3 * force(&flat, &there), slack);
        }
        assert_eq!(
            flat.closed() == flat.contacts["joint"].len(),
            all_closed,
            "{name}"
        );
    }
}
