//! Friction in space.

mod random;
mod symmetry;
mod wedge;
mod working_set;

use contact_dd_partition::element::ElementKind::{self, *};
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use super::{BODY, is_near};
use crate::support::assembled::Assembled;
use crate::support::blocks::{Blocks, joined};
use crate::support::close::close;
use crate::support::energy::{Works, checked_works};
use crate::support::extruded::extruded;
use crate::support::scenes::{at_step, built_in, model, two_block_scene, two_blocks};
use crate::support::solids::{SOLIDS, between, moved, solid, turned};
use crate::support::solution::ContactPoint;
use crate::support::solver::{Case, solve, solve_steps};
use crate::support::sorts::sort;
use crate::support::stress::judge::Findings;

/// A vector in the syntax of a scene.
fn vector(v: [f64; 3]) -> String {
    format!("[{:?}, {:?}, {:?}]", v[0], v[1], v[2])
}

/// A low block on a plane, all in a general orientation, under a shear load per area of the base and its weight.
fn on_plane(kind: ElementKind, law: &str, push: [f64; 2], pressure: f64) -> Model {
    let mesh = moved(
        solid("block", kind, [3, 2, 1], between([0.0; 3], [1.5, 1.0, 0.1])),
        turned,
    );
    let text = format!(
        "{BODY}
        [[traction]]
        on = 'block z0'
        value = {}
        [[traction]]
        on = 'block z1'
        value = {}
        [[contact]]
        name = 'floor'
        sides = ['block z0']
        obstacle = {{ point = [0.0, 0.0, 0.0], normal = {} }}
        gap = 0.0
        {law}",
        vector(turned([push[0], push[1], 0.0])),
        vector(turned([0.0, 0.0, -pressure])),
        vector(turned([0.0, 0.0, 1.0])),
    );
    model(&text, mesh)
}

const PRESSURE: f64 = 1e6;
const AREA: f64 = 1.5;

#[test]
fn a_block_stands_below_the_angle_of_friction_and_slides_above_it_in_every_direction() {
    for direction in [0.3_f64, 2.0, 5.5] {
        for (share, stands) in [
            (0.9, true),
            (1.0 - 1e-6, true),
            (1.0 + 1e-6, false),
            (1.1, false),
        ] {
            let push = [direction.cos(), direction.sin()].map(|c| 0.4 * share * PRESSURE * c);
            let model = on_plane(Hexahedron8, "friction = 0.4", push, PRESSURE);
            let ended = Case::of(&model, 2).run(&[]);
            let expected = if stands { 0 } else { 4 };
            assert_eq!(
                ended.code(),
                expected,
                "{direction}, {share}: {}",
                ended.stderr
            );
            assert!(
                stands || ended.stderr.contains("slides"),
                "{}",
                ended.stderr
            );
        }
    }
}

#[test]
fn what_a_block_is_pushed_with_is_what_friction_holds() {
    for kind in [Tetrahedron4, Hexahedron20] {
        let push = [2e5, -1.5e5];
        let solution = solve(&on_plane(kind, "friction = 0.5", push, PRESSURE), 3);
        let sum = solution.points().fold([0.0; 3], |sum, point| {
            [0, 1, 2].map(|k| sum[k] + point.tangential_force[k])
        });
        let expected = turned([-push[0], -push[1], 0.0]).map(|c| AREA * c);
        is_near(&sum, &expected, 1e-10 * AREA * PRESSURE);
        assert_eq!(solution.closed(), solution.points().count());
    }
}

/// Two blocks, the upper one moved by its upper side.
fn driven(kind: ElementKind, law: &str, steps: &str) -> (String, Mesh) {
    let lower = solid("lower", kind, [2, 2, 1], between([0.0; 3], [1.0, 1.0, 0.5]));
    let upper = solid(
        "upper",
        kind,
        [2, 2, 1],
        between([0.0, 0.0, 0.5], [1.0, 1.0, 1.0]),
    );
    let text = format!(
        "materials.rock = {{young = 20e9, poisson = 0.0}}
        bodies.lower.material = 'rock'
        bodies.upper.material = 'rock'
        [[displacement]]
        on = 'lower z0'
        x = 0
        y = 0
        z = 0
        [[displacement]]
        on = 'upper z1'
        x = 0
        y = 0
        z = -1e-4
        [[contact]]
        name = 'joint'
        sides = ['upper z0', 'lower z1']
        gap = 0.0
        {law}
        {steps}"
    );
    (text, joined(lower, upper))
}

fn to(x: f64, y: f64) -> String {
    format!(
        "[[step]]
        [[step.displacement]]
        on = 'upper z1'
        x = {x:?}
        y = {y:?}
        z = -1e-4
        [[step.displacement]]
        on = 'lower z0'
        x = 0
        y = 0
        z = 0
        "
    )
}

/// A block on a plane in uniform compression and shear, τ = μ p opposite to the slip increment, whose direction changes
/// from step to step.
#[test]
fn what_slips_evenly_is_pulled_back_by_the_bound_whatever_way_it_goes() {
    let (mu, pressure, high, shear_modulus) = (0.3, 2e6, 0.5, 10e9);
    let slips = [[1e-4_f64, 0.5e-4], [1.1e-4, 2e-4], [-1e-4, 1e-4]];
    let mut text = format!(
        "materials.rock = {{young = 20e9, poisson = 0.0}}
        bodies.block.material = 'rock'
        [[displacement]]
        on = 'block z1'
        x = 0
        y = 0
        z = 0
        [[contact]]
        name = 'floor'
        sides = ['block z0']
        obstacle = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
        gap = 0.0
        friction = {mu}
        "
    );
    let mut shears = Vec::new();
    let mut before = [0.0_f64; 2];
    for slip in slips {
        let way = [0, 1].map(|k| slip[k] - before[k]);
        let shear = way.map(|w| mu * pressure * w / way[0].hypot(way[1]));
        let top = [0, 1].map(|k| slip[k] + shear[k] / shear_modulus * high);
        text += &format!(
            "[[step]]
            [[step.displacement]]
            on = 'block z1'
            x = {:?}
            y = {:?}
            z = {:?}
            ",
            top[0],
            top[1],
            -pressure / 20e9 * high
        );
        for (side, traction) in ["x1", "x0", "y1", "y0"]
            .iter()
            .zip([shear[0], -shear[0], shear[1], -shear[1]])
        {
            text +=
                &format!("[[step.traction]]\non = 'block {side}'\nvalue = [0, 0, {traction:?}]\n");
        }
        shears.push(shear);
        before = slip;
    }
    for kind in SOLIDS {
        let mesh = solid(
            "block",
            kind,
            [2, 2, 1],
            between([0.0; 3], [1.0, 1.0, high]),
        );
        let solutions = solve_steps(&model(&text, mesh), 3);
        for ((solution, slip), shear) in solutions.iter().zip(slips).zip(&shears) {
            for point in solution.points() {
                let area = point.force / point.pressure;
                close(point.pressure, pressure, 1e-10 * pressure);
                is_near(&point.slip, &[slip[0], slip[1], 0.0], 1e-10 * 1e-4);
                let expected = [-shear[0] * area, -shear[1] * area, 0.0];
                is_near(&point.tangential_force, &expected, 1e-10 * pressure * area);
                assert!(point.slipping);
            }
        }
    }
}

/// A closed path along which a joint sticks and slips; in the end it is periodic.
#[test]
fn what_a_cycle_in_space_takes_is_what_friction_dissipates() {
    let corners = [[2e-4, 0.0], [2e-4, 2e-4], [-2e-4, 1e-4], [0.0, -2e-4]];
    for (kind, law) in [
        (Hexahedron8, "friction = 0.3"),
        (Tetrahedron10, "tresca = 1e6"),
    ] {
        let mut steps = String::new();
        (0..5).for_each(|_| corners.iter().for_each(|[x, y]| steps += &to(*x, *y)));
        let (text, mesh) = driven(kind, law, &steps);
        let model = model(&text, mesh);
        let works = checked_works(&model, &solve_steps(&model, 4));
        let last = &works[4 * corners.len()..];
        let outside: f64 = last.iter().map(Works::outside).sum();
        let friction: f64 = last.iter().map(|work| work.friction).sum();
        assert!(friction > 0.0, "{law}");
        close(outside, friction, 1e-10 * friction);
    }
}

#[test]
fn a_joint_that_sticks_is_glued() {
    let steps = to(1e-5, 2e-5);
    for law in ["friction = 5.0", "tresca = 1e9"] {
        let (text, mesh) = driven(Tetrahedron10, law, &steps);
        let glued = at_step(&model(&text, mesh.clone()), 0);
        let solution = &solve_steps(&model(&text, mesh), 2)[0];
        let assembled = Assembled::new(&glued);
        let closed = vec![true; assembled.conditions.len()];
        let stuck: Vec<_> = assembled
            .tangents
            .iter()
            .map(|t| (t.row.clone(), 0.0))
            .collect();
        let (u, _) = assembled.solve(&closed, &stuck);
        let found = solution.dofs(&glued);
        is_near(&found, &u, 1e-12 * 1e-4);
        assert_eq!(solution.slipping(), 0);
    }
}

/// A rotated scene: magnitudes of forces and slips are unchanged.
#[test]
fn an_answer_turns_with_its_scene() {
    let scene = |to: fn([f64; 3]) -> [f64; 3], kind| {
        let lower = solid("lower", kind, [3, 3, 1], between([0.0; 3], [1.0, 1.0, 0.3]));
        let upper = solid(
            "upper",
            kind,
            [3, 3, 2],
            between([0.0, 0.0, 0.3], [1.0, 1.0, 0.7]),
        );
        let text = format!(
            "materials.rock = {{young = 20e9, poisson = 0.25}}
            bodies.lower.material = 'rock'
            bodies.upper = {{material = 'rock', body_force = {}}}
            [[displacement]]
            on = 'lower z0'
            x = 0
            y = 0
            z = 0
            [[bilateral]]
            on = 'lower y0'
            [[bilateral]]
            on = 'upper y0'
            [[traction]]
            on = 'upper z1'
            value = {}
            [[pressure]]
            on = 'upper x1'
            value = 6e5
            [[contact]]
            name = 'joint'
            sides = ['upper z0', 'lower z1']
            gap = 0.0
            tresca = 2e5",
            vector(to([0.0, 0.0, -1e5])),
            vector(to([2e5, 3e5, -1e6])),
        );
        let model = model(&text, moved(joined(lower, upper), to));
        (solve(&model, 4), model)
    };
    for kind in [Hexahedron8, Tetrahedron10] {
        let (straight, _) = scene(|x| x, kind);
        let (other, model) = scene(turned, kind);
        let (force, size) = (straight.largest_force(), straight.largest_displacement());
        assert!(straight.slipping() > 3 && straight.slipping() < straight.closed());
        for a in straight.points() {
            let b = other.points().find(|b| b.tags == a.tags).unwrap();
            close(a.force, b.force, 1e-9 * force);
            is_near(
                &turned(a.tangential_force),
                &b.tangential_force,
                1e-9 * force,
            );
            is_near(&turned(a.slip), &b.slip, 1e-9 * size);
        }
        let faults = Findings::new(&model, &Assembled::new(&model), &other, true).faults();
        assert!(faults.is_empty(), "{faults:?}");
    }
}

/// Between planes that prevent displacement along z, with the inner nodes free: plane strain is exact.
#[test]
fn extruded_scenes_with_friction_have_the_answers_of_the_plane() {
    let (raous, _) = built_in("raous", 0);
    let sides = [
        ("axis", "right"),
        ("top", "top"),
        ("side", "left"),
        ("base", "bottom"),
    ];
    let raous = sides.iter().fold(raous.to_owned(), |text, (from, to)| {
        text.replace(&format!("\"{from}\""), &format!("\"plate {to}\""))
    });
    let plate = Blocks::new().rectangle("plate", [0.0, 0.04], [0.0, 0.04], [12, 12]);
    let floor = "point = [0.0, 0.0], normal = [0.0, 1.0]";
    let blocks = two_block_scene();
    let law = |law: &str| format!("{blocks}\n{law}\n");
    let joint = two_blocks().mesh;
    let (plate_ends, block_ends) = (
        "['plate back', 'plate front']",
        "['lower back', 'lower front', 'upper back', 'upper front']",
    );
    for (text, plane, ends) in [
        (raous, plate.mesh, plate_ends),
        (law("friction = 0.15"), joint.clone(), block_ends),
        (
            law("friction = 0.05\ncohesion = 1e4"),
            joint.clone(),
            block_ends,
        ),
        (law("tresca = 5e4"), joint, block_ends),
    ] {
        let plane = sort("quad4").of(&plane);
        let solid = extruded(&plane, &[0.0, 0.1, 0.3]).unwrap();
        let deep = text
            .replace("plane = 'strain'", "")
            .replace("plane = \"strain\"", "")
            .replace(floor, "point = [0, 0, 0], normal = [0, 1, 0]");
        let deep = model(&format!("{deep}\n[[bilateral]]\non = {ends}\n"), solid);
        let flat = solve(&model(&text, plane), 4);
        let deep = solve(&deep, 6);
        let (force, size) = (flat.largest_force(), flat.largest_displacement());
        assert!(flat.slipping() > 0);
        for point in flat.points() {
            let same = |p: &&ContactPoint| (0..2).all(|k| p.position[k] == point.position[k]);
            let there: Vec<&ContactPoint> = deep.points().filter(same).collect();
            assert_eq!(there.len(), 3);
            let sum: f64 = there.iter().map(|p| p.force).sum();
            close(sum, 0.3 * point.force, 1e-10 * force);
            for p in there {
                is_near(&p.slip, &point.slip, 1e-10 * size);
                let share = p.force / sum;
                if sum > 1e-3 * force {
                    let expected = point.tangential_force.map(|f| 0.3 * share * f);
                    is_near(&p.tangential_force, &expected, 1e-10 * force);
                }
            }
        }
    }
}
