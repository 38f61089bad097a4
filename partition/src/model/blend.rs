//! Quadratic facets of space without a node in the middle: ∫ N of their corners isn't positive, so that a pressure
//! pulls there. With functions of which each corner takes a part from the nodes on its edges all forces push.

use nalgebra::DMatrix;

use crate::element::ElementKind;

/// What a corner takes of the function of a node on an edge (Popp, Wohlmuth, Gee and Wall, SIAM J. Sci. Comput.
/// 34, 2012). On triangles of 6 nodes it may be anything below 1/2, on quadrilaterals of 8 above 1/8, too; with
/// this the dual functions are the least in the mean.
pub(super) const TAKEN: f64 = 0.2;

/// Whether ∫ N of corners isn't positive.
pub(super) fn has_weightless_corners(kind: ElementKind) -> bool {
    kind.dim() > 1 && kind.nodes() == 2 * kind.corners()
}

/// The functions of the first `count` nodes when each of a node on an edge hands the part `taken` to either
/// end of the edge. All of it handed over leaves the functions of the linear facet; there a node
/// in the middle hands its own to all corners.
pub(super) fn blend(kind: ElementKind, count: usize, taken: f64) -> DMatrix<f64> {
    let (nodes, corners) = (kind.nodes(), kind.corners());
    let mut basis = DMatrix::identity(count, nodes);
    for (_, edge) in kind.facets() {
        let &[start, end, middle] = *edge else {
            continue;
        };
        basis[(start, middle)] += taken;
        basis[(end, middle)] += taken;
        if middle < count {
            basis[(middle, middle)] = 1.0 - 2.0 * taken;
        }
    }
    if count == corners {
        for middle in 2 * corners..nodes {
            (0..corners).for_each(|corner| basis[(corner, middle)] = 1.0 / corners as f64);
        }
    }
    basis
}

/// The functions of a facet with positive integrals, as rows of coefficients of its shape functions.
pub(super) fn positive(kind: ElementKind) -> DMatrix<f64> {
    match has_weightless_corners(kind) {
        true => blend(kind, kind.nodes(), TAKEN),
        false => DMatrix::identity(kind.nodes(), kind.nodes()),
    }
}
