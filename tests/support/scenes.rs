//! Scenes that several tests solve.

use contact_dd_partition::example;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use super::blocks::{Blocks, jittered};
use super::extruded::extruded;
use super::sorts::sort;

/// Plane state, materials and bodies of most scenes.
pub const BODIES: &str = "
plane = 'strain'
materials.steel = {young = 210e9, poisson = 0.3}
materials.rock = {young = 20e9, poisson = 0.22}
bodies.lower.material = 'rock'
bodies.upper.material = 'steel'
";

/// The lower block held at its bottom.
pub const HELD: &str = "
[[displacement]]
on = 'lower bottom'
x = 0.0
y = 0.0
";

/// Supports of both blocks: `HELD`, and the upper block at its left side against sliding.
pub const SUPPORTS: &str = "
[[displacement]]
on = 'lower bottom'
x = 0.0
y = 0.0
[[displacement]]
on = 'upper left'
x = 0.0
";

/// A pressure on the left that becomes tension on the right.
pub const LOAD: &str = "
[[pressure]]
on = 'upper top'
value = '1e6*(1.95-1.9*x)'
";

/// The joint of the two blocks.
pub const JOINT: &str = "
[[contact]]
name = 'joint'
sides = ['upper bottom', 'lower top']
";

/// A wide lower and a narrower upper block, 2 m and 1 m wide, 1 m high each.
pub fn two_blocks() -> Blocks {
    Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [16, 8])
        .rectangle("upper", [0.5, 1.5], [1.0, 2.0], [8, 8])
}

/// The scene of [`two_blocks`], complete with supports, load and contact.
pub fn two_block_scene() -> String {
    format!("{BODIES}{SUPPORTS}{LOAD}{JOINT}")
}

/// The model of a scene in TOML, which may leave out `mesh`, on a mesh.
#[track_caller]
pub fn model(text: &str, mesh: Mesh) -> Model {
    let text = match text.contains("mesh =") {
        true => text.to_owned(),
        false => format!("mesh = 'here.msh'\n{text}"),
    };
    let scene = Scene::parse(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Model::new(&scene, mesh).unwrap_or_else(|e| panic!("{e}"))
}

/// A built-in scene: its text and its mesh.
pub fn built_in(name: &str, refine: u32) -> (&'static str, Mesh) {
    let example = example::find(name).unwrap();
    (example.scene, example.mesh(refine).unwrap())
}

/// The model of a built-in scene.
pub fn built_in_model(name: &str, refine: u32) -> Model {
    let (text, mesh) = built_in(name, refine);
    model(text, mesh)
}

/// The model with the loads of step k as its only ones, without steps.
pub fn at_step(model: &Model, k: usize) -> Model {
    let mut at_step = model.clone();
    let step = &model.steps[k];
    for (support, &value) in at_step.supports.iter_mut().zip(&step.supports) {
        support.value = value;
    }
    for ((_, force), &value) in at_step.forces.iter_mut().zip(&step.forces) {
        *force = value;
    }
    at_step.forces.retain(|(_, force)| *force != [0.0; 3]);
    at_step.steps.clear();
    at_step
}

/// A plate of squares of two materials, 7 along its height, held on the left and pulled on the right.
pub fn checkerboard(young: [f64; 2], poisson: f64, length: usize, cells: usize) -> Model {
    let (scene, mesh) = squares(young, poisson, length, cells);
    model(&scene, mesh)
}

/// The scene of the checkerboard and its mesh.
fn squares(young: [f64; 2], poisson: f64, length: usize, cells: usize) -> (String, Mesh) {
    let mut blocks = Blocks::new();
    for i in 0..7 * length {
        for j in 0..7 {
            let end = match i {
                0 => " at the left",
                i if i + 1 == 7 * length => " at the right",
                _ => "",
            };
            let name = format!("{}{end}", ["even", "odd"][(i + j) % 2]);
            let side = |i: usize| [i as f64 / 7.0, (i + 1) as f64 / 7.0];
            blocks = blocks.rectangle(&name, side(i), side(j), [cells, cells]);
        }
    }
    let mesh = blocks.glued(|_, _| true).mesh;
    let mut scene = String::from("plane = 'strain'\n");
    for (kind, young) in ["even", "odd"].into_iter().zip(young) {
        scene += &format!("[materials.{kind}]\nyoung = {young}\npoisson = {poisson}\n");
        for end in ["", " at the left", " at the right"] {
            scene += &format!("[bodies.'{kind}{end}']\nmaterial = '{kind}'\n");
        }
    }
    for kind in ["even", "odd"] {
        scene += &format!("[[displacement]]\non = '{kind} at the left left'\nx = 0.0\ny = 0.0\n");
        scene += &format!("[[traction]]\non = '{kind} at the right right'\nvalue = [1e2, -2e2]\n");
    }
    let step = 1.0 / (7 * cells) as f64;
    (scene, jittered(mesh, 0.2 * step, 3))
}

/// The checkerboard in space, held all over on the left: columns that are `layers` cells long.
pub fn columns(young: [f64; 2], poisson: f64, cells: usize, layers: usize) -> Model {
    let (scene, mesh) = squares(young, poisson, 1, cells);
    let heights: Vec<f64> = (0..=layers).map(|k| k as f64 / layers as f64).collect();
    let scene = (scene.replace("plane = 'strain'\n", ""))
        .replace("y = 0.0\n", "y = 0.0\nz = 0.0\n")
        .replace("-2e2]", "-2e2, 1e2]");
    let mesh = extruded(&sort("quad4").of(&mesh), &heights);
    model(&scene, mesh.unwrap())
}

/// A block whose corner lies in that of two walls and on a third one across: three conditions on a node, each with the
/// keys `words`, under a body force.
pub fn corner(force: [f64; 2], words: &str) -> Model {
    let blocks = Blocks::new().rectangle("block", [0.01, 1.01], [0.02, 1.02], [8, 8]);
    let wall = |name: &str, on: &str, point: &str, normal: &str| {
        format!(
            "[[contact]]
            name = '{name}'
            sides = ['block {on}']
            obstacle = {{ point = {point}, normal = {normal} }}
            {words}\n"
        )
    };
    let text = format!(
        "plane = 'strain'
        materials.rock = {{young = 2e9, poisson = 0.22}}
        bodies.block = {{material = 'rock', body_force = [{}, {}]}}
        {}{}{}",
        force[0],
        force[1],
        wall("floor", "bottom", "[0.0, 0.0]", "[0.0, 1.0]"),
        wall("wall", "left", "[0.0, 0.0]", "[1.0, 0.0]"),
        wall("slope", "bottom", "[0.005, 0.0]", "[1.0, 1.0]"),
    );
    model(&text, blocks.mesh)
}
