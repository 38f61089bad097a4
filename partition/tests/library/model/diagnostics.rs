//! Warnings of scenes that are allowed.

use super::contact::stack;
use crate::blocks::Blocks;
use crate::says::says;

const HELD: &str = "[[displacement]]\non = 'lower bottom'\nx = 0\ny = 0\n";
const CONTACT: &str = "[[contact]]\nname = 'c'\nsides = ['lower top', 'upper bottom']\n";
const TABLE: &str = "[[contact]]\nname = 'table'\nsides = ['lower bottom']\n";

/// All that is warned of, line by line.
fn warned(blocks: &Blocks, text: &str) -> String {
    blocks.model(text).unwrap().warnings.join("\n")
}

/// Two blocks that lie on each other, and whose nodes don't match.
fn uneven() -> Blocks {
    Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [4, 2])
        .block("upper", [0.5, 1.5], [1.0, 2.0], [3, 2])
}

#[test]
fn bodies_that_touch_without_a_contact_are_named() {
    for blocks in [
        stack(0.0),
        uneven(),
        stack(0.0).quadratic(),
        stack(0.0).disguised(),
    ] {
        let printed = warned(&blocks, HELD);
        assert!(
            printed.starts_with("bodies 'lower' and 'upper' touch without a contact, as at ("),
            "{printed}"
        );
        assert_eq!(printed.lines().count(), 1);
        assert_eq!(warned(&blocks, &format!("{HELD}{CONTACT}")), "");
    }
    assert_eq!(warned(&stack(1e-3), HELD), "");
}

#[test]
fn bodies_that_overlap_without_a_contact_are_named_with_the_depth() {
    let overlapping = |low: f64| {
        Blocks::new()
            .block("lower", [0.0, 2.0], [0.0, 1.0], [4, 2])
            .block("upper", [0.5, 1.5], [low, low + 1.0], [3, 2])
    };
    let says = "bodies 'lower' and 'upper' overlap without a contact by up to 0.2 m, as at (";
    for blocks in [overlapping(0.8), overlapping(0.8).quadratic()] {
        let printed = warned(&blocks, HELD);
        assert!(printed.starts_with(says), "{printed}");
        assert_eq!(printed.lines().count(), 1);
        // One body is there after the other.
        let steps = "[[step]]\n[[step]]\nremove = 'lower'\nadd = 'upper'\n";
        let printed = warned(&blocks, &format!("{HELD}{steps}"));
        assert!(!printed.contains("overlap"), "{printed}");
    }
    // Apart, and within the distance of straight facets from a curve.
    for low in [1.001, 0.999] {
        assert_eq!(warned(&overlapping(low), HELD), "", "{low}");
    }
}

/// The nodes at (x, y), in the order of their blocks.
fn nodes_at(blocks: &Blocks, x: f64, y: f64) -> Vec<u32> {
    let points = (0..).zip(&blocks.mesh.points);
    let there = points.filter(|(_, p)| p[0] == x && p[1] == y);
    there.map(|(node, _)| node).collect()
}

/// The blocks, with the node `kept` in place of another one.
fn glued(mut blocks: Blocks, kept: u32, gone: u32) -> Blocks {
    let mesh = &mut blocks.mesh;
    for elements in [&mut mesh.cells, &mut mesh.facets] {
        for e in 0..elements.len() {
            let nodes = elements.nodes_of_mut(e).iter_mut();
            nodes
                .filter(|node| **node == gone)
                .for_each(|node| *node = kept);
        }
    }
    blocks
}

/// Two blocks that are one body with a crack, as they share their nodes at these places between them.
fn cracked(shared: &[f64]) -> Blocks {
    let mut blocks = stack(0.0);
    for &x in shared {
        let twins = nodes_at(&blocks, x, 1.0);
        blocks = glued(blocks, twins[0], twins[1]);
    }
    blocks
}

#[test]
fn a_crack_without_a_contact_is_named() {
    let printed = warned(&cracked(&[2.0]), HELD);
    assert!(printed.contains("touch without a contact"), "{printed}");
    let printed = warned(&cracked(&[2.0]), &format!("{HELD}{CONTACT}"));
    assert!(!printed.contains("touch without a contact"), "{printed}");
}

#[test]
fn a_crack_that_its_mouth_holds_together_is_named() {
    let printed = warned(&cracked(&[2.0]), &format!("{HELD}{CONTACT}"));
    says(
        &printed,
        "contact 'c': its sides share node … at (2, 1) m, although the outer boundary begins there … \
         OpenBoundaryPhysicalGroup",
    );
    assert_eq!(printed.lines().count(), 1, "{printed}");
    let both = warned(&cracked(&[0.0, 2.0]), &format!("{HELD}{CONTACT}"));
    says(&both, "at (0, 1) m, one of 2 such places");
    // A tie holds its sides together anyway.
    let tie = "[[tie]]\nname = 't'\nsides = ['lower top', 'upper bottom']\n";
    let printed = warned(&cracked(&[2.0]), &format!("{HELD}{tie}"));
    assert!(!printed.contains("its sides share node"), "{printed}");
}

#[test]
fn a_tip_inside_a_body_is_no_mouth() {
    let mut blocks = cracked(&[1.5, 2.0]);
    for (name, of_twins) in [("below", 0), ("above", 1)] {
        let xs = [0.0, 0.5, 1.0];
        let mut nodes = xs.map(|x| nodes_at(&blocks, x, 1.0)[of_twins]).to_vec();
        nodes.push(nodes_at(&blocks, 1.5, 1.0)[0]);
        blocks.facets(name, nodes.into_iter());
    }
    let contact = CONTACT.replace("'lower top', 'upper bottom'", "'below', 'above'");
    assert_eq!(warned(&blocks, &format!("{HELD}{contact}")), "");
}

#[test]
fn pieces_that_hang_together_where_cracks_meet_are_named() {
    let blocks = Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [4, 2])
        .block("left", [0.0, 1.0], [1.0, 2.0], [2, 2])
        .block("right", [1.0, 2.0], [1.0, 2.0], [2, 2]);
    let contacts = "[[contact]]\nname = 'bar'\nsides = ['lower top', ['left bottom', 'right bottom']]\n\
        [[contact]]\nname = 'stem'\nsides = ['left right', 'right left']\n";
    let text = format!("{HELD}{contacts}");
    assert_eq!(warned(&blocks, &text), "");
    let at_junction = nodes_at(&blocks, 1.0, 1.0);
    let printed = warned(&glued(blocks, at_junction[1], at_junction[2]), &text);
    says(
        &printed,
        "contact 'stem': its sides share node … at (1, 1) m, although it meets contact 'bar' there",
    );
    assert_eq!(printed.lines().count(), 1, "{printed}");
}

#[test]
fn contacts_between_the_same_facets_are_named() {
    let again = "[[contact]]\nname = 'again'\nsides = ['upper bottom', 'lower top']\n";
    let printed = (stack(0.0).model(&format!("{HELD}{CONTACT}{again}"))).unwrap_err();
    says(
        &printed,
        "contact 'again': there is contact 'c' between the same facets",
    );
    let floor = |name: &str, y: f64| {
        TABLE.replace("table", name)
            + &format!("obstacle = {{point = [0, {y}], normal = [0, 1]}}\n")
    };
    let twice = floor("floor", 0.0) + &floor("again", 0.0);
    let error = stack(0.0).model(&format!("{CONTACT}{twice}")).unwrap_err();
    says(
        &error,
        "contact 'again': there is contact 'floor' between the same facets",
    );
    let steps = floor("floor", 0.0) + &floor("lower floor", -0.5);
    assert_eq!(warned(&stack(0.0), &format!("{CONTACT}{steps}")), "");
}

#[test]
fn a_corner_of_a_side_is_named() {
    let corner = CONTACT.replace("['lower top', 'up", "[['lower top', 'lower left'], 'up");
    assert_eq!(warned(&stack(0.0), &format!("{HELD}{corner}")), "");
    let mortar = format!("{HELD}{corner}pairing = 'mortar'\n");
    let printed = warned(&stack(0.0), &mortar);
    says(
        &printed,
        "contact 'c': side a has a corner of 90° at node … (0, 1)",
    );
    let on_b = CONTACT.replace("'upper bottom'", "['upper bottom', 'upper left']");
    assert_eq!(warned(&stack(0.0), &format!("{HELD}{on_b}")), "");
}

#[test]
fn loads_beyond_the_stiffness_and_ways_beyond_the_size_are_named() {
    let load =
        |value: &str| format!("{HELD}{CONTACT}[[pressure]]\non = 'upper top'\nvalue = {value}\n");
    assert_eq!(warned(&stack(0.0), &load("2")), "");
    let printed = warned(&stack(0.0), &load("'-100*x'"));
    says(
        &printed,
        "pressure[1] on 'upper top': up to 200 Pa on 'steel' of a stiffness of 240 Pa",
    );
    let traction = "[[traction]]\non = 'upper top'\nvalue = [0, 150]\n";
    let scaled = format!("{HELD}{CONTACT}{traction}[[step]]\nscale = 0.01\n[[step]]\nscale = 1\n");
    let printed = warned(&stack(0.0), &scaled);
    assert!(
        printed.starts_with("traction[1] on 'upper top': up to 150 Pa"),
        "{printed}"
    );
    assert_eq!(printed.lines().count(), 1);
    let pushed = format!("{HELD}{CONTACT}[[displacement]]\non = 'upper top'\ny = -5\n");
    let printed = warned(&stack(0.0), &pushed);
    says(
        &printed,
        "displacement[2] on 'upper top': a displacement of 5 m, and the bodies measure 2 m",
    );
    assert_eq!(printed.lines().count(), 1);
}

#[test]
fn loads_far_beyond_the_stiffness_are_refused_unless_the_scene_says_that_they_are_meant() {
    let body = |key: &str| {
        format!(
            "bodies.lower = {{ material = 'steel', {key} }}\nbodies.upper.material = 'steel'\n{HELD}{CONTACT}"
        )
    };
    let side = |list: &str, value: &str| {
        format!("{HELD}{CONTACT}[[{list}]]\non = 'upper top'\nvalue = {value}\n")
    };
    let scaled = format!(
        "{}[[step]]\nscale = 0.1\n[[step]]\nscale = 100\n",
        side("pressure", "500")
    );
    for (scene, expected) in [
        (
            side("pressure", "'-1e5*x'"),
            "pressure[1] on 'upper top': up to 2e5 Pa … strains of about 833.3",
        ),
        (
            side("traction", "[0, 3e4]"),
            "traction[1] on 'upper top': up to 30000 Pa",
        ),
        (scaled, "pressure[1] on 'upper top'"),
        (
            format!("{HELD}{CONTACT}[[force]]\non = 'upper top'\ntotal = [3e5, -4e5]\n"),
            "force[1] on 'upper top': forces of 5e5 N/m on bodies that measure 2 m",
        ),
        (
            body("body_force = [0, -25e3]"),
            "body 'lower': body forces of up to 25000 N/m³",
        ),
        (
            body("initial_stress = [-5e6, -5e6, 0, 0]"),
            "body 'lower': initial stresses of up to 5e6 Pa",
        ),
        (
            body("thermal = { expansion = 12, temperature = 80 }"),
            "body 'lower': thermal strains are about 960",
        ),
        (
            format!("{HELD}{CONTACT}gap = -1e10\n"),
            "contact 'c': a gap of -1e10 m presses bodies that measure 2 m … strains of about 5e9",
        ),
    ] {
        let printed = stack(0.0).model(&scene).unwrap_err();
        says(&printed, expected);
        says(&printed, "large_strains = true");
        let printed = warned(&stack(0.0), &format!("large_strains = true\n{scene}"));
        says(&printed, expected);
    }
}

#[test]
fn places_far_away_are_named() {
    let far = format!("{CONTACT}{TABLE}obstacle = {{point = [0, -50], normal = [0, 1]}}\n");
    let printed = warned(&stack(0.0), &far);
    says(
        &printed,
        "contact 'table': the smallest gap is 50 m, and the bodies measure 2 m",
    );
    let given = format!("{HELD}{CONTACT}gap = 0\n");
    assert_eq!(warned(&stack(0.5), &given), "");
    let millimetres = warned(&stack(0.0), &format!("units = 'mm'\n{far}"));
    assert!(millimetres.contains("is 50 mm, and the bodies measure 2 mm"));
    let high = Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [4, 2])
        .block("upper", [0.0, 2.0], [4.0, 5.0], [4, 2]);
    let printed = warned(&high, &given);
    says(
        &printed,
        "contact 'c'.gap: it is 0 m where the mesh has 3 m",
    );
}

#[test]
fn an_interference_is_named_however_far_away_the_scene_lies() {
    let far = stack(-1e-3).moved(|[x, y, z]| [x + 1e6, y - 1e6, z]);
    let printed = warned(&far, &format!("{HELD}{CONTACT}"));
    says(&printed, "an interference fit of up to");
}
