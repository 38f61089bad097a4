//! Bodies, materials, groups, partitions.

use crate::blocks::{Blocks, STEEL};
use crate::close::close;
use crate::says::says;
use contact_dd_partition::mesh::Group;
use contact_dd_partition::model::{Model, PlaneState};
use contact_dd_partition::scene::Scene;

fn two() -> Blocks {
    Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [2, 1])
        .block("upper", [0.0, 2.0], [1.0, 2.0], [2, 1])
}

#[test]
fn every_cell_knows_its_body_and_material() {
    let model = two()
        .model("materials.wood = {young = 1, poisson = 0}\nbodies.upper.material = 'wood'\nbodies.lower.material = 'steel'")
        .unwrap();
    assert_eq!(model.bodies, ["lower", "upper"]);
    assert_eq!(model.cell_body, [0, 0, 0, 0, 1, 1, 1, 1]);
    assert_eq!(model.cell_material, [0, 0, 0, 0, 1, 1, 1, 1]);
    assert_eq!(model.materials[1].name, "wood");
    let no_contact = |warning: &String| warning.contains("touch without a contact");
    assert!(model.warnings.iter().all(no_contact));
}

#[test]
fn isotropic_stiffness_is_hookes_in_both_plane_states() {
    let compliance = |young: f64, poisson: f64, stress: [f64; 3]| {
        let [x, y, z] = stress;
        (x - poisson * (y + z)) / young
    };
    for plane in ["strain", "stress"] {
        let text = STEEL.replace("strain", plane) + "bodies.lower.material = 'steel'";
        let scene = Scene::parse(&text).unwrap();
        let model = Model::new(&scene, two().mesh).unwrap();
        let steel = &model.materials[0];
        let strain = [3e-3, -1e-3, 2e-3];
        let stress = steel
            .stiffness
            .rows::<3>()
            .map(|row| row.iter().zip(strain).map(|(c, e)| c * e).sum::<f64>());
        let out = steel.out_of_plane.unwrap();
        let stress_z: f64 = out.iter().zip(strain).map(|(c, e)| c * e).sum();
        close(
            compliance(200.0, 0.25, [stress[0], stress[1], stress_z]),
            3e-3,
            1e-16,
        );
        close(
            compliance(200.0, 0.25, [stress[1], stress[0], stress_z]),
            -1e-3,
            1e-16,
        );
        close(stress[2], 200.0 / 2.5 * 2e-3, 1e-14);
        let strain_z = compliance(200.0, 0.25, [stress_z, stress[0], stress[1]]);
        match model.plane {
            Some(PlaneState::Strain) => close(strain_z, 0.0, 1e-16),
            Some(PlaneState::Stress) => assert_eq!(stress_z, 0.0),
            _ => panic!("a scene of plane strain or stress"),
        }
    }
}

#[test]
fn a_given_stiffness_is_used_as_it_stands() {
    let wood = "materials.wood = {stiffness = [[10, 2, 1], [2, 5, 0], [1, 0, 3]], out_of_plane = [1, 2, 3]}\nbodies.lower.material = 'wood'";
    let model = two().model(wood).unwrap();
    let material = &model.materials[1];
    assert_eq!(
        material.stiffness.rows::<3>(),
        [[10.0, 2.0, 1.0], [2.0, 5.0, 0.0], [1.0, 0.0, 3.0]]
    );
    assert_eq!(material.out_of_plane, Some([1.0, 2.0, 3.0]));
    let model = two()
        .model(&wood.replace(", out_of_plane = [1, 2, 3]", ""))
        .unwrap();
    assert_eq!(model.materials[1].out_of_plane, None);
}

#[test]
fn nearly_incompressible_triangles_are_warned_of() {
    let text = "materials.rubber = {young = 1, poisson = 0.49}\nbodies.lower.material = 'rubber'\nbodies.upper.material = 'steel'";
    let model = two().model(text).unwrap();
    let locking = |warning: &&String| warning.contains("lock at");
    let warnings: Vec<&String> = model.warnings.iter().filter(locking).collect();
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].contains("'rubber'"));
}

#[test]
fn cells_in_no_body_are_left_out_with_their_nodes_and_a_warning() {
    let model = two()
        .model("bodies.upper.material = 'steel'\n[[displacement]]\non = 'upper top'\nx = 0")
        .unwrap();
    assert_eq!(model.mesh.points.len(), 6);
    assert_eq!(model.mesh.cells.len(), 4);
    assert_eq!(model.mesh.node_tags, two().mesh.node_tags[6..]);
    assert_eq!(model.mesh.cell_tags, two().mesh.cell_tags[4..]);
    assert_eq!(model.mesh.facets.len(), 6);
    assert!(model.mesh.points.iter().all(|p| p[1] >= 1.0));
    let heights: Vec<f64> = (model.supports.iter())
        .map(|s| model.mesh.points[s.node as usize][1])
        .collect();
    assert_eq!(heights, [2.0; 3]);
    let warning = &model.warnings[0];
    assert!(warning.contains("4 of 8 cells") && warning.contains("the group 'lower' isn't among"));
}

#[test]
fn a_condition_on_what_is_left_out_is_an_error() {
    let error = two()
        .model("bodies.upper.material = 'steel'\n[[displacement]]\non = 'lower top'\nx = 0")
        .unwrap_err();
    says(&error, "group 'lower top': the facet of nodes");
}

#[test]
fn a_cell_in_two_bodies_is_named() {
    let mut blocks = two();
    blocks.mesh.groups.insert(
        "both".into(),
        Group {
            dim: 2,
            members: vec![0, 4],
        },
    );
    let error = blocks.model("").unwrap_err();
    assert_eq!(
        error,
        "bodies: cell 5000 of the mesh is in both 'both' and 'lower'"
    );
}

#[test]
fn a_cell_without_area_is_named() {
    let mut blocks = two();
    blocks.mesh.points[1] = [1.0, 0.5, 0.0];
    blocks.mesh.points[0] = [0.0, 0.0, 0.0];
    blocks.mesh.points[4] = [2.0, 1.0, 0.0];
    let error = blocks.model("").unwrap_err();
    says(
        &error,
        "element 5000 has no area: its nodes 1003, 1006, 1015 lie on one line",
    );
}

#[test]
fn unknown_groups_are_named_with_the_nearest_and_the_list() {
    let error = two().model("bodies.uper.material = 'steel'").unwrap_err();
    says(
        &error,
        "bodies: the mesh has no physical group 'uper'; did you mean 'upper'? (groups of cells: lower, upper)",
    );
    let error = two()
        .model("[[pressure]]\non = 'uper top'\nvalue = 1")
        .unwrap_err();
    says(&error, "pressure[1] on 'uper top' … 'upper top'");
    let error = two()
        .model("[[pressure]]\non = 'upper'\nvalue = 1")
        .unwrap_err();
    says(
        &error,
        "'upper' is a group of cells; expected one of facets",
    );
}

#[test]
fn a_partition_holds_every_cell_once() {
    let mut blocks = two();
    for (name, members) in [
        ("s1", vec![0, 1, 4, 5, 6]),
        ("s2", vec![2, 3, 7]),
        ("s3", vec![3, 7]),
    ] {
        blocks
            .mesh
            .groups
            .insert(name.into(), Group { dim: 2, members });
    }
    let bodies = "\nbodies.lower.material = 'steel'\nbodies.upper.material = 'steel'\n";
    let model = |list: &str| blocks.model(&format!("subdomains = {list}{bodies}"));
    let owner = model("['s1', 's2']").unwrap().prescribed_subdomains;
    assert_eq!(owner, Some(vec![0, 0, 1, 1, 0, 0, 0, 1]));
    let error = model("['s1', 's2', 's3']").unwrap_err();
    says(&error, "cell 5003 of the mesh is in both 's2' and 's3'");
    let error = model("['s1', 's3']").unwrap_err();
    says(&error, "cell 5002 of the mesh … is in none");
}

#[test]
fn a_plane_mesh_needs_a_plane_state() {
    let text = STEEL.replace("plane = 'strain'\n", "") + "bodies.lower.material = 'steel'";
    let error = Model::new(&Scene::parse(&text).unwrap(), two().mesh).unwrap_err();
    assert!(error.to_string().contains("the key 'plane' is missing"));
}
