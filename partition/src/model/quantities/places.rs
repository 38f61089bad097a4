//! Positions of quantities: the node, or the point of a contact, that is the nearest one.

use super::Known;
use crate::contact_point::ContactPoint;
use crate::element::geometry::{difference, length};
use crate::magnitude::{short, short_point};
use crate::mesh::Mesh;
use crate::mesh::bounding_box::BoundingBox;
use crate::scene::quantity::Place;

/// Distance of coincident nodes, relative to the extent of the mesh.
const SAME: f64 = 1e-9;

/// True if a position is farther from the box around each cell than that cell measures.
fn is_off(mesh: &Mesh, point: [f64; 3]) -> bool {
    mesh.cells.iter().all(|(_, nodes)| {
        let around = BoundingBox::around(nodes.iter().map(|&n| &mesh.points[n as usize]));
        let nearest = [0, 1, 2].map(|k| point[k].clamp(around.low[k], around.high[k]));
        length(difference(point, nearest)) > around.extent()
    })
}

impl Known<'_> {
    /// The node of the mesh at a position.
    ///
    /// # Errors
    /// A tag of no node, a position off the bodies, or with two nodes at the same distance.
    pub(super) fn node(&self, place: &Place) -> Result<u32, String> {
        let mesh = &self.bodies.mesh;
        let point = match place {
            Place::Node(tag) => {
                let place = mesh.node_tags.iter().position(|of| of == tag);
                return (place.map(|node| node as u32))
                    .ok_or_else(|| format!("no body has a node {tag}"));
            }
            Place::Point(point) => point.value,
        };
        let away = |x: &[f64; 3]| length(difference(*x, point));
        let least = mesh.points.iter().map(away).fold(f64::INFINITY, f64::min);
        let slack = SAME * BoundingBox::around(&mesh.points).extent();
        let near = mesh.points.iter().zip(&mesh.node_tags).enumerate();
        let near: Vec<(usize, i64)> = near
            .filter(|(_, (x, _))| away(x) <= least + slack)
            .map(|(node, (_, tag))| (node, *tag))
            .collect();
        match near[..] {
            [(node, tag), ..] if is_off(mesh, point) => Err(self.away(
                least,
                "the bodies",
                &format!("node {tag} at {}", short_point(mesh.points[node], mesh.dim)),
            )),
            [(node, _)] => Ok(node as u32),
            [(_, first), (_, second), ..] => Err(format!(
                "the nodes {first} and {second} are both the nearest to 'at'; expected 'node', the tag of one"
            )),
            [] => Err("the mesh has no nodes".into()),
        }
    }

    /// The point of a contact at a position.
    ///
    /// # Errors
    /// A node without a condition, or a position farther from the contact than the contact measures.
    pub(super) fn point<'p>(
        &self,
        points: &'p [ContactPoint<u32>],
        place: &Place,
    ) -> Result<&'p ContactPoint<u32>, String> {
        let found = match place {
            Place::Node(tag) => points
                .iter()
                .find(|point| point.tag_a == *tag || point.tag_b == *tag),
            Place::Point(at) => {
                let away = |p: &ContactPoint<u32>| length(difference(p.position, at.value));
                let nearest = (points.iter()).min_by(|a, b| away(a).total_cmp(&away(b)));
                let mesh = &self.bodies.mesh;
                let extent = BoundingBox::around(points.iter().map(|p| &p.position)).extent();
                let is_far = |p: &&ContactPoint<u32>| away(p) > extent;
                if let Some(point) = nearest.filter(is_far)
                    && (extent > 0.0 || is_off(mesh, at.value))
                {
                    let place = short_point(point.position, mesh.dim);
                    let what = format!("point at {place}");
                    return Err(self.away(away(point), "the contact", &what));
                }
                nearest
            }
        };
        found.ok_or_else(|| "the contact has no condition at that node".into())
    }

    /// The error of a position at this distance (m) from an object; `from` and the nearest part of it are given in
    /// words.
    fn away(&self, distance: f64, from: &str, nearest: &str) -> String {
        format!(
            "'at' is {} {} away from {from}, the nearest {nearest}; expected a place on it, or 'node', the tag of a node",
            short(distance),
            self.scene.units.length()
        )
    }
}
