//! The reference elements.

mod laws;

use contact_dd_partition::element::ElementKind::{self, *};

#[test]
fn every_kind_keeps_the_laws_of_a_reference_element() {
    for kind in ElementKind::ALL {
        laws::keeps_all(&kind);
    }
}

#[test]
fn vtk_has_a_number_of_its_own_for_every_cell() {
    for kind in ElementKind::of_dim(2) {
        assert_eq!(ElementKind::cell_from_vtk(kind.vtk().into(), 2), Ok(kind));
    }
}

#[test]
fn shape_functions_reproduce_the_polynomials_that_their_kind_has() {
    let linear: &[[i32; 2]] = &[[0, 0], [1, 0], [0, 1]];
    let quadratic: &[[i32; 2]] = &[[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2]];
    let more: &[[i32; 2]] = &[[2, 1], [1, 2]];
    let cases = [
        (Triangle3, linear.to_vec()),
        (Triangle6, quadratic.to_vec()),
        (Quad4, [linear, &[[1, 1]]].concat()),
        (Quad8, [quadratic, more].concat()),
        (Quad9, [quadratic, more, &[[2, 2]]].concat()),
    ];
    for (kind, powers) in cases {
        for [p, q] in powers {
            let monomial = |xi: [f64; 3]| xi[0].powi(p) * xi[1].powi(q);
            let at = [0.3, -0.45, 0.0];
            let values = kind.shape(at).into_iter().zip(kind.node_coordinates());
            let sum: f64 = values.map(|(n, &node)| n * monomial(node)).sum();
            assert!((sum - monomial(at)).abs() < 1e-15, "{kind:?} {p} {q}");
        }
    }
}
