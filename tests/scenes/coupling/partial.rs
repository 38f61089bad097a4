//! Couplings of some displacements.

use contact_dd_partition::element::ElementKind::{Hexahedron8, Hexahedron20, Tetrahedron10};
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use super::{coupling, resultant};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::Case;

const YOUNG: f64 = 20e9;
const POISSON: f64 = 0.3;
const SIZE: [f64; 3] = [0.6, 0.4, 1.0];

/// A block with symmetry conditions on its three lower sides.
const BLOCK: &str = "
materials.rock = {young = 20e9, poisson = 0.3}
bodies.block = {material = 'rock'}
[[bilateral]]
on = ['block x0', 'block y0', 'block z0']
";

/// Axes rotated about y and then about z, by angles of 3-4-5 triangles.
const AXES: [[f64; 3]; 3] = [[0.48, 0.64, -0.6], [-0.8, 0.6, 0.0], [0.36, 0.48, 0.8]];

fn turned(x: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| (0..3).map(|axis| x[axis] * AXES[axis][k]).sum())
}

/// A side that follows the point only along its normal allows lateral contraction: the stress is uniform, also with
/// skew axes, and for any other prescribed components of the point.
#[test]
fn a_side_that_follows_along_its_normal_contracts_freely() {
    let force = 3e6;
    let strain = force / (YOUNG * SIZE[0] * SIZE[1]);
    let point = turned([0.3, 0.2, 1.0]);
    let normal = AXES[2];
    let pulled = normal.map(|c| force * c);
    for (kind, n) in [(Hexahedron8, [3, 2, 3]), (Tetrahedron10, [1, 1, 2])] {
        let mesh = solid("block", kind, n, |xi| turned(between([0.0; 3], SIZE)(xi)));
        let keys = format!("directions = [{normal:?}]\nforce = {pulled:?}");
        let text = format!("{BLOCK}{}", coupling("block z1", &point, &keys));
        uniform(&model(&text, mesh), strain);
    }
    let mesh = solid("block", Hexahedron20, [1, 1, 2], between([0.0; 3], SIZE));
    let shift = strain * SIZE[2];
    for keys in [
        format!("force = [0.0, 0.0, {force:?}]"),
        format!("z = {shift:?}\nrx = 0.0\nry = 0.0"),
        format!("x = 0.0\ny = 1.0\nz = {shift:?}\nrx = 0.0\nry = 0.0\nrz = 0.0"),
    ] {
        let keys = format!("directions = [[0.0, 0.0, 2.0]]\n{keys}");
        let text = format!("{BLOCK}{}", coupling("block z1", &[0.3, 0.2, 1.4], &keys));
        let model = model(&text, mesh.clone());
        let all = model.mesh.points.iter().zip(&model.mesh.node_tags);
        let all: Vec<_> = all.take(model.mesh.points.len() - 3).collect();
        for count in [1, 2] {
            let solution = Case::of(&model, count).solve(&[]);
            for (x, tag) in &all {
                let u = solution.displacement[tag];
                for (k, slope) in [-POISSON, -POISSON, 1.0].into_iter().enumerate() {
                    close(u[k], slope * strain * x[k], 1e-10 * strain);
                }
            }
        }
    }
}

/// Fails unless the skew block is under uniform uniaxial stress along its third axis.
#[track_caller]
fn uniform(model: &Model, strain: f64) {
    let nodes = model.mesh.points.len() - 3;
    for count in [1, 4] {
        for interface in ["direct", "iterative"] {
            let solution = Case::of(model, count).solve(&["--interface", interface]);
            for (x, tag) in model.mesh.points[..nodes].iter().zip(&model.mesh.node_tags) {
                let u = solution.displacement[tag];
                for (axis, slope) in AXES.iter().zip([-POISSON, -POISSON, 1.0]) {
                    let along = |v: [f64; 3]| (0..3).map(|k| v[k] * axis[k]).sum::<f64>();
                    close(along(u), slope * strain * along(*x), 1e-9 * strain);
                }
            }
        }
    }
}

/// A coupling in three rotated directions equals the one in all directions.
#[test]
fn all_directions_are_all_displacements() {
    let mesh = solid("block", Hexahedron8, [3, 2, 3], between([0.0; 3], SIZE));
    let block = BLOCK.replace(
        "[[bilateral]]\non = ['block x0', 'block y0', 'block z0']",
        "[[displacement]]\non = 'block z0'\nx = 0.0\ny = 0.0\nz = 0.0",
    );
    let keys = "force = [2e5, -3e5, 1e5]\nmoment = [1e5, -2e5, 3e5]";
    let of = |keys: &str| {
        let text = format!("{block}{}", coupling("block z1", &[0.2, 0.5, 1.3], keys));
        Case::of(&model(&text, mesh.clone()), 3).solve(&[])
    };
    let expected = of(keys);
    let found = of(&format!("directions = {AXES:?}\n{keys}"));
    let scale = expected.largest_displacement();
    for (tag, v) in &expected.displacement {
        (0..3).for_each(|k| close(found.displacement[tag][k], v[k], 1e-10 * scale));
    }
    let [one, other] = [&found, &expected].map(|of| resultant(&of.report["reactions"][0]));
    (0..6).for_each(|k| close(one[k], other[k], 1e-8 * 5e5));
}

/// A block on a wall with friction, with its upper side guided by a plate that moves along x and z, and rotates.
fn guided() -> Model {
    let text = "
materials.rock = {young = 20e9, poisson = 0.22}
bodies.block = {material = 'rock'}
[[contact]]
name = 'wall'
sides = ['block z0']
obstacle = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
friction = 0.3
"
    .to_owned()
        + &coupling(
            "block z1",
            &[0.3, 0.2, 1.0],
            "directions = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]\nx = 0.0\nz = -1e-5\nrx = 0.0\nry = 0.0\nrz = 0.0",
        )
        + "[[step]]\n[[step]]\ncoupling.grip = { x = 2e-5 }\n";
    let mesh = solid("block", Hexahedron8, [4, 3, 5], between([0.0; 3], SIZE));
    model(&text, mesh)
}

#[test]
fn ranks_and_solvers_make_no_difference() {
    let case = Case::in_clusters(&guided(), 6, 3);
    let ended = case.run(&[]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let steps = Solution::steps(&case.result());
    steps.iter().for_each(Solution::check_certificate);
    case.is_the_same_on_all_ranks_and_by_iteration(1e-7);
}

#[test]
fn directions_that_couple_nothing_are_refused() {
    let mesh = solid("block", Hexahedron8, [1, 1, 1], between([0.0; 3], SIZE));
    let of = |keys: &str| {
        let text = format!(
            "mesh = 'm'\n{BLOCK}{}",
            coupling("block z1", &[0.3, 0.2, 1.5], keys)
        );
        match Scene::parse(&text) {
            Err(error) => error.to_string(),
            Ok(scene) => Model::new(&scene, mesh.clone()).unwrap_err().to_string(),
        }
    };
    for (keys, expected) in [
        (
            "directions = [[0.0, 0.0, 1.0]]\nforce = [1.0, 0.0, 1.0]",
            "isn't coupled; expected",
        ),
        (
            "directions = [[0.0, 0.0, 1.0]]\nmoment = [0.0, 0.0, 1.0]",
            "isn't coupled; expected",
        ),
        (
            "directions = [[1.0, 0.0, 0.0]]\nx = 0.0",
            "don't tell 'x' from other components",
        ),
        (
            "directions = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]",
            "aren't perpendicular",
        ),
        ("directions = [[0.0, 0.0, 0.0]]", "a direction of length 0"),
        ("directions = [[0.0, 1.0]]", "vectors of three components"),
        (
            "kind = 'distributing'\ndirections = [[0.0, 0.0, 1.0]]",
            "a distributing coupling has none",
        ),
    ] {
        let error = of(keys);
        assert!(error.contains(expected), "{error}");
    }
}
