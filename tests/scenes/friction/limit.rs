//! Friction at its limit.

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::model::Model;

use crate::support::blocks::joined;
use crate::support::scenes::model;
use crate::support::solids::{between, solid};
use crate::support::solver::Case;

const FRICTION: f64 = 0.1;
const PRESSURE: f64 = 1e5;

/// A block on another one that is fixed below, with the loads `more`.
fn on_a_block(more: &str) -> Model {
    let mesh = joined(
        solid(
            "b0",
            Hexahedron8,
            [1, 1, 2],
            between([0.0; 3], [1.0, 1.0, 0.3]),
        ),
        solid(
            "b1",
            Hexahedron8,
            [1, 1, 1],
            between([0.0, 0.0, 0.3], [1.0, 1.0, 0.6]),
        ),
    );
    let text = format!(
        "materials.m0 = {{young = 1e9, poisson = 0.2}}
        materials.m1 = {{young = 1e9, poisson = 0.2}}
        [bodies]
        b0 = {{material = 'm0'}}
        b1 = {{material = 'm1'}}
        [[displacement]]
        on = 'b0 z0'
        x = 0
        y = 0
        z = 0
        [[pressure]]
        on = 'b1 z1'
        value = {PRESSURE:e}
        [[contact]]
        name = 'c0'
        sides = ['b1 z0', 'b0 z1']
        friction = {FRICTION}
        {more}"
    );
    model(&text, mesh)
}

/// Loaded by a share of the largest friction force: at the limit the position of the block is indeterminate.
#[test]
fn a_block_that_friction_holds_with_all_that_it_has_is_said_to_be_at_the_limit() {
    let most = FRICTION * PRESSURE;
    for (share, is_at_limit) in [(0.99, false), (1.0 - 1e-9, true)] {
        // Pushed at the height of the joint, so that the pressure stays uniform.
        let push = share * most;
        let push = format!("[[traction]]\non = 'b1 z0'\nvalue = [0, {push:e}, 0]");
        let solution = Case::of(&on_a_block(&push), 2).solve(&[]);
        let friction = &solution.report["friction"];
        assert_eq!(friction["at_limit"], is_at_limit, "{share}");
        let warnings = solution.report["warnings"].to_string();
        let words = "limit of friction: friction alone restrains 'b1' (translation along (0.0000, 1.0000, 0.0000))";
        assert_eq!(warnings.contains(words), is_at_limit, "{share}: {warnings}");
    }
}

/// Pairs of plates side by side, the upper one of each pushed between two directions of the outer polygon of the
/// friction cone, by a share of the largest friction force.
fn pairs_of_plates(pairs: usize, share: f64) -> Model {
    const WEIGHT: f64 = 2e4;
    let (mut bodies, mut conditions, mut mesh) = (String::new(), String::new(), None);
    let (sin, cos) = std::f64::consts::FRAC_PI_8.sin_cos();
    let [x, y] = [cos, sin].map(|part| share * FRICTION * WEIGHT * part);
    for i in 0..pairs {
        let at = |z: f64| {
            let from = [1.5 * i as f64, 0.0, z];
            between(from, [from[0] + 1.0, 1.0, z + 0.5])
        };
        let [low, high] = ["low", "up"].map(|name| format!("{name}{i}"));
        for (name, z) in [(&low, 0.0), (&high, 0.5)] {
            let plate = solid(name, Hexahedron8, [1; 3], at(z));
            mesh = Some(match mesh {
                Some(before) => joined(before, plate),
                None => plate,
            });
        }
        bodies += &format!(
            "{low}.material = 'rock'
            {high} = {{material = 'rock', body_force = [{x:e}, {y:e}, {:e}]}}\n",
            -WEIGHT
        );
        conditions += &format!(
            "[[displacement]]
            on = '{low} z0'
            x = 0
            y = 0
            z = 0
            [[contact]]
            name = 'joint {i}'
            sides = ['{high} z0', '{low} z1']
            friction = {FRICTION}\n"
        );
    }
    let text = format!(
        "materials.rock = {{young = 2e10, poisson = 0.2}}
        [bodies]
        {bodies}{conditions}"
    );
    model(&text, mesh.unwrap())
}

#[test]
fn many_bodies_are_held_up_to_the_circle_of_friction() {
    for (share, code) in [(0.96, 0), (1.03, 4)] {
        let ended = Case::of(&pairs_of_plates(60, share), 120).run(&[]);
        assert_eq!(
            ended.code(),
            code,
            "{share}: {}{}",
            ended.stdout,
            ended.stderr
        );
    }
}
