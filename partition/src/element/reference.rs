//! A reference element: its definition, and data derived from it.

use std::sync::OnceLock;

use super::definition::{CellRules, Definition, Domain};
use super::kind::ElementKind;
use super::tables::{Lattice, TabulatedPoint};

/// The degree for the stiffness around an axis: the hoop strain varies even in linear triangles.
const AROUND_AXIS: usize = 2;

/// A reference element.
#[derive(Debug)]
pub struct ReferenceElement {
    pub(super) definition: Definition,
    tables: OnceLock<Tables>,
}

/// Data derived from a definition, computed on first use.
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
    /// The element with a definition.
    pub const fn new(definition: Definition) -> Self {
        Self {
            definition,
            tables: OnceLock::new(),
        }
    }

    /// Name in plain words.
    pub fn name(&self) -> &'static str {
        self.definition.name
    }

    /// The domain that it fills.
    pub fn domain(&self) -> Domain {
        self.definition.domain
    }

    /// Dimension.
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

    /// True if all its nodes are corners.
    pub fn is_linear(&self) -> bool {
        self.definition.is_linear()
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

    /// Facets of a cell: kind and local nodes, in the plane with the cell on their left, in space counter-clockwise
    /// seen from outside.
    pub fn facets(&self) -> &'static [(ElementKind, &'static [usize])] {
        self.definition.facets
    }

    /// The quadrature rules of a cell.
    pub fn rules(&self) -> Option<CellRules> {
        self.definition.rules
    }

    /// The permutation of local nodes that reverses the orientation.
    pub fn reversed(&self) -> &'static [usize] {
        self.definition.reversed
    }

    /// The local nodes of a line from its start to its end; of other kinds in their order.
    pub fn along(&self) -> &[usize] {
        &self.tables().along
    }

    /// The corners around a local node: itself, the ends of its edge, the corners of its face or all.
    pub fn corners_around(&self, node: usize) -> &[usize] {
        &self.tables().corners_around[node]
    }

    /// The edges at a corner of a cell, as the other end and the middle node, if any: in the plane the edge after the
    /// corner and the one before it, in space all three.
    pub fn edges_at(&self, corner: usize) -> &[(usize, Option<usize>)] {
        &self.tables().edges_at[corner]
    }

    /// The quadrature points of a cell's stiffness; facets have none.
    pub fn stiffness_points(&self) -> &[TabulatedPoint] {
        &self.tables().stiffness
    }

    /// The quadrature points of the stiffness around an axis.
    pub fn points_around_axis(&self) -> &[TabulatedPoint] {
        &self.tables().around_axis
    }

    /// The points of a cell at which stresses are evaluated for recovery; facets have none.
    pub fn stress_points(&self) -> &[TabulatedPoint] {
        &self.tables().stress
    }

    /// The quadrature points of the stiffness with reduced integration, for 8-node quadrilaterals and 20-node
    /// hexahedra: the superconvergent points of stresses. `None` for other kinds.
    pub fn reduced_points(&self) -> Option<&[TabulatedPoint]> {
        matches!((self.dim(), self.nodes()), (2, 8) | (3, 20)).then(|| self.stress_points())
    }

    /// Points at which the Jacobian is sampled.
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
                lattice: Lattice::new(&self.definition),
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
            // In space each edge belongs to two faces, with opposite directions.
            match (line[0] == corner, line[1] == corner) {
                (true, _) => found.insert(0, (line[1], middle)),
                (_, true) if self.dim() == 2 => found.push((line[0], middle)),
                _ => {}
            }
        }
        found
    }
}
