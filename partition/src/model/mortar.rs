//! Conditions between sides whose nodes don't match: segment-to-segment contact, in space with polygons for
//! segments, with dual Lagrange multipliers (Wohlmuth 2000; Popp, Gitterle, Gee and Wall 2010).
//!
//! Side a carries the multipliers. Its averaged normals, interpolated along its facets, say what of
//! side b lies opposite each of its points. With the dual basis φ on what is covered, ∫ φ_j N_k =
//! δ_jk ∫ N_k, the condition of node j is
//!
//! ```text
//! n_j·(u_a(j) − Σ_k M_jk/D_jj u_b(k)) ≤ g_j,   D_jj = ∫ φ_j,   M_jk = ∫ φ_j N_k^b,   g_j = ∫ φ_j g / D_jj
//! ```
//!
//! so that its multiplier is the normal force on node j. All integrals go over the part of side a
//! that side b covers (Cichosz and Bischoff 2011), so that a uniform pressure passes whatever the
//! meshes and wherever the sides end. On a facet that is covered in part N_k are the shape functions of that part alone:
//! φ_j changes its sign, and the dual functions of the whole facet would have forces act beyond what is covered.

mod bases;
mod chart;
mod cover;
mod dual;
mod extent;
mod field;
mod foot;
mod map;
mod pairing;
mod polygons;
mod probes;
mod root;
mod rows;
mod segments;
#[cfg(test)]
mod tests;
mod weights;

use std::collections::HashMap;

use nalgebra::DMatrix;

use self::cover::{Cover, Opposite};
use self::field::Field;
use self::rows::Row;
use self::weights::weights;
use super::sides::{Sides, apart};
use super::surface::SurfaceFacet;
use crate::contact_point::ContactPoint;

/// A facet of side a and what of side b covers it.
struct Covered<'a> {
    facet: &'a SurfaceFacet,
    cover: Cover,
    /// What is known of the part that is covered; `None` where it extends over the whole.
    part: Option<Part>,
}

/// A covered part of a facet as a facet of its own.
struct Part {
    /// Its shape functions as rows of coefficients of those of the facet.
    functions: DMatrix<f64>,
    /// Their integrals over what is covered.
    cover: Cover,
}

pub(super) use self::foot::{foot, middle};
pub(super) use self::map::Map;
pub(super) use self::pairing::{Mortar, pair};

/// What the nodes of side a make of a contact.
struct Carried {
    /// A contact point for every node that carries a multiplier, along the side.
    points: Vec<ContactPoint<u32>>,
    /// How much is lost of where the sides are nearest to each other (m): the least of the mean gaps over the facets
    /// around nodes, over the least gap that there is. So far they can go through each other before the first point
    /// closes.
    unseen: f64,
}

/// The contact of two sides whose side a carries the multipliers.
///
/// # Errors
/// Sides that don't face each other.
fn carried(sides: &Sides) -> Result<Carried, String> {
    let normals: HashMap<u32, [f64; 3]> = (sides.a.nodes().into_iter())
        .filter_map(|(node, at)| Some((node, at.normal()?)))
        .collect();
    let opposite = Opposite::new(sides.b, sides.behind);
    let mut covered = Vec::new();
    let mut any_back_facing = false;
    for facet in in_order(sides) {
        // Only a shared node may be without one, where the side turns back at a crack tip.
        let at_node = |node: &u32| normals.get(node).copied().unwrap_or(facet.normal);
        let normals = facet.nodes.iter().map(at_node).collect();
        let field = Field::new(facet, normals);
        let (cover, back_facing) = opposite.cover(&field);
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
    Ok(Carried { points, unseen })
}

/// The facets along side a.
fn in_order<'a>(sides: &Sides<'a>) -> Vec<&'a SurfaceFacet> {
    let order = sides.a.in_order().into_iter().enumerate();
    let place: HashMap<u32, usize> = order.map(|(place, node)| (node, place)).collect();
    let mut facets: Vec<&SurfaceFacet> = sides.a.facets.iter().collect();
    facets.sort_by_key(|facet| place[&facet.nodes[0]]);
    facets
}
