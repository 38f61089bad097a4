//! Contact with a rigid obstacle, n·u ≤ g: points of one node, on some quadratic faces with the ends of its edge.

use std::collections::HashMap;

use super::blend::CORNER_SHARE;
use super::ray_search::FACING;
use super::sides::SideNode;
use super::surface::Surface;
use crate::contact_point::ContactPoint;
use crate::element::geometry::{advance, difference, dot, length};
use crate::mesh::Mesh;
use crate::scene::condition::Obstacle;

/// A contact point for every node of a side that faces the obstacle: its signed distance, linearized at the nearest
/// point of the obstacle, stays ≥ 0.
///
/// Nodes that are averted from the obstacle, with their own body in between, are left out. So a whole outline may be
/// given as a side, and a node faces only one of two opposite walls.
///
/// The distance to a moving obstacle is linearized at the end of its `motion`, so that it is exact there; for round
/// obstacles it is approximate in between.
pub(super) fn points(
    mesh: &Mesh,
    (obstacle, motion): (&Obstacle, Vec<[f64; 3]>),
    side: &Surface,
    nodes: Vec<SideNode>,
) -> Result<Vec<ContactPoint<u32>>, String> {
    let around = side.around();
    // At a corner of the outline, only the part that faces the obstacle counts.
    let facing_area = |a: &SideNode, normal: [f64; 3]| {
        let facets = around[&a.node].iter().map(|&f| &side.facets[f]);
        let facing = facets.filter(|facet| dot(facet.normal_at(a.node), normal) >= FACING);
        let area: f64 = facing.map(|facet| facet.tributary_area(a.node)).sum();
        if area > 0.0 { area } else { a.tributary_area }
    };
    let end = motion.last().copied().unwrap_or_default();
    let mut points = Vec::with_capacity(nodes.len());
    let mut place = HashMap::new();
    for a in nodes {
        let tag = mesh.node_tags[a.node as usize];
        let Some((distance, out)) = distance(obstacle, difference(a.position, end)) else {
            return Err(format!(
                "node {tag} lies in the obstacle's centre, where no point of it is nearest"
            ));
        };
        let normal = out.map(|c| -c);
        if dot(a.normal, normal) < FACING {
            continue;
        }
        place.insert(a.node, points.len());
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
    blend_corners(side, &mut points, &place);
    for point in &mut points {
        point.gap -= dot(point.normal(), end);
        point.motion.clone_from(&motion);
    }
    Ok(points)
}

/// Modified constraints on quadratic facets whose corners carry a force only through other facets. With the modified
/// functions, in which corners take a part of those of the nodes on their edges, N_e = (Ñ_e + …)/(1 − Σ taken), the
/// constraint of a node e on an edge is
///
/// > (u_e − Σ taken·u_c)·n/(1 − Σ taken) ≤ (g_e − Σ taken·g_c)/(1 − Σ taken),   c the ends of its edge
fn blend_corners(side: &Surface, points: &mut [ContactPoint<u32>], place: &HashMap<u32, usize>) {
    let plain = points.to_vec();
    for facet in &side.facets {
        for (middle, corners) in facet.blending().takers {
            let at = |local: usize| place.get(&facet.nodes[local]).copied();
            let Some(middle) = at(middle).filter(|&middle| points[middle].entries.len() == 1)
            else {
                continue;
            };
            let ends: Vec<&ContactPoint<u32>> = corners
                .into_iter()
                .filter_map(at)
                .map(|c| &plain[c])
                .collect();
            let left = 1.0 - CORNER_SHARE * ends.len() as f64;
            let point = &mut points[middle];
            point.entries[0].1 = 1.0 / left;
            point.gap /= left;
            point.force_point = point.position.map(|x| x / left);
            for end in ends {
                point.entries.push((end.entries[0].0, -CORNER_SHARE / left));
                point.gap -= CORNER_SHARE / left * end.gap;
                point.force_point = advance(point.force_point, -CORNER_SHARE / left, end.position);
            }
        }
    }
}

/// Signed distance of a point from an obstacle, positive outside of its material, and the outward normal of the
/// obstacle at its nearest point.
fn distance(obstacle: &Obstacle, at: [f64; 3]) -> Option<(f64, [f64; 3])> {
    match obstacle {
        Obstacle::HalfSpace { point, normal } => {
            let normal = unit(normal.value);
            Some((dot(difference(at, point.value), normal), normal))
        }
        Obstacle::Ball {
            center,
            radius,
            inside,
        } => round(difference(at, center.value), *radius, *inside),
        Obstacle::Cylinder {
            point,
            axis,
            radius,
            inside,
        } => {
            let (arm, axis) = (difference(at, point.value), unit(axis.value));
            round(advance(arm, -dot(arm, axis), axis), *radius, *inside)
        }
    }
}

/// Distance and normal of a round obstacle for the point at the end of `arm`, which starts at the centre or on the
/// axis.
fn round(arm: [f64; 3], radius: f64, inside: bool) -> Option<(f64, [f64; 3])> {
    let far = length(arm);
    let out = (far > 0.0).then(|| arm.map(|c| c / far))?;
    Some(match inside {
        true => (radius - far, out.map(|c| -c)),
        false => (far - radius, out),
    })
}

/// The unit vector along a direction.
fn unit(direction: [f64; 3]) -> [f64; 3] {
    // Scaled first, so that no square overflows or underflows.
    let largest = direction.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    let scaled = direction.map(|c| c / largest);
    scaled.map(|c| c / length(scaled))
}
