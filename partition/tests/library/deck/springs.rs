//! Springs to the ground.

use super::refused::refused;
use super::{CUBES, MODEL, means, read, step};

/// A spring between the nodes 8 and 15.
fn between(kind: &str, property: &str) -> String {
    format!("*ELEMENT, TYPE={kind}, ELSET=Link\n21, 8, 15\n*SPRING, ELSET=Link\n{property}\n")
}

#[test]
fn springs_between_nodes_pull_along_an_axis_or_their_line() {
    let pressure = "pressure = [{ on = 'pressure 1', value = 1.0 }]";
    let ends = "name = 'spring 21', between = ['end of spring 1', 'end of spring 2']";
    for property in ["40.", "\n40."] {
        means(
            &format!("{}{}", between("SPRINGA", property), step(LOAD)),
            &format!("spring = [{{ {ends}, axial = 40.0 }}]\n{pressure}"),
        );
    }
    means(
        &format!("{}{}", between("SPRING2", "2, 2\n40."), step(LOAD)),
        &format!("spring = [{{ {ends}, stiffness = [0.0, 40.0, 0.0] }}]\n{pressure}"),
    );
}

const LOAD: &str = "*DLOAD\nUpper, P2, 1.";

fn springs(axis: usize, stiffness: &str) -> String {
    format!(
        "*ELEMENT, TYPE=SPRING1, ELSET=Feet\n21, 15\n22, 16\n*SPRING, ELSET=Feet\n{axis}\n{stiffness}\n"
    )
}

#[test]
fn springs_to_the_ground_hold_their_nodes_along_an_axis() {
    let also = "*ELEMENT, TYPE=SPRING1, ELSET=One\n23, 16\n*SPRING, ELSET=One\n2\n5.\n*SPRING, ELSET=One\n3\n1.\n";
    let pressure = "pressure = [{ on = 'pressure 1', value = 1.0 }]";
    means(
        &format!("{}{}", springs(3, "40."), step(LOAD)),
        &format!("spring = [{{ on = 'spring 1', stiffness = [0.0, 0.0, 40.0] }}]\n{pressure}"),
    );
    means(
        &format!("{}{also}{}", springs(3, "40."), step(LOAD)),
        &format!(
            "spring = [{{ on = 'spring 1', stiffness = [0.0, 0.0, 40.0] }}, \
             {{ on = 'spring 2', stiffness = [0.0, 5.0, 41.0] }}]\n{pressure}"
        ),
    );
    let all = springs(3, "40.").replace("22, 16", "22, 16\n23, 17\n24, 18");
    let mesh = read(&format!("{CUBES}{MODEL}{all}{}", step(LOAD)))
        .unwrap()
        .mesh;
    let of = &mesh.groups["spring 1"];
    assert_eq!((of.dim, of.members.len()), (0, 4));
    let deck = format!("{CUBES}{MODEL}{}{}", springs(3, "40."), step(LOAD));
    let warnings = read(&deck).unwrap().mesh.warnings;
    assert!(warnings.is_empty(), "{warnings:?}");
}

#[test]
fn springs_that_arent_supported_are_refused_with_their_line() {
    for (more, expected) in [
        (
            springs(3, "40.").replace("TYPE=SPRING1", "TYPE=SPRING3"),
            "line 49: elements of type SPRING3 aren't supported; expected SPRING1, SPRING2 or SPRINGA",
        ),
        (
            springs(3, "40.").replace("SPRING, ", "SPRING, NONLINEAR, "),
            "line 52: *SPRING with NONLINEAR isn't read; expected one stiffness",
        ),
        (
            springs(4, "40."),
            "line 52: *SPRING: the node 15 has no degree of freedom 4; expected 1 to 3, of reference nodes to 6",
        ),
        (
            springs(3, "-1."),
            "line 54: *SPRING: the stiffness is -1; expected at least 0",
        ),
        (
            springs(3, "40., , 20.\n50., , 100."),
            "line 52: *SPRING has 3 lines behind it; expected two",
        ),
        (
            springs(3, "40.").replace("SPRING, ELSET=Feet", "SPRING, ELSET=Hands"),
            "line 49: the springs have no *SPRING, ELSET=FEET; expected it",
        ),
        (
            springs(3, "40.") + "*SPRING, ELSET=Hands\n1\n1.\n",
            "line 55: there are no springs 'HANDS'; expected *ELEMENT, TYPE=SPRING1",
        ),
        (
            format!(
                "*NODE\n99, 0., 0., 3.\n{}",
                springs(3, "40.").replace("15", "99")
            ),
            "line 54: *SPRING: the node 99 is none of a body; expected nodes of solids",
        ),
        (
            springs(3, "40.") + "*TRANSFORM, NSET=Top\n0., 1., 0., -1., 0., 0.\n",
            "line 52: *SPRING: the node 15 has *TRANSFORM; expected springs along x, y and z",
        ),
    ] {
        refused(&format!("{CUBES}{MODEL}{more}{}", step(LOAD)), expected);
    }
}
