//! Quadratic cells: loads, supports and contact on edges that may be curved, and cells that can't be.

use super::contact::{conditions, stack};
use crate::blocks::Blocks;
use crate::close::close;
use crate::says::says;
use contact_dd_partition::element::ElementKind::{self, Quad4, Quad8, Quad9, Triangle6};
use contact_dd_partition::element::Elements;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

const CONTACT: &str = "[[contact]]\nname = 'c'\nsides = ['lower top', 'upper bottom']\n";

/// A quarter of a ring, 1 < r < 2, in quadratic triangles with all their nodes on circles and rays:
/// `b bottom` is the inner arc, `b top` the outer one, `b left` lies on the y axis, `b right` on the
/// x axis.
fn ring() -> Blocks {
    Blocks::new()
        .block("b", [0.0, 1.0], [1.0, 2.0], [6, 2])
        .quadratic()
        .moved(|[s, r, z]| {
            let angle = (1.0 - s) * std::f64::consts::FRAC_PI_2;
            [r * angle.cos(), r * angle.sin(), z]
        })
}

/// Σ F·w for the loads of a model.
fn work(model: &Model, w: impl Fn([f64; 3]) -> [f64; 2]) -> f64 {
    let forces = model.forces.iter();
    let terms = forces.map(|&(node, force)| {
        let [x, y] = w(model.mesh.points[node as usize]);
        force[0] * x + force[1] * y
    });
    terms.sum()
}

#[test]
fn cubic_loads_are_integrated_exactly_with_quadratic_shape_functions() {
    let model = Blocks::new()
        .block("b", [0.0, 2.0], [0.0, 1.0], [3, 2])
        .quadratic()
        .model(
            "bodies.b = {material = 'steel', body_force = ['x^2*y', 0]}
            [[traction]]
            on = 'b top'
            value = [0, 'x^3']",
        )
        .unwrap();
    // ∫ x²y·(x², xy, y²) over the block, and ∫ x³·x² along its top.
    close(work(&model, |[x, _, _]| [x * x, 0.0]), 3.2, 1e-13);
    close(work(&model, |[x, y, _]| [x * y, 0.0]), 4.0 / 3.0, 1e-13);
    close(work(&model, |[_, y, _]| [y * y, 0.0]), 2.0 / 3.0, 1e-13);
    close(work(&model, |[x, _, _]| [0.0, x * x]), 64.0 / 6.0, 1e-13);
}

#[test]
fn a_uniform_load_goes_to_the_ends_and_the_middle_of_an_edge_as_1_4_1() {
    let model = Blocks::new()
        .block("b", [0.0, 3.0], [0.0, 1.0], [1, 1])
        .quadratic()
        .model("[[pressure]]\non = 'b top'\nvalue = 2.0")
        .unwrap();
    let mut forces: Vec<f64> = model.forces.iter().map(|(_, force)| force[1]).collect();
    forces.sort_by(f64::total_cmp);
    for (force, exact) in forces.iter().zip([-4.0, -1.0, -1.0]) {
        close(*force, exact, 1e-14);
    }
}

#[test]
fn a_pressure_along_a_curved_edge_pushes_as_along_its_chord() {
    let model = ring()
        .model("[[pressure]]\non = 'b bottom'\nvalue = 3.0")
        .unwrap();
    // From inside, and the ends of the arc lie where they are, on the circle or beside it.
    close(work(&model, |_| [1.0, 0.0]), 3.0, 1e-14);
    close(work(&model, |_| [0.0, 1.0]), 3.0, 1e-14);
    close(work(&model, |[x, y, _]| [-y, x]), 0.0, 1e-14);
    // ∫ p n·x ds is twice the area below the arc: fourth order in the length of facets.
    let twice = work(&model, |[x, y, _]| [x, y]) / 3.0;
    close(twice, std::f64::consts::FRAC_PI_2, 1e-4);
}

#[test]
fn the_mesh_of_a_ring_has_its_area_to_fourth_order() {
    let mesh = ring().mesh;
    let area: f64 = (0..mesh.cells.len()).map(|c| mesh.measure(c).abs()).sum();
    close(area, 0.75 * std::f64::consts::PI, 2e-4);
}

#[test]
fn nodes_in_the_middle_of_edges_bear_four_sixths_of_them() {
    let rows = conditions(&stack(0.25).quadratic(), CONTACT).unwrap();
    assert_eq!(rows.len(), 9);
    let shares = [1.0, 4.0, 2.0, 4.0, 2.0, 4.0, 2.0, 4.0, 1.0];
    for (k, (row, share)) in rows.iter().zip(shares).enumerate() {
        close(row.area, 0.5 * share / 6.0, 1e-15);
        close(row.position[0], 2.0 - 0.25 * k as f64, 1e-15);
        close(row.gap, 0.25, 1e-15);
        let ends: Vec<_> = row.row().map(|(_, n)| n).collect();
        assert_eq!(ends, [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]]);
    }
}

#[test]
fn the_normal_at_a_node_is_that_of_the_curved_edges_there() {
    let text = "[[contact]]\nname = 'c'\nsides = ['b bottom']\nobstacle = {center = [0, 0], radius = 0.9}\n[[bilateral]]\non = 'b top'";
    let model = ring().model(text).unwrap();
    let contact = &model.contacts[0].points;
    assert_eq!(contact.len(), 13);
    let share: f64 = contact.iter().map(|row| row.area).sum();
    close(share, std::f64::consts::FRAC_PI_2, 1e-5);
    assert_eq!(model.supports.len(), 13);
    for support in &model.supports {
        let [x, y, _] = model.mesh.points[support.node as usize];
        let along = (x * support.direction[0] + y * support.direction[1]) / 2.0;
        // At both ends only one edge determines the normal: accurate to third order in its length.
        let is_end = x.min(y) < 1e-9;
        close(along, 1.0, if is_end { 1e-4 } else { 1e-14 });
    }
}

#[test]
fn curved_sides_meet_node_by_node() {
    let outer = |[s, r, z]: [f64; 3]| {
        let angle = (1.0 - s) * std::f64::consts::FRAC_PI_2;
        [r * angle.cos(), r * angle.sin(), z]
    };
    let blocks = Blocks::new()
        .block("lower", [0.0, 1.0], [1.0, 2.0], [6, 2])
        .block("upper", [0.0, 1.0], [2.01, 3.0], [6, 2])
        .quadratic()
        .moved(outer);
    for blocks in [blocks.clone(), blocks.disguised()] {
        let rows = conditions(&blocks, CONTACT).unwrap();
        assert_eq!(rows.len(), 13);
        for row in &rows {
            close(row.gap, 0.01, 1e-6);
            let [x, y, _] = row.position;
            let is_end = x.min(y) < 1e-9;
            let along = (x * row.frame.normal[0] + y * row.frame.normal[1]) / 2.0;
            close(along, 1.0, if is_end { 1e-4 } else { 1e-14 });
        }
        let angles: Vec<f64> = rows
            .iter()
            .map(|r| r.position[1].atan2(r.position[0]))
            .collect();
        assert!(angles.is_sorted(), "{angles:?}");
    }
}

#[test]
fn a_corner_opposite_the_middle_of_an_edge_is_no_match() {
    let quadratic = Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [2, 2])
        .quadratic();
    let linear = Blocks::new().block("upper", [0.0, 2.0], [1.0, 2.0], [4, 2]);
    let by_nodes = format!("{CONTACT}pairing = 'nodes'\n");
    let error = conditions(&joined(quadratic, linear), &by_nodes).unwrap_err();
    says(&error, "the sides don't match at 2 nodes");
}

/// Two meshes as one, without common nodes.
fn joined(mut first: Blocks, second: Blocks) -> Blocks {
    let (mesh, other) = (&mut first.mesh, second.mesh);
    let counts = [mesh.points.len(), mesh.facets.len(), mesh.cells.len()].map(|n| n as u32);
    let moved = |nodes: &[u32]| -> Vec<u32> { nodes.iter().map(|n| n + counts[0]).collect() };
    mesh.points.extend(&other.points);
    let tags = other.node_tags.iter().map(|tag| tag + 100_000);
    mesh.node_tags.extend(tags);
    (other.cells.iter()).for_each(|(kind, nodes)| mesh.cells.push(kind, &moved(nodes)));
    (other.facets.iter()).for_each(|(kind, nodes)| mesh.facets.push(kind, &moved(nodes)));
    let tags = other.cell_tags.iter().map(|tag| tag + 100_000);
    mesh.cell_tags.extend(tags);
    for (name, mut group) in other.groups {
        (group.members.iter_mut()).for_each(|member| *member += counts[group.dim]);
        mesh.groups.insert(name, group);
    }
    first
}

/// A mesh of one cell with these nodes.
fn single(kind: ElementKind, points: Vec<[f64; 3]>) -> Blocks {
    let mut cells = Elements::default();
    let nodes: Vec<u32> = (0..points.len() as u32).collect();
    cells.push(kind, &nodes);
    let group = contact_dd_partition::mesh::Group {
        dim: 2,
        members: vec![0],
    };
    Blocks {
        mesh: Mesh {
            dim: 2,
            node_tags: (100..100 + points.len() as i64).collect(),
            points,
            cells,
            cell_tags: vec![77],
            groups: [("b".to_owned(), group)].into(),
            ..Mesh::default()
        },
    }
}

#[test]
fn a_cell_that_is_folded_somewhere_is_named_with_the_place() {
    let moved = |kind: ElementKind, node: usize, to: [f64; 2]| {
        let mut points = kind.node_coordinates().to_vec();
        points[node] = [to[0], to[1], 0.0];
        single(kind, points).model("").map(|_| ())
    };
    // A corner beyond 180°, edges that bulge across the cell, a node of an edge beside its end, a
    // centre outside.
    for (kind, node, to, expected) in [
        (Quad4, 2, [-0.5, -0.5], "near node 102"),
        (Triangle6, 3, [0.5, 0.45], "is folded"),
        (Triangle6, 5, [0.0, 0.9], "near node 102"),
        (Quad8, 4, [-0.6, -1.0], "near node 100"),
        (Quad9, 8, [0.0, 0.9], "is folded"),
    ] {
        let error = moved(kind, node, to).unwrap_err();
        says(&error, &format!("element 77 ({})", kind.name()));
        assert!(error.contains(expected), "{kind:?}: {error}");
        let there = kind.node_coordinates()[node];
        assert_eq!(moved(kind, node, [there[0], there[1]]), Ok(()));
    }
}

#[test]
fn a_cell_without_area_or_with_a_node_twice_is_named() {
    let mut points = Quad4.node_coordinates().to_vec();
    points[1] = points[0];
    let error = single(Quad4, points).model("").unwrap_err();
    says(&error, "element 77");
    let flat = Triangle6.node_coordinates().iter();
    let flat = flat.map(|&[x, _, _]| [x, 2.0 * x, 0.0]).collect();
    let error = single(Triangle6, flat).model("").unwrap_err();
    says(&error, "element 77 has no area");
}

#[test]
fn cells_inside_out_are_turned() {
    for kind in [Triangle6, Quad4, Quad8, Quad9] {
        let points = kind.node_coordinates().iter();
        let mirrored: Vec<_> = points.map(|&[x, y, z]| [-x, y + 0.1 * x * x, z]).collect();
        let model = single(kind, mirrored).model("").unwrap();
        assert!(model.mesh.measure(0) > 0.0);
        assert!(
            (model.mesh.cells.nodes_of(0).iter())
                .zip(kind.reversed())
                .all(|(n, r)| *n as usize == *r)
        );
    }
}

#[test]
fn linear_cells_that_share_an_edge_with_quadratic_ones_are_refused() {
    let mut blocks = Blocks::new()
        .block("b", [0.0, 1.0], [0.0, 1.0], [1, 1])
        .quadratic();
    let mut cells = Elements::default();
    cells.push(Triangle6, blocks.mesh.cells.nodes_of(0));
    let corners = blocks.mesh.cells.nodes_of(1)[..3].to_vec();
    cells.push(ElementKind::Triangle3, &corners);
    blocks.mesh.cells = cells;
    let error = blocks.model("").unwrap_err();
    says(
        &error,
        "elements 5000 (triangle of 6 nodes) and 5001 (triangle of 3 nodes)",
    );
}

#[test]
fn quadratic_cells_lock_far_later_than_linear_ones() {
    let text = "bodies.b.material = 'rubber'\nmaterials.rubber = {young = 1, poisson = 0.499}";
    let linear = Blocks::new().block("b", [0.0, 1.0], [0.0, 1.0], [2, 2]);
    let warnings = linear.model(text).unwrap().warnings;
    assert!(
        warnings[0].contains("material 'rubber': triangles of 3 nodes lock"),
        "{warnings:?}"
    );
    let quadratic = linear.clone().quadratic();
    assert!(quadratic.model(text).unwrap().warnings.is_empty());
    let softer = text.replace("0.499", "0.49999");
    let warnings = quadratic.model(&softer).unwrap().warnings;
    assert!(
        warnings[0].contains(
            "material 'rubber': triangles of 6 nodes lock, too, at a Poisson's ratio of 0.49999"
        ),
        "{warnings:?}"
    );
    let warnings = linear.model(&softer).unwrap().warnings;
    assert!(
        warnings[0].ends_with("quadratic ones lock less"),
        "{warnings:?}"
    );
}

#[test]
fn a_sheet_locks_at_no_poissons_ratio() {
    let text = "mesh = 'a.msh'\nplane = 'stress'\nbodies.b.material = 'rubber'\n\
        materials.rubber = {young = 1, poisson = 0.49999}";
    let blocks = Blocks::new().block("b", [0.0, 1.0], [0.0, 1.0], [2, 2]);
    let scene = Scene::parse(text).unwrap();
    for blocks in [blocks.clone(), blocks.quadratic()] {
        let model = Model::new(&scene, blocks.mesh).unwrap();
        assert_eq!(model.warnings, Vec::<String>::new());
    }
}
