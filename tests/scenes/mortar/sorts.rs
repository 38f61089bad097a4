//! A uniform pressure passes exactly between cells of any kinds.

use super::patch::{cracked_plate, is_uniform};
use crate::support::solver::solve;
use crate::support::sorts::SORTS;
use crate::support::uneven::two_sorts;

#[test]
fn a_uniform_pressure_passes_between_cells_of_any_kinds() {
    for (i, lower) in SORTS.into_iter().enumerate() {
        for (step, n, angle) in [(0, [3, 7], 0.0), (1, [7, 3], 0.4), (3, [5, 5], 2.0)] {
            let upper = SORTS[(i + step) % SORTS.len()];
            for upside_down in [false, true] {
                let model = two_sorts([lower, upper], n, 3, angle, upside_down);
                is_uniform(&solve(&model, 5), angle);
            }
        }
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
