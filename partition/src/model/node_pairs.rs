//! Node-to-node contact: points of nodes that lie opposite each other.

use std::collections::{HashMap, HashSet};

use super::ray_search::{Hit, Target};
use super::sides::{SideNode, Sides, apart};
use super::surface::{CORNER, SurfaceFacet};
use crate::contact_point::ContactPoint;
use crate::element::geometry::{advance, dot, length};
use crate::mesh::Mesh;

/// Reason for which two sides have no pairs of nodes.
pub(super) enum Unpaired {
    /// Sides that face each other, but with non-matching nodes.
    Unmatched(String),
    /// Sides that don't face each other.
    Apart(String),
}

/// A contact point for every node of side a and its partner on side b.
///
/// # Errors
/// Sides that don't face each other, or with non-matching nodes.
pub(super) fn points(sides: &Sides) -> Result<Vec<ContactPoint<u32>>, Unpaired> {
    let mesh = sides.mesh;
    let skip = |node: u32| sides.shared.contains(&node);
    let (mid_a, mid_b) = (sides.a.mid_nodes(), sides.b.mid_nodes());
    let target = Target::new(sides.b);
    let mut points = Vec::new();
    let mut partners = HashSet::new();
    let mut unmatched = Vec::new();
    let mut any_back_facing = false;
    for a in &sides.nodes_a {
        match target.hit(a.position, a.normal, sides.behind, skip) {
            Hit::Nodes(nodes) => {
                partners.extend(nodes.iter().copied());
                let is_mid = mid_a.contains(&a.node);
                // Tributary areas of a corner and of a middle node differ.
                if let Some(other) = nodes.iter().find(|&b| mid_b.contains(b) != is_mid) {
                    let facet = sides.around_b[other][0];
                    unmatched.push((a.node, "b", &sides.b.facets[facet]));
                    continue;
                }
                points.extend(points_of_node(a, nodes, sides));
            }
            Hit::Facet(facet) => unmatched.push((a.node, "b", &sides.b.facets[facet])),
            Hit::Nothing { back_facing } => any_back_facing |= back_facing,
        }
    }
    let target = Target::new(sides.a);
    let alone = (sides.nodes_b.iter()).filter(|b| !partners.contains(&b.node));
    for b in alone {
        if let Hit::Facet(facet) = target.hit(b.position, b.normal, sides.behind, skip) {
            unmatched.push((b.node, "a", &sides.a.facets[facet]));
        }
    }
    if let Some(mismatch) = mismatch(mesh, &unmatched) {
        return Err(Unpaired::Unmatched(mismatch));
    }
    if points.is_empty() {
        return Err(Unpaired::Apart(apart(any_back_facing)));
    }
    if let Some(facet) = cut_otherwise(sides, &points) {
        return Err(Unpaired::Unmatched(format!(
            "the sides' nodes match, but their facets don't: side b has none opposite that of nodes {}; expected \
             facets of the same corners on both sides",
            mesh.tags_of(&facet.nodes)
        )));
    }
    Ok(points)
}

/// The reason of a mismatch where nodes lie opposite the inside of facets of the other side, each with that side's
/// letter.
fn mismatch(mesh: &Mesh, unmatched: &[(u32, &str, &SurfaceFacet)]) -> Option<String> {
    let (node, side, facet) = unmatched.first()?;
    let shown: Vec<u32> = unmatched.iter().take(5).map(|u| u.0).collect();
    Some(format!(
        "the sides don't match at {} nodes (tags {}{}): the normal of node {} meets side \
         {side} between nodes {}; expected each corner opposite a corner and each node on an \
         edge opposite another",
        unmatched.len(),
        mesh.tags_of(&shown),
        if unmatched.len() > 5 { ", …" } else { "" },
        mesh.node_tags[*node as usize],
        mesh.tags_of(&facet.nodes)
    ))
}

/// The contact points of a node of side a and its partners; there are several if they coincide.
fn points_of_node(a: &SideNode, nodes: Vec<u32>, sides: &Sides) -> Vec<ContactPoint<u32>> {
    let mesh = sides.mesh;
    let faced = opposed_facets(a, &nodes, sides);
    let normal = pressed_along(a, &faced);
    let point = |(b, area): (u32, f64)| {
        let to_b = advance(mesh.points[b as usize], -1.0, a.position);
        let entries = vec![(a.node, 1.0), (b, -1.0)];
        let tag_a = mesh.node_tags[a.node as usize];
        ContactPoint {
            gap: dot(to_b, normal),
            area,
            tag_b: mesh.node_tags[b as usize],
            ..ContactPoint::new(entries, normal, a.position, tag_a)
        }
    };
    opposite(a, nodes, &faced).into_iter().map(point).collect()
}

/// A facet of side a whose nodes have partners that don't form a facet of side b: in space the same nodes may be the
/// corners of other triangles, or of a quadrilateral, on which a uniform pressure has different nodal forces.
fn cut_otherwise<'a>(sides: &Sides<'a>, points: &[ContactPoint<u32>]) -> Option<&'a SurfaceFacet> {
    if sides.mesh.dim < 3 {
        return None;
    }
    let mut partners: HashMap<u32, Vec<u32>> = HashMap::new();
    for node in &sides.shared {
        partners.insert(*node, vec![*node]);
    }
    for point in points {
        let [(a, _), (b, _)] = point.entries[..] else {
            continue;
        };
        partners.entry(a).or_default().push(b);
    }
    sides.a.facets.iter().find(|facet| {
        let of_nodes = facet.nodes.iter().map(|node| partners.get(node));
        let Some(of_nodes) = of_nodes.collect::<Option<Vec<_>>>() else {
            return false;
        };
        let is_opposite = |other: &SurfaceFacet| {
            let has = |nodes: &&Vec<u32>| nodes.iter().any(|node| other.nodes.contains(node));
            other.nodes.len() == facet.nodes.len() && of_nodes.iter().all(has)
        };
        let mut near = of_nodes[0].iter().flat_map(|b| &sides.around_b[b]);
        !near.any(|&other| is_opposite(&sides.b.facets[other]))
    })
}

/// A facet of side a around a node, and for which of the node's partners a facet of side b lies opposite.
struct OpposedFacet<'a> {
    facet: &'a SurfaceFacet,
    partners: Vec<bool>,
}

/// The facets around node `a`, whose `partners` on side b coincide.
fn opposed_facets<'a>(a: &SideNode, partners: &[u32], sides: &Sides<'a>) -> Vec<OpposedFacet<'a>> {
    let around = sides.around_a[&a.node].iter().map(|&f| &sides.a.facets[f]);
    let faced = around.map(|facet| {
        let meets = |b: &u32| {
            let mut facets = sides.around_b[b].iter().map(|&f| &sides.b.facets[f]);
            facets.any(|other| facet.is_opposite(a.node, other, *b, a.normal))
        };
        OpposedFacet {
            facet,
            partners: partners.iter().map(meets).collect(),
        }
    });
    faced.collect()
}

/// Direction of the contact force on node `a`: its normal, or at a corner with a facet averted from side b the normal
/// of the other facets.
fn pressed_along(a: &SideNode, faced: &[OpposedFacet]) -> [f64; 3] {
    let (mut facing, mut back_facing) = ([0.0; 3], Vec::new());
    for OpposedFacet { facet, partners } in faced {
        match partners.contains(&true) {
            true => facing = advance(facing, facet.measure, facet.normal_at(a.node)),
            false => back_facing.push(facet.normal_at(a.node)),
        }
    }
    let size = length(facing);
    let is_corner = |&normal: &[f64; 3]| dot(normal, facing) < CORNER.cos() * size;
    match size > 0.0 && back_facing.iter().any(is_corner) {
        true => facing.map(|c| c / size),
        false => a.normal,
    }
}

/// Nodes, of coincident `partners` on side b, with which node `a` of side a has constraints, and the part of its
/// tributary area for each: the part opposite facets of side b, as side a may extend beyond it.
///
/// Pairs of diagonally opposite bodies are left out: where corners of several bodies meet in a point, bodies across the
/// diagonal share only that point, and a constraint between them would follow from those between neighbours.
fn opposite(a: &SideNode, partners: Vec<u32>, faced: &[OpposedFacet]) -> Vec<(u32, f64)> {
    let mut areas: Vec<f64> = vec![0.0; partners.len()];
    for OpposedFacet { facet, partners } in faced {
        let count = partners.iter().filter(|&&met| met).count();
        let area = facet.tributary_area(a.node) / count.max(1) as f64;
        (areas.iter_mut().zip(partners).filter(|(_, met)| **met)).for_each(|(sum, _)| *sum += area);
    }
    if areas.iter().all(|&area| area == 0.0) {
        let area = a.tributary_area / partners.len() as f64;
        return partners.into_iter().map(|b| (b, area)).collect();
    }
    (partners.into_iter().zip(areas))
        .filter(|&(_, area)| area > 0.0)
        .collect()
}
