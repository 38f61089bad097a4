//! Probes: nodes of the side without constraints that are checked for penetration.

use super::super::ray_search::{Hit, Target};
use super::super::sides::{SideNode, Sides};
use super::super::surface::{Surface, SurfaceFacet};
use super::field::{ahead, beside};
use super::foot::foot_on;
use super::root::root;
use crate::contact_point::Probe;
use crate::element::geometry::{difference, dot};
use crate::mesh::Mesh;

/// A probe at every node of side b whose normal intersects side a.
pub(super) fn probes(sides: &Sides) -> Vec<Probe<u32>> {
    let target = Target::new(sides.a);
    let is_shared = |node: u32| sides.shared.contains(&node);
    let probe = |b: &SideNode| {
        let hit = target.hit(b.position, b.normal, sides.behind, is_shared);
        let (entries, gap) = opposite(hit, (sides.mesh, sides.a), b)?;
        Some(Probe {
            contact: 0,
            tag: sides.mesh.node_tags[b.node as usize],
            entries,
            normal: b.normal,
            gap,
        })
    };
    sides.nodes_b.iter().filter_map(probe).collect()
}

/// A node with weight 1, the nodes of the opposite facet intersected by its normal, whose weights sum to −1, and the
/// gap (m).
pub(in crate::model) fn opposite(
    hit: Hit,
    (mesh, side): (&Mesh, &Surface),
    of: &SideNode,
) -> Option<(Vec<(u32, f64)>, f64)> {
    let (opposite, gap) = match hit {
        Hit::Nodes(nodes) => {
            let node = *nodes.first()?;
            let offset = difference(mesh.points[node as usize], of.position);
            (vec![(node, -1.0)], dot(offset, of.normal))
        }
        Hit::Facet(facet) => {
            let facet = &side.facets[facet];
            let (shape, gap) = intersection(facet, of)?;
            let nodes = facet.nodes.iter().zip(shape);
            (nodes.map(|(&node, n)| (node, -n)).collect(), gap)
        }
        Hit::Nothing { .. } => return None,
    };
    let entries = std::iter::once((of.node, 1.0)).chain(opposite);
    Some((entries.collect(), gap))
}

/// The shape functions of a facet at the intersection with the normal of a node, and the distance (m).
fn intersection(facet: &SurfaceFacet, node: &SideNode) -> Option<(Vec<f64>, f64)> {
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
