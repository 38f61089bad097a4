//! A uniform pressure passes exactly between cells of any kinds.

use crate::patch::{PRESSURE, cracked_plate, is_uniform};
use crate::support::blocks::{Blocks, joined, moved};
use crate::support::scenes::model;
use crate::support::solver::solve;
use crate::support::sorts::{SORTS, Sort};
use crate::{block, materials};

#[test]
fn a_uniform_pressure_passes_between_cells_of_any_kinds() {
    for (i, lower) in SORTS.into_iter().enumerate() {
        for (step, n, angle) in [(0, [3, 7], 0.0), (1, [7, 3], 0.4), (3, [5, 5], 2.0)] {
            let upper = SORTS[(i + step) % SORTS.len()];
            passes([lower, upper], n, angle);
        }
    }
}

/// Two blocks of so many cells along their joint, the upper one on the lower one, turned.
#[track_caller]
fn passes([lower, upper]: [Sort; 2], n: [usize; 2], angle: f64) {
    let place = |name, y, n, sort: Sort| {
        let mesh = block(Blocks::new(), name, [0.0, 2.0], y, [n, 3], n as u64);
        sort.of(&mesh.mesh)
    };
    let mesh = joined(
        place("lower", [0.0, 1.0], n[0], lower),
        place("upper", [1.0, 2.0], n[1], upper),
    );
    let (sin, cos) = f64::sin_cos(angle);
    let mesh = moved(mesh, |[x, y]| [cos * x - sin * y, sin * x + cos * y]);
    for sides in ["'lower top', 'upper bottom'", "'upper bottom', 'lower top'"] {
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
        let model = model(&text, mesh.clone());
        is_uniform(&solve(&model, 5), angle);
    }
}

#[test]
fn a_uniform_pressure_passes_a_crack_in_cells_of_any_kinds() {
    for sort in SORTS {
        for sides in [
            "'middle above bottom', 'middle below top'",
            "'middle below top', 'middle above bottom'",
        ] {
            let text = format!("[[contact]]\nname = 'crack'\nsides = [{sides}]\n");
            is_uniform(&solve(&cracked_plate([4, 7], &text, sort), 5), 0.0);
        }
    }
}
