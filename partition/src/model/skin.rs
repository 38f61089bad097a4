//! The boundary of all bodies, and its pairs of facets that face each other.

mod facet;
mod view;

use std::collections::BTreeMap;

pub(super) use self::facet::{ROUND_OFF, STANDING_OFF, SkinFacet};
use self::view::View;
use super::bodies::Bodies;
use super::facet_tree::FacetTree;
use super::surface::SurfaceFacet;
use crate::element::geometry::dot;
use crate::mesh::Mesh;
use crate::mesh::topology::{CellFacet, Topology};
use crate::scene::material::PlaneState;

/// Cosine of the angle up to which neighbours form no corner: 45°.
const SMOOTH: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Two facets that face each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facing {
    /// The facets, ascending.
    pub facets: [usize; 2],
    /// The distance from one to the other along the normal, at the centre of their overlap (m).
    pub gap: f64,
    /// Length or area of their overlap.
    pub measure: f64,
}

/// The boundary facets, which belong to a single cell.
pub(super) struct Skin<'a> {
    pub facets: Vec<SkinFacet>,
    pub mesh: &'a Mesh,
}

impl<'a> Skin<'a> {
    /// The facets of the boundary for which `wanted` is true; around an axis without those on the axis.
    pub fn new(
        bodies: &'a Bodies,
        topology: &Topology,
        plane: Option<PlaneState>,
        wanted: impl Fn(&CellFacet) -> bool,
    ) -> Self {
        let mesh = &bodies.mesh;
        let pieces = topology.pieces();
        let facet = |place: CellFacet| {
            let cell = place.cell as usize;
            let (kind, _) = mesh.cells.kind(cell).facets()[place.facet as usize];
            let nodes = place.nodes(&mesh.cells);
            let at = nodes.iter().map(|&node| mesh.points[node as usize]);
            SkinFacet {
                place,
                shape: SurfaceFacet::new(kind, nodes.clone(), at.collect(), plane),
                body: bodies.cell_body[cell],
                piece: pieces[cell],
            }
        };
        let facets = topology.boundary().filter(wanted).map(facet);
        Self {
            facets: facets.filter(|facet| facet.shape.area() > 0.0).collect(),
            mesh,
        }
    }

    /// All pairs of facets that face each other with nothing between them, ascending, up to the distance `reach` of the
    /// larger one's size (m), in either sense. O(n log n) for n facets, as long as the reach doesn't exceed their size.
    pub fn facing(&self, reach: impl Fn(f64) -> f64) -> Vec<Facing> {
        let shapes = self.facets.iter().map(|facet| &facet.shape);
        let tree = FacetTree::new(shapes, |_| 0.0);
        let mut pairs: BTreeMap<[usize; 2], Facing> = BTreeMap::new();
        for (index, facet) in self.facets.iter().enumerate() {
            let others = tree.near(&facet.shape, reach(facet.shape.size()));
            let opposite: Vec<(usize, &SkinFacet)> = others
                .map(|other| (other, &self.facets[other]))
                .filter(|(_, other)| dot(facet.shape.normal, other.shape.normal) < -SMOOTH)
                .collect();
            if opposite.is_empty() {
                continue;
            }
            for (seen, gap, measure) in View::new(facet, self.mesh).of(&opposite) {
                let size = facet.shape.size().max(self.facets[seen].shape.size());
                if gap.abs() > reach(size) {
                    continue;
                }
                let facets = [index.min(seen), index.max(seen)];
                let found = (pairs.entry(facets)).or_insert(Facing {
                    facets,
                    gap,
                    measure,
                });
                // Two facets that aren't parallel see each other differently.
                found.measure = found.measure.max(measure);
                if gap.abs() < found.gap.abs() {
                    found.gap = gap;
                }
            }
        }
        pairs.into_values().collect()
    }

    /// The facets of the same body that continue each facet without a corner.
    pub fn neighbours(&self) -> Vec<Vec<usize>> {
        let mut at_edge: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
        for (index, facet) in self.facets.iter().enumerate() {
            let nodes = &facet.shape.nodes;
            match self.mesh.dim {
                2 => nodes[..2]
                    .iter()
                    .for_each(|&node| at_edge.entry([node; 2]).or_default().push(index)),
                _ => facet.shape.kind.facets().iter().for_each(|(_, edge)| {
                    let [p, q] = [nodes[edge[0]], nodes[edge[1]]];
                    let edge = [p.min(q), p.max(q)];
                    at_edge.entry(edge).or_default().push(index);
                }),
            }
        }
        let mut neighbours = vec![Vec::new(); self.facets.len()];
        for around in at_edge.values() {
            for &one in around {
                let goes_on = |&&other: &&usize| {
                    let (a, b) = (&self.facets[one], &self.facets[other]);
                    let is_smooth = dot(a.shape.normal, b.shape.normal) > SMOOTH;
                    one != other && a.body == b.body && is_smooth
                };
                neighbours[one].extend(around.iter().filter(goes_on));
            }
        }
        neighbours
    }
}
