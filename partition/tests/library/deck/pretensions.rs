//! Bolts whose force or shortening is given at a node.

use super::refused::refused;
use super::{CUBES, MODEL, means, step};

/// A cut through the upper cube, if there were more of it, and its node.
const CUT: &str = "\
*NODE
100, 0., 0., 0.
*SURFACE, NAME=Cut
Upper, S2
";

const SECTION: &str = "*PRE-TENSION SECTION, SURFACE=Cut, NODE=100\n";

const BOLT: &str = "name = 'bolt of CUT', on = 'Cut', direction = [0.0, 0.0, 1.0]";

#[test]
fn the_first_degree_of_freedom_of_its_node_is_force_or_shortening() {
    let force = step("*CLOAD\n100, 1, 20.");
    means(
        &format!("{CUT}{SECTION}{force}"),
        &format!("pretension = [{{ {BOLT}, force = 20.0 }}]"),
    );
    let turned = format!("{CUT}{SECTION}0., 0., 1.\n");
    let shortening = step("*BOUNDARY\n100, 1, 1, 1e-3");
    means(
        &format!("{turned}{shortening}"),
        &format!("pretension = [{{ {BOLT}, shortening = 1e-3 }}]"),
    );
}

#[test]
fn a_node_that_is_fixed_keeps_what_the_force_has_reached() {
    let steps = step("*CLOAD\n100, 1, 20.") + &step("*BOUNDARY, FIXED\n100, 1, 1");
    let steps = steps + &step("*BOUNDARY, OP=NEW\nBottom, 1, 3\n*CLOAD, OP=NEW\n100, 1, 5.");
    let of_steps = |time: &str, given: &str| {
        format!(
            "{{ time = {time}, displacement = [{{ on = 'Bottom', x = 0.0, y = 0.0, z = 0.0 }}], pretension = {{ 'bolt of CUT' = {{ {given} }} }} }}"
        )
    };
    let of_steps = [
        of_steps("1.0", "force = 20.0"),
        of_steps("2.0", "lock = true"),
        of_steps("3.0", "force = 5.0"),
    ];
    let of_steps = format!("step = [{}]", of_steps.join(", "));
    means(
        &format!("{CUT}{SECTION}{steps}"),
        &format!("pretension = [{{ {BOLT}, force = 20.0 }}]\n{of_steps}"),
    );
}

#[test]
fn what_is_no_pretension_is_refused() {
    let both = step("*CLOAD\n100, 1, 20.") + &step("*BOUNDARY\n100, 1, 1, 1e-3");
    for (section, steps, expected) in [
        (
            SECTION,
            both,
            "has a force in one step and a displacement in another",
        ),
        (
            SECTION,
            step("*BOUNDARY, FIXED\n100, 1, 1"),
            "is fixed before it has a force",
        ),
        (SECTION, step("*CLOAD\n100, 2, 20."), "which isn't coupled"),
        (
            "*PRE-TENSION SECTION, SURFACE=Cut, NODE=15\n",
            step(""),
            "which is one of a body",
        ),
        (
            "*PRE-TENSION SECTION, SURFACE=Gap, NODE=100\n",
            step(""),
            "there is no",
        ),
    ] {
        let deck = format!("{CUBES}{MODEL}{CUT}{section}{steps}");
        refused(&deck, expected);
    }
}
