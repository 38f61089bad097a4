//! Reading and writing of MSH files, against files spelled out number by number.

mod file;
mod kinds;

use std::collections::BTreeMap;

use contact_dd_partition::mesh::{Mesh, gmsh};
use file::{FORMS, Form, version_2_2, version_4_1};

use crate::table::cases;

fn groups(mesh: &Mesh) -> BTreeMap<&str, (usize, &[u32])> {
    let groups = mesh.groups.iter();
    groups
        .map(|(name, group)| (name.as_str(), (group.dim, group.members.as_slice())))
        .collect()
}

#[test]
fn every_version_and_encoding_gives_the_same_mesh() {
    for bytes in FORMS.map(version_4_1).iter().chain(&FORMS.map(version_2_2)) {
        let mesh = gmsh::parse(bytes).unwrap();
        assert_eq!(mesh.dim, 2);
        assert_eq!(mesh.node_tags, [8, 10, 12, 40]);
        let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
        assert_eq!(mesh.points, corners.map(|[x, y]| [x, y, 0.0]));
        assert_eq!(mesh.cell_tags, [20, 90]);
        assert_eq!(mesh.cells.nodes_of(0), [0, 2, 3]);
        assert_eq!(mesh.cells.nodes_of(1), [0, 3, 1], "turned over");
        assert_eq!(mesh.facets.len(), 2);
        assert_eq!(mesh.facets.nodes_of(0), [0, 2]);
        assert_eq!(mesh.facets.nodes_of(1), [1, 0]);
        let expected: [(&str, (usize, &[u32])); 5] = [
            ("7", (1, &[0])),
            ("block", (2, &[0, 1])),
            ("corner", (0, &[0])),
            ("left crack", (1, &[1])),
            ("upper half", (2, &[1])),
        ];
        assert_eq!(groups(&mesh), BTreeMap::from(expected));
    }
}

#[test]
fn what_is_written_is_read_back_bit_by_bit() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("mesh.msh");
    let mut mesh = gmsh::parse(&version_4_1(Form::Ascii)).unwrap();
    mesh.points[1][0] = -1e-301;
    mesh.points[2][1] = 0.1 + 0.2;
    mesh.groups.entry("empty one".into()).or_default().dim = 1;
    gmsh::write(&mesh, &path).unwrap();
    assert_eq!(gmsh::read(&path).unwrap(), mesh);
}

#[test]
fn a_name_of_two_dimensions_serves_both_with_the_dimension_behind_it() {
    let text = String::from_utf8(version_4_1(Form::Ascii)).unwrap();
    let mesh = gmsh::parse(text.replace("left crack", "block").as_bytes()).unwrap();
    let groups = groups(&mesh);
    assert_eq!(groups["block (surface)"], (2, &[0, 1][..]));
    assert_eq!(groups["block (curve)"], (1, &[1][..]));
    assert!(!groups.contains_key("block"));
}

#[test]
fn cells_outside_all_groups_are_left_out_only_where_others_are_in_one() {
    let text = String::from_utf8(version_2_2(Form::Ascii)).unwrap();
    let one = text.replace("20 2 2 9 ", "20 2 2 0 ");
    let mesh = gmsh::parse(one.as_bytes()).unwrap();
    assert_eq!(
        (mesh.cell_tags, mesh.node_tags),
        (vec![90], vec![8, 10, 40])
    );
    let none = one
        .replace(" 2 2 9 ", " 2 2 0 ")
        .replace(" 2 2 4 ", " 2 2 0 ");
    assert_eq!(gmsh::parse(none.as_bytes()).unwrap().cells.len(), 2);
}

/// The reader's message on the square in MSH 4.1, ASCII, with something replaced.
fn complaint(from: &str, to: &str) -> String {
    let text = String::from_utf8(version_4_1(Form::Ascii)).unwrap();
    assert!(text.contains(from), "{from} isn't in the file");
    let damaged = text.replacen(from, to, 1);
    gmsh::parse(damaged.as_bytes()).unwrap_err().to_string()
}

const WRONG: &str = r#"
4.1 0 8 => 4 0 8
    line 2 in $MeshFormat: MSH version 4 isn't
$MeshFormat => $Nodes
    expected $MeshFormat first, found $Nodes
90 8 10 40 => 90 8 11 40
    line 24 in $Elements: element 90 names node 11
90 8 10 40 => 90 8 8 40
    element 90 has no area: its nodes 8, 8, 40
90 8 10 40 => 20 8 10 40
    the element tag 20 occurs twice
2 2 2 1 90 => 2 2 21 1 90
    element 90 is of type 21, of third
2 2 2 1 90 => 2 2 2 8000000000 90
    it is truncated
40 8 1 1 0.25 => 8 8 1 1 0.25
    line 18 in $Nodes: the node tag 8 occurs twice
0.5 0 0 0.25 => 0.5 NaN 0 0.25
    the x coordinate is NaN
0.5 0 0 0.25 => 0.5 0 inf 0.25
    the y coordinate is inf
0.5 0 0 0.25 => 0.5 0 0 0.5
    node 8 has z = 0.5
0.5 0 0 0.25 => 0.5 0 oh 0.25
    expected the y coordinate, a number, found `oh`
2 5 8 77 => 2 6 8 77
    expected 6 nodes as declared, found 5
2 5 8 77 => 2 99999999999 8 77
    number of nodes is 99999999999, but the file ends
2 5 8 77 => 2 -5 8 77
    expected the number of nodes, a whole number, found `-5`
0 5 "corner" => 0 5 corner
    line 9 in $PhysicalNames: expected dimension
"upper half" => "block"
    two physical groups of dimension 2 are called "block"
"#;

#[test]
fn what_is_wrong_with_a_file_is_said_with_its_place() {
    for (from, to, expected) in cases(WRONG) {
        let printed = complaint(&from, &to);
        assert!(printed.contains(&expected), "{from} → {to}: {printed}");
    }
}

/// The message on a square of triangles in the plane x = 0, with this line among the physical names.
fn upright(name: &str) -> String {
    let names = match name.is_empty() {
        true => String::new(),
        false => format!("$PhysicalNames\n1\n{name}\n$EndPhysicalNames\n"),
    };
    let text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{names}$Nodes\n4\n1 0 0 0\n2 0 1 0\n3 0 1 1\n4 0 0 1\n$EndNodes\n\
         $Elements\n2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n$EndElements\n"
    );
    gmsh::parse(text.as_bytes()).unwrap_err().to_string()
}

#[test]
fn a_surface_in_space_is_said_to_have_no_volume() {
    assert!(
        upright("").contains(
            "gmsh -3, not gmsh -2, makes them, and a file holds those of a Physical Volume"
        )
    );
    let printed = upright("3 7 \"die\"");
    assert!(
        printed.contains("the group 'die' of volumes is empty: gmsh -3"),
        "{printed}"
    );
}

#[test]
fn every_truncated_file_is_an_error() {
    for bytes in FORMS.map(version_4_1).iter().chain(&FORMS.map(version_2_2)) {
        let whole = bytes.len() - 1;
        for length in 0..whole {
            assert!(gmsh::parse(&bytes[..length]).is_err(), "cut at {length}");
        }
        assert!(gmsh::parse(&bytes[..whole]).is_ok());
    }
}

#[test]
fn files_of_gmsh_itself_are_read_whatever_options_it_wrote_them_with() {
    let dir = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/library/gmsh/files");
    let files = std::fs::read_dir(dir).unwrap().map(|f| f.unwrap().path());
    let files: Vec<_> = files.filter(|f| f.extension().unwrap() == "msh").collect();
    assert_eq!(files.len(), 8);
    let mut first = None;
    for file in files {
        let mut mesh = gmsh::read(&file).unwrap();
        let area: f64 = (0..mesh.cells.len()).map(|c| mesh.measure(c)).sum();
        assert!((area - 2.0).abs() < 1e-14, "{area}");
        assert!((0..mesh.cells.len()).all(|c| mesh.measure(c) > 0.0));
        let counts = groups(&mesh);
        let counts: Vec<_> = counts.iter().map(|(n, g)| (*n, g.0, g.1.len())).collect();
        let cells = mesh.cells.len();
        assert_eq!(
            counts,
            [
                ("11", 1, 2),
                ("both", 2, cells),
                ("corner", 0, 1),
                ("ends", 1, 4),
                ("lower body", 2, cells / 2),
                ("lower face", 1, 2),
                ("upper body", 2, cells / 2),
                ("upper face", 1, 2),
            ]
        );
        // In 2.2 Gmsh numbers elements anew, once for each group, and turns those of a reversed
        // curve round; ASCII has 16 digits.
        mesh.cell_tags.clear();
        for facet in 0..mesh.facets.len() {
            mesh.facets.nodes_of_mut(facet).sort_unstable();
        }
        for x in mesh.points.iter_mut().flatten() {
            *x = (*x * 1e12).round() / 1e12;
        }
        assert_eq!(first.get_or_insert_with(|| mesh.clone()), &mesh, "{file:?}");
    }
}
