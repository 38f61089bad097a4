//! Tables that decks request.

use contact_dd_partition::deck::prints::{Prints, Table};

use super::refused::refused;
use super::{CUBES, MODEL, read, step};

fn prints(more: &str) -> (Prints, Vec<String>) {
    let translation = read(&format!("{CUBES}{MODEL}{more}")).unwrap();
    (translation.prints, translation.mesh.warnings)
}

/// The tables of every step, by label and set.
fn tables(prints: &Prints) -> Vec<Vec<String>> {
    let words = |table: &Table| format!("{} {} {}", table.label, table.set, table.totals);
    let of_step = |tables: &Vec<Table>| tables.iter().map(words).collect();
    prints.steps.iter().map(of_step).collect()
}

#[test]
fn tables_count_until_a_step_has_others() {
    let load = "*DLOAD\nUpper, P2, 1.\n";
    let (found, warnings) = prints(
        &[
            step(&format!(
                "{load}*NODE PRINT, NSET=Top\nU\n*NODE PRINT, NSET=Bottom, TOTALS=ONLY\nRF, U\n*EL PRINT, ELSET=Upper\nS, E"
            )),
            step(&format!("{load}*NODE PRINT, NSET=Bottom, TOTALS=YES\nRF")),
            step(&format!("{load}*NODE PRINT, NSET=Bottom, FREQUENCY=0\nRF")),
        ]
        .concat(),
    );
    let elements = ["S UPPER NO", "E UPPER NO"];
    let of_nodes = [
        &["U TOP NO", "RF BOTTOM ONLY", "U BOTTOM ONLY"][..],
        &["RF BOTTOM YES"],
        &[],
    ];
    let expected: Vec<Vec<&str>> = (of_nodes.iter())
        .map(|nodes| [nodes, &elements[..]].concat())
        .collect();
    assert_eq!(tables(&found), expected);
    assert_eq!(found.nodes["TOP"], [15, 16, 17, 18]);
    assert_eq!(found.elements["UPPER"], [2]);
    assert_eq!(found.cells[&2].nodes, [11, 12, 13, 14, 15, 16, 17, 18]);
    assert!(!found.cells[&2].is_reduced);
    assert_eq!(found.thickness, 1.0);
    assert!(warnings.is_empty(), "{warnings:?}");
}

#[test]
fn what_isnt_printed_is_named() {
    let more = "*DLOAD\nUpper, P2, 1.\n*NODE PRINT, NSET=Top, TIMEPOINTS=T\nU, NT\n*NODE PRINT\nU\n*EL PRINT, ELSET=Upper\nENER";
    let (found, warnings) = prints(&step(more));
    assert_eq!(tables(&found), [["U TOP NO"]]);
    assert_eq!(
        warnings,
        [
            "not needed, and left out: *NODE PRINT without NSET, ENER of *EL PRINT, NT of *NODE PRINT"
        ]
    );
}

#[test]
fn nodes_of_no_solid_are_left_out() {
    let node = "*NODE, NSET=Eye\n99, 0., 0., 3.\n*NSET, NSET=Some\nEye, 15\n";
    let more = format!(
        "{node}{}",
        step("*DLOAD\nUpper, P2, 1.\n*NODE PRINT, NSET=Some\nU")
    );
    let (found, warnings) = prints(&more);
    assert_eq!(found.nodes["SOME"], [15]);
    let note = "*NODE PRINT of nodes of no solid, such as 99";
    assert!(
        warnings.iter().any(|warning| warning.contains(note)),
        "{warnings:?}"
    );
}

#[test]
fn tables_of_nothing_are_refused_with_their_line() {
    let load = "*DLOAD\nUpper, P2, 1.\n";
    for (more, expected) in [
        (
            step(&format!("{load}*NODE PRINT, NSET=Roof\nU")),
            "line 53: ",
        ),
        (
            step(&format!("{load}*NODE PRINT, NSET=Top, TOTALS=SOME\nU")),
            "line 53: *NODE PRINT has TOTALS=SOME; expected YES, ONLY or NO",
        ),
        (
            format!("*EL PRINT, ELSET=Upper\nS\n{}", step(load)),
            "line 49: *EL PRINT stands in no step; expected it behind *STEP",
        ),
    ] {
        refused(&format!("{CUBES}{MODEL}{more}"), expected);
    }
}
