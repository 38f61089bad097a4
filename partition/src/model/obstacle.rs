//! Contact with a rigid obstacle, n·u ≤ g: points of one node.

use super::ray_search::FACING;
use super::sides::SideNode;
use super::surface::Surface;
use crate::contact_point::ContactPoint;
use crate::element::geometry::{difference, dot, length};
use crate::mesh::Mesh;
use crate::scene::condition::Obstacle;

/// A contact point for every node of a side that faces the obstacle: its signed distance, linearized
/// at the nearest point of the obstacle, stays ≥ 0.
///
/// From the other nodes the body itself lies between them and the obstacle. Without them a whole
/// outline may be given as a side, and a node meets one of two opposite walls only.
pub(super) fn points(
    mesh: &Mesh,
    obstacle: &Obstacle,
    side: &Surface,
    nodes: Vec<SideNode>,
) -> Result<Vec<ContactPoint<u32>>, String> {
    let around = side.around();
    // Of an outline that turns a corner at the node the part that faces the obstacle.
    let facing_area = |a: &SideNode, normal: [f64; 3]| {
        let facets = around[&a.node].iter().map(|&f| &side.facets[f]);
        let facing = facets.filter(|facet| dot(facet.normal_at(a.node), normal) >= FACING);
        let area: f64 = facing.map(|facet| facet.tributary_area(a.node)).sum();
        if area > 0.0 { area } else { a.tributary_area }
    };
    let mut points = Vec::with_capacity(nodes.len());
    for a in nodes {
        let tag = mesh.node_tags[a.node as usize];
        let Some((distance, out)) = distance(obstacle, a.position) else {
            return Err(format!(
                "node {tag} lies in the circle's centre, where no point of it is nearest"
            ));
        };
        let normal = out.map(|c| -c);
        if dot(a.normal, normal) < FACING {
            continue;
        }
        points.push(ContactPoint {
            gap: distance,
            area: facing_area(&a, normal),
            ..ContactPoint::new(vec![(a.node, 1.0)], normal, a.position, tag)
        });
    }
    if points.is_empty() {
        return Err(
            "no node of the side faces the obstacle; expected an outward normal towards it \
             (an obstacle's normal points out of its material)"
                .to_owned(),
        );
    }
    Ok(points)
}

/// Signed distance of a point to an obstacle, positive outside of its material, and the
/// obstacle's normal at its point nearest to it, out of its material.
fn distance(obstacle: &Obstacle, at: [f64; 3]) -> Option<(f64, [f64; 3])> {
    match obstacle {
        Obstacle::HalfPlane { point, normal } => {
            // Scaled first, so that no square under- or overflows.
            let largest = normal.value.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
            let scaled = normal.value.map(|c| c / largest);
            let normal = scaled.map(|c| c / length(scaled));
            Some((dot(difference(at, point.value), normal), normal))
        }
        Obstacle::Circle {
            center,
            radius,
            inside,
        } => {
            let arm = difference(at, center.value);
            let far = length(arm);
            let out = (far > 0.0).then(|| arm.map(|c| c / far))?;
            Some(if *inside {
                (radius - far, out.map(|c| -c))
            } else {
                (far - radius, out)
            })
        }
    }
}
