//! Inclusions in holes, round or square, with clearance or interference.

use super::draft::Draft;

/// A square plate with a hole in its middle and a body in the hole, held by the plate only.
pub fn inclusion(draft: &mut Draft) {
    // Without matching nodes only kinks between its facets would keep a round body from turning.
    let round = draft.random.chance(0.6) && draft.matching;
    let n = 2 * draft.random.count(1, draft.cells.div_ceil(2));
    let rings = draft.random.count(1, draft.cells);
    let radius = draft.random.within(0.1, 0.8);
    // A round hole's clearance is in its geometry, a square one's is given.
    let clearance = match round {
        true => {
            let size = draft.compression().min(1e-3) * draft.random.magnitude(-2.0, 1.0);
            size * draft.random.pick(&[-1.0, 0.0, 1.0])
        }
        false => 0.0,
    };
    for side in 0..4 {
        let along = draft.facing(n);
        draft.shape(&format!("p{side}"), [along, rings], |[s, t]| {
            let along = 1.0 - 2.0 * s;
            let inner = match round {
                true => squircle([along, -1.0]),
                false => [along, -1.0],
            };
            let point = [0, 1].map(|i| {
                let outer = [along, -1.0][i];
                inner[i] * (radius + clearance) * (1.0 - t) + outer * t
            });
            turned(point, side)
        });
    }
    draft.glue(|x, y| (x.abs() - y.abs()).abs() < 1e-9);
    draft.body("plate", &["p0", "p1", "p2", "p3"], [0.0, 0.0]);
    let n = [n, n].map(|n| draft.facing(n));
    draft.shape("d", n, |[s, t]| {
        let square = [2.0 * s - 1.0, 2.0 * t - 1.0];
        let point = match round {
            true => squircle(square),
            false => square,
        };
        point.map(|c| c * radius)
    });
    let push = match draft.random.below(3) {
        0 => [0.0, 0.0],
        _ => [0.0; 2].map(|_| draft.load * draft.random.signed()),
    };
    draft.body("d", &["d"], push);
    let names = ["bottom", "left", "top", "right"];
    // p0 lies below, p1 at the right, p2 above, p3 at the left.
    let facing = ["bottom", "right", "top", "left"];
    if round {
        let a = names.map(|name| format!("d {name}"));
        let b = [0, 1, 2, 3].map(|side| format!("p{side} bottom"));
        draft.contact(&a, &b, None);
    } else {
        for (side, name) in facing.iter().enumerate() {
            let axis = if side % 2 == 0 { "x" } else { "y" };
            let gap = draft.drawn_gap(axis);
            let (a, b) = ([format!("d {name}")], [format!("p{side} bottom")]);
            draft.contact(&a, &b, Some(&gap));
        }
    }
    loads(draft);
}

/// Loads of the plate, which is supported by rollers below and on the left; the other sides are pushed or pulled.
fn loads(draft: &mut Draft) {
    let loose = draft.random.chance(0.08);
    draft.equilibrium = Some(!loose);
    draft.hold("p0 top", None, Some("0"));
    if !loose {
        draft.hold("p3 top", Some("0"), None);
    }
    for (side, axis) in [(1, "y"), (2, "x")] {
        let size = draft.load * draft.random.magnitude(-2.0, 0.0);
        let sign = draft.random.pick(&[-1.0, 1.0]);
        let slope = draft.random.signed();
        let value = format!("({:e})*(1+({slope})*{axis})", sign * size);
        draft.pressure(&format!("p{side} top"), &value);
    }
}

/// Map of a square to a disk; its boundary remains the boundary.
fn squircle([x, y]: [f64; 2]) -> [f64; 2] {
    [
        x * (1.0 - y * y / 2.0).sqrt(),
        y * (1.0 - x * x / 2.0).sqrt(),
    ]
}

/// A point turned by quarters of a turn, counter-clockwise.
fn turned([x, y]: [f64; 2], quarters: usize) -> [f64; 2] {
    match quarters {
        0 => [x, y],
        1 => [-y, x],
        2 => [-x, -y],
        _ => [y, -x],
    }
}
