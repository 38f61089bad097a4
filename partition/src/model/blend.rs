//! Quadratic facets whose corners have no positive ∫ N, so that a pressure pulls there or doesn't push: in space those
//! without a node in the middle, around an axis those that end on it. With functions of which such a corner takes a
//! part from the nodes on its edges all forces push.

use nalgebra::DMatrix;

use crate::element::ElementKind;

/// Share of a corner in the function of a node on an edge (Popp, Wohlmuth, Gee and Wall, SIAM J. Sci. Comput.
/// 34, 2012). On triangles of 6 nodes it may be anything below 1/2, on quadrilaterals of 8 above 1/8, too; with
/// this the dual functions are the least in the mean.
pub(super) const TAKEN: f64 = 0.2;

/// True if ∫ N of corners isn't positive.
fn has_weightless_corners(kind: ElementKind) -> bool {
    kind.dim() > 1 && kind.nodes() == 2 * kind.corners()
}

/// The functions of the corners alone: each node on an edge hands half of its own to either end, a node in the
/// middle hands its own to all.
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
    /// Nodes on edges, each with the corners that take a part.
    pub takers: Vec<(usize, Vec<usize>)>,
}

impl Blending {
    /// The blend of a facet of a kind, one corner of which may lie on the axis that it goes around: there a line of three
    /// nodes has ∫ N dS = 0.
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

    /// True if no corner takes any.
    pub fn is_none(&self) -> bool {
        self.takers.is_empty()
    }

    /// The functions with positive integrals, as rows of coefficients of the shape functions.
    pub fn positive(&self) -> DMatrix<f64> {
        let mut basis = DMatrix::identity(self.nodes, self.nodes);
        for (middle, corners) in &self.takers {
            for &corner in corners {
                basis[(corner, *middle)] += TAKEN;
            }
            basis[(*middle, *middle)] = 1.0 - corners.len() as f64 * TAKEN;
        }
        basis
    }
}
