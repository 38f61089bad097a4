//! Forces on nodes.

use contact_dd_partition::mesh::{Group, Mesh};
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::extruded::extruded;
use crate::support::scenes::{BODIES, HELD, JOINT, SUPPORTS, model, two_blocks};
use crate::support::solver::solve;
use crate::support::sorts::{SORTS, sort};
use crate::support::statics::{balanced, reaction};

const ONE_BODY: &str = "
materials.rock = {young = 20e9, poisson = 0.25}
bodies.block.material = 'rock'
[[displacement]]
on = 'block bottom'
x = 0.0
y = 0.0
";

/// The sum of all nodal forces of a model.
fn sum(model: &Model) -> [f64; 3] {
    (model.forces.iter()).fold([0.0; 3], |sum, (_, force)| {
        [0, 1, 2].map(|i| sum[i] + force[i])
    })
}

#[test]
fn a_total_on_a_side_is_shared_like_a_uniform_traction() {
    // The areas of the tops; around an axis that of the whole ring.
    let ring = std::f64::consts::PI * (1.5_f64.powi(2) - 0.5_f64.powi(2));
    for (plane, area) in [("strain", 1.0), ("axisymmetric", ring)] {
        let mesh = Blocks::new()
            .rectangle("block", [0.5, 1.5], [0.0, 1.0], [5, 4])
            .mesh;
        for sort in SORTS {
            let of = |load: &str| {
                let text = format!("plane = '{plane}'\n{ONE_BODY}{load}");
                model(&text, sort.of(&mesh))
            };
            let [x, y] = [3e5, -2e6];
            let total = of(&format!("[[force]]\non = 'block top'\ntotal = [{x}, {y}]"));
            let traction = of(&format!(
                "[[traction]]\non = 'block top'\nvalue = [{}, {}]",
                x / area,
                y / area
            ));
            assert_eq!(total.forces.len(), traction.forces.len());
            for ((node, found), (same, expected)) in total.forces.iter().zip(&traction.forces) {
                assert_eq!(node, same);
                for (found, expected) in found.iter().zip(expected) {
                    close(*found, *expected, 1e-12 * y.abs());
                }
            }
        }
    }
}

#[test]
fn points_share_a_total_in_equal_parts_and_each_has_its_own_otherwise() {
    let plane = Blocks::new()
        .rectangle("block", [0.0, 1.0], [0.0, 1.0], [4, 4])
        .mesh;
    let mut mesh = extruded(&sort("quad4").of(&plane), &[0.0, 0.5, 1.0]).unwrap();
    let members: Vec<u32> = (0..mesh.points.len() as u32).rev().take(3).collect();
    let members: Vec<u32> = members.into_iter().rev().collect();
    mesh.groups
        .insert("three".into(), Group { dim: 0, members });
    for (key, factor) in [("total", 1.0), ("each", 3.0)] {
        let text = format!(
            "{ONE_BODY}z = 0.0\n[[force]]\non = 'three'\n{key} = [3e5, -6e5, 9e5]\n
             [[step]]\nscale = {{ force = 0.5 }}\n
             [[step]]\nforce = [{{ on = 'three', {key} = [0.0, 0.0, 3.0] }}]"
        );
        let model = model(&text, mesh.clone());
        assert_eq!(model.forces.len(), 3);
        for (_, force) in &model.forces {
            let expected = [1e5, -2e5, 3e5].map(|part| 0.5 * factor * part);
            (force.iter().zip(expected)).for_each(|(a, b)| close(*a, b, 1e-9));
        }
        for force in &model.steps[1].forces {
            assert_eq!(*force, [0.0, 0.0, factor]);
        }
    }
}

#[test]
fn a_joint_carries_a_force_at_a_point_with_its_moment() {
    let mesh = two_blocks().mesh;
    let top = |x: f64| {
        let at = |p: &[f64; 3]| (p[0] - x).abs() < 1e-9 && (p[1] - 2.0).abs() < 1e-9;
        mesh.points.iter().position(at).unwrap() as u32
    };
    let mut mesh: Mesh = mesh.clone();
    let members = vec![top(0.75)];
    mesh.groups.insert("tip".into(), Group { dim: 0, members });
    let force = -1e6;
    let text = format!("{BODIES}{SUPPORTS}{JOINT}[[force]]\non = 'tip'\ntotal = [0.0, {force}]");
    let model = model(&text, mesh);
    assert_eq!(sum(&model), [0.0, force, 0.0]);
    for count in [2, 3, 6] {
        let solution = solve(&model, count);
        // The support on the left, without friction, carries a moment but no vertical force.
        let [x, y, _] = reaction(solution.contacts.values().flatten());
        balanced([x, y, 0.0], [0.0, -force, 0.0], 1e-10 * force.abs());
    }
}

#[test]
fn a_force_without_an_amount_or_on_cells_is_refused() {
    let mesh = two_blocks().mesh;
    let scene = |force: &str| Scene::parse(&format!("mesh = 'm'\n{BODIES}{HELD}{JOINT}{force}"));
    let of = |force: &str| match scene(force) {
        Err(error) => error.to_string(),
        Ok(scene) => Model::new(&scene, mesh.clone()).unwrap_err().to_string(),
    };
    for (force, expected) in [
        (
            "[[force]]\non = 'upper top'",
            "'total', the sum of forces, or 'each'",
        ),
        (
            "[[force]]\non = 'upper top'\ntotal = [1.0, 2.0]\neach = [1.0, 2.0]",
            "'total', the sum of forces, or 'each'",
        ),
        ("[[force]]\non = 'upper top'\ntotal = [1.0]", "expected"),
        (
            "[[force]]\non = 'upper'\ntotal = [1.0, 2.0]",
            "'upper' is a group of cells; expected one of facets or points",
        ),
        (
            "[[force]]\non = 'top'\ntotal = [1.0, 2.0]",
            "no physical group 'top'",
        ),
    ] {
        let error = of(force);
        assert!(error.contains(expected), "{error}");
    }
}
