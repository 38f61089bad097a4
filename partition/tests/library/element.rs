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
    for (dim, kind) in [2, 3]
        .into_iter()
        .flat_map(|dim| ElementKind::of_dim(dim).map(move |kind| (dim, kind)))
    {
        assert_eq!(ElementKind::cell_from_vtk(kind.vtk().into(), dim), Ok(kind));
    }
}

#[test]
fn shape_functions_reproduce_the_polynomials_that_their_kind_has() {
    let all = || (0..27).map(|i| [i % 3, i / 3 % 3, i / 9]);
    let plane = || all().filter(|powers| powers[2] == 0);
    let total = |powers: &[i32; 3]| powers.iter().sum::<i32>();
    // The degree without the factors of first degree, which a serendipity element has on top.
    let superlinear = |powers: &[i32; 3]| powers.iter().filter(|&&p| p != 1).sum::<i32>();
    let most = |powers: &[i32; 3]| powers.iter().copied().max().unwrap_or_default();
    let cases: [(ElementKind, usize, Vec<[i32; 3]>); 10] = [
        (Triangle3, 3, plane().filter(|p| total(p) <= 1).collect()),
        (Triangle6, 6, plane().filter(|p| total(p) <= 2).collect()),
        (Quad4, 4, plane().filter(|p| most(p) <= 1).collect()),
        (Quad8, 8, plane().filter(|p| superlinear(p) <= 2).collect()),
        (Quad9, 9, plane().collect()),
        (Tetrahedron4, 4, all().filter(|p| total(p) <= 1).collect()),
        (Tetrahedron10, 10, all().filter(|p| total(p) <= 2).collect()),
        (Hexahedron8, 8, all().filter(|p| most(p) <= 1).collect()),
        (
            Hexahedron20,
            20,
            all().filter(|p| superlinear(p) <= 2).collect(),
        ),
        (Hexahedron27, 27, all().collect()),
    ];
    for (kind, count, powers) in cases {
        assert_eq!(powers.len(), count, "{kind:?}");
        for powers in powers {
            let monomial =
                |xi: [f64; 3]| -> f64 { xi.iter().zip(powers).map(|(x, p)| x.powi(p)).product() };
            let mut at = [0.3, -0.45, 0.2];
            at[kind.dim()..].fill(0.0);
            let values = kind.shape(at).into_iter().zip(kind.node_coordinates());
            let sum: f64 = values.map(|(n, &node)| n * monomial(node)).sum();
            assert!((sum - monomial(at)).abs() < 2e-15, "{kind:?} {powers:?}");
        }
    }
}
