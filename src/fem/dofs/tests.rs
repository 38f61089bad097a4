use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::geometry::dot;
use contact_dd_partition::element::{ElementKind, Elements};
use contact_dd_partition::model::{Material, Support};
use contact_dd_partition::problem::{InterfaceNode, Subdomain};

use super::super::block::Block;
use super::super::prescribed::Prescribed;
use super::*;

fn material() -> Material {
    Material {
        name: "m".into(),
        stiffness: [[3.0, 1.0, 0.0], [1.0, 3.0, 0.0], [0.0, 0.0, 1.0]].into(),
        out_of_plane: None,
        poisson: None,
    }
}

/// A unit square of two triangles, its lower left corner at `at`.
fn square(index: usize, at: [f64; 2]) -> Subdomain {
    let mut cells = Elements::default();
    cells.push(ElementKind::Triangle3, &[0, 1, 2]);
    cells.push(ElementKind::Triangle3, &[0, 2, 3]);
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    Subdomain {
        index,
        body: index,
        points: corners
            .iter()
            .map(|c| [at[0] + c[0], at[1] + c[1], 0.0])
            .collect(),
        node_tags: (0..4).map(|i| 10 * index as i64 + i).collect(),
        cells,
        cell_material: vec![0, 0],
        supports: Vec::new(),
        forces: Vec::new(),
        interface: Vec::new(),
        steps: Vec::new(),
    }
}

fn support(node: u32, direction: [f64; 3], value: f64) -> Support {
    Support {
        node,
        direction,
        value,
        condition: 0,
    }
}

/// Two squares, one on the other, in contact along an inclined normal; the lower one is held at an
/// inclined support and shares two nodes with the rest of the world.
fn scene() -> OwnedBlock {
    let mut lower = square(0, [0.0, 0.0]);
    let inclined = [0.6, 0.8, 0.0];
    lower.supports = vec![
        support(0, inclined, 0.25),
        support(1, [1.0, 0.0, 0.0], -0.5),
    ];
    let mut upper = square(1, [0.0, 1.0]);
    upper.supports = vec![
        support(3, [0.0, 1.0, 0.0], 0.125),
        support(3, [1.0, 0.0, 0.0], 0.5),
    ];
    upper.interface = vec![InterfaceNode {
        node: 2,
        interface: 7,
    }];
    let block = Block::new(vec![lower, upper], 2, |_| true);
    let normal = [-0.28, 0.96, 0.0];
    let point = |a: u32, b: u32| ContactPoint::new(vec![(a, 1.0), (b, -1.0)], normal, [0.0; 3], 0);
    OwnedBlock {
        block,
        points: vec![point(3, 4), point(2, 5)],
    }
}

fn dofs_of(owned: &OwnedBlock) -> (Dofs, Prescribed) {
    let (loads, materials) = (BlockLoads::new(owned, 0), [material()]);
    let dofs = Dofs::new(owned, &loads, &materials).unwrap();
    let prescribed = Prescribed::new(owned, &loads, &materials).unwrap();
    (dofs, prescribed)
}

fn vector(u: &[f64], node: usize) -> [f64; 3] {
    [u[2 * node], u[2 * node + 1], 0.0]
}

/// Unknowns with nothing special about them.
fn unknowns(dofs: &Dofs) -> Vec<f64> {
    (0..dofs.len()).map(|i| (1.3 * i as f64).sin()).collect()
}

#[test]
fn every_displacement_obeys_the_supports() {
    let (dofs, prescribed) = dofs_of(&scene());
    let u = prescribed.displacement(&dofs, &unknowns(&dofs));
    assert!((dot(vector(&u, 0), [0.6, 0.8, 0.0]) - 0.25).abs() < 1e-15);
    assert!((u[2] + 0.5).abs() < 1e-15);
    assert!((u[14] - 0.5).abs() < 1e-15 && (u[15] - 0.125).abs() < 1e-15);
}

#[test]
fn the_normal_jump_of_a_point_is_its_unknown() {
    let owned = scene();
    let (dofs, prescribed) = dofs_of(&owned);
    let x = unknowns(&dofs);
    let u = prescribed.displacement(&dofs, &x);
    for (j, point) in owned.points.iter().enumerate() {
        assert!((point.normal_jump(2, &u) - x[dofs.interior + j]).abs() < 1e-15);
    }
}

#[test]
fn traces_come_last_and_are_the_displacement_of_shared_nodes() {
    let (dofs, prescribed) = dofs_of(&scene());
    let x = unknowns(&dofs);
    let u = prescribed.displacement(&dofs, &x);
    assert_eq!(
        dofs.interface_dofs,
        [
            InterfaceDof { node: 7, axis: 0 },
            InterfaceDof { node: 7, axis: 1 }
        ]
    );
    assert_eq!(vector(&u, 6)[..2], x[dofs.len() - 2..]);
    // 16 components less 4 that are prescribed; normal jumps replace displacements one by one.
    assert_eq!(dofs.len(), 12);
}

#[test]
fn loads_work_on_unknowns_what_they_work_on_displacements() {
    let (dofs, _) = dofs_of(&scene());
    let f: Vec<f64> = (0..16).map(|i| (0.7 * i as f64).cos()).collect();
    let x = unknowns(&dofs);
    let mut change = vec![0.0; 16];
    dofs.add_change(&x, &mut change);
    let mut load = vec![0.0; dofs.len()];
    dofs.add_load(&f, &mut load);
    let on_nodes: f64 = f.iter().zip(&change).map(|(f, u)| f * u).sum();
    let on_unknowns: f64 = load.iter().zip(&x).map(|(f, x)| f * x).sum();
    assert!((on_nodes - on_unknowns).abs() < 1e-14);
}
