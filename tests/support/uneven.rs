//! Blocks whose meshes don't match.

use contact_dd_partition::model::Model;

use super::blocks::{Blocks, joined, moved};
use super::random::Random;
use super::scenes::model;
use super::sorts::Sort;

/// The pressure on the blocks [Pa].
pub const PRESSURE: f64 = 1e6;

/// Two materials, and bodies that alternate between them.
pub fn materials(bodies: &[&str]) -> String {
    let mut text = "plane = 'strain'
        materials.m0 = {young = 210e9, poisson = 0.3}
        materials.m1 = {young = 20e9, poisson = 0.22}\n"
        .to_owned();
    for (i, body) in bodies.iter().enumerate() {
        text += &format!("bodies.'{body}'.material = 'm{}'\n", i % 2);
    }
    text
}

/// A block of n[0] × n[1] cells with nodes irregularly spaced along x.
pub fn block(
    blocks: Blocks,
    name: &str,
    x: [f64; 2],
    y: [f64; 2],
    n: [usize; 2],
    seed: u64,
) -> Blocks {
    let mut random = Random::new(seed);
    let columns: Vec<f64> = (0..=n[0])
        .map(|i| match i == 0 || i == n[0] {
            true => i as f64 / n[0] as f64,
            false => (i as f64 + 0.35 * random.signed()) / n[0] as f64,
        })
        .collect();
    blocks.mapped(name, n, |[s, t]| {
        let column = columns[(s * n[0] as f64).round() as usize];
        [x[0] + column * (x[1] - x[0]), y[0] + t * (y[1] - y[0])]
    })
}

/// Two blocks of these cells along their joint and `rows` across, the upper one on the lower one, under [`PRESSURE`]
/// from above, rotated by an angle. With `upside_down` the lower one is side a.
#[track_caller]
pub fn two_sorts(
    [lower, upper]: [Sort; 2],
    n: [usize; 2],
    rows: usize,
    angle: f64,
    upside_down: bool,
) -> Model {
    let place = |name, y, n, sort: Sort| {
        let mesh = block(Blocks::new(), name, [0.0, 2.0], y, [n, rows], n as u64);
        sort.of(&mesh.mesh)
    };
    let mesh = joined(
        place("lower", [0.0, 1.0], n[0], lower),
        place("upper", [1.0, 2.0], n[1], upper),
    );
    let (sin, cos) = f64::sin_cos(angle);
    let mesh = moved(mesh, |[x, y]| [cos * x - sin * y, sin * x + cos * y]);
    let sides = match upside_down {
        true => "'lower top', 'upper bottom'",
        false => "'upper bottom', 'lower top'",
    };
    let text = format!(
        "{}
        [[bilateral]]
        on = 'lower bottom'
        [[bilateral]]
        on = 'lower left'
        [[bilateral]]
        on = 'upper left'
        [[pressure]]
        on = 'upper top'
        value = {PRESSURE}
        [[contact]]
        name = 'joint'
        sides = [{sides}]
        gap = 0.0",
        materials(&["lower", "upper"])
    );
    model(&text, mesh)
}

/// The stress of an upright column under [`PRESSURE`], rotated by an angle: xx, yy, xy.
pub fn turned_pressure(angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [sin * sin, cos * cos, -sin * cos].map(|s| -PRESSURE * s)
}
