//! Modified shape functions for quadratic facets whose corners have ∫ N ≤ 0, so that a pressure there pulls or has no
//! force: in space facets without a node in the middle, around an axis facets that end on it. Each such corner takes a
//! part of the shape functions of the nodes on its edges, so that all nodal forces of a pressure push.

use nalgebra::DMatrix;

use crate::element::ElementKind;

/// Share of a corner in the function of a node on an edge (Popp, Wohlmuth, Gee and Wall, SIAM J. Sci. Comput. 34,
/// 2012). Triangles of 6 nodes admit any share below 1/2, quadrilaterals of 8 nodes only shares above 1/8; this one
/// minimizes the average size of the dual functions.
pub(super) const CORNER_SHARE: f64 = 0.2;

/// True if ∫ N ≤ 0 at corners.
fn has_weightless_corners(kind: ElementKind) -> bool {
    kind.dim() > 1 && kind.nodes() == 2 * kind.corners()
}

/// Functions of the corners only: each node on an edge gives half of its function to either end, a node in the middle
/// an equal part to all.
pub(super) fn of_corners(kind: ElementKind) -> DMatrix<f64> {
    let (nodes, corners) = (kind.nodes(), kind.corners());
    let mut basis = DMatrix::identity(corners, nodes);
    for (_, edge) in kind.facets() {
        let &[start, end, middle] = *edge else {
            continue;
        };
        basis[(start, middle)] += 0.5;
        basis[(end, middle)] += 0.5;
    }
    for middle in 2 * corners..nodes {
        (0..corners).for_each(|corner| basis[(corner, middle)] = 1.0 / corners as f64);
    }
    basis
}

/// Corners of a facet that take a part of the functions of nodes on its edges.
#[derive(Clone, Debug)]
pub(super) struct Blending {
    nodes: usize,
    /// Nodes on edges, each with the corners that take a part of its function.
    pub takers: Vec<(usize, Vec<usize>)>,
}

impl Blending {
    /// The modification for facets of a kind, one corner of which may lie on the axis of symmetry: there a line of
    /// three nodes has ∫ N dS = 0.
    pub fn new(kind: ElementKind, on_axis: Option<usize>) -> Self {
        let takers = match (has_weightless_corners(kind), on_axis) {
            (true, _) => {
                let edges = kind.facets().iter();
                edges
                    .map(|(_, edge)| (edge[2], edge[..2].to_vec()))
                    .collect()
            }
            (false, Some(corner)) => vec![(2, vec![corner])],
            (false, None) => Vec::new(),
        };
        Self {
            nodes: kind.nodes(),
            takers,
        }
    }

    /// True if the shape functions stay unmodified.
    pub fn is_none(&self) -> bool {
        self.takers.is_empty()
    }

    /// The modified functions, with positive integrals, as rows of coefficients of the shape functions.
    pub fn positive(&self) -> DMatrix<f64> {
        let mut basis = DMatrix::identity(self.nodes, self.nodes);
        for (middle, corners) in &self.takers {
            for &corner in corners {
                basis[(corner, *middle)] += CORNER_SHARE;
            }
            basis[(*middle, *middle)] = 1.0 - corners.len() as f64 * CORNER_SHARE;
        }
        basis
    }
}
