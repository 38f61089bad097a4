//! Decks of Abaqus and CalculiX.

mod assemblies;
mod kinds;
mod latitude;
mod limits;
mod mistakes;
mod scenes;

use std::path::Path;

use crate::says::says;
use contact_dd_partition::mesh::{self, Mesh};
use tempfile::TempDir;

/// Mesh of a deck and of the files it includes.
fn read_all(files: &[(&str, &str)]) -> Result<Mesh, String> {
    let folder = TempDir::new().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let path = folder.path().join(files[0].0);
    let shown = |folder: &Path| format!("{}/", folder.display());
    mesh::read(&path).map_err(|error| error.to_string().replace(&shown(folder.path()), ""))
}

fn read(deck: &str) -> Result<Mesh, String> {
    read_all(&[("part.inp", deck)])
}

/// The tags of the nodes of a group, by cell, facet or node.
fn tags(mesh: &Mesh, name: &str) -> Vec<Vec<i64>> {
    let group = mesh.groups.get(name);
    let group = group.unwrap_or_else(|| panic!("no group {name}: {:?}", mesh.groups.keys()));
    let members = group.members.iter().map(|&member| {
        let nodes = match mesh.dim - group.dim {
            0 => mesh.cells.nodes_of(member as usize),
            1 if group.dim > 0 => mesh.facets.nodes_of(member as usize),
            _ => std::slice::from_ref(&member),
        };
        let mut tags: Vec<i64> = nodes.iter().map(|&n| mesh.node_tags[n as usize]).collect();
        tags.sort_unstable();
        tags
    });
    let mut members: Vec<Vec<i64>> = members.collect();
    members.sort();
    members
}

/// Two squares side by side, of nodes 1 to 6, with the nodes 1, 2, 3 at the bottom.
const SQUARES: &str = "\
*HEADING
 Two squares, written by hand
** a comment
*Node, nset=All
1, 0., 0.
2, 1.0D0, 0.
3, 2., 0., 0.
 4, 0., 1.
5, 1., 1.

6, 2., 1.
99, 7., 7.
*ELEMENT, TYPE=CPS4R,
 ELSET=Left
1, 1, 2, 5, 4
*element,type=cpe4,elset=\"Right one\"
2, 2, 3,
 6, 5
";

#[test]
fn keywords_have_any_case_and_go_on_behind_a_comma() {
    let mesh = read(&format!(
        "{SQUARES}*nset, nset=base, generate
1, 3
*NSET, NSET=corners
BASE, 4,
6
*NSET, NSET=Odd, GENERATE
1, 1000000000, 2
*Elset,elset=both
left, right ONE
*SURFACE, NAME=Ends
Left, S4
2, s2
*Surface, type=element, name=outside
both,
*MATERIAL, NAME=steel
*ELASTIC
210e3, 0.3
*STEP
*NODE FILE
U
*END STEP
"
    ))
    .unwrap();
    assert_eq!(mesh.node_tags, [1, 2, 3, 4, 5, 6]);
    assert_eq!(mesh.cell_tags, [1, 2]);
    assert_eq!(tags(&mesh, "Left"), [[1, 2, 4, 5]]);
    assert_eq!(tags(&mesh, "Right one"), [[2, 3, 5, 6]]);
    assert_eq!(tags(&mesh, "both").len(), 2);
    assert_eq!(tags(&mesh, "base"), [[1, 2], [2, 3]]);
    assert_eq!(tags(&mesh, "Ends"), [[1, 4], [3, 6]]);
    assert_eq!(tags(&mesh, "outside").len(), 6);
    // Not all between two neighbours: points.
    assert_eq!(tags(&mesh, "Odd"), [[1], [3], [5]]);
    let printed = mesh.warnings.join("\n");
    says(&printed, "CPS4R as CPS4");
    says(&printed, "*ELASTIC, *MATERIAL, *STEP");
    assert!(
        !printed.contains("FILE") && !printed.contains("HEADING"),
        "{printed}"
    );
}

#[test]
fn a_deck_includes_others() {
    let (nodes, rest) = SQUARES.split_once("*ELEMENT").unwrap();
    let (head, lines) = nodes.split_once("nset=All\n").unwrap();
    let whole = read(SQUARES).unwrap();
    for main in [
        format!("{head}nset=All\n*INCLUDE, INPUT=nodes.txt\n*ELEMENT{rest}"),
        format!("{head}nset=All, input=nodes.txt\n*ELEMENT{rest}"),
        "*Include, input=middle.inp\n".into(),
    ] {
        let middle = format!("{head}nset=All\n*INCLUDE, INPUT=nodes.txt\n*ELEMENT{rest}");
        let files = [
            ("main.inp", main.as_str()),
            ("middle.inp", &middle),
            ("nodes.txt", lines),
        ];
        assert_eq!(read_all(&files).unwrap(), whole);
    }
}

#[test]
fn a_set_of_nodes_with_the_name_of_elements_is_told_apart_unless_it_is_theirs() {
    let mesh = read(&format!(
        "{SQUARES}*NSET, NSET=LEFT\n1, 2, 4, 5\n*NSET, NSET=Right one\n3, 6\n\
         *SURFACE, NAME=Top\nLeft, S3\n*NSET, NSET=TOP\n4, 5\n"
    ))
    .unwrap();
    assert_eq!(tags(&mesh, "Left"), [[1, 2, 4, 5]]);
    assert_eq!(tags(&mesh, "Right one (surface)"), [[2, 3, 5, 6]]);
    assert_eq!(tags(&mesh, "Right one (curve)"), [[3, 6]]);
    assert_eq!(tags(&mesh, "Top"), [[4, 5]]);
    assert!(!mesh.groups.contains_key("Right one"));
}
