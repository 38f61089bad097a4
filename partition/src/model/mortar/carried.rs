//! The contact points of two sides of which side a carries the multipliers.

use std::collections::HashMap;

use super::super::sides::{Sides, apart};
use super::super::surface::SurfaceFacet;
use super::cover::{Cover, Opposite};
use super::covered::{Covered, Part};
use super::field::NormalField;
use super::rows::Row;
use super::weights::weights;
use super::{polygons, segments};
use crate::contact_point::ContactPoint;

/// The contact points carried by the nodes of side a.
pub(super) struct CarriedPoints {
    /// A contact point for every node that carries a multiplier, along the side.
    pub points: Vec<ContactPoint<u32>>,
    /// Penetration of the sides (m) until the first point closes: the smallest of the average gaps over the facets
    /// around nodes, minus the smallest gap.
    pub unseen: f64,
}

/// The contact of two sides of which side a carries the multipliers.
///
/// # Errors
/// Sides that don't face each other.
pub(super) fn carried(sides: &Sides) -> Result<CarriedPoints, String> {
    let normals: HashMap<u32, [f64; 3]> = (sides.a.nodes().into_iter())
        .filter_map(|(node, at)| Some((node, at.normal()?)))
        .collect();
    let opposite = Opposite::new(sides.b, sides.behind);
    let mut covered = Vec::new();
    let mut any_back_facing = false;
    for facet in in_order(sides) {
        // Only a shared node, a crack tip at which the side turns back, may have no normal.
        let at_node = |node: &u32| normals.get(node).copied().unwrap_or(facet.normal);
        let normals = facet.nodes.iter().map(at_node).collect();
        let field = NormalField::new(facet, normals);
        let (cover, back_facing) = cover_of(&opposite, &field);
        any_back_facing |= back_facing;
        if !cover.is_empty() {
            let part = cover.extent.functions(facet.kind).map(|functions| Part {
                cover: cover.of_functions(&functions),
                functions,
            });
            covered.push(Covered { facet, cover, part });
        }
    }
    let mut rows: HashMap<u32, Row> = HashMap::new();
    for (on, weights) in covered.iter().zip(weights(sides, &covered)) {
        for (node, weight) in weights {
            rows.entry(node).or_default().add(on, sides.b, &weight);
        }
    }
    let plane = sides.a.facets.first().and_then(|facet| facet.plane);
    let least = |of: fn(&Row) -> f64| rows.values().map(of).fold(f64::INFINITY, f64::min);
    let unseen = least(Row::mean_gap) - least(|row| row.least_gap);
    let points: Vec<ContactPoint<u32>> = (sides.nodes_a.iter())
        .filter_map(|a| Some(rows.remove(&a.node)?.point(a, &normals, sides.mesh, plane)))
        .collect();
    if points.is_empty() {
        return Err(apart(any_back_facing));
    }
    Ok(CarriedPoints { points, unseen })
}

/// The facets along side a.
fn in_order<'a>(sides: &Sides<'a>) -> Vec<&'a SurfaceFacet> {
    let order = sides.a.in_order().into_iter().enumerate();
    let place: HashMap<u32, usize> = order.map(|(place, node)| (node, place)).collect();
    let mut facets: Vec<&SurfaceFacet> = sides.a.facets.iter().collect();
    facets.sort_by_key(|facet| place[&facet.nodes[0]]);
    facets
}

/// The part of a facet of side a that is covered by side b, and whether a facet of side b there faces the same way.
fn cover_of(opposite: &Opposite, field: &NormalField) -> (Cover, bool) {
    match field.facet().kind.dim() {
        1 => segments::cover(opposite, field),
        _ => polygons::cover(opposite, field),
    }
}
