//! Links between cells without a common facet: contact points, and nodes at which pieces of the mesh are joined.

use crate::contact_point::Law;
use crate::lists::Lists;
use crate::model::Model;

/// Weight of a node that both sides of a cut share.
pub(super) const NODE: u32 = 256;

/// Nodes that a contact point with friction adds to the front that merges its sides: one of each side. Without
/// friction, sides are joined only along the normal: one unknown of a node replaces the shared ones.
const NODES_OF_POINT: u32 = 2;

/// Pairs of cells of two pieces of the mesh that share a node but no facet, and the weight of that link.
pub(super) fn hinges(model: &Model) -> Vec<(u32, u32, u32)> {
    let piece = model.topology.pieces();
    let mut ties = Vec::new();
    if piece.iter().all(|&piece| piece == 0) {
        return ties;
    }
    let mut first = vec![u32::MAX; model.mesh.points.len()];
    for (cell, (_, nodes)) in (0..).zip(model.mesh.cells.iter()) {
        for &node in nodes {
            let first = &mut first[node as usize];
            if *first == u32::MAX {
                *first = cell;
            } else if piece[*first as usize] != piece[cell as usize] {
                ties.push((*first, cell, NODE));
            }
        }
    }
    ties
}

/// The pairs of cells that contact points tie to each other, and the weights of these ties.
///
/// A point ties each cell with a facet at its nodes on side a to each cell with one at its nodes on side b.
pub(super) fn ties(model: &Model) -> Vec<(u32, u32, u32)> {
    let mesh = &model.mesh;
    let points = || model.contacts.iter().flat_map(|contact| &contact.points);
    let mut in_contact = vec![false; mesh.points.len()];
    for &(node, _) in points().flat_map(|point| &point.entries) {
        in_contact[node as usize] = true;
    }
    let cells = mesh
        .cells
        .iter()
        .enumerate()
        .flat_map(|(cell, (_, nodes))| {
            let on_surface = nodes.iter().filter(|&&node| in_contact[node as usize]);
            let has_facet = on_surface.clone().count() >= mesh.dim;
            on_surface.map(move |&node| (node, (cell as u32, has_facet)))
        });
    let around = Lists::new(mesh.points.len(), cells);
    let at = |nodes: Vec<u32>| -> Vec<u32> {
        let all = || nodes.iter().flat_map(|&node| around.of(node as usize));
        let with_facet = all().filter(|(_, has_facet)| *has_facet);
        let mut cells: Vec<u32> = with_facet.map(|&(cell, _)| cell).collect();
        if cells.is_empty() {
            cells.extend(all().map(|&(cell, _)| cell));
        }
        cells.sort_unstable();
        cells.dedup();
        cells
    };
    let mut ties = Vec::new();
    for point in points() {
        let side = |sign: f64| {
            let entries = point
                .entries
                .iter()
                .filter(|(_, weight)| sign * weight > 0.0);
            at(entries.map(|&(node, _)| node).collect())
        };
        let (side_a, side_b) = (side(1.0), side(-1.0));
        let pairs = side_a.len() * side_b.len();
        let of_point = match point.law {
            Law::Frictionless => NODE / mesh.dim as u32,
            Law::Tied => NODE,
            Law::Given { .. } | Law::Coulomb { .. } => NODE * NODES_OF_POINT,
        };
        let weight = (of_point / pairs.max(1) as u32).max(1);
        for &a in &side_a {
            let others = side_b.iter().filter(|&&b| a != b);
            ties.extend(others.map(|&b| (a, b, weight)));
        }
    }
    ties
}
