//! Refusals of keywords, with the line and advice.

use super::{CUBES, MODEL, read, step};
use crate::says::says;

const LOAD: &str = "*DLOAD\nUpper, P2, 1.";

#[track_caller]
pub fn refused(deck: &str, expected: &str) {
    match read(deck) {
        Ok(translation) => panic!("{expected}: {}", translation.scene),
        Err(printed) => says(&printed, expected),
    }
}

#[test]
fn keywords_that_change_the_answer_are_refused_with_their_line() {
    for (more, expected) in [
        (
            "*PLASTIC\n200., 0.",
            "line 49: *PLASTIC isn't read: bodies are linear elastic here; instead",
        ),
        (
            "*DYNAMIC",
            "line 49: *DYNAMIC isn't read: loads are static here: expected *STATIC; instead",
        ),
        (
            "*HEAT TRANSFER",
            "line 49: *HEAT TRANSFER isn't read … instead give the temperatures",
        ),
        ("*HEATTRANSFER", "line 49: *HEAT TRANSFER isn't read"),
        (
            "*TIE, NAME=T, MULTISTAGE\nHigh, Low",
            "line 49: *TIE with MULTISTAGE isn't read; expected a tie of two sides",
        ),
        ("*EQUATION\n2", "line 50: the equation has 0 of its 2 terms"),
        (
            "*EQUATION\n1\n15, 4, 1.",
            "line 50: *EQUATION: the degree of freedom 4 of the node 15 is no displacement; expected one, or a reference node",
        ),
        (
            "*EQUATION\n2\nTop, 1, 1., Top, 2, 1.",
            "line 50: an equation between several sets isn't read",
        ),
        (
            "*MPC\nSLIDER, 1, 2",
            "line 50: *MPC of type SLIDER: isn't read; expected BEAM, STRAIGHT, PLANE or MEANROT, or an *EQUATION",
        ),
        (
            "*MPC\nPLANE, 1, 2, 3",
            "line 50: *MPC of type PLANE: it has 3 nodes; expected 4 at least",
        ),
        (
            "*KINEMATIC COUPLING, REF NODE=1",
            "line 49: *KINEMATIC COUPLING isn't read; instead give *COUPLING",
        ),
        (
            "*PRE-TENSION SECTION, ELEMENT=2, NODE=100",
            "line 49: *PRE-TENSION SECTION of an ELEMENT, a beam, isn't read; expected",
        ),
        (
            "*GAP, ELSET=All",
            "line 49: *GAP isn't supported yet; instead",
        ),
        (
            "*SELECT CYCLIC SYMMETRY MODES, NMIN=0, NMAX=2",
            "line 49: *SELECT CYCLIC SYMMETRY MODES isn't read: loads are static here: expected *STATIC; instead",
        ),
        (
            "*SHELL SECTION, ELSET=All",
            "line 49: *SHELL SECTION isn't read … instead mesh the part by solids",
        ),
        (
            "*BEAM SECTION, ELSET=All",
            "line 49: *BEAM SECTION isn't read … instead mesh",
        ),
        (
            "*CHANGE FRICTION, INTERACTION=Dry\n*FRICTION\n0.1",
            "line 49: *CHANGE FRICTION stands in no step; expected it behind *STEP",
        ),
        (
            "*CHANGE SOLID SECTION, ELSET=All, MATERIAL=Steel",
            "line 49: *CHANGE SOLID SECTION isn't read: laws are the same in all steps here; instead give one for all of them",
        ),
        (
            "*DISTRIBUTING COUPLING, ELSET=Upper\nTop, 1.",
            "line 49: *DISTRIBUTING COUPLING: the set Upper has 0 elements of type DCOUP3D; expected one",
        ),
        (
            "*INITIAL CONDITIONS, TYPE=STRESS\n1, 1, 1., 0., 0., 0., 0., 0.\n1, 2, 2., 0., 0., 0., 0., 0.",
            "line 51: the stress isn't the same at all points of element 1, which isn't supported; instead",
        ),
        (
            "*MODEL CHANGE",
            "line 49: *MODEL CHANGE stands in no step; expected it behind *STEP",
        ),
        (
            "*FRICTON\n0.1",
            "line 49: the keyword *FRICTON isn't known … did you mean *FRICTION?",
        ),
        (
            "*NEVER SEEN",
            "line 49: the keyword *NEVER SEEN isn't known, and may change the answer",
        ),
        (
            "*DISTRIBUTION, NAME=D\n1, 1., 0., 0., 0., 1., 0.",
            "line 49: *DISTRIBUTION has no line of all other elements",
        ),
        (
            "*ORIENTATION, NAME=O, DEFINITION=NODES\n1, 2",
            "line 49: *ORIENTATION of DEFINITION=NODES isn't read",
        ),
        (
            "*TRANSFORM, NSET=Top, TYPE=S\n1., 0., 0., 0., 1., 0.",
            "line 49: *TRANSFORM of the system S isn't read",
        ),
        (
            "*AMPLITUDE, NAME=A, DEFINITION=PERIODIC",
            "line 49: *AMPLITUDE of DEFINITION=PERIODIC",
        ),
        (
            "*INITIAL CONDITIONS, TYPE=VELOCITY\n1, 1, 0.",
            "line 49: *INITIAL CONDITIONS of TYPE=VELOCITY",
        ),
        (
            "*BOUNDARY\n1, 11, 11, 20.",
            "line 50: *BOUNDARY of the degrees of freedom 11 to 11",
        ),
        ("*BOUNDARY\n99, 1", "line 50: there is no node 99"),
        (
            "*BOUNDARY\nNowhere, 1",
            "line 50: there is no node and no set of nodes 'Nowhere'",
        ),
        (
            "*SURFACE BEHAVIOR, NO SEPARATION",
            "line 49: *SURFACE BEHAVIOR with NO SEPARATION isn't read",
        ),
        (
            "*FRICTION, ROUGH",
            "line 49: *FRICTION with ROUGH isn't read",
        ),
        (
            "*CONTACT PAIR, INTERACTION=Dry\nHigh, Nothing",
            "line 50: there is no surface 'NOTHING'",
        ),
        (
            "*CONTACT PAIR, INTERACTION=Dry\nHigh",
            "line 50: the contact of 'HIGH' with itself",
        ),
        (
            "*CLEARANCE, MASTER=High, SLAVE=Low, VALUE=0.1",
            "line 49: there is no *CONTACT PAIR",
        ),
        ("*DLOAD\nUpper, P2, 1.", "line 49: *DLOAD stands in no step"),
    ] {
        refused(&format!("{CUBES}{MODEL}{more}\n{}", step(LOAD)), expected);
    }
}

#[test]
fn loads_that_arent_read_are_refused_with_their_line() {
    for (more, expected) in [
        (
            "*DLOAD\nUpper, P7, 1.",
            "line 52: element 2 has no face P7; expected P1 to P6",
        ),
        (
            "*DLOAD\nUpper, P2NU, 1.",
            "line 52: a load P2NU of *DLOAD isn't read",
        ),
        ("*DLOAD\nUpper, GRAV, 1.", "line 52: GRAV has no direction"),
        (
            "*DSLOAD\nHigh, SHEAR, 1.",
            "line 52: a load SHEAR of *DSLOAD isn't read",
        ),
        (
            "*DSLOAD\nNothing, P, 1.",
            "line 52: there is no surface 'NOTHING'",
        ),
        (
            "*CLOAD\nTop, 4, 1.",
            "line 52: *CLOAD on the degree of freedom 4 … no moments",
        ),
        (
            "*CLOAD, AMPLITUDE=A\nTop, 1, 1.",
            "line 51: there is no amplitude 'A'",
        ),
        (
            "*CLOAD, TIME DELAY=1.\nTop, 1, 1.",
            "line 51: *CLOAD with TIME DELAY isn't read, and may change",
        ),
        (
            "*BOUNDARY, FIXED, OP=NEW\nTop, 1",
            "line 52: *BOUNDARY with FIXED and OP=NEW isn't read",
        ),
        (
            "*TEMPERATURE\n18, 50.",
            "line 49: the nodes of element 2 are warmer … by 0 and by 50",
        ),
        ("*STATIC, RIKS", "line 51: *STATIC, RIKS isn't read"),
        ("*STEP", "line 51: *STEP within a step; expected *END STEP"),
    ] {
        refused(&format!("{CUBES}{MODEL}{}", step(more)), expected);
    }
    let held = "*EQUATION\n1\n100, 3, 1.\n*BOUNDARY\n100, 3, 3, 0.5\n";
    refused(
        &format!("{CUBES}{MODEL}*NODE\n100, 0., 0., 0.\n{held}{}", step(LOAD)),
        "line 52: supports of its nodes contradict the equation by -5e-1; expected supports that agree with it",
    );
    let up_and_down = "*AMPLITUDE, NAME=A\n0., 0., 0.5, 1., 1., 0.\n";
    let load = step("*DLOAD, AMPLITUDE=A\nUpper, P2, 1.");
    refused(
        &format!("{CUBES}{MODEL}{up_and_down}{load}"),
        "line 54: the amplitude isn't linear within the step",
    );
    // Without friction the load path doesn't matter.
    let without = MODEL.replace("*FRICTION\n0.2\n", "");
    assert!(read(&format!("{CUBES}{without}{up_and_down}{load}")).is_ok());
}

#[test]
fn what_is_missing_is_named() {
    let whole = format!("{CUBES}{MODEL}{}", step(LOAD));
    for (without, expected) in [
        (
            "*SOLID SECTION, ELSET=Upper, MATERIAL=STEEL\n",
            "element 2 has no *SOLID SECTION",
        ),
        (
            "*ELASTIC\n210e3, 0.3\n",
            "line 32: the material Steel has no *ELASTIC",
        ),
        ("*STATIC\n", "line 49: the step has no *STATIC"),
        (
            "*SURFACE INTERACTION, NAME=Dry\n",
            "line 41: *SURFACE BEHAVIOR belongs to nothing",
        ),
    ] {
        assert!(whole.contains(without));
        refused(&whole.replacen(without, "", 1), expected);
    }
    refused(
        &format!("{CUBES}{MODEL}"),
        "the deck has no step; expected *STEP with *STATIC",
    );
    let weight = step("*DLOAD\nUpper, GRAV, 1., 0., 0., -1.");
    let light = format!("{CUBES}{MODEL}{weight}").replace("*DENSITY\n7.8e-9\n", "");
    refused(
        &light,
        "line 50: GRAV is per mass, but the material Steel has no *DENSITY",
    );
    let warm = whole.replace("210e3, 0.3", "210e3, 0.3, 0.\n180e3, 0.3, 500.");
    refused(&warm, "line 35: stiffness depends on temperature");
    let other = whole.replace("MATERIAL=STEEL", "MATERIAL=Wood");
    refused(&other, "line 39: there is no *MATERIAL 'WOOD'");
}
