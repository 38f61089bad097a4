//! Γ_τ and body forces.

use crate::blocks::Blocks;
use crate::close::close;
use crate::says::says;
use contact_dd_partition::element::ElementKind::Line2;
use contact_dd_partition::mesh::Group;
use contact_dd_partition::model::Model;

/// A block with sides that are neither straight nor regular.
fn block() -> Blocks {
    Blocks::new()
        .block("b", [0.0, 2.0], [0.0, 1.0], [5, 4])
        .moved(|[x, y, z]| [x + 0.1 * x * y, y + 0.05 * x * x * y, z])
}

/// Σ F·(1, x, y), by component: work of a load in rigid and linear displacements.
fn moments(model: &Model) -> [[f64; 3]; 2] {
    let mut sum = [[0.0; 3]; 2];
    for &(node, force) in &model.forces {
        let [x, y, _] = model.mesh.points[node as usize];
        for (row, f) in sum.iter_mut().zip(force) {
            for (s, w) in row.iter_mut().zip([1.0, x, y]) {
                *s += f * w;
            }
        }
    }
    sum
}

#[test]
fn a_cubic_traction_is_integrated_exactly() {
    let model = Blocks::new()
        .block("b", [0.0, 2.0], [0.0, 1.0], [3, 1])
        .model("[[traction]]\non = 'b top'\nvalue = ['x^3', '1-x^2']")
        .unwrap();
    let [fx, fy] = moments(&model);
    for (sum, exact) in fx.iter().zip([4.0, 6.4, 4.0]) {
        close(*sum, exact, 1e-14);
    }
    for (sum, exact) in fy.iter().zip([2.0 - 8.0 / 3.0, 2.0 - 4.0, 2.0 - 8.0 / 3.0]) {
        close(*sum, exact, 1e-14);
    }
    assert_eq!(model.forces.len(), 4);
}

#[test]
fn a_cubic_body_force_is_integrated_exactly() {
    let model = Blocks::new()
        .block("b", [0.0, 2.0], [0.0, 1.0], [3, 2])
        .model("bodies.b = {material = 'steel', body_force = ['x^2*y', 'x^3']}")
        .unwrap();
    let [fx, fy] = moments(&model);
    for (sum, exact) in fx.iter().zip([4.0 / 3.0, 2.0, 8.0 / 9.0]) {
        close(*sum, exact, 1e-14);
    }
    for (sum, exact) in fy.iter().zip([4.0, 6.4, 2.0]) {
        close(*sum, exact, 1e-14);
    }
}

#[test]
fn a_pressure_all_around_holds_itself_in_equilibrium() {
    let model = block()
        .model("[[pressure]]\non = ['b top', 'b left', 'b right', 'b bottom']\nvalue = 7")
        .unwrap();
    let [fx, fy] = moments(&model);
    close(fx[0], 0.0, 1e-13);
    close(fy[0], 0.0, 1e-13);
    close(fx[2], fy[1], 1e-13);
    // Σ F·x = −p·area, on either axis.
    let polygon_area: f64 = (model.mesh.cells.iter())
        .map(|(kind, nodes)| {
            let at: Vec<_> = nodes
                .iter()
                .map(|&n| model.mesh.points[n as usize])
                .collect();
            0.5 * kind.jacobian(&at, [0.0; 3])
        })
        .sum();
    close(fx[1], -7.0 * polygon_area, 1e-12);
    close(fy[2], -7.0 * polygon_area, 1e-12);
}

#[test]
fn a_positive_pressure_pushes_into_the_body() {
    let model = block()
        .model("[[pressure]]\non = 'b bottom'\nvalue = 3")
        .unwrap();
    close(moments(&model)[1][0], 6.0, 1e-14);
    close(moments(&model)[0][0], 0.0, 1e-14);
}

#[test]
fn weight_is_force_times_area_and_loads_on_one_place_add_up() {
    let model = Blocks::new()
        .block("b", [0.0, 2.0], [0.0, 1.0], [3, 2])
        .model("bodies.b = {material = 'steel', body_force = [0, -5]}\n[[traction]]\non = 'b top'\nvalue = [1, 2]\n[[traction]]\non = 'b top'\nvalue = [1, 0]")
        .unwrap();
    close(moments(&model)[1][0], -10.0 + 4.0, 1e-14);
    close(moments(&model)[0][0], 4.0, 1e-14);
    assert!(model.forces.windows(2).all(|w| w[0].0 < w[1].0));
}

#[test]
fn a_zero_load_loads_no_node() {
    let model = block()
        .model("[[traction]]\non = 'b top'\nvalue = [0, 0]")
        .unwrap();
    assert!(model.forces.is_empty());
}

#[test]
fn facets_that_are_not_on_the_boundary_are_named() {
    let mut blocks = block();
    blocks.mesh.facets.push(Line2, &[0, 7]);
    blocks.mesh.facets.push(Line2, &[0, 9]);
    let count = blocks.mesh.facets.len() as u32;
    for (name, facet) in [("inside", count - 2), ("nowhere", count - 1)] {
        let members = vec![facet];
        blocks
            .mesh
            .groups
            .insert(name.into(), Group { dim: 1, members });
    }
    let error = |name: &str| {
        let text = format!("[[traction]]\non = '{name}'\nvalue = [0, 1]");
        blocks.model(&text).unwrap_err()
    };
    let inside = error("inside");
    says(
        &inside,
        "traction[1] on 'inside': the facet of nodes 1003, 1024 lies between two cells",
    );
    let nowhere = error("nowhere");
    says(&nowhere, "the facet of nodes 1003, 1030 belongs to no cell");
}

#[test]
fn a_vector_has_the_dimension_of_the_mesh() {
    let scene = contact_dd_partition::scene::Scene::parse(
        "mesh='a'\nmaterials.m = {young=1, poisson=0}\nbodies.b = {material='m', body_force=[0,0,1]}",
    )
    .unwrap();
    let error = Model::new(&scene, block().mesh).unwrap_err();
    assert!(error.to_string().contains("plane"), "{error}");
}

/// −∫ Bᵀ σ does to linear displacements what σ does to their strains.
#[test]
fn initial_stress_does_the_work_of_its_strains() {
    let body = "bodies.b = {material = 'steel', initial_stress = ['x', '2*y', 9, 'x+y']}\n";
    let model = Blocks::new()
        .block("b", [0.0, 2.0], [0.0, 1.0], [5, 4])
        .model(body)
        .unwrap();
    let [fx, fy] = moments(&model);
    // ∫ σ_xx, σ_xy and σ_yy over the block, against displacements x and y in either direction.
    for (sum, exact) in fx
        .into_iter()
        .chain(fy)
        .zip([0.0, -2.0, -3.0, 0.0, -3.0, -2.0])
    {
        close(sum, exact, 1e-13);
    }
    let means = model.initial_stress.cells.iter();
    close(means.clone().map(|s| s[0]).sum::<f64>() / 40.0, 1.0, 1e-13);
    assert!(means.map(|s| s[2]).all(|zz| (zz - 9.0).abs() < 1e-13));
    assert_eq!(model.materials[1].name, "steel of b");
}

#[test]
fn heat_in_plane_strain_needs_the_stiffness_out_of_the_plane() {
    let text = "materials.wood.stiffness = [[9, 1, 0], [1, 5, 0], [0, 0, 2]]
bodies.b = {material = 'wood', thermal = {expansion = 1e-5, temperature = 20}}\n";
    let printed = Blocks::new()
        .block("b", [0.0, 2.0], [0.0, 1.0], [5, 4])
        .model(text)
        .unwrap_err();
    assert!(
        printed.starts_with("bodies.b.thermal: in plane strain"),
        "{printed}"
    );
}
