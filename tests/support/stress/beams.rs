//! Slender beams, clamped or held by contact, on each other and on stops.

use super::boxes::wall;
use super::draft::{Draft, rectangle};

/// Cantilevers on top of each other with rough gaps, like a leaf spring; the lowest may touch stops.
pub fn beams(draft: &mut Draft) {
    let count = draft.random.count(1, 4);
    let length = draft.random.magnitude(0.5, 2.0);
    let columns = draft.random.count(4, 5 * draft.cells);
    // A slender beam bends far more than a block is compressed.
    let deflection = draft.compression() * length.powi(3);
    for i in 0..count {
        let y = [i as f64, i as f64 + 1.0];
        let n = [draft.facing(columns), draft.random.count(1, 3)];
        let name = format!("b{i}");
        let weight = draft.load * draft.random.signed() * 0.1;
        draft.block(&name, rectangle([0.0, length], y), n, [0.0, weight]);
        draft.hold(&format!("{name} left"), Some("0"), Some("0"));
        if i > 0 {
            let gap = clamped_gap(draft, deflection, length);
            let (a, b) = (format!("b{i} bottom"), format!("b{} top", i - 1));
            draft.contact(&[a], &[b], Some(&gap));
        }
    }
    if draft.random.chance(0.6) {
        let gap = clamped_gap(draft, deflection, length);
        draft.obstacle(&["b0 bottom".into()], &wall(0.0, 0.0, [0, 1]), Some(&gap));
    }
    if draft.random.chance(0.3) {
        let gap = clamped_gap(draft, deflection, length);
        let top = wall(0.0, count as f64, [0, -1]);
        draft.obstacle(&[format!("b{} top", count - 1)], &top, Some(&gap));
    }
    let waves = draft.random.within(0.0, 20.0) / length;
    let (size, mean) = (draft.load, draft.random.signed());
    let value = format!("({size:e})*(({mean})+cos(({waves:e})*x))");
    draft.pressure(&format!("b{} top", count - 1), &value);
}

/// A plank on many stops, held in its length at one end.
pub fn plank(draft: &mut Draft) {
    let length = draft.random.magnitude(0.5, 1.5);
    let spans = draft.random.count(2, 5);
    let cells = draft.random.count(1, draft.cells);
    let weight = draft.weight(1.0) - 1e-3 * draft.load;
    let deflection = draft.compression() * (length / spans as f64).powi(3);
    let step = length / spans as f64;
    let mut names = Vec::new();
    for i in 0..spans {
        let x = [i as f64 * step, (i + 1) as f64 * step];
        let name = format!("s{i}");
        draft.shape(&name, [cells, 2], |[s, t]| [x[0] * (1.0 - s) + x[1] * s, t]);
        names.push(name);
    }
    draft.glue(|_, _| true);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    draft.body("plank", &names, [0.0, weight]);
    draft.hold("s0 left", Some("0"), None);
    for (i, name) in names.iter().enumerate() {
        // A piece without a stop between two that have one.
        if i % 2 == 1 && i + 1 < spans && draft.random.chance(0.5) {
            continue;
        }
        let gap = bending_gap(draft, deflection, step);
        let stop = wall(0.0, 0.0, [0, 1]);
        draft.obstacle(&[format!("{name} bottom")], &stop, Some(&gap));
    }
    for name in names {
        let size = draft.load * draft.random.within(0.0, 1.0);
        draft.pressure(&format!("{name} top"), &format!("{size:e}"));
    }
}

/// A gap that vanishes where both sides are clamped.
fn clamped_gap(draft: &mut Draft, deflection: f64, length: f64) -> String {
    let gap = bending_gap(draft, deflection, length);
    format!("(x/({length:e}))*({gap})")
}

fn bending_gap(draft: &mut Draft, deflection: f64, length: f64) -> String {
    let size = deflection * draft.random.magnitude(-6.0, 0.0);
    let phase = draft.random.within(0.0, 6.0);
    let waves = draft.random.pick(&[3.0, 30.0, 1e4]) / length;
    let offset = size * draft.random.pick(&[0.0, 0.0, 1.0, 0.5]);
    format!("({size:e})*sin(({waves:e})*x+({phase}))+({offset:e})")
}
