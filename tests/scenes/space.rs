//! Scenes in space.

use std::collections::HashMap;

use contact_dd_partition::element::ElementKind::{self, *};
use contact_dd_partition::element::geometry::{advance, cross, dot, length};
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use crate::support::blocks::{jittered, joined};
use crate::support::close::close;
use crate::support::comparison::compare;
use crate::support::extruded::extruded;
use crate::support::monolithic::Monolithic;
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

/// A symmetric stress with no special direction (Pa): XX YY ZZ XY YZ XZ.
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

/// Fails unless cells and nodes have this stress.
#[track_caller]
fn is_stressed(solution: &Solution, stress: [f64; 6], slack: f64) {
    let cells = solution.cells.iter().map(|(_, stress)| stress);
    for found in cells.chain(solution.nodal_stress.values()) {
        is_near(found, &stress, slack);
    }
}

/// The tractions of a stress on the faces of a turned cube.
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
            is_stressed(&solution, STRESS, 1e-10 * 3e6);
            // What is fixed is the mean over the nodes, without rotation in the mean: u − ε x is rigid.
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
                // A rigid motion moves no two points towards each other.
                let (way, change) = (advance(*x, -1.0, x0), advance(*u, -1.0, u0));
                assert!(dot(way, change).abs() < 1e-14, "{kind:?}");
            }
            assert_eq!(solution.report["warnings"].as_array().unwrap().len(), 1);
        }
    }
}

/// Two blocks on a floor, both pressed from above and aside.
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

/// Two blocks that meet in an inclined face, all cells irregular.
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
    // All three pressures the same: the joint may be inclined.
    let text = format!("{}{floor}", PRESSED.replace("2e6", "1e6"));
    let strain = -1e6 * (1.0 - 2.0 * POISSON) / YOUNG;
    for kind in SOLIDS {
        for upper in [[3, 2, 2], [2, 3, 2]] {
            let model = model(&text, moved(two_blocks(kind, upper), turned));
            for count in [2, 6] {
                let solution = solve(&model, count);
                is_stressed(&solution, [-1e6, -1e6, -1e6, 0.0, 0.0, 0.0], 1e-10 * 1e6);
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
    // Pure bending about y: u = κ (x z, 0, −x²/2) + ν κ (0, −y z, …) without any load but moments at the ends.
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

/// The parts of a result that count, in the order of nodes of the model.
fn outcome(model: &Model, solution: &Solution) -> (Vec<[f64; 3]>, Vec<f64>) {
    let tags = model.mesh.node_tags.iter();
    let displacement = tags.map(|tag| solution.displacement[tag]).collect();
    (
        displacement,
        solution.points().map(|point| point.force).collect(),
    )
}

/// A block that rocks on a wider one: a part of the joint opens.
const ROCKING: &str = "
materials.rock = {young = 20e9, poisson = 0.25}
bodies.lower.material = 'rock'
bodies.upper = {material = 'rock', body_force = [0.0, 0.0, -25e3]}
[[displacement]]
on = 'lower z0'
x = 0
y = 0
z = 0
[[displacement]]
on = 'upper y0'
y = 0
[[displacement]]
on = 'upper x0'
x = 0
[[pressure]]
on = 'upper z1'
value = '1e6*(1.3-1.6*x)'
[[contact]]
name = 'joint'
sides = ['upper z0', 'lower z1']
";

fn rocking(kind: ElementKind) -> Mesh {
    let lower = solid("lower", kind, [5, 3, 2], between([0.0; 3], [1.0, 1.0, 0.5]));
    let upper = solid(
        "upper",
        kind,
        [5, 3, 3],
        between([0.0, 0.0, 0.5], [1.0, 1.0, 1.0]),
    );
    joined(lower, upper)
}

#[test]
fn a_result_does_not_depend_on_the_unit_or_the_direction() {
    let first_model = model(ROCKING, rocking(Hexahedron8));
    let first = solve(&first_model, 5);
    let (u, forces) = outcome(&first_model, &first);
    assert!(
        (1..forces.len()).contains(&first.closed()),
        "{}",
        first.closed()
    );
    let size = first.largest_displacement();
    let force = first.largest_force();

    // Axes exchanged by turns, which mirrors nothing; then mirrored in x and y.
    let turn = ROCKING
        .replace("[0.0, 0.0, -25e3]", "[-25e3, 0.0, 0.0]")
        .replace("z0'\nx = 0\ny = 0\nz = 0", "z0'\ny = 0\nz = 0\nx = 0")
        .replace("y0'\ny = 0", "y0'\nz = 0")
        .replace("x0'\nx = 0", "x0'\ny = 0")
        .replace("1.6*x", "1.6*y");
    let turned_model = model(&turn, moved(rocking(Hexahedron8), |[x, y, z]| [z, x, y]));
    let (other, other_forces) = outcome(&turned_model, &solve(&turned_model, 5));
    let mut sorted = [forces.clone(), other_forces];
    sorted
        .iter_mut()
        .for_each(|forces| forces.sort_by(f64::total_cmp));
    is_near(&sorted[0], &sorted[1], 1e-10 * force);
    for (u, [z, x, y]) in u.iter().zip(other) {
        is_near(u, &[x, y, z], 1e-10 * size);
    }

    let mirrored = ROCKING.replace("1.6*x", "1.6*(-x)");
    let mirrored_model = model(
        &mirrored,
        moved(rocking(Hexahedron8), |[x, y, z]| [-x, y, z]),
    );
    let (other, _) = outcome(&mirrored_model, &solve(&mirrored_model, 5));
    for (u, [x, y, z]) in u.iter().zip(other) {
        is_near(u, &[-x, y, z], 1e-10 * size);
    }

    let in_millimetres = ROCKING
        .replace("20e9", "20e3")
        .replace("-25e3", "-25e-6")
        .replace("1e6*(1.3-1.6*x)", "1.3-1.6e-3*x");
    let scaled_model = model(
        &in_millimetres,
        moved(rocking(Hexahedron8), |x| x.map(|c| 1e3 * c)),
    );
    let scaled = solve(&scaled_model, 5);
    let (other, other_forces) = outcome(&scaled_model, &scaled);
    is_near(&forces, &other_forces, 1e-10 * force);
    for (u, other) in u.iter().zip(other) {
        is_near(u, &other.map(|c| 1e-3 * c), 1e-10 * size);
    }
}

#[test]
fn a_joint_that_opens_in_part_is_that_of_a_monolithic_solve() {
    for kind in SOLIDS {
        let at_once = rocking(kind);
        let apart = joined(
            solid("lower", kind, [3, 2, 1], between([0.0; 3], [1.2, 1.0, 0.5])),
            solid(
                "upper",
                kind,
                [3, 3, 1],
                between([0.1, 0.0, 0.5], [1.0, 1.0, 1.0]),
            ),
        );
        let meshes = match kind.is_linear() {
            true => vec![at_once, apart],
            false => vec![apart],
        };
        for mesh in meshes {
            let model = model(&ROCKING.replace("1.3-1.6*x", "2.0-3.5*x"), mesh);
            let reference = Monolithic::new(&model);
            for count in [2, 5] {
                let solution = solve(&model, count);
                compare(&model, &reference, &solution);
                let all = solution.points().count();
                assert!(
                    (1..all).contains(&solution.closed()),
                    "{kind:?}: all or none of {all}"
                );
            }
        }
    }
}

#[test]
fn round_obstacles_keep_their_distance() {
    let scene = |obstacle: &str| {
        format!(
            "{BODY}
[[bilateral]]
on = ['block x0', 'block y0']
[[displacement]]
on = 'block z1'
z = -0.01
[[contact]]
name = 'obstacle'
sides = ['block z0']
obstacle = {{{obstacle}}}
"
        )
    };
    type Distance = fn([f64; 3]) -> f64;
    let obstacles: [(&str, Distance); 3] = [
        ("center = [0, 0, -2], radius = 1.995", |[x, y, z]| {
            length([x, y, z + 2.0]) - 1.995
        }),
        (
            "point = [5, 0, -2], axis = [3, 0, 0], radius = 1.995",
            |[_, y, z]| y.hypot(z + 2.0) - 1.995,
        ),
        (
            "center = [0, 0, 8], radius = 8.005, inside = true",
            |[x, y, z]| 8.005 - length([x, y, z - 8.0]),
        ),
    ];
    for kind in SOLIDS {
        for (obstacle, distance) in obstacles {
            let model = model(&scene(obstacle), solid("block", kind, [4, 4, 2], |x| x));
            let solution = solve(&model, 3);
            let points = &solution.contacts["obstacle"];
            assert!(
                (1..points.len()).contains(&solution.closed()),
                "{kind:?} {obstacle}"
            );
            // On the other quadratic faces conditions are of several nodes.
            if matches!(kind, Tetrahedron10 | Hexahedron20) {
                continue;
            }
            for point in points {
                let u = solution.displacement[&point.tags[0]];
                let x = advance(point.position, 1.0, u);
                let away = distance(x);
                // Linearized at the nearest point, to second order in u.
                let slack = 4.0 * dot(u, u) + 1e-14;
                assert!(away > -slack, "{kind:?} {obstacle}: {away:e}");
                if point.closed {
                    close(away, 0.0, slack);
                }
            }
        }
    }
}

#[test]
fn a_body_that_nothing_holds_turns_about_an_axis() {
    // Held at one edge against translations, pushed so that it turns about it.
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
    // On rollers below, pushed round: it turns about z.
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

#[test]
fn a_stack_held_by_contact_alone_comes_to_rest() {
    let text = "
materials.rock = {young = 20e9, poisson = 0.25}
bodies.lower.material = 'rock'
bodies.upper = {material = 'rock', body_force = [0.0, 0.0, -25e3]}
[[displacement]]
on = 'lower z0'
x = 0
y = 0
z = 0
[[contact]]
name = 'joint'
sides = ['upper z0', 'lower z1']
";
    for kind in SOLIDS {
        for gap in [0.0, 0.2] {
            let lower = solid("lower", kind, [3, 3, 2], between([0.0; 3], [1.5, 1.5, 0.5]));
            let high = between([0.5, 0.5, 0.5 + gap], [1.0, 1.0, 1.0 + gap]);
            let model = model(text, joined(lower, solid("upper", kind, [1, 1, 2], high)));
            let solution = solve(&model, 4);
            let weight = 25e3 * 0.125;
            let carried: f64 = solution.points().map(|point| point.force).sum();
            close(carried, weight, 1e-10 * weight);
            let warnings = solution.report["warnings"].as_array().unwrap();
            assert_eq!(warnings.len(), 3, "{kind:?}: {warnings:?}");
        }
    }
}

/// What a plane scene says in space: nothing moves along z.
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
        // The conditions on faces of eight nodes are others than on lines of three: alike where all are closed.
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
        // Two nodes on the joint are in one place.
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
