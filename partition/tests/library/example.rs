//! The meshes of the built-in scenes, and the program that makes them.

mod shapes;
mod solids;

use std::collections::BTreeSet;

use crate::says::says;
use contact_dd_partition::element::ElementKind::{Quad4, Quad8, Quad9, Triangle6};
use contact_dd_partition::example::{self, EXAMPLES};
use contact_dd_partition::mesh::topology::Topology;
use contact_dd_partition::mesh::{Mesh, gmsh};
use contact_dd_partition::model::{Contact, Model};
use contact_dd_partition::scene::Scene;

fn mesh_of(name: &str, refine: u32) -> Mesh {
    example::find(name).unwrap().mesh(refine).unwrap()
}

/// The examples of the plane whose meshes are made for any cells and size.
fn adjustable() -> impl Iterator<Item = &'static example::Example> {
    let names = ["gears", "sphere", "cube-crack", "pin", "stack3d"];
    EXAMPLES
        .iter()
        .filter(move |example| !names.contains(&example.name))
}

fn area(mesh: &Mesh) -> f64 {
    (0..mesh.cells.len()).map(|cell| mesh.measure(cell)).sum()
}

/// The nodes of a side.
fn nodes_of(mesh: &Mesh, side: &str) -> BTreeSet<u32> {
    let group = &mesh.groups[side];
    assert_eq!(group.dim, 1, "{side}");
    let facets = group.members.iter();
    facets
        .flat_map(|&facet| mesh.facets.nodes_of(facet as usize).to_vec())
        .collect()
}

fn length(mesh: &Mesh, side: &str) -> f64 {
    let facets = mesh.groups[side].members.iter();
    facets
        .map(|&facet| {
            let [a, b] =
                [0, 1].map(|i| mesh.points[mesh.facets.nodes_of(facet as usize)[i] as usize]);
            (a[0] - b[0]).hypot(a[1] - b[1])
        })
        .sum()
}

/// A point on a grid fine enough to distinguish nodes and coarse enough to absorb rounding.
fn key(point: [f64; 3]) -> [i64; 2] {
    [0, 1].map(|i| (point[i] * 1e9).round() as i64)
}

#[test]
fn every_mesh_covers_its_scene_exactly_at_every_refinement() {
    for (name, exact) in [
        ("granite", 100.0),
        ("hertz", 4.0),
        ("crack", 1600.0),
        ("patch", 4.0),
        ("junction", 100.0),
        ("stack", 9.0),
        ("wall", 1.25 * 0.75),
        ("incline", 3.0),
        ("raous", 0.0016),
        ("mindlin", 400.0),
        ("granite-friction", 100.0),
        ("shrink-fit", 120.0 * 50.0 + 80.0 * 50.0),
    ] {
        for refine in 0..2 {
            let area = area(&mesh_of(name, refine));
            assert!((area / exact - 1.0).abs() < 1e-12, "{name}: {area}");
        }
    }
}

#[test]
fn refinement_follows_the_curved_side_of_the_plate_with_second_order() {
    let exact = 0.05_f64.powi(2) - std::f64::consts::PI * 0.01_f64.powi(2) / 4.0;
    let errors = [0, 1, 2].map(|refine| area(&mesh_of("plain", refine)) - exact);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "order {order}");
    }
}

#[test]
fn quadratic_cells_follow_the_curved_side_of_the_plate_with_fourth_order() {
    let exact = 0.05_f64.powi(2) - std::f64::consts::PI * 0.01_f64.powi(2) / 4.0;
    for kind in [Triangle6, Quad8, Quad9] {
        let errors = [0, 1, 2].map(|refine| {
            let mesh = example::find("plain").unwrap().mesh_of(kind, refine);
            (area(&mesh.unwrap()) - exact).abs()
        });
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((order - 4.0).abs() < 0.1, "{kind:?}: order {order}");
        }
    }
}

#[test]
fn edges_of_graded_meshes_are_straight_with_nodes_in_their_middle() {
    for kind in [Triangle6, Quad8, Quad9] {
        let mesh = example::find("hertz").unwrap().mesh_of(kind, 1).unwrap();
        for (kind, nodes) in mesh.cells.iter() {
            let at = |local: usize| mesh.points[nodes[local] as usize];
            for (_, local) in kind.facets() {
                let [a, b, middle] = [at(local[0]), at(local[1]), at(local[2])];
                for axis in 0..2 {
                    assert!((middle[axis] - 0.5 * (a[axis] + b[axis])).abs() < 1e-15);
                }
            }
        }
    }
}

#[test]
fn examples_of_any_cells_are_the_same_scene() {
    for example in adjustable() {
        let triangles = example.mesh(0).unwrap();
        for kind in [Triangle6, Quad4, Quad8, Quad9] {
            let mesh = example.mesh_of(kind, 0).unwrap();
            assert!(
                mesh.cells.iter().any(|(of, _)| of == kind),
                "{}",
                example.name
            );
            assert!(mesh.groups.keys().eq(triangles.groups.keys()));
            assert_eq!(mesh.facets.len(), triangles.facets.len());
            let topology = Topology::new(&mesh);
            for (_, facet) in mesh.facets.iter() {
                assert_eq!(topology.cells_at(facet).len(), 1, "{}", example.name);
            }
            let scene = Scene::parse(example.scene).unwrap();
            let model = Model::new(&scene, mesh).unwrap();
            let linear = Model::new(&scene, triangles.clone()).unwrap();
            for (contact, other) in model.contacts.iter().zip(&linear.contacts) {
                let share = |c: &Contact| c.points.iter().map(|r| r.area).sum::<f64>();
                assert!(contact.points.len() >= other.points.len());
                // A crack tip carries no constraint, and its share is smaller.
                assert!(
                    share(contact) > (1.0 - 1e-12) * share(other),
                    "{}",
                    example.name
                );
            }
        }
    }
}

#[test]
fn refinement_cuts_every_cell_into_four_and_every_facet_into_two() {
    for example in adjustable() {
        let (coarse, fine) = (example.mesh(0).unwrap(), example.mesh(1).unwrap());
        assert_eq!(fine.cells.len(), 4 * coarse.cells.len());
        assert_eq!(fine.facets.len(), 2 * coarse.facets.len());
        assert!(fine.groups.keys().eq(coarse.groups.keys()));
    }
    assert!(example::find("granite").unwrap().mesh(30).is_err());
}

#[test]
fn meshes_are_conforming_and_their_sides_lie_on_the_boundary() {
    for example in EXAMPLES {
        let mesh = example.mesh(0).unwrap();
        let topology = Topology::new(&mesh);
        for (_, facet) in mesh.facets.iter() {
            assert_eq!(topology.cells_at(facet).len(), 1, "{}", example.name);
        }
        let mut boundary = 0.0;
        for (kind, nodes) in mesh.cells.iter() {
            for (_, local) in kind.facets() {
                let facet: Vec<u32> = local.iter().map(|&i| nodes[i]).collect();
                let cells = topology.cells_at(&facet);
                assert!(cells.len() <= 2, "{}", example.name);
                if cells.len() == 1 {
                    let [a, b] = [0, 1].map(|i| mesh.points[facet[i] as usize]);
                    boundary += (a[0] - b[0]).hypot(a[1] - b[1]);
                }
            }
        }
        // Both sides of every contact, beside the outline.
        let exact = match example.name {
            "granite" => 40.0 + 4.0 * 11.25_f64.sqrt(),
            "hertz" => 8.0,
            "crack" => 160.0 + 4.0,
            "patch" => 8.0 + 2.0 * 2.0_f64.hypot(0.4),
            "junction" => 40.0 + 2.0 * (10.0_f64.hypot(6.0) + 5.0 + 5.0),
            "stack" => 2.0 * (4.0 + 3.0 + 2.0 + 3.0),
            "wall" => 27.0 * 0.75 + 6.0 * 0.5,
            "incline" => 8.0,
            "raous" => 0.16,
            "mindlin" => 120.0,
            "shrink-fit" => 340.0 + 260.0,
            _ => continue,
        };
        assert!((boundary / exact - 1.0).abs() < 1e-12, "{}", example.name);
    }
}

#[test]
fn sides_of_a_contact_have_matching_nodes_and_share_none_but_crack_tips() {
    for (name, a, b, conditions, tips) in [
        ("granite", "left crack lower", "left crack upper", 24, 1),
        ("granite", "right crack lower", "right crack upper", 24, 1),
        ("crack", "crack upper", "crack lower", 23, 2),
        ("patch", "lower face", "upper face", 17, 0),
        ("junction", "oblique upper", "oblique lower", 21, 0),
        ("junction", "vertical right", "vertical left", 11, 0),
        ("junction", "horizontal upper", "horizontal lower", 11, 0),
        ("stack", "lower joint above", "lower joint below", 25, 0),
        ("stack", "upper joint above", "upper joint below", 17, 0),
        ("mindlin", "upper face", "lower face", 39, 0),
    ] {
        let mesh = mesh_of(name, 0);
        let (a, b) = (nodes_of(&mesh, a), nodes_of(&mesh, b));
        let places = |side: &BTreeSet<u32>| -> BTreeSet<[i64; 2]> {
            side.iter().map(|&n| key(mesh.points[n as usize])).collect()
        };
        assert_eq!(places(&a), places(&b), "{name}");
        assert_eq!(places(&b).len(), conditions + tips, "{name}");
        assert_eq!(
            b.len(),
            conditions + tips,
            "{name}: side b has one node a place"
        );
        assert_eq!(a.intersection(&b).count(), tips, "{name}");
    }
}

#[test]
fn bodies_hang_together_and_are_never_glued() {
    for (name, bodies) in [
        ("granite", 1),
        ("hertz", 1),
        ("crack", 1),
        ("patch", 2),
        ("junction", 4),
        ("stack", 3),
        ("wall", 33),
        ("rollers", 5),
        ("gears", 2),
        ("plain", 1),
        ("incline", 1),
        ("raous", 1),
        ("mindlin", 2),
        ("granite-friction", 1),
        ("shrink-fit", 2),
    ] {
        let mesh = mesh_of(name, 0);
        let pieces: BTreeSet<u32> = Topology::new(&mesh).pieces().into_iter().collect();
        assert_eq!(pieces.len(), bodies, "{name}");
        let groups = mesh.groups.values().filter(|g| g.dim == 2);
        assert_eq!(groups.count(), bodies, "{name}");
    }
}

#[test]
fn a_mesh_by_gmsh_is_refined_by_gmsh_only() {
    let gears = example::find("gears").unwrap();
    for refused in [gears.mesh(1), gears.mesh_of(Triangle6, 0)] {
        let error = refused.unwrap_err().to_string();
        says(&error, "gmsh -2 -order 2 -clscale 0.5");
        assert_eq!(error.lines().count(), 1);
    }
    let folder = tempfile::tempdir().unwrap();
    gears.write(&gears.mesh(0).unwrap(), folder.path()).unwrap();
    let geometry = std::fs::read_to_string(folder.path().join("gears.geo")).unwrap();
    assert!(geometry.contains("Physical Curve(\"bore\")"));
}

#[test]
fn cells_are_well_shaped() {
    // Meshes graded towards points have long cells far from them.
    let graded = [
        "hertz",
        "crack",
        "rollers",
        "mindlin",
        "pin",
        "sphere",
        "stack3d",
        "cube-crack",
    ];
    let is_graded = |name: &str| graded.contains(&name);
    for example in EXAMPLES.iter().filter(|e| !is_graded(e.name)) {
        let mesh = example.mesh(0).unwrap();
        let mut worst = f64::INFINITY;
        for (_, nodes) in mesh.cells.iter() {
            let p: Vec<[f64; 3]> = nodes.iter().map(|&n| mesh.points[n as usize]).collect();
            for i in 0..3 {
                let [a, b, c] = [i, (i + 1) % 3, (i + 2) % 3].map(|k| p[k]);
                let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
                let angle = (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]);
                worst = worst.min(angle.to_degrees());
            }
        }
        assert!(worst > 18.0, "{}: smallest angle {worst}°", example.name);
    }
}

#[test]
fn meshes_are_read_back_from_their_files_bit_by_bit() {
    let dir = tempfile::tempdir().unwrap();
    for example in EXAMPLES {
        let mesh = example.mesh(0).unwrap();
        let scene = example.write(&mesh, dir.path()).unwrap();
        assert_eq!(std::fs::read_to_string(&scene).unwrap(), example.scene);
        let (made, _) = example.make(0).unwrap();
        assert_eq!(made.title, Scene::read(&scene).unwrap().title);
        assert_eq!(gmsh::read(&dir.path().join("mesh.msh")).unwrap(), mesh);
    }
}
