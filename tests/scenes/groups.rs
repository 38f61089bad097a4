//! Many bodies in contact: rows, walls, pockets, bridges.

use contact_dd_partition::mesh::Mesh;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::comparison::compare;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::model;
use crate::support::solution::ContactPoint;
use crate::support::solver::solve;
use crate::support::statics::{balanced, reaction};

const ROCK: &str = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.22}
";

/// Four barrels in a row, 2 m long each, with flat contacts.
fn row() -> (Mesh, String) {
    let mut blocks = Blocks::new();
    let mut bodies = ROCK.to_owned();
    let mut contacts = String::new();
    for i in 0..4 {
        blocks = blocks.mapped(&format!("b{i}"), [8, 6], |[s, t]| {
            let bulge = 0.5 + 0.5 * (std::f64::consts::PI * s).sin();
            [2.0 * (i as f64 + s), (2.0 * t - 1.0) * bulge]
        });
        bodies += &format!("bodies.b{i}.material = 'rock'\n");
        if i > 0 {
            contacts += &format!(
                "[[contact]]
                name = 'joint {i}'
                sides = ['b{} right', 'b{i} left']\n",
                i - 1
            );
        }
    }
    (blocks.mesh, bodies + &contacts)
}

const LEFT_WALL: &str = "[[contact]]
name = 'wall'
sides = ['b0 left']
obstacle = {point = [0, 0], normal = [1, 0]}
";

#[test]
fn every_contact_of_a_row_carries_the_same_force() {
    let (mesh, row) = row();
    let pushed = "[[traction]]\non = 'b3 right'\nvalue = [-1e6, 0.0]\n";
    let squeezed = "[[contact]]
        name = 'right wall'
        sides = ['b3 right']
        obstacle = {point = [7.999, 0], normal = [-1, 0]}\n";
    for (end, force) in [(pushed, Some(1e6)), (squeezed, None)] {
        let model = model(&format!("{row}{LEFT_WALL}{end}"), mesh.clone());
        for count in [4, 9] {
            let solution = solve(&model, count);
            let forces = (solution.contacts.values())
                .map(|points| points.iter().map(|p| p.force).sum::<f64>());
            let forces: Vec<f64> = forces.collect();
            let expected = force.unwrap_or(forces[0]);
            assert!(expected > 1e5, "{forces:?}");
            for found in forces {
                close(found, expected, 1e-11 * expected);
            }
        }
    }
}

/// A wall of `courses` courses, 4 m long, of bricks of 1 m × 0.5 m; with `running` bond every other course begins with
/// half a brick. Its scene has its weight, 25 kN/m³, and 0.1 MPa from above; one contact for all bed joints of a
/// course, and one for all its head joints.
fn wall(courses: usize, running: bool) -> (Mesh, String) {
    let mut blocks = Blocks::new();
    let mut bodies = ROCK.to_owned();
    let mut contacts = String::new();
    let mut below: Vec<String> = Vec::new();
    for course in 0..courses {
        let shift = if running && course % 2 == 1 { 0.5 } else { 0.0 };
        let mut ends: Vec<f64> = (0..=4).map(|i| i as f64 + shift).collect();
        if shift > 0.0 {
            ends.insert(0, 0.0);
            ends[5] = 4.0;
        }
        let low = 0.5 * course as f64;
        let mut bricks = Vec::new();
        for (i, x) in ends.windows(2).enumerate() {
            let name = format!("brick {course} {i}");
            let columns = (4.0 * (x[1] - x[0])).round() as usize;
            blocks = blocks.rectangle(&name, [x[0], x[1]], [low, low + 0.5], [columns, 2]);
            bodies +=
                &format!("bodies.'{name}' = {{material = 'rock', body_force = [0, -25e3]}}\n");
            bricks.push(name);
        }
        let sides = |bricks: &[String], side: &str| {
            let names: Vec<String> = bricks.iter().map(|b| format!("'{b} {side}'")).collect();
            names.join(", ")
        };
        let bottoms = sides(&bricks, "bottom");
        contacts += &match course {
            0 => format!(
                "[[contact]]\nname = 'bed 0'\nsides = [[{bottoms}]]
                obstacle = {{point = [0, 0], normal = [0, 1]}}\n"
            ),
            _ => format!(
                "[[contact]]\nname = 'bed {course}'\nsides = [[{bottoms}], [{}]]\n",
                sides(&below, "top")
            ),
        };
        contacts += &format!(
            "[[contact]]\nname = 'heads {course}'\nsides = [[{}], [{}]]\n",
            sides(&bricks[..bricks.len() - 1], "right"),
            sides(&bricks[1..], "left")
        );
        below = bricks;
    }
    for brick in below {
        contacts += &format!("[[pressure]]\non = '{brick} top'\nvalue = 1e5\n");
    }
    (blocks.mesh, bodies + &contacts)
}

#[test]
fn every_bed_joint_of_a_wall_carries_what_is_above_it() {
    for running in [true, false] {
        let courses = 4;
        let (mesh, scene) = wall(courses, running);
        let model = model(&scene, mesh);
        for count in [18, 30] {
            let solution = solve(&model, count);
            for course in 0..courses {
                let points = &solution.contacts[&format!("bed {course}")];
                let above = (courses - course) as f64 * 4.0 * 0.5 * 25e3 + 4.0 * 1e5;
                balanced(reaction(points), [0.0, above, 2.0 * above], 1e-10 * above);
                // Tributary areas cover the joint exactly once, whatever the bricks.
                let length: f64 = (points.iter())
                    .filter(|point| point.force > 0.0)
                    .map(|point| point.force / point.pressure)
                    .sum();
                assert!(length <= 4.0 + 1e-9, "{length}");
            }
        }
    }
}

/// A block in a pocket of a body below and on both sides of it.
fn pocket() -> Mesh {
    Blocks::new()
        .rectangle("floor", [-1.0, 1.0], [-1.0, 0.0], [8, 4])
        .rectangle("left floor", [-2.0, -1.0], [-1.0, 0.0], [4, 4])
        .rectangle("right floor", [1.0, 2.0], [-1.0, 0.0], [4, 4])
        .rectangle("left wall", [-2.0, -1.0], [0.0, 1.0], [4, 4])
        .rectangle("right wall", [1.0, 2.0], [0.0, 1.0], [4, 4])
        .glued(|_, _| true)
        .rectangle("block", [-1.0, 1.0], [0.0, 1.0], [8, 4])
        .mesh
}

fn pocket_scene(rest: &str) -> String {
    let floors = ["floor", "left floor", "right floor"];
    let bodies: String = floors
        .iter()
        .chain(&["left wall", "right wall"])
        .map(|name| format!("bodies.'{name}'.material = 'rock'\n"))
        .collect();
    format!(
        "{ROCK}{bodies}
        bodies.block = {{material = 'rock', body_force = [4e5, -25e3]}}
        [[displacement]]
        on = ['floor bottom', 'left floor bottom', 'right floor bottom']
        x = 0.0
        y = 0.0
        [[pressure]]
        on = 'block top'
        value = 1e6
        [[contact]]
        name = 'below'
        sides = ['block bottom', 'floor top']
        [[contact]]
        name = 'left'
        sides = ['block left', 'left wall right']
        [[contact]]
        name = 'right'
        sides = ['block right', 'right wall left']
        {rest}"
    )
}

#[test]
fn a_block_in_a_pocket_touches_it_on_three_sides_and_in_corners() {
    // On at least one side the block's lateral expansion closes the contact; on the other it stays open.
    let model = model(&pocket_scene(""), pocket());
    let reference = Monolithic::new(&model);
    for count in [2, 5, 8] {
        let solution = solve(&model, count);
        compare(&model, &reference, &solution);
        let [below, left, right] = ["below", "left", "right"].map(|n| &solution.contacts[n][..]);
        let shared = |a: &[ContactPoint], b: &[ContactPoint]| {
            let on_b = |p: &&ContactPoint| b.iter().any(|q| q.tags == p.tags);
            a.iter().filter(on_b).count()
        };
        assert_eq!([shared(below, left), shared(below, right)], [1, 1]);
        let total = [below, left, right].map(reaction);
        let [x, y] = [0, 1].map(|k| total.iter().map(|r| r[k]).sum::<f64>());
        close(x, -2.0 * 4e5, 1e-4);
        close(y, 2.0 * (25e3 + 1e6), 1e-4);
    }
}

#[test]
fn contacts_and_a_support_may_meet_in_a_corner() {
    // The corner nodes of the pocket and of the block are held along x as well.
    let held = "[[displacement]]\non = ['block left', 'left wall right']\nx = 0.0\n";
    let model = model(&pocket_scene(held), pocket());
    assert!(
        model.warnings.iter().any(|w| w.contains("'left'")),
        "{:?}",
        model.warnings
    );
    let reference = Monolithic::new(&model);
    for count in [2, 6] {
        let solution = solve(&model, count);
        compare(&model, &reference, &solution);
    }
}

#[test]
fn a_bridge_obeys_the_lever() {
    let blocks = Blocks::new()
        .rectangle("left pier", [0.0, 1.0], [0.0, 1.0], [4, 4])
        .rectangle("right pier", [3.0, 4.0], [0.0, 1.0], [4, 4])
        .rectangle("left leg", [0.0, 1.0], [1.0, 2.0], [4, 4])
        .rectangle("right leg", [3.0, 4.0], [1.0, 2.0], [4, 4])
        .rectangle("deck", [0.0, 4.0], [2.0, 3.0], [16, 4])
        .glued(|_, y| y == 2.0);
    let names = ["left pier", "right pier", "left leg", "right leg", "deck"];
    let bodies = names.map(|name| format!("bodies.'{name}'.material = 'rock'\n"));
    let text = format!(
        "{ROCK}{}
        [[displacement]]
        on = ['left pier bottom', 'right pier bottom']
        x = 0.0
        y = 0.0
        [[traction]]
        on = 'deck top'
        value = ['0', '-1e6*x']
        [[contact]]
        name = 'left joint'
        sides = ['left leg bottom', 'left pier top']
        [[contact]]
        name = 'right joint'
        sides = ['right leg bottom', 'right pier top']",
        bodies.concat()
    );
    let model = model(&text, blocks.mesh);
    let load = 1e6 * 8.0;
    for count in [3, 5, 9] {
        let solution = solve(&model, count);
        // ∫ 1e6 x dx and ∫ 1e6 x² dx from 0 to 4.
        balanced(
            reaction(solution.points()),
            [0.0, load, 1e6 * 64.0 / 3.0],
            1e-10 * load,
        );
        assert!(
            solution
                .contacts
                .values()
                .all(|points| points.iter().any(|p| p.closed))
        );
    }
}
