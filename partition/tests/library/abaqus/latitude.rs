//! Decks in unusual forms that Abaqus or CalculiX accept: they give the same mesh.

use super::{SQUARES, read, tags};
use crate::says::says;
use contact_dd_partition::mesh::Mesh;

/// Two cubes on each other of the nodes 1 to 12, with a set each and a surface.
const CUBES: &str = "\
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
9, 0., 0., 2.
10, 1., 0., 2.
11, 1., 1., 2.
12, 0., 1., 2.
*ELEMENT, TYPE=C3D8, ELSET=Low
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=High
2, 5, 6, 7, 8, 9, 10, 11, 12
*NSET, NSET=Bottom
1, 2, 3, 4
*SURFACE, NAME=Top
High, S2
";

/// Mesh of a deck, whose warnings have to be as expected, with ` … ` between their parts.
#[track_caller]
fn quiet(deck: &str, warning: &str) -> Mesh {
    let mut mesh = read(deck).unwrap();
    let printed = mesh.warnings.join("\n");
    match warning {
        "" => assert_eq!(printed, ""),
        _ => says(&printed, warning),
    }
    mesh.warnings.clear();
    mesh
}

/// The deck with `from` replaced.
fn with(from: &str, to: &str) -> String {
    assert!(CUBES.contains(from), "{from}");
    CUBES.replacen(from, to, 1)
}

#[test]
fn the_same_mesh_comes_of_a_deck_that_others_would_read() {
    let plain = quiet(CUBES, "");
    let (nodes, rest) = CUBES.split_at(CUBES.find("*ELEMENT").unwrap());
    let (elements, sets) = rest.split_at(rest.find("*NSET").unwrap());
    let top = "*SURFACE, NAME=Top\nHigh, S2\n";
    let apart = "*SURFACE, NAME=One, INTERNAL\nHigh, S2\n*SURFACE, NAME=Two, INTERNAL\n2, S2\n";
    for (deck, warning) in [
        (format!("\u{feff}{CUBES}"), ""),
        (CUBES.replace('\n', "\r\n"), ""),
        (
            format!("A beam, by hand\n1, 2, 3\n{CUBES}"),
            "text before the first keyword is left out: line 1 `A beam, by hand`, line 2",
        ),
        (format!("{elements}{nodes}{sets}"), ""),
        (format!("{sets}{elements}{nodes}"), ""),
        (
            with("2, 1., 0., 0.", "2, 1., 0., 0.\n2, 10.-1, 0.0d5"),
            "nodes are given twice, at the same place: 2 (line 4)",
        ),
        (with("10, 1., 0., 2.", "10, 100.-2, +0.+3, 0.002+3"), ""),
        (
            with("8, 0., 1., 1.\n", "8, -0., 1., 10.D-1\n"),
            "",
        ),
        (
            with("3, 4, 5, 6, 7, 8", "3, 4, 5, 6, 7, 8, 11, 12"),
            "left out: element 1 of C3D8 (line 15)",
        ),
        (
            with(
                "*ELEMENT, TYPE=C3D8, ELSET=High",
                "*ELEMENT, TYPE=C3D8, ELSET=Low\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*ELEMENT, TYPE=C3D8, ELSET=High",
            ),
            "elements are given twice, with the same nodes: 1 (line 17)",
        ),
        (
            with("1, 2, 3, 4\n*SURF", "1, 2, 3, 4, 77, 78\n*SURF"),
            "nodes that aren't there, which are left out: 77 of 'Bottom' (line 19), 78 of",
        ),
        (
            with("High, S2", "High, S2\n99, S1"),
            "elements that aren't there, which are left out: 99 of 'Top' (line 22)",
        ),
        (CUBES.replace(top, &format!("{apart}*SURFACE, NAME=Top, COMBINE=UNION\nOne, Two\n")), ""),
        (CUBES.replace(top, &format!("*SURFACE, NAME=Top, COMBINE=UNION\nOne,\nTwo\n{apart}")), ""),
        (
            with(
                "*NSET",
                "*ELEMENT, TYPE=MASS, ELSET=M\n70, 12\n*ELEMENT, TYPE=R3D4, ELSET=R\n71, 1, 2, 3, 4\n\
                 *ELEMENT, TYPE=SPRINGA\n72, 1, 12\n*ELSET, ELSET=High\n71, R, M\n*NSET",
            ),
            "elements that are no cells of a body are left out: MASS, R3D4",
        ),
        (
            CUBES.replace(top, "*SURFACE, NAME=Top, TYPE=NODE\nNT, 1.\n*NSET, NSET=NT, INTERNAL\n9, 10, 11, 12\n"),
            "",
        ),
        (
            CUBES.replace(top, "*SURFACE, NAME=Top, TYPE=NODE\n9, 1.\n10\n11\n12\n5\n"),
            "belong to no facet whose nodes all are in these, and are left out: 5 of 'Top'",
        ),
        (
            CUBES.replace(
                top,
                "*SURFACE, NAME=Top\nSkin, SPOS\n*ELEMENT, TYPE=S4R, ELSET=_Skin\n50, 9, 10, 11, 12\n\
                 *ELSET, ELSET=Skin, INTERNAL\n50\n",
            )
            .replace(", ELSET=_Skin", ""),
            "S4R as sides",
        ),
        (
            CUBES.replace(
                top,
                "*SURFACE, NAME=Top\n50, SNEG\n51, SNEG\n*ELEMENT, TYPE=S4\n50, 12, 11, 10, 9\n51, 1, 3, 9, 11\n",
            ),
            "elements that are no faces of cells are left out: 51",
        ),
    ] {
        let mesh = quiet(&deck, warning);
        assert!(mesh == plain, "{deck}\n{:?}\n{:?}", mesh.groups, plain.groups);
    }
}

#[test]
fn sets_may_name_those_that_come_later() {
    let mesh = read(&format!(
        "*NSET, NSET=ends\nleft edge, 2, Right edge\n*NSET, NSET=Right edge\nr\n*NSET, NSET=r\n3, 6\n\
         *NSET, NSET=left edge\n1, 4\n{SQUARES}*NSET, NSET=of left, ELSET=both\n*ELSET, ELSET=both\nleft, 2\n"
    ))
    .unwrap();
    assert_eq!(tags(&mesh, "Right edge"), [[3, 6]]);
    assert_eq!(tags(&mesh, "left edge"), [[1, 4]]);
    assert_eq!(tags(&mesh, "ends").len(), 4);
    assert_eq!(tags(&mesh, "both").len(), 2);
}

#[test]
fn an_instance_may_have_its_mesh_in_itself() {
    let (nodes, sets) = CUBES.split_at(CUBES.find("*NSET").unwrap());
    let dependent = format!(
        "*PART, NAME=P\n{CUBES}*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n1., 0., 2.\n*END INSTANCE\n\
         *INSTANCE, NAME=J, PART=P\n*END INSTANCE\n*END ASSEMBLY\n"
    );
    let expected = read(&dependent).unwrap();
    for own in [
        format!(
            "*PART, NAME=P\n*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n1., 0., 2.\n{CUBES}*END INSTANCE\n\
             *INSTANCE, NAME=J, PART=P\n{CUBES}*END INSTANCE\n*END ASSEMBLY\n"
        ),
        format!(
            "*PART, NAME=P\n{nodes}*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=I, PART=P\n1., 0., 2.\n{sets}\
             *END INSTANCE\n*INSTANCE, NAME=J, PART=P\n{sets}*END INSTANCE\n*END ASSEMBLY\n"
        ),
    ] {
        let mesh = read(&own).unwrap();
        assert_eq!(mesh, expected);
    }
    assert_eq!(expected.points[0], [1.0, 0.0, 2.0]);
    assert_eq!(expected.node_tags.len(), 24);
}

#[test]
fn cells_with_incompatible_modes_are_named_to_the_solver() {
    let deck = CUBES.replacen("C3D8,", "C3D8I,", 1);
    let mesh = read(&deck).unwrap();
    assert!(mesh.has_modes.contains(&true));
    assert!(
        !mesh
            .warnings
            .iter()
            .any(|warning| warning.contains("C3D8I"))
    );
    assert!(read(CUBES).unwrap().has_modes.is_empty());
}
