//! Bodies held only by rigid obstacles: floors, notches, circles, pipes.

use super::boxes::wall;
use super::draft::{Draft, rectangle};

/// A body on a floor, pressed by circles from above.
pub fn punched(draft: &mut Draft) {
    let height = draft.random.magnitude(-1.5, 0.3);
    let n = [draft.side_cells().max(2), draft.side_cells()];
    let weight = draft.weight(height) - draft.load * 1e-2;
    draft.block("b", rectangle([-1.0, 1.0], [0.0, height]), n, [0.0, weight]);
    let floor = draft.drawn_gap("x");
    let side = |name: &str| [format!("b {name}")];
    draft.obstacle(&side("bottom"), &wall(0.0, 0.0, [0, 1]), Some(&floor));
    draft.hold("b left", Some("0"), None);
    if draft.random.chance(0.1) {
        let pull = draft.load * 10.0 * (1.0 + height);
        draft.traction("b top", ["0", &format!("{pull:e}")]);
        draft.equilibrium = Some(false);
        return;
    }
    let depth = draft.compression() * height * draft.random.magnitude(-1.0, 1.0);
    for _ in 0..draft.random.count(1, 3) {
        let (radius, x) = (draft.random.magnitude(-0.5, 1.5), draft.random.signed());
        let y = height - depth + radius;
        let circle = format!("{{ center = [{x:e}, {y:e}], radius = {radius:e} }}");
        draft.obstacle(&side("top"), &circle, None);
    }
    if draft.random.chance(0.5) {
        let pressure = draft.drawn_pressure("x", [-1.0, 1.0]);
        draft.pressure("b top", &pressure);
    }
}

/// A wedge in a notch of two inclined walls.
pub fn notched(draft: &mut Draft) {
    let slope = draft.random.magnitude(-1.0, 0.7);
    let n = [draft.side_cells(), draft.side_cells()];
    // The lower corner comes first: its two lower sides lie on the walls.
    let corners = [[0.0, 0.0], [1.0, slope], [0.0, 2.0 * slope], [-1.0, slope]];
    let weight = draft.weight(slope) - draft.load * 1e-2;
    draft.block("b", corners, n, [0.0, weight]);
    let (left, right) = (draft.drawn_gap("x"), draft.drawn_gap("x"));
    let normal = |sign: f64| format!("[{:e}, 1.0]", sign * slope);
    for (side, sign, gap) in [("bottom", -1.0, right), ("left", 1.0, left)] {
        let walls = format!("{{ point = [0.0, 0.0], normal = {} }}", normal(sign));
        draft.obstacle(&[format!("b {side}")], &walls, Some(&gap));
    }
    let size = draft.load * draft.random.magnitude(-3.0, 0.0);
    if draft.random.chance(0.1) {
        let pull = draft.load * 10.0 * (1.0 + slope);
        for side in ["b top", "b right"] {
            draft.traction(side, ["0", &format!("{pull:e}")]);
        }
        draft.equilibrium = Some(false);
    } else {
        for side in ["b top", "b right"] {
            draft.traction(side, ["0", &format!("{:e}", -size)]);
        }
    }
}

/// A disk in a pipe, on a floor between walls, or on two other circles.
pub fn disk(draft: &mut Draft) {
    let n = 2 * draft.cells.div_ceil(2);
    draft.shape("d", [n, n], |[s, t]| {
        let [x, y] = [2.0 * s - 1.0, 2.0 * t - 1.0];
        [
            x * (1.0 - y * y / 2.0).sqrt(),
            y * (1.0 - x * x / 2.0).sqrt(),
        ]
    });
    let loose = draft.random.chance(0.1);
    draft.equilibrium = Some(!loose);
    let weight = draft.load * draft.random.magnitude(-2.0, 0.0);
    let gap = draft.compression() * draft.random.magnitude(-2.0, 1.0);
    let all = ["bottom", "right", "top", "left"].map(|side| format!("d {side}"));
    match draft.random.below(3) {
        0 => {
            let radius = 1.0 + gap;
            let pipe = format!("{{ center = [0.0, 0.0], radius = {radius:e}, inside = true }}");
            let sides = if loose { &all[..1] } else { &all[..] };
            draft.obstacle(sides, &pipe, None);
        }
        1 => {
            for (side, at, normal) in [
                (0, [0.0, -1.0], [0, 1]),
                (1, [1.0 + gap, 0.0], [-1, 0]),
                (3, [-1.0 - gap, 0.0], [1, 0]),
            ] {
                draft.obstacle(&all[side..=side], &wall(at[0], at[1], normal), None);
            }
        }
        _ => {
            for x in [-1.5, 1.5] {
                let circle = format!("{{ center = [{x}, -2.0], radius = 1.5 }}");
                let side = if x < 0.0 {
                    [all[3].clone(), all[0].clone()]
                } else {
                    [all[0].clone(), all[1].clone()]
                };
                draft.obstacle(&side, &circle, None);
            }
        }
    }
    let (up, aside) = match loose {
        true => (weight, 0.0),
        false => (-weight, weight * 0.05 * draft.random.signed()),
    };
    draft.body("d", &["d"], [aside, up]);
}
