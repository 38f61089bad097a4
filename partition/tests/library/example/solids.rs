//! Meshes of scenes in space.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::example;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::mesh::topology::Topology;
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

fn ball(kind: ElementKind, refine: u32) -> Mesh {
    example::find("sphere")
        .unwrap()
        .mesh_of(kind, refine)
        .unwrap()
}

fn volume(mesh: &Mesh) -> f64 {
    (0..mesh.cells.len()).map(|cell| mesh.measure(cell)).sum()
}

#[test]
fn an_eighth_of_a_ball_is_one_piece_of_any_cells() {
    let exact = PI * 8.0_f64.powi(3) / 6.0;
    for kind in ElementKind::of_dim(3) {
        let mesh = ball(kind, 0);
        let off = if kind.is_linear() { 5e-2 } else { 2e-3 };
        assert!(
            (volume(&mesh) / exact - 1.0).abs() < off,
            "{kind:?}: {}",
            volume(&mesh) / exact
        );
        let topology = Topology::new(&mesh);
        assert!(
            topology.pieces().iter().all(|&piece| piece == 0),
            "{kind:?}"
        );
        topology.check_sides(&mesh).unwrap();
        // Every facet of one cell is on a plane of symmetry or on the ball.
        for facet in topology.boundary() {
            let on = facet
                .nodes(&mesh.cells)
                .into_iter()
                .map(|n| mesh.points[n as usize]);
            let is_on = |at: [f64; 3]| {
                let [x, y, z] = [at[0], at[1], 8.0 - at[2]];
                let far = x.hypot(y).hypot(z);
                [x, y, z, far - 8.0].map(|away| away.abs() < 1e-9)
            };
            let all = on.fold([true; 4], |all, at| {
                let here = is_on(at);
                [0, 1, 2, 3].map(|k| all[k] && here[k])
            });
            assert!(all.contains(&true), "{kind:?}");
        }
    }
}

#[test]
fn refinement_follows_the_ball() {
    let exact = PI * 8.0_f64.powi(3) / 6.0;
    let errors =
        [0, 1].map(|refine| (volume(&ball(ElementKind::Hexahedron8, refine)) - exact).abs());
    let order = (errors[0] / errors[1]).log2();
    assert!((order - 2.0).abs() < 0.15, "order {order}");
}

#[test]
fn blocks_in_space_are_as_large_as_they_are_meant_of_any_cells() {
    for (name, bodies, exact) in [("cube-crack", 1, 500.0), ("stack3d", 3, 16.0 + 9.0 + 4.0)] {
        for kind in ElementKind::of_dim(3) {
            let example = example::find(name).unwrap();
            let mesh = example.mesh_of(kind, 0).unwrap();
            assert!(
                (volume(&mesh) - exact).abs() < 1e-10 * exact,
                "{name} {kind:?}"
            );
            let topology = Topology::new(&mesh);
            topology.check_sides(&mesh).unwrap();
            let pieces = topology.pieces().into_iter().max();
            assert_eq!(pieces, Some(bodies - 1), "{name} {kind:?}");
            let scene = Scene::parse(example.scene).unwrap();
            let model = Model::new(&scene, mesh).unwrap();
            assert_eq!(model.warnings, Vec::<String>::new(), "{name} {kind:?}");
        }
    }
}

#[test]
fn the_sides_of_a_crack_share_its_front_alone() {
    let mesh = example::find("cube-crack").unwrap().mesh(0).unwrap();
    let nodes = |side: &str| -> BTreeSet<u32> {
        let members = mesh.groups[side].members.iter();
        members
            .flat_map(|&facet| mesh.facets.nodes_of(facet as usize).to_vec())
            .collect()
    };
    for (crack, tip) in [("left", 3.0), ("right", 7.0)] {
        let [lower, upper] = ["lower", "upper"].map(|side| nodes(&format!("{crack} crack {side}")));
        assert_eq!(lower.len(), upper.len());
        let front = lower
            .intersection(&upper)
            .map(|&node| mesh.points[node as usize]);
        let on_front = |x: [f64; 3]| x[0] == tip || x[1] == 3.0;
        assert!(front.clone().all(on_front));
        let all = lower.iter().map(|&node| mesh.points[node as usize]);
        assert_eq!(front.count(), all.filter(|&x| on_front(x)).count());
    }
}
