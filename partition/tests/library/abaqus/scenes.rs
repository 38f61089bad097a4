//! Built-in scenes whose mesh is written as a deck: nothing of the problem changes.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::element::ElementKind::{self, *};
use contact_dd_partition::example;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;
use contact_dd_partition::problem::Problem;
use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::scene::Scene;

use super::{SQUARES, read};
use crate::says::says;

/// The form in which a deck gives a side.
#[derive(Clone, Copy, Debug)]
enum Sides {
    /// `*NSET`.
    Nodes,
    /// `*ELEMENT` of one dimension less, as Gmsh writes them.
    Elements,
}

fn type_of(kind: ElementKind) -> &'static str {
    match kind {
        Line2 => "T3D2",
        Line3 => "T3D3",
        Triangle3 => "CPS3",
        Triangle6 => "CPE6",
        Quad4 => "CAX4",
        Quad8 => "CPS8",
        Tetrahedron4 => "C3D4",
        Tetrahedron10 => "C3D10",
        Hexahedron8 => "C3D8",
        _ => "C3D20",
    }
}

fn line(deck: &mut String, tag: i64, nodes: impl Iterator<Item = i64>) {
    write!(deck, "{tag}").unwrap();
    nodes.for_each(|node| write!(deck, ", {node}").unwrap());
    deck.push('\n');
}

fn deck(mesh: &Mesh, sides: Sides) -> String {
    let mut deck = String::from("*NODE\n");
    for (tag, [x, y, z]) in mesh.node_tags.iter().zip(&mesh.points) {
        writeln!(deck, "{tag}, {x:e}, {y:e}, {z:e}").unwrap();
    }
    let tags = |nodes: &[u32]| {
        nodes
            .iter()
            .map(|&n| mesh.node_tags[n as usize])
            .collect::<Vec<_>>()
    };
    for (cell, (kind, nodes)) in mesh.cells.iter().enumerate() {
        writeln!(deck, "*ELEMENT, TYPE={}", type_of(kind)).unwrap();
        line(&mut deck, mesh.cell_tags[cell], tags(nodes).into_iter());
    }
    let mut tag = mesh.cell_tags.iter().max().unwrap() + 1;
    for (name, group) in &mesh.groups {
        let members = || group.members.iter().map(|&m| m as usize);
        if group.dim == mesh.dim {
            writeln!(deck, "*ELSET, ELSET={name}").unwrap();
            members().for_each(|cell| writeln!(deck, "{}", mesh.cell_tags[cell]).unwrap());
            continue;
        }
        match sides {
            Sides::Elements if group.dim > 0 => {
                for facet in members() {
                    let kind = type_of(mesh.facets.kind(facet));
                    writeln!(deck, "*ELEMENT, TYPE={kind}, ELSET={name}").unwrap();
                    line(
                        &mut deck,
                        tag,
                        tags(mesh.facets.nodes_of(facet)).into_iter(),
                    );
                    tag += 1;
                }
            }
            _ => {
                writeln!(deck, "*NSET, NSET={name}").unwrap();
                let nodes = members().flat_map(|m| match group.dim {
                    0 => vec![mesh.node_tags[m]],
                    _ => tags(mesh.facets.nodes_of(m)),
                });
                let nodes: BTreeSet<i64> = nodes.collect();
                nodes
                    .iter()
                    .for_each(|node| writeln!(deck, "{node}").unwrap());
            }
        }
    }
    deck
}

fn problem(scene: &str, mesh: Mesh, subdomains: usize) -> Problem {
    let model = Model::new(&Scene::parse(scene).unwrap(), mesh).unwrap();
    let decomposition = Decomposition::new(&model, Some(subdomains)).unwrap();
    Problem::new(&model, &decomposition).unwrap()
}

#[test]
fn a_scene_makes_the_same_problem_of_a_deck() {
    for (name, kind, sides) in [
        ("junction", Triangle3, Sides::Nodes),
        ("shrink-fit", Triangle6, Sides::Elements),
        ("shrink-fit", Quad4, Sides::Elements),
        ("junction", Quad8, Sides::Nodes),
        ("stack3d", Tetrahedron4, Sides::Elements),
        ("stack3d", Tetrahedron10, Sides::Nodes),
        ("cube-crack", Hexahedron8, Sides::Elements),
        ("stack3d", Hexahedron20, Sides::Nodes),
    ] {
        let example = example::find(name).unwrap();
        let mesh = example.mesh_of(kind, 0).unwrap();
        let mut of_deck = read(&deck(&mesh, sides)).unwrap();
        assert_eq!(of_deck.points, mesh.points);
        assert_eq!(of_deck.cells, mesh.cells);
        of_deck.warnings.clear();
        let same = problem(example.scene, of_deck, 4) == problem(example.scene, mesh, 4);
        assert!(same, "{name}, {kind:?}, {sides:?}");
    }
}

#[test]
fn what_a_deck_is_warned_of_is_a_line_of_the_problem_file_whatever_the_deck_holds() {
    let mesh = read(&format!(
        "red \u{1b}[31m\n{SQUARES}*FOO\u{1b}[31mred\n*ELEMENT, TYPE=MASS\u{7}\n9, 1\n*NSET, NSET=n\n77\n"
    ));
    let scene = "mesh = 'a.inp'\nplane = 'stress'\nmaterials.steel = {young = 200, poisson = 0.25}\n\
                 bodies.Left.material = 'steel'\nbodies.'Right one'.material = 'steel'\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("problem.h5");
    problem(scene, mesh.unwrap(), 1).write(&path).unwrap();
    let read = ProblemFile::open(&path).and_then(|file| file.problem());
    let printed = read.unwrap().catalog.warnings.join(" | ");
    assert!(!printed.contains(char::is_control), "{printed:?}");
    says(&printed, r"*FOO\u{1b}[31MRED");
}
