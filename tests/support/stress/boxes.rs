//! Packings of blocks in a box: rows side by side, grids with crossings.

use super::draft::{Draft, rectangle};

/// Blocks in columns and rows between rigid walls, pushed about by forces within them.
pub fn packing(draft: &mut Draft) {
    let (across, up) = (draft.random.count(1, 4), draft.random.count(1, 4));
    let n = [0; 2].map(|_: usize| draft.random.count(1, draft.cells.div_ceil(2)));
    let widths: Vec<f64> = (0..across)
        .map(|_| draft.random.magnitude(-1.5, 0.3))
        .collect();
    let heights: Vec<f64> = (0..up).map(|_| draft.random.magnitude(-1.5, 0.3)).collect();
    // A row slides without the wall that it is pushed against.
    let open = draft.random.chance(0.1);
    draft.equilibrium = Some(!open);
    let ends = |sizes: &[f64], i: usize| {
        let low: f64 = sizes[..i].iter().sum();
        [low, low + sizes[i]]
    };
    let clear = draft.random.chance(0.5);
    for i in 0..across {
        for j in 0..up {
            let (x, y) = (ends(&widths, i), ends(&heights, j));
            let push = draft.load * draft.random.magnitude(-3.0, 0.0);
            let push = match open {
                true => push,
                false => push * draft.random.pick(&[-1.0, 0.0, 1.0]),
            };
            let weight = draft.weight(heights[j]) - draft.load * 1e-3;
            let n = n.map(|n| draft.facing(n));
            draft.block(&format!("b{i}_{j}"), rectangle(x, y), n, [push, weight]);
        }
    }
    for i in 0..across {
        for j in 0..up {
            let side = |name: &str| [format!("b{i}_{j} {name}")];
            let mut gap = |axis: &str| match clear {
                true => draft.drawn_gap(axis),
                false => "0".into(),
            };
            let gaps = [gap("y"), gap("x"), gap("y"), gap("x")];
            if i + 1 < across {
                let right = [format!("b{}_{j} left", i + 1)];
                draft.contact(&side("right"), &right, Some(&gaps[0]));
            } else if !open {
                draft.obstacle(
                    &side("right"),
                    &wall(ends(&widths, i)[1], 0.0, [-1, 0]),
                    Some(&gaps[0]),
                );
            }
            if j + 1 < up {
                let above = [format!("b{i}_{} bottom", j + 1)];
                draft.contact(&side("top"), &above, Some(&gaps[1]));
            } else {
                let pressure = draft.drawn_pressure("x", ends(&widths, i));
                draft.pressure(&side("top")[0], &pressure);
            }
            if i == 0 {
                draft.obstacle(&side("left"), &wall(0.0, 0.0, [1, 0]), Some(&gaps[2]));
            }
            if j == 0 {
                draft.obstacle(&side("bottom"), &wall(0.0, 0.0, [0, 1]), Some(&gaps[3]));
            }
        }
    }
}

/// A half-plane as a scene writes it.
pub fn wall(x: f64, y: f64, [a, b]: [i32; 2]) -> String {
    format!("{{ point = [{x:e}, {y:e}], normal = [{a}.0, {b}.0] }}")
}
