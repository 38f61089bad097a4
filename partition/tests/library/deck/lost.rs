//! What would be lost or replaced without a word is refused, with its line.

use super::refused::refused;
use super::{CUBES, MODEL, read, scene, step};

const LOAD: &str = "*DLOAD\nUpper, P2, 1.";

/// A node that no element has.
const ALONE: &str = "*NODE\n21, 0.5, 0.5, 3.\n";

/// The cubes without contact, glued.
fn glued() -> String {
    let (sections, _) = MODEL.split_once("*SURFACE INTERACTION").unwrap();
    format!("{CUBES}{sections}*TIE, NAME=Glue\nHigh, Low\n*BOUNDARY\nBottom, 1, 3\n")
}

#[test]
fn a_perturbation_step_stands_alone() {
    let perturbed = step(LOAD).replacen("*STEP", "*STEP, PERTURBATION", 1);
    let model = glued();
    assert!(read(&format!("{model}{perturbed}")).is_ok());
    for steps in [
        step(LOAD) + &perturbed,
        perturbed.clone() + &step(LOAD),
        perturbed.clone() + &perturbed,
    ] {
        refused(
            &format!("{model}{steps}"),
            "*STEP with PERTURBATION beside other steps isn't read … expected",
        );
    }
    refused(
        &format!("{CUBES}{MODEL}{perturbed}"),
        "line 49: a step with PERTURBATION keeps the contacts",
    );
}

#[test]
fn forces_and_supports_of_nodes_of_nothing_are_refused() {
    for (acts, expected) in [
        (
            "*CLOAD\n21, 3, 5.",
            "line 54: the node 21 belongs to no solid element and no coupling, so its force acts on nothing; expected",
        ),
        (
            "*BOUNDARY\n21, 3, 3",
            "line 54: the node 21 belongs … so its support holds nothing; expected",
        ),
        (
            "*BOUNDARY\nSome, 3, 3, 0.1",
            "line 54: the node 21 belongs … so its support holds nothing",
        ),
        ("*CLOAD\nSome, 3, 1.", "line 54: the node 21 belongs"),
    ] {
        let some = ALONE.replace("*NODE\n", "*NODE, NSET=Alone\n");
        let deck = format!("{CUBES}{MODEL}{some}{}", step(acts));
        let deck = deck.replace(
            "*NSET, NSET=Top\n",
            "*NSET, NSET=Some\nAlone, 15\n*NSET, NSET=Top\n",
        );
        let expected = expected.replace("line 54", "line 56");
        refused(&deck, &expected);
    }
    // An equation is of another axis.
    let equation = "*EQUATION\n2\n15, 3, 1., 21, 3, -1.\n";
    let along = |axis: usize| step(&format!("*CLOAD\n21, {axis}, 5."));
    assert!(read(&format!("{CUBES}{MODEL}{ALONE}{equation}{}", along(3))).is_ok());
    refused(
        &format!("{CUBES}{MODEL}{ALONE}{equation}{}", along(1)),
        "line 57: the node 21 belongs",
    );
    // Sets of planes often have nodes of nothing.
    let all = "*NSET, NSET=Some\n21, 15\n";
    let deck = format!(
        "{CUBES}{MODEL}{ALONE}{all}{}",
        step(&format!("*BOUNDARY\nSome, 1, 1\n{LOAD}"))
    );
    let warnings = read(&deck).unwrap().mesh.warnings;
    assert!(
        warnings.iter().any(|warning| warning.contains(
            "line 56: the support leaves out nodes that belong to no solid element and no coupling, such as 21"
        )),
        "{warnings:?}"
    );
}

#[test]
fn trusses_with_a_section_are_refused_and_others_are_sides() {
    let truss = "*ELEMENT, TYPE=T3D2, ELSET=Rod\n31, 15, 16\n";
    let section = "*SOLID SECTION, ELSET=Rod, MATERIAL=STEEL\n0.1\n";
    assert!(read(&format!("{CUBES}{MODEL}{truss}{}", step(LOAD))).is_ok());
    refused(
        &format!("{CUBES}{MODEL}{truss}{section}{}", step(LOAD)),
        "line 51: *SOLID SECTION of element 31, a line of 2 nodes: the stiffness of trusses",
    );
    let beam = truss.replace("T3D2", "B31");
    refused(
        &format!("{CUBES}{MODEL}{beam}{section}{}", step(LOAD)),
        "line 51: *SOLID SECTION of elements of type B31: the stiffness of trusses",
    );
    refused(
        &format!("{CUBES}{MODEL}{truss}{}", step("*DLOAD\nRod, BX, 1.")),
        "line 54: the set Rod has no solid elements, so its load acts on nothing; expected",
    );
    let plane = "*ELEMENT, TYPE=CPE4, ELSET=Rod\n31, 15, 16, 17, 18\n";
    refused(
        &format!("{CUBES}{MODEL}{plane}{section}{}", step(LOAD)),
        "line 51: the plane element 31 stands beside solids in space",
    );
}

#[test]
fn a_deck_of_no_solids_names_its_elements() {
    let shells =
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n*ELEMENT, TYPE=S4\n1, 1, 2, 3, 4\n";
    refused(
        &format!("{shells}{}", step("*CLOAD\n3, 1, 1.")),
        "the deck has no solid elements: its elements of type S4 have no stiffness here; expected",
    );
}

#[test]
fn friction_has_one_coefficient() {
    let deck = |rows: &str| {
        let model = MODEL.replace("*FRICTION\n0.2\n", &format!("*FRICTION\n{rows}\n"));
        format!("{CUBES}{model}{}", step(LOAD))
    };
    assert!(read(&deck("0.2, , 0.\n0.2, , 10.")).is_ok());
    refused(
        &deck("0.2, , 0.\n0.1, , 10."),
        "line 45: the coefficient of friction varies with slip rate, pressure or temperature",
    );
    refused(
        &deck("-0.2"),
        "line 44: the coefficient of friction is -0.2; expected at least 0",
    );
}

#[test]
fn second_definitions_are_refused_with_both_lines() {
    for (more, expected) in [
        (
            "*MATERIAL, NAME=steel\n*ELASTIC\n1., 0.\n",
            "line 49: *MATERIAL 'STEEL' is given twice, first in line 32; expected one",
        ),
        (
            "*SURFACE INTERACTION, NAME=DRY\n",
            "line 49: *SURFACE INTERACTION 'DRY' is given twice, first in line 41",
        ),
        (
            "*FRICTION\n0.1\n",
            "line 49: *FRICTION is given twice, first in line 43; expected one",
        ),
        (
            "*MATERIAL, NAME=Wood\n*ELASTIC\n1., 0.\n*ELASTIC\n2., 0.\n",
            "line 52: *ELASTIC is given twice, first in line 50",
        ),
        (
            "*MATERIAL, NAME=Wood\n*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=Upper, MATERIAL=Wood\n",
            "line 52: element 2 has another *SOLID SECTION in line 40; expected one",
        ),
    ] {
        refused(&format!("{CUBES}{MODEL}{more}{}", step(LOAD)), expected);
    }
    // The same section twice says one thing.
    let same = "*SOLID SECTION, ELSET=Upper, MATERIAL=Steel\n";
    assert!(read(&format!("{CUBES}{MODEL}{same}{}", step(LOAD))).is_ok());
    // A law may change with a step.
    let change = "*CHANGE FRICTION, INTERACTION=Dry\n*FRICTION\n0.1\n";
    let steps = step(LOAD) + &step(&format!("{change}{LOAD}"));
    assert!(read(&format!("{CUBES}{MODEL}{steps}")).is_ok());
}

#[test]
fn entries_too_many_are_refused() {
    for (acts, expected) in [
        (
            "*CLOAD\nTop, 3, 3, 25.",
            "line 52: *CLOAD has `25.` behind its 3 entries; expected nodes",
        ),
        (
            "*BOUNDARY\nTop, 3, 3, 0, 5",
            "line 52: *BOUNDARY has `5` behind its 4 entries; expected",
        ),
        (
            "*DLOAD\nUpper, P2, 2,5",
            "line 52: *DLOAD has `5` behind its 3 entries",
        ),
    ] {
        refused(&format!("{CUBES}{MODEL}{}", step(acts)), expected);
    }
    assert_eq!(
        scene(&step("*CLOAD\nTop, 3, 2., 0")).force.len(),
        1,
        "a zero may follow"
    );
}

#[test]
fn parameters_are_read_harmless_or_refused() {
    let deck = format!("{CUBES}{MODEL}{}", step(LOAD));
    for (from, to) in [
        ("*STATIC", "*STATIC, STABILIZE, DIRECT"),
        ("INTERACTION=Dry,", "INTERACTION=Dry, EXTENSION ZONE=0.1,"),
        ("TYPE=SURFACE TO SURFACE", "TYPE=NODE TO SURFACE"),
    ] {
        assert!(deck.contains(from), "{from}");
        assert!(read(&deck.replacen(from, to, 1)).is_ok(), "{to}");
    }
    for (from, to, expected) in [
        (
            "TYPE=SURFACE TO SURFACE",
            "TYPE=SURF TO SURF",
            "line 45: *CONTACT PAIR with TYPE=SURF TO SURF isn't read, and may change",
        ),
        (
            "ELSET=Lower\n1, 1",
            "ELSET=Lower, OFFSET=10\n1, 1",
            "line 18: *ELEMENT with OFFSET isn't read, and may change",
        ),
        (
            "*STATIC",
            "*STATIC\n0.1, -1.",
            "line 50: the time of the step is -1; expected more than 0",
        ),
        (
            "*STATIC",
            "*PARAMETER\nF=1.\n*STATIC",
            "line 50: *PARAMETER isn't read: other lines take its values by <name>; instead write the values there",
        ),
        (
            "210e3, 0.3",
            "-210e3, 0.3",
            "line 34: *ELASTIC: Young's modulus is -210000; expected more than 0",
        ),
    ] {
        assert!(deck.contains(from), "{from}");
        refused(&deck.replacen(from, to, 1), expected);
    }
}
