//! An element is added.

use std::collections::BTreeMap;

use contact_dd_mpi::fem::elasticity::{ElementMatrix, MAX_NODES};
use contact_dd_partition::element::quadrilaterals::{QUAD4, QUAD8, QUAD9};
use contact_dd_partition::element::reference::ReferenceElement;
use contact_dd_partition::element::triangles::{TRIANGLE3, TRIANGLE6};
use nalgebra::{DMatrix, DVector};

use super::laws;
use super::quad6::QUAD6;
use crate::support::close::close;

const C: [[f64; 3]; 3] = [[3.0, 1.0, 0.2], [1.0, 2.5, -0.1], [0.2, -0.1, 0.9]];

#[test]
fn it_keeps_the_laws_of_a_reference_element() {
    laws::keeps_all(&QUAD6);
    assert!(QUAD6.nodes() <= MAX_NODES);
}

/// K of an element, dofs node by node.
fn stiffness(element: &ReferenceElement, at: &[[f64; 3]]) -> DMatrix<f64> {
    let mut k = ElementMatrix::default();
    k.set(element, at, &C.into());
    DMatrix::from_fn(2 * at.len(), 2 * at.len(), |i, j| k.row(i)[j])
}

#[test]
fn nothing_but_rigid_motions_costs_no_energy() {
    let eigenvalues = stiffness(&QUAD6, &laws::bent(&QUAD6)).symmetric_eigenvalues();
    let largest = eigenvalues.max();
    let free = eigenvalues.iter().filter(|&&x| x.abs() < 1e-12 * largest);
    assert_eq!(free.count(), 3, "{eigenvalues}");
    assert!(eigenvalues.min() > -1e-14 * largest);
}

/// Fields that its shape functions span, on a rectangle, where their energy is known.
#[test]
fn the_energy_of_a_field_that_it_spans_is_exact() {
    let (a, b) = (1.5, 0.4);
    let at: Vec<_> = (QUAD6.node_coordinates().iter())
        .map(|&[s, t, _]| [a * s, b * t, 0.0])
        .collect();
    let k = stiffness(&QUAD6, &at);
    let energy = |u: fn(f64, f64) -> [f64; 2]| {
        let u = at.iter().flat_map(|&[x, y, _]| u(x, y));
        let u = DVector::from_iterator(12, u);
        u.dot(&(&k * &u))
    };
    // ε_xx = 2x, then γ_xy = 2x; ε_xx = 2xy with γ_xy = x²: ∫ over [−a, a] × [−b, b] by hand.
    let x2 = 4.0 * a.powi(3) * b / 3.0;
    close(energy(|x, _| [x * x, 0.0]), 4.0 * C[0][0] * x2, 1e-12);
    close(energy(|x, _| [0.0, x * x]), 4.0 * C[2][2] * x2, 1e-12);
    let (x2y2, x4) = (4.0 * (a * b).powi(3) / 9.0, 4.0 * a.powi(5) * b / 5.0);
    let exact = 4.0 * C[0][0] * x2y2 + C[2][2] * x4;
    close(energy(|x, y| [x * x * y, 0.0]), exact, 1e-12);
}

/// Cells by the places of their nodes on a lattice, two steps a cell.
type Patch = Vec<(&'static ReferenceElement, Vec<[i32; 2]>)>;

/// The cell of the square in this column and row.
fn whole(element: &'static ReferenceElement, column: i32, row: i32) -> Patch {
    let nodes = element.node_coordinates().iter();
    let place = |&[s, t, _]: &[f64; 3]| [2 * column + 1 + s as i32, 2 * row + 1 + t as i32];
    vec![(element, nodes.map(place).collect())]
}

/// The two triangles of the square in this column and row.
fn halves(element: &'static ReferenceElement, column: i32, row: i32) -> Patch {
    let half = |at: i32, step: f64| {
        let nodes = element.node_coordinates().iter();
        let place = |&[s, t, _]: &[f64; 3]| {
            let along = |x: f64| (step * x) as i32;
            [2 * column + at + along(s), 2 * row + at + along(t)]
        };
        (element, nodes.map(place).collect())
    };
    vec![half(0, 2.0), half(2, -2.0)]
}

/// A linear displacement leaves no force on the inner nodes of a patch whose nodes lie anywhere.
#[track_caller]
fn passes(patch: &Patch, columns: i32, rows: i32) {
    let place = |&[i, j]: &[i32; 2]| {
        let (x, y) = (f64::from(i), f64::from(j));
        [
            x + 0.1 * (2.3 * y).sin(),
            y + 0.15 * (1.7 * x + y).cos(),
            0.0,
        ]
    };
    let mut forces: BTreeMap<[i32; 2], [f64; 2]> = BTreeMap::new();
    for (element, nodes) in patch {
        let at: Vec<_> = nodes.iter().map(place).collect();
        let u = at
            .iter()
            .flat_map(|x| [0.1 * x[0] + 0.2 * x[1] + 3.0, -0.3 * x[0] + 0.4 * x[1]]);
        let force = stiffness(element, &at) * DVector::from_iterator(2 * at.len(), u);
        for (node, of_node) in nodes.iter().zip(force.as_slice().chunks(2)) {
            let sum = forces.entry(*node).or_default();
            *sum = [sum[0] + of_node[0], sum[1] + of_node[1]];
        }
    }
    let inside = |[i, j]: [i32; 2]| 0 < i && i < 2 * columns && 0 < j && j < 2 * rows;
    let (inner, outer): (Vec<_>, Vec<_>) = forces.iter().partition(|(at, _)| inside(**at));
    let largest = |of: &[(&[i32; 2], &[f64; 2])]| {
        let all = of.iter().flat_map(|(_, force)| *force);
        all.fold(0.0_f64, |m, f| m.max(f.abs()))
    };
    assert!(inner.len() >= 3 && largest(&outer) > 0.1);
    assert!(largest(&inner) < 1e-13, "{:e}", largest(&inner));
}

#[test]
fn it_passes_the_patch_test_between_quadratic_cells() {
    let patch = [
        whole(&QUAD8, 0, 0),
        halves(&TRIANGLE6, 1, 0),
        whole(&QUAD6, 0, 1),
        whole(&QUAD6, 1, 1),
        halves(&TRIANGLE6, 0, 2),
        whole(&QUAD9, 1, 2),
    ];
    passes(&patch.concat(), 2, 3);
}

#[test]
fn it_passes_the_patch_test_between_linear_cells() {
    let patch = [
        whole(&QUAD4, 0, 0),
        whole(&QUAD6, 1, 0),
        halves(&TRIANGLE3, 2, 0),
        halves(&TRIANGLE3, 0, 1),
        whole(&QUAD6, 1, 1),
        whole(&QUAD4, 2, 1),
    ];
    passes(&patch.concat(), 3, 2);
}
