//! Plates with edge cracks and inner cracks, and wedges between blocks.

use super::draft::{Draft, bilinear};

/// A plate of pieces that are glued except for cracks along horizontal lines.
pub fn cracked(draft: &mut Draft) {
    let (across, up) = (draft.random.count(2, 4), draft.random.count(2, 3));
    // A piece in which a crack ends from both sides needs an inner column.
    let n = [0; 2].map(|_: usize| draft.random.count(2, draft.cells.max(2)));
    let lean = draft.random.signed() * draft.random.pick(&[0.0, 0.5, 1.0]);
    let plate = move |[x, y]: [f64; 2]| [x, y + lean * x];
    let open: Vec<Vec<bool>> = (1..up).map(|_| crack(draft, across)).collect();
    let is_above_crack = |i: usize, j: usize| j > 0 && open[j - 1][i];
    for i in 0..across {
        let mut columns = n[0];
        for j in 0..up {
            if is_above_crack(i, j) {
                columns = draft.facing(columns).max(2);
            }
            let (x, y) = (i as f64, j as f64);
            let n = [columns, n[1]];
            draft.shape(&format!("q{i}_{j}"), n, |[s, t]| plate([x + s, y + t]));
        }
    }
    let cracks = open.clone();
    let is_open = move |x: f64, y: f64| {
        let level = y - lean * x;
        let line = level.round();
        let on_line = (level - line).abs() < 1e-9 && line >= 1.0 && line < up as f64;
        // Tips are glued: a node is free only between open pieces, or at the edge of the plate.
        let pieces = [x - 1e-6, x + 1e-6].map(f64::floor);
        on_line
            && pieces.iter().all(|&piece| {
                let outside = piece < 0.0 || piece >= across as f64;
                outside || cracks[line as usize - 1][piece as usize]
            })
    };
    draft.glue(|x, y| !is_open(x, y));
    let names: Vec<String> = (0..across * up)
        .map(|k| format!("q{}_{}", k / up, k % up))
        .collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    draft.body("plate", &names, [0.0, 0.0]);
    for (j, line) in open.iter().enumerate() {
        for (i, _) in line.iter().enumerate().filter(|(_, open)| **open) {
            let gap = draft.drawn_gap("x");
            let (a, b) = (format!("q{i}_{} bottom", j + 1), format!("q{i}_{j} top"));
            draft.contact(&[a], &[b], Some(&gap));
        }
    }
    for i in 0..across {
        draft.hold(&format!("q{i}_0 bottom"), Some("0"), Some("0"));
        let (aside, down) = (
            draft.load * draft.random.signed(),
            draft.load * draft.random.signed(),
        );
        let top = format!("q{i}_{} top", up - 1);
        draft.traction(&top, [&format!("{aside:e}"), &format!("{down:e}*(1+x)")]);
    }
}

/// Pieces of a line that are open: one at most, so that no two open pieces share a node that would have to be glued on
/// either side.
fn crack(draft: &mut Draft, across: usize) -> Vec<bool> {
    let at = draft.random.below(across);
    (0..across).map(|i| i == at).collect()
}

/// A wedge that is pressed between two blocks.
pub fn wedge(draft: &mut Draft) {
    let lean = draft.random.magnitude(-1.5, -0.3);
    let (low, high) = (draft.random.magnitude(-1.5, 0.0), 1.0);
    let n = draft.side_cells();
    let mut columns = || draft.random.count(1, draft.cells);
    let columns = [columns(), columns(), columns()];
    let left = [
        [-1.0 - low, 0.0],
        [-low, 0.0],
        [-low - lean, high],
        [-1.0 - low, high],
    ];
    let right = left.map(|[x, y]| [-x, y]);
    let right = [right[1], right[0], right[3], right[2]];
    let middle = [left[1], right[0], right[3], left[2]];
    let weight = draft.weight(1.0);
    for (name, corners, columns) in [
        ("left", left, columns[0]),
        ("middle", middle, columns[1]),
        ("right", right, columns[2]),
    ] {
        let force = [0.0, if name == "middle" { weight } else { 0.0 }];
        let n = [columns, draft.facing(n)];
        draft.shape(name, n, |st| bilinear(corners, st));
        draft.body(name, &[name], force);
    }
    for (block, outer) in [("left", "left left"), ("right", "right right")] {
        draft.hold(&format!("{block} bottom"), None, Some("0"));
        draft.hold(outer, Some("0"), None);
    }
    for (side, other) in [
        ("middle left", "left right"),
        ("middle right", "right left"),
    ] {
        let gap = draft.drawn_gap("y");
        draft.contact(&[side.into()], &[other.into()], Some(&gap));
    }
    let size = draft.load * draft.random.magnitude(-2.0, 0.0);
    let lifted = draft.random.chance(0.1);
    draft.equilibrium = Some(!lifted);
    let value = match lifted {
        true => format!("{:e}", -100.0 * draft.load),
        false => format!("{size:e}"),
    };
    draft.pressure("middle top", &value);
}
