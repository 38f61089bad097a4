//! A reference element: what a kind of cell or facet is, all in one place.

use std::sync::OnceLock;

use super::ElementKind;
use super::jacobian::Lattice;
use super::quadrature::TabulatedPoint;

/// What a reference element fills.
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
    /// Its dimension.
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

    /// The corners whose linear shape functions aren't 0 at a point.
    fn corners_near(self, xi: [f64; 3]) -> Vec<usize> {
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

    /// Its measure.
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

    /// The point that a point of the unit square or cube stands for; a triangle is the square with one of
    /// its edges collapsed, (s, t) → (s, t(1 − s)), a tetrahedron the cube with two faces collapsed,
    /// (s, t, r) → (s, t(1 − s), r(1 − s)(1 − t)).
    pub(super) fn of_unit_cube(self, [s, t, r]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Triangle => [s, t * (1.0 - s), 0.0],
            Self::Tetrahedron => [s, t * (1.0 - s), r * (1.0 - s) * (1.0 - t)],
            Self::Cube => [2.0 * s - 1.0, 2.0 * t - 1.0, 2.0 * r - 1.0],
            _ => [2.0 * s - 1.0, 2.0 * t - 1.0, 0.0],
        }
    }
}

/// What somebody who adds a kind writes down; the rest follows from it.
#[derive(Debug)]
pub struct Definition {
    /// Its name in words.
    pub name: &'static str,
    /// What it fills.
    pub domain: Domain,
    /// Reference coordinates of its nodes, in the order of VTK: corners first, counter-clockwise,
    /// the first one at the domain's first; nodes on edges; nodes in the middles of faces; of the cell.
    pub node_coordinates: &'static [[f64; 3]],
    /// N_i(ξ), one for each node.
    pub shape: fn([f64; 3]) -> Vec<f64>,
    /// ∂N_i/∂ξ_j, one for each node; 0 beyond its dimension.
    pub gradients: fn([f64; 3]) -> Vec<[f64; 3]>,
    /// Kind and local nodes of every facet. In the plane the cell lies to their left, and facet i begins
    /// at corner i; in space they run counter-clockwise seen from outside.
    pub facets: &'static [(ElementKind, &'static [usize])],
    /// The order of its nodes that turns it inside out.
    pub reversed: &'static [usize],
    /// VTK's number of the cell type.
    pub vtk: u8,
    /// The rules by which it is integrated; facets have none.
    pub rules: Option<CellRules>,
}

/// The rules by which a cell is integrated: degrees up to which they are exact, on the square and
/// the cube in each direction.
#[derive(Clone, Copy, Debug)]
pub struct CellRules {
    /// Of ∫ Bᵀ C B: exact for ∫ ∇N_i, and with it the patch test, on cells of any shape with curved
    /// edges, and for the stiffness of cells with an affine map.
    pub stiffness: usize,
    /// Of the points where stresses are more accurate than elsewhere, or make patches that are
    /// (Barlow, Int. J. Numer. Meth. Eng. 10, 1976; Zienkiewicz and Zhu 1992).
    pub stress: usize,
    /// Of ∫ N_i b for a constant load, in a cell of any shape.
    pub constant_load: usize,
    /// Of the same for a cubic load, in a cell with straight edges and nodes in their middle.
    pub cubic_load: usize,
}

/// The degree that the stiffness around an axis needs: in linear triangles, too, the strain of the hoop varies.
const AROUND_AXIS: usize = 2;

/// A reference element.
#[derive(Debug)]
pub struct ReferenceElement {
    pub(super) definition: Definition,
    tables: OnceLock<Tables>,
}

/// What follows from a definition, made when first asked for.
#[derive(Debug)]
struct Tables {
    along: Vec<usize>,
    corners_around: Vec<Vec<usize>>,
    edges_at: Vec<Vec<(usize, Option<usize>)>>,
    stiffness: Vec<TabulatedPoint>,
    around_axis: Vec<TabulatedPoint>,
    stress: Vec<TabulatedPoint>,
    lattice: Lattice,
}

impl ReferenceElement {
    /// The element that is defined so.
    pub const fn new(definition: Definition) -> Self {
        Self {
            definition,
            tables: OnceLock::new(),
        }
    }

    /// Its name in words.
    pub fn name(&self) -> &'static str {
        self.definition.name
    }

    /// What it fills.
    pub fn domain(&self) -> Domain {
        self.definition.domain
    }

    /// Its dimension.
    pub fn dim(&self) -> usize {
        self.definition.domain.dim()
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.definition.node_coordinates.len()
    }

    /// Number of corners, which are the first of its nodes.
    pub fn corners(&self) -> usize {
        self.definition.domain.corners()
    }

    /// VTK's number of the cell type.
    pub fn vtk(&self) -> u8 {
        self.definition.vtk
    }

    /// Whether its nodes lie at its corners alone.
    pub fn is_linear(&self) -> bool {
        self.nodes() == self.corners()
    }

    /// Reference coordinates of the nodes.
    pub fn node_coordinates(&self) -> &'static [[f64; 3]] {
        self.definition.node_coordinates
    }

    /// Values of the shape functions N_i(ξ), one for each node; their sum is 1.
    pub fn shape(&self, xi: [f64; 3]) -> Vec<f64> {
        (self.definition.shape)(xi)
    }

    /// Gradients ∂N_i/∂ξ_j of the shape functions, one for each node; components beyond the
    /// element's dimension are zero.
    pub fn gradients(&self, xi: [f64; 3]) -> Vec<[f64; 3]> {
        (self.definition.gradients)(xi)
    }

    /// Facets of a cell: kind and local nodes, in the plane with the cell to their left, in space
    /// counter-clockwise seen from outside.
    pub fn facets(&self) -> &'static [(ElementKind, &'static [usize])] {
        self.definition.facets
    }

    /// The rules by which a cell is integrated.
    pub fn rules(&self) -> Option<CellRules> {
        self.definition.rules
    }

    /// The order of local nodes that turns the element inside out.
    pub fn reversed(&self) -> &'static [usize] {
        self.definition.reversed
    }

    /// The local nodes of a line from its start to its end; those of other kinds as they are.
    pub fn along(&self) -> &[usize] {
        &self.tables().along
    }

    /// The corners that a local node lies between: itself, the ends of its edge, the corners of its face or all.
    pub fn corners_around(&self, node: usize) -> &[usize] {
        &self.tables().corners_around[node]
    }

    /// The edges at a corner of a cell, the other end and the node between, if there is one: in the plane the one
    /// after the corner and the one before it, in space all three.
    pub fn edges_at(&self, corner: usize) -> &[(usize, Option<usize>)] {
        &self.tables().edges_at[corner]
    }

    /// The points at which a cell's stiffness is integrated; facets have none.
    pub fn stiffness_points(&self) -> &[TabulatedPoint] {
        &self.tables().stiffness
    }

    /// The same where the cell goes all around an axis.
    pub fn points_around_axis(&self) -> &[TabulatedPoint] {
        &self.tables().around_axis
    }

    /// The points of a cell at which stresses are taken for their recovery; facets have none.
    pub fn stress_points(&self) -> &[TabulatedPoint] {
        &self.tables().stress
    }

    /// Where the Jacobian is sampled.
    pub(super) fn lattice(&self) -> &Lattice {
        &self.tables().lattice
    }

    fn tables(&self) -> &Tables {
        self.tables.get_or_init(|| {
            let at = self.node_coordinates();
            let mut along: Vec<usize> = (0..self.nodes()).collect();
            if self.domain() == Domain::Line {
                along.sort_by(|&a, &b| at[a][0].total_cmp(&at[b][0]));
            }
            let rule = |degree: fn(CellRules) -> usize| {
                (self.rules()).map_or_else(Vec::new, |rules| self.tabulate(degree(rules)))
            };
            Tables {
                along,
                corners_around: at
                    .iter()
                    .map(|&xi| self.domain().corners_near(xi))
                    .collect(),
                edges_at: (0..self.corners())
                    .map(|corner| self.find_edges(corner))
                    .collect(),
                stiffness: rule(|rules| rules.stiffness),
                around_axis: rule(|rules| rules.stiffness.max(AROUND_AXIS)),
                stress: rule(|rules| rules.stress),
                lattice: Lattice::new(self),
            }
        })
    }

    fn find_edges(&self, corner: usize) -> Vec<(usize, Option<usize>)> {
        let lines = self
            .facets()
            .iter()
            .flat_map(|&(facet, local)| -> Vec<Vec<usize>> {
                let edges = facet.facets().iter();
                match facet.dim() {
                    2 => edges
                        .map(|(_, edge)| edge.iter().map(|&i| local[i]).collect())
                        .collect(),
                    _ => vec![local.to_vec()],
                }
            });
        let mut found: Vec<(usize, Option<usize>)> = Vec::new();
        for line in lines.filter(|line| line.len() > 1) {
            let middle = line.get(2).copied();
            // In space each edge is one of two faces, in the other direction.
            match (line[0] == corner, line[1] == corner) {
                (true, _) => found.insert(0, (line[1], middle)),
                (_, true) if self.dim() == 2 => found.push((line[0], middle)),
                _ => {}
            }
        }
        found
    }
}
