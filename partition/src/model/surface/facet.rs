//! A facet of the boundary with its outward normal.

use super::super::blend::Blending;
use crate::element::ElementKind;
use crate::element::geometry::{advance, cross, difference, dot, length};
use crate::mesh::Mesh;
use crate::mesh::topology::CellFacet;
use crate::scene::material::PlaneState;

/// Degree of exactness for the measure of curved facets.
const CURVED_DEGREE: usize = 9;

/// A facet of the boundary.
#[derive(Clone, Debug)]
pub(in crate::model) struct SurfaceFacet {
    pub kind: ElementKind,
    /// Nodes in the order that has the cell on its left.
    pub nodes: Vec<u32>,
    /// Coordinates of the nodes (m).
    pub at: Vec<[f64; 3]>,
    /// Unit outward normal at its centre, which is the normal of its chord.
    pub normal: [f64; 3],
    /// Length or area.
    pub measure: f64,
    /// Plane state; `None` in space.
    pub plane: Option<PlaneState>,
}

impl SurfaceFacet {
    /// A facet of `nodes` at `at`.
    pub fn new(
        kind: ElementKind,
        nodes: Vec<u32>,
        at: Vec<[f64; 3]>,
        plane: Option<PlaneState>,
    ) -> Self {
        let area = integrate(kind, |xi| kind.area_vector(&at, xi));
        let chord = length(area);
        let measure = match kind.is_linear() {
            true => chord,
            false => integrate(kind, |xi| [length(kind.area_vector(&at, xi)), 0.0, 0.0])[0],
        };
        Self {
            kind,
            nodes,
            normal: area.map(|c| c / chord),
            measure,
            at,
            plane,
        }
    }

    /// The facet of a cell of the mesh.
    pub fn of_cell(mesh: &Mesh, of: CellFacet, plane: Option<PlaneState>) -> Self {
        let cell = mesh.cells.nodes_of(of.cell as usize);
        let kind = mesh.cells.kind(of.cell as usize);
        let (kind, local) = kind.facets()[of.facet as usize];
        let nodes: Vec<u32> = local.iter().map(|&i| cell[i]).collect();
        let at = nodes.iter().map(|&n| mesh.points[n as usize]).collect();
        Self::new(kind, nodes, at, plane)
    }

    /// dS at ξ: length, area, or area of the ring around the axis (m, m²).
    pub fn density(&self, xi: [f64; 3]) -> f64 {
        let x = self.kind.position(&self.at, xi);
        PlaneState::thickness(self.plane, x) * length(self.kind.area_vector(&self.at, xi))
    }

    /// ∫ dS (m, m²).
    pub fn area(&self) -> f64 {
        match self.plane {
            Some(PlaneState::Axisymmetric) => {
                integrate(self.kind, |xi| [self.density(xi), 0.0, 0.0])[0]
            }
            _ => self.measure,
        }
    }

    /// The corner of a line of three nodes that lies on the axis of an axisymmetric scene.
    pub fn corner_on_axis(&self) -> Option<usize> {
        let is_ring = self.plane == Some(PlaneState::Axisymmetric);
        let corner = || (self.at.iter().take(self.kind.corners())).position(|x| x[0] == 0.0);
        (is_ring && !self.kind.is_linear()).then(corner).flatten()
    }

    /// The modified functions with positive integrals.
    pub fn blending(&self) -> Blending {
        Blending::new(self.kind, self.corner_on_axis())
    }

    /// The average of its nodes (m).
    pub fn middle(&self) -> [f64; 3] {
        let part = 1.0 / self.at.len() as f64;
        (self.at.iter()).fold([0.0; 3], |sum, &at| advance(sum, part, at))
    }

    /// Approximate diameter (m).
    pub fn size(&self) -> f64 {
        match self.kind.dim() {
            0 => 0.0,
            1 => self.measure,
            _ => self.measure.sqrt(),
        }
    }

    /// Unit outward normal at one of its nodes, also for curved facets.
    pub fn normal_at(&self, node: u32) -> [f64; 3] {
        let place = self.nodes.iter().position(|&own| own == node);
        let Some(place) = place.filter(|_| !self.kind.is_linear()) else {
            return self.normal;
        };
        let area = (self.kind).area_vector(&self.at, self.kind.node_coordinates()[place]);
        let size = length(area);
        area.map(|c| c / size)
    }

    /// Nodes from its start to its end.
    pub(super) fn along(&self) -> impl Iterator<Item = u32> {
        self.kind.along().iter().map(|&i| self.nodes[i])
    }

    /// Integral over the facet of a node's shape function, on quadratic faces that of [`Blending::positive`]; 0 for
    /// nodes of other facets.
    pub fn tributary_area(&self, node: u32) -> f64 {
        let Some(place) = self.nodes.iter().position(|&own| own == node) else {
            return 0.0;
        };
        let blending = self.blending();
        let blended = (!blending.is_none()).then(|| blending.positive());
        let area = integrate(self.kind, |xi| {
            let shape = self.kind.shape(xi);
            let weight = match &blended {
                None => shape[place],
                Some(basis) => basis.row(place).iter().zip(shape).map(|(b, n)| b * n).sum(),
            };
            [weight * self.density(xi), 0.0, 0.0]
        });
        area[0]
    }

    /// Largest distance of nodes on its edges from the middle of their chords (m).
    pub(super) fn edge_sagitta(&self) -> f64 {
        let edges: Vec<&[usize]> = match self.kind.dim() {
            1 => vec![&[0, 1, 2][..self.nodes.len().min(3)]],
            _ => self.kind.facets().iter().map(|(_, edge)| *edge).collect(),
        };
        let of_edge = |edge: &[usize]| match *edge {
            [start, end, middle] => {
                let chord = advance(self.at[start], 1.0, self.at[end]).map(|c| 0.5 * c);
                length(difference(self.at[middle], chord))
            }
            _ => 0.0,
        };
        edges.into_iter().map(of_edge).fold(0.0, f64::max)
    }

    /// The vector from its node `node` to its centre, projected perpendicular to `normal`; `None` for a node of another
    /// facet.
    fn aside(&self, node: u32, normal: [f64; 3]) -> Option<[f64; 3]> {
        let from = self.nodes.iter().position(|&n| n == node)?;
        let offset = advance(self.middle(), -1.0, self.at[from]);
        Some(advance(offset, -dot(offset, normal), normal))
    }

    /// The edges of a face at its corner `node`, projected perpendicular to `normal`.
    fn wedge(&self, node: u32, normal: [f64; 3]) -> Option<[[f64; 3]; 2]> {
        let corner = self.nodes.iter().position(|&n| n == node)?;
        if self.kind.dim() < 2 || corner >= self.kind.corners() {
            return None;
        }
        let edges = self.kind.edges_at(corner);
        let edge = |&(end, _): &(usize, Option<usize>)| {
            let offset = advance(self.at[end], -1.0, self.at[corner]);
            advance(offset, -dot(offset, normal), normal)
        };
        Some([edge(edges.first()?), edge(edges.get(1)?)])
    }

    /// True if this facet at node `a` and `other` at node `b`, which lies on the `normal` of `a`, are opposite each
    /// other and not side by side.
    pub fn is_opposite(&self, a: u32, other: &Self, b: u32, normal: [f64; 3]) -> bool {
        match (self.aside(a, normal), other.aside(b, normal)) {
            (Some(own), Some(others)) => {
                let same_way = match (self.wedge(a, normal), other.wedge(b, normal)) {
                    (Some(wedge), Some(opposite)) => {
                        is_between(opposite, others, own) || is_between(wedge, own, others)
                    }
                    _ => dot(own, others) > 1e-6 * length(own) * length(others),
                };
                same_way && dot(self.normal, other.normal) < 0.0
            }
            _ => false,
        }
    }
}

/// True if a direction lies in the wedge between two edges that contains `inside`, all of them in one plane.
fn is_between([first, second]: [[f64; 3]; 2], inside: [f64; 3], direction: [f64; 3]) -> bool {
    let beside = |edge| dot(cross(edge, inside), cross(edge, direction)) >= 0.0;
    beside(first) && beside(second)
}

fn integrate(kind: ElementKind, integrand: impl Fn([f64; 3]) -> [f64; 3]) -> [f64; 3] {
    // The measure of a curved facet isn't the integral of a polynomial.
    let rule = kind.quadrature(if kind.is_linear() { 2 } else { CURVED_DEGREE });
    let points = rule.into_iter();
    points.fold([0.0; 3], |sum, (xi, w)| advance(sum, w, integrand(xi)))
}
