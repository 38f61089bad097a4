use contact_dd_partition::element::geometry::dot;
use contact_dd_partition::element::{ElementKind, Elements};
use contact_dd_partition::hierarchy::tree::Tree;
use contact_dd_partition::model::Support;
use contact_dd_partition::problem::{InitialStress, InterfaceNode, Subdomain};
use contact_dd_partition::quantity::NodalShares;

use super::super::block::Block;
use super::super::prescribed::Prescribed;
use super::*;

/// A unit square of two triangles.
fn square() -> Subdomain {
    let mut cells = Elements::default();
    cells.push(ElementKind::Triangle3, &[0, 1, 2]);
    cells.push(ElementKind::Triangle3, &[0, 2, 3]);
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    Subdomain {
        index: 0,
        body: 0,
        points: corners.map(|[x, y]| [x, y, 0.0]).to_vec(),
        node_tags: (0..4).collect(),
        cells,
        cell_material: vec![0, 0],
        supports: Vec::new(),
        springs: Vec::new(),
        forces: Vec::new(),
        initial_stress: InitialStress::default(),
        interface: Vec::new(),
        shares: NodalShares::default(),
        steps: Vec::new(),
        reference_nodes: 0,
        auxiliary_nodes: 0,
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

/// A square with an inclined support and another one, which shares two nodes with other subdomains; a support
/// constrains one of these partly.
fn scene() -> Block {
    let mut square = square();
    square.supports = vec![
        support(0, [0.6, 0.8, 0.0], 0.25),
        support(1, [1.0, 0.0, 0.0], -0.5),
        support(3, [0.0, 1.0, 0.0], 0.125),
        support(3, [1.0, 0.0, 0.0], 0.5),
    ];
    let on = |node, interface| InterfaceNode { node, interface };
    square.interface = vec![on(2, 4), on(1, 7)];
    Block::new(square, &Tree::default(), 2)
}

fn dofs_of(block: &Block) -> (Dofs, Prescribed) {
    let loads = BlockLoads::new(block, 0);
    (
        Dofs::new(block, &loads).unwrap(),
        Prescribed::new(block, &loads),
    )
}

fn vector(u: &[f64], node: usize) -> [f64; 3] {
    [u[2 * node], u[2 * node + 1], 0.0]
}

/// Arbitrary values of the unknowns.
fn unknowns(dofs: &Dofs) -> Vec<f64> {
    (0..dofs.len()).map(|i| (1.3 * i as f64).sin()).collect()
}

#[test]
fn every_displacement_obeys_the_supports() {
    let (dofs, prescribed) = dofs_of(&scene());
    let u = prescribed.displacement(&dofs, &unknowns(&dofs));
    assert!((dot(vector(&u, 0), [0.6, 0.8, 0.0]) - 0.25).abs() < 1e-15);
    assert!((u[2] + 0.5).abs() < 1e-15);
    assert!((u[6] - 0.5).abs() < 1e-15 && (u[7] - 0.125).abs() < 1e-15);
}

#[test]
fn traces_come_last_and_are_the_displacement_of_nodes_on_the_interface() {
    let (dofs, prescribed) = dofs_of(&scene());
    let x = unknowns(&dofs);
    let u = prescribed.displacement(&dofs, &x);
    let names = dofs.interface_dofs.iter().map(|dof| (dof.node, dof.axis));
    assert!(names.eq([(4, 0), (4, 1), (7, 1)]));
    assert_eq!(vector(&u, 2)[..2], x[1..3]);
    // The free axis of node 1 is y, in either direction.
    assert_eq!(u[3].abs(), x[3].abs());
    // 8 components minus 4 prescribed ones.
    assert_eq!(dofs.len(), 4);
}

#[test]
fn loads_work_on_unknowns_what_they_work_on_displacements() {
    let (dofs, _) = dofs_of(&scene());
    let f: Vec<f64> = (0..8).map(|i| (0.7 * i as f64).cos()).collect();
    let x = unknowns(&dofs);
    let mut change = vec![0.0; 8];
    dofs.add_change(&x, &mut change);
    let mut load = vec![0.0; dofs.len()];
    dofs.add_load(&f, &mut load);
    let on_nodes: f64 = f.iter().zip(&change).map(|(f, u)| f * u).sum();
    let on_unknowns: f64 = load.iter().zip(&x).map(|(f, x)| f * x).sum();
    assert!((on_nodes - on_unknowns).abs() < 1e-14);
}

#[test]
fn of_a_node_that_slides_the_displacement_along_its_normal_alone_is_on_the_interface() {
    let mut block = scene();
    let normal = [0.6, -0.8, 0.0];
    // Node 1 has the frame of its supports.
    block.slides = [(1, normal), (2, normal)].into();
    let (dofs, prescribed) = dofs_of(&block);
    let names = dofs.interface_dofs.iter().map(|dof| (dof.node, dof.axis));
    assert!(names.eq([(4, 0), (7, 1)]));
    assert_eq!((dofs.interior, dofs.len()), (2, 4));
    let mut x = unknowns(&dofs);
    let before = prescribed.displacement(&dofs, &x);
    assert!((dot(vector(&before, 2), normal) - x[2]).abs() < 1e-15);
    // The interior doesn't change that displacement.
    x[..2].fill(0.75);
    let after = prescribed.displacement(&dofs, &x);
    assert!((dot(vector(&after, 2), normal) - x[2]).abs() < 1e-15);
    assert!(vector(&before, 2) != vector(&after, 2));
}

#[test]
fn what_slides_is_no_run_of_unknowns_though_its_numbers_follow_one_another() {
    let mut block = scene();
    block.interface.truncate(1);
    block.slides = [(2, [0.0, 1.0, 0.0])].into();
    let (dofs, _) = dofs_of(&block);
    let numbers = [0, 1].map(|component| dofs.terms(2, component)[0].0 as usize);
    assert_eq!(numbers, [dofs.interior - 1, dofs.interior]);
    assert_eq!(dofs.direct(2), None);
}
