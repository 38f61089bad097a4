//! Sectors of rings.

use super::refused::refused;
use super::{CUBES, MODEL, means, step};

const SIDES: &str = "\
*SURFACE, NAME=One
Upper, S3
*SURFACE, NAME=Next
Upper, S6
";

#[test]
fn a_model_of_sectors_turns_the_sides_of_its_tie() {
    let tie = "*TIE, NAME=Cut, POSITION TOLERANCE=1e-3, CYCLIC SYMMETRY\nOne, Next\n";
    for keys in ["N=4, NGRAPH=4, TIE=Cut", "N=4"] {
        let model = format!("*CYCLIC SYMMETRY MODEL, {keys}\n1., 1., 0., 1., 1., 2.\n");
        means(
            &format!("{SIDES}{tie}{model}{}", step("")),
            "cyclic = [{ name = 'CUT', sides = ['One', 'Next'], point = [1.0, 1.0, 0.0], axis = [0.0, 0.0, 2.0], sectors = 4 }]",
        );
    }
}

#[test]
fn what_is_no_model_of_sectors_is_refused() {
    let tie = "*TIE, NAME=Cut, CYCLIC SYMMETRY\nOne, Next\n";
    let axis = "1., 1., 0., 1., 1., 2.\n";
    for (text, expected) in [
        (tie.to_owned(), "has no *CYCLIC SYMMETRY MODEL"),
        (format!("{tie}*CYCLIC SYMMETRY MODEL, N=4\n"), "has no axis"),
        (
            format!("{tie}*CYCLIC SYMMETRY MODEL, N=1\n{axis}"),
            "of 1 sectors",
        ),
        (
            format!("{tie}*CYCLIC SYMMETRY MODEL, N=4\n1., 1., 0., 1., 1., 0.\n"),
            "the axis has no direction",
        ),
        (
            format!("*CYCLIC SYMMETRY MODEL, N=4\n{axis}"),
            "names no *TIE with CYCLIC SYMMETRY",
        ),
    ] {
        refused(
            &format!("{CUBES}{MODEL}{SIDES}{text}{}", step("")),
            expected,
        );
    }
}
