//! Springs between points: the relative displacement of their ends equals that of an auxiliary node on a spring to the
//! ground.
//!
//! So each is an equation, n·(u_a − u_b − s) = 0 with the average displacements of both ends, of a compliant point.

use super::{Contact, groups};
use crate::contact_point::{ContactPoint, Law};
use crate::element::geometry::{advance, difference};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::bounding_box::BoundingBox;
use crate::scene::Scene;
use crate::scene::spring::SpringBetween;

/// Distance of ends that coincide up to round-off, relative to the extent of the mesh: the middles of two sides are sums,
/// and the direction between them would be that of their last digits.
const SAME: f64 = 1e-9;

/// The springs between points of a scene, numbered from `first` on.
///
/// # Errors
/// Groups that don't exist, ends that share a node or coincide, zero stiffness.
pub(super) fn springs_between(
    scene: &Scene,
    mesh: &Mesh,
    first: usize,
) -> Result<Vec<Contact>, InputError> {
    let spring = |(number, (index, spring)): (usize, (usize, &SpringBetween))| {
        let what = format!("spring[{}]", index + 1);
        Ok(Contact {
            name: spring.title(),
            points: points(spring, mesh, &what, (first + number) as u32)?,
            probes: Vec::new(),
            prescribed: Vec::new(),
        })
    };
    scene.springs_between().enumerate().map(spring).collect()
}

/// The points of a spring: one along each direction of nonzero stiffness.
fn points(
    spring: &SpringBetween,
    mesh: &Mesh,
    what: &str,
    contact: u32,
) -> Result<Vec<ContactPoint<u32>>, InputError> {
    let [a, b] = &spring.ends;
    let ends = [groups::nodes(mesh, a, what)?, groups::nodes(mesh, b, what)?];
    if let Some(&node) = ends[0].iter().find(|node| ends[1].contains(node)) {
        let tag = mesh.node_tags[node as usize];
        let message = format!("{what}: the node {tag} is at both ends; expected two places");
        return Err(InputError::new(message));
    }
    let middles = ends.each_ref().map(|nodes| {
        let part = 1.0 / nodes.len() as f64;
        let sum = |sum, &node: &u32| advance(sum, part, mesh.points[node as usize]);
        nodes.iter().fold([0.0; 3], sum)
    });
    let round_off = SAME * BoundingBox::around(&mesh.points).extent();
    let along = spring.along(difference(middles[0], middles[1]), round_off);
    let along = along.map_err(InputError::about(what))?;
    let point = |(place, (axis, stiffness)): (usize, ([f64; 3], f64))| {
        let mut entries = Vec::new();
        let mut axes = Vec::new();
        for (nodes, sign) in ends.iter().zip([1.0, -1.0]) {
            let part = 1.0 / nodes.len() as f64;
            entries.extend(nodes.iter().map(|&node| (node, part)));
            axes.extend(nodes.iter().map(|_| axis.map(|c| sign * c)));
        }
        let [tag_a, tag_b] = ends
            .each_ref()
            .map(|nodes| mesh.node_tags[nodes[0] as usize]);
        ContactPoint {
            contact,
            place: place as u32,
            area: 1.0,
            law: Law::Tied,
            axes,
            stiffness: [stiffness, 0.0],
            force_point: middles[0],
            tag_b,
            ..ContactPoint::new(entries, axis, mesh.points[ends[0][0] as usize], tag_a)
        }
    };
    Ok(along.into_iter().enumerate().map(point).collect())
}
