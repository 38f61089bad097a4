//! Contact in space.

use contact_dd_partition::element::ElementKind::{self, *};
use contact_dd_partition::element::geometry::{advance, dot, length};
use contact_dd_partition::mesh::Mesh;

use super::BODY;
use crate::support::blocks::joined;
use crate::support::close::close;
use crate::support::comparison::compare;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::model;
use crate::support::solids::{SOLIDS, between, solid};
use crate::support::solver::solve;

/// A block resting on another one by its weight.
const RESTING: &str = "
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

/// The same scene with a load that makes the block rock: the joint opens in part.
pub fn rocking_scene() -> String {
    format!(
        "{RESTING}[[displacement]]
on = 'upper y0'
y = 0
[[displacement]]
on = 'upper x0'
x = 0
[[pressure]]
on = 'upper z1'
value = '1e6*(1.3-1.6*x)'
"
    )
}

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
            let model = model(&rocking_scene().replace("1.3-1.6*x", "2.0-3.5*x"), mesh);
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
fn a_stack_held_by_contact_alone_comes_to_rest() {
    for kind in SOLIDS {
        for gap in [0.0, 0.2] {
            let lower = solid("lower", kind, [3, 3, 2], between([0.0; 3], [1.5, 1.5, 0.5]));
            let high = between([0.5, 0.5, 0.5 + gap], [1.0, 1.0, 1.0 + gap]);
            let model = model(
                RESTING,
                joined(lower, solid("upper", kind, [1, 1, 2], high)),
            );
            let solution = solve(&model, 4);
            let weight = 25e3 * 0.125;
            let carried: f64 = solution.points().map(|point| point.force).sum();
            close(carried, weight, 1e-10 * weight);
            let warnings = solution.report["warnings"].as_array().unwrap();
            assert_eq!(warnings.len(), 3, "{kind:?}: {warnings:?}");
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
            // On the other quadratic faces constraints involve several nodes.
            if matches!(kind, Tetrahedron10 | Hexahedron20) {
                continue;
            }
            for point in points {
                let u = solution.displacement[&point.tags[0]];
                let x = advance(point.position, 1.0, u);
                let away = distance(x);
                // Linearization at the nearest point has an error of second order in u.
                let slack = 4.0 * dot(u, u) + 1e-14;
                assert!(away > -slack, "{kind:?} {obstacle}: {away:e}");
                if point.closed {
                    close(away, 0.0, slack);
                }
            }
        }
    }
}
