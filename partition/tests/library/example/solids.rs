//! Meshes of scenes in space.

use std::f64::consts::PI;

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::example;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::mesh::topology::Topology;

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
