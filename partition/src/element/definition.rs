//! The definition of a reference element: its domain, nodes, shape functions, facets and quadrature rules.

use super::kind::ElementKind;

/// The domain of a reference element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// The origin.
    Point,
    /// −1 ≤ ξ ≤ 1.
    Line,
    /// The triangle with the corners (0, 0), (1, 0), (0, 1).
    Triangle,
    /// −1 ≤ ξ, η ≤ 1.
    Square,
    /// The tetrahedron with the corners 0 and (1, 0, 0), (0, 1, 0), (0, 0, 1).
    Tetrahedron,
    /// −1 ≤ ξ, η, ζ ≤ 1.
    Cube,
}

impl Domain {
    /// Dimension.
    pub fn dim(self) -> usize {
        match self {
            Self::Point => 0,
            Self::Line => 1,
            Self::Triangle | Self::Square => 2,
            Self::Tetrahedron | Self::Cube => 3,
        }
    }

    /// Number of its corners.
    pub fn corners(self) -> usize {
        match self {
            Self::Point => 1,
            Self::Line => 2,
            Self::Triangle => 3,
            Self::Square | Self::Tetrahedron => 4,
            Self::Cube => 8,
        }
    }

    /// The corners with nonzero linear shape functions at a point.
    pub(super) fn corners_near(self, xi: [f64; 3]) -> Vec<usize> {
        let linear = match self {
            Self::Point => ElementKind::Point1,
            Self::Line => ElementKind::Line2,
            Self::Triangle => ElementKind::Triangle3,
            Self::Square => ElementKind::Quad4,
            Self::Tetrahedron => ElementKind::Tetrahedron4,
            Self::Cube => ElementKind::Hexahedron8,
        };
        let shares = linear.shape(xi).into_iter().enumerate();
        shares
            .filter(|(_, share)| *share != 0.0)
            .map(|(corner, _)| corner)
            .collect()
    }

    /// Measure.
    pub fn measure(self) -> f64 {
        match self {
            Self::Point => 1.0,
            Self::Line => 2.0,
            Self::Triangle => 0.5,
            Self::Square => 4.0,
            Self::Tetrahedron => 1.0 / 6.0,
            Self::Cube => 8.0,
        }
    }

    /// The map from the unit square or cube onto the domain; a triangle is the square with one of its edges collapsed,
    /// (s, t) → (s, t(1 − s)), a tetrahedron the cube with two faces collapsed, (s, t, r) → (s, t(1 − s), r(1 − s)(1 −
    /// t)).
    pub(super) fn of_unit_cube(self, [s, t, r]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Triangle => [s, t * (1.0 - s), 0.0],
            Self::Tetrahedron => [s, t * (1.0 - s), r * (1.0 - s) * (1.0 - t)],
            Self::Cube => [2.0 * s - 1.0, 2.0 * t - 1.0, 2.0 * r - 1.0],
            _ => [2.0 * s - 1.0, 2.0 * t - 1.0, 0.0],
        }
    }
}

/// The definition of a kind, which determines all other data.
#[derive(Debug)]
pub struct Definition {
    /// Name in plain words.
    pub name: &'static str,
    /// The domain that it fills.
    pub domain: Domain,
    /// Reference coordinates of its nodes, in the order of VTK: corners first, counter-clockwise, the first one at the
    /// domain's first; then nodes on edges, in the middles of faces, and in the middle of the cell.
    pub node_coordinates: &'static [[f64; 3]],
    /// N_i(ξ), one for each node.
    pub shape: fn([f64; 3]) -> Vec<f64>,
    /// ∂N_i/∂ξ_j, one for each node; 0 beyond its dimension.
    pub gradients: fn([f64; 3]) -> Vec<[f64; 3]>,
    /// Kind and local nodes of every facet. In the plane the cell lies on their left, and facet i begins at corner i;
    /// in space they run counter-clockwise seen from outside.
    pub facets: &'static [(ElementKind, &'static [usize])],
    /// The permutation of its nodes that reverses its orientation.
    pub reversed: &'static [usize],
    /// VTK's number of the cell type.
    pub vtk: u8,
    /// The quadrature rules of a cell; facets have none.
    pub rules: Option<CellRules>,
}

/// The quadrature rules of a cell: their degrees of exactness, on the square and the cube in each direction.
#[derive(Clone, Copy, Debug)]
pub struct CellRules {
    /// Degree for ∫ Bᵀ C B: exact for ∫ ∇N_i, and so for the patch test, on cells of any shape with curved edges, and
    /// for the stiffness of cells with an affine map.
    pub stiffness: usize,
    /// Degree of the rule at whose points stresses are superconvergent, or suitable for patch recovery (Barlow, Int. J.
    /// Numer. Meth. Eng. 10, 1976; Zienkiewicz and Zhu 1992).
    pub stress: usize,
    /// Degree for ∫ N_i b with a constant load, in a cell of any shape.
    pub constant_load: usize,
    /// Degree for the same integral with a cubic load, in a cell with straight edges and their nodes in the middle.
    pub cubic_load: usize,
}

impl Definition {
    /// True if all its nodes are corners.
    pub(super) fn is_linear(&self) -> bool {
        self.node_coordinates.len() == self.domain.corners()
    }
}
