//! Scenes in space with friction, whose loads rotate and reverse.

use std::f64::consts::{PI, TAU};

use super::super::draft::Draft;
use super::super::friction::frictional;
use super::super::{Family, matching};

/// The families of scenes in space with friction: the frictionless ones, pushed around, and a driven one.
pub const FAMILIES: [Family; 7] = [
    frictional(matching("stack in space", stack)),
    frictional(matching("packing in space", packing)),
    frictional(matching("layers in space", layers)),
    frictional(matching("wedge in space", wedge)),
    frictional(matching("corner in space", corner)),
    frictional(matching("indenter in space", indenter)),
    frictional(matching("driven in space", driven)),
];

fn stack(draft: &mut Draft) {
    super::stack(draft);
    pushed_about(draft);
}

fn packing(draft: &mut Draft) {
    super::packing(draft);
    pushed_about(draft);
}

fn layers(draft: &mut Draft) {
    super::layers(draft);
    pushed_about(draft);
}

fn wedge(draft: &mut Draft) {
    super::wedge(draft);
    pushed_about(draft);
}

fn corner(draft: &mut Draft) {
    super::corner(draft);
    pushed_about(draft);
}

fn indenter(draft: &mut Draft) {
    super::indenter(draft);
    draft.some_pressure("b1 z1");
    pushed_about(draft);
}

/// Adds tractions along a pressed side, in none or up to five load steps, between which they rotate or reverse.
fn pushed_about(draft: &mut Draft) {
    let at = draft.random.below(draft.pressed.len());
    let side = draft.pressed[at].clone();
    let size = draft.load * draft.random.magnitude(-4.0, -1.0);
    let mut angle = draft.random.within(0.0, TAU);
    let mut traction = |draft: &mut Draft| {
        angle += match draft.random.chance(0.3) {
            true => PI,
            false => draft.random.within(0.0, PI),
        };
        let size = size * draft.random.within(0.0, 1.0);
        let along = [size * angle.cos(), size * angle.sin()];
        let value = match side.as_bytes() {
            [.., b'x', _] => [0.0, along[0], along[1]],
            [.., b'y', _] => [along[0], 0.0, along[1]],
            _ => [along[0], along[1], 0.0],
        };
        let value = draft.turned(value).map(|c| format!("{c:e}"));
        format!("on = '{side}'\nvalue = {value:?}\n")
    };
    if draft.random.chance(0.5) {
        let traction = traction(draft);
        draft.add(&format!("[[traction]]\n{traction}"));
    }
    if draft.random.chance(0.3) {
        return;
    }
    for _ in 0..draft.random.count(1, 5) {
        let [pressure, weight] = [0; 2].map(|_: usize| draft.random.within(0.3, 1.5));
        let traction = traction(draft);
        draft.step(&format!(
            "scale = {{ pressure = {pressure}, body_force = {weight} }}\n[[step.traction]]\n{traction}"
        ));
    }
}

/// A block on a base, pressed, its upper side moved around further than it sticks, and rotated; or it is pressed by
/// that side, too.
fn driven(draft: &mut Draft) {
    let height = draft.random.magnitude(-1.0, 0.0);
    let n = draft.counts();
    let wide = match draft.matching {
        true => 1.0,
        false => draft.random.within(1.0, 2.0),
    };
    let [low, high] = [1.0 - wide, wide];
    draft.cuboid("base", [low, low, -0.5], [high, high, 0.0], n, [0.0; 3]);
    let n = draft.facing_counts(n);
    draft.cuboid("b", [0.0; 3], [1.0, 1.0, height], n, [0.0; 3]);
    let gap = draft.some_gap().unwrap_or_else(|| "0".into());
    draft.joint("b z0", "base z1", Some(&gap));
    draft.hold_all("base z0");
    let size = draft.compression() * draft.random.magnitude(-1.0, 1.0);
    let pressed = draft.compression() * draft.random.magnitude(-1.0, 0.5);
    // Displacements are prescribed along x, y and z, which are tilted against the bodies' axes.
    let by_load = !draft.tilted && draft.random.chance(0.5);
    if by_load {
        draft.some_pressure("b z1");
    }
    let turns = !draft.tilted && draft.random.chance(0.4);
    let mut angle = draft.random.within(0.0, TAU);
    let mut moved = |draft: &mut Draft| {
        angle += match draft.random.chance(0.3) {
            true => PI,
            false => draft.random.within(0.0, PI),
        };
        let size = size * draft.random.within(0.0, 1.0);
        let down = pressed * draft.random.within(0.2, 1.2);
        let [x, y, z] = draft.turned([size * angle.cos(), size * angle.sin(), -down]);
        let spin = match turns {
            true => size * draft.random.signed(),
            false => 0.0,
        };
        let mut keys = format!(
            "on = 'b z1'\nx = '({x:e})-({spin:e})*(y-0.5)'\ny = '({y:e})+({spin:e})*(x-0.5)'\n"
        );
        if !by_load {
            keys += &format!("z = {z:e}\n");
        }
        keys
    };
    let first = moved(draft);
    draft.add(&format!("[[displacement]]\n{first}"));
    for _ in 0..draft.random.count(0, 5) {
        let keys = moved(draft);
        draft.step(&format!(
            "[[step.displacement]]\n{keys}[[step.displacement]]\non = 'base z0'\nx = 0\ny = 0\nz = 0"
        ));
    }
}
