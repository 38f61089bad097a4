//! Probes: nodes of the side without conditions that are looked at for penetration.

use super::super::ray_search::{Hit, Target};
use super::super::sides::{SideNode, Sides};
use super::super::surface::SurfaceFacet;
use super::field::{ahead, beside};
use super::foot::foot_on;
use super::root::root;
use crate::contact_point::Probe;
use crate::element::geometry::{difference, dot};

/// A probe at every node of side b whose normal meets side a.
pub(super) fn probes(sides: &Sides) -> Vec<Probe<u32>> {
    let target = Target::new(sides.a);
    let is_shared = |node: u32| sides.shared.contains(&node);
    let probe = |b: &SideNode| {
        let (opposite, gap) = match target.hit(b.position, b.normal, sides.behind, is_shared) {
            Hit::Nodes(nodes) => {
                let node = *nodes.first()?;
                let way = difference(sides.mesh.points[node as usize], b.position);
                (vec![(node, -1.0)], dot(way, b.normal))
            }
            Hit::Facet(facet) => {
                let facet = &sides.a.facets[facet];
                let (shape, gap) = met(facet, b)?;
                let nodes = facet.nodes.iter().zip(shape);
                (nodes.map(|(&node, n)| (node, -n)).collect(), gap)
            }
            Hit::Nothing { .. } => return None,
        };
        Some(Probe {
            contact: 0,
            tag: sides.mesh.node_tags[b.node as usize],
            entries: std::iter::once((b.node, 1.0)).chain(opposite).collect(),
            normal: b.normal,
            gap,
        })
    };
    sides.nodes_b.iter().filter_map(probe).collect()
}

/// The shape functions of a facet where the normal of a node meets it, and how far ahead (m).
fn met(facet: &SurfaceFacet, node: &SideNode) -> Option<(Vec<f64>, f64)> {
    let (x, normal) = (node.position, node.normal);
    match facet.kind.dim() {
        1 => {
            let eta = root(|eta| beside(facet, x, normal, eta))?;
            let shape = facet.kind.shape([eta, 0.0, 0.0]);
            Some((shape, ahead(facet, x, normal, eta)))
        }
        _ => {
            let ([s, t], gap) = foot_on(facet, [x, normal])?;
            Some((facet.kind.shape([s, t, 0.0]), gap))
        }
    }
}
