//! Cyclic symmetry: equations u_b = R u_a between the nodes of the two sides of a sector, R the rotation from one side
//! to the other.
//!
//! Each component is an equation of two terms, e·u_b − (Rᵀ e)·u_a = 0, treated like other equations in fronts and
//! clusters; a node on the axis is its own partner, and is held perpendicular to the axis. The solution is the same in
//! every sector (nodal diameter 0).

use std::collections::HashMap;

use super::bodies::Bodies;
use super::seams::press_along;
use super::{Contact, groups};
use crate::contact_point::{ContactPoint, Law, LocalFrame};
use crate::element::geometry::{advance, cross, difference, dot, length};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::bounding_box::BoundingBox;
use crate::scene::Scene;
use crate::scene::cyclic::Cyclic;

/// Distance between partners, relative to the extent of the mesh, that is round-off: coordinates may have five digits.
const NEAR: f64 = 1e-5;

/// Norm of the difference up to which unit vectors are equal.
const SAME: f64 = 1e-6;

/// The cyclic symmetries of a scene, numbered from `first` on; the normals of `contacts` at their sides are corrected.
///
/// # Errors
/// Groups that don't exist, nodes without a partner.
pub(super) fn cyclic(
    scene: &Scene,
    bodies: &Bodies,
    contacts: &mut [Contact],
    first: usize,
    warnings: &mut Vec<String>,
) -> Result<Vec<Contact>, InputError> {
    let mesh = &bodies.mesh;
    let mut all = Vec::new();
    for cyclic in &scene.cyclic {
        let what = format!("cyclic '{}'", cyclic.name);
        let [a, b] = [0, 1].map(|side| groups::boundary_nodes(mesh, &cyclic.sides[side], &what));
        let sides = [a?, b?];
        let (turn, pairs) = partners((bodies, cyclic), &sides, &what)?;
        turn_normals(contacts, (mesh, &turn), &pairs, &what)?;
        if mesh.dim == 3 {
            turn_tangents(contacts, (mesh, &turn), &pairs);
        }
        warnings.extend(uneven(contacts, mesh, &pairs, &what));
        let mut points = Vec::new();
        for [a, b] in pairs {
            for axis in turn.held_axes(a == b, mesh.dim) {
                let place = points.len() as u32;
                let contact = (first + all.len()) as u32;
                let point = point(mesh, [a, b], (axis, turn.back(axis)));
                points.push(ContactPoint {
                    contact,
                    place,
                    ..point
                });
            }
        }
        all.push(Contact {
            name: cyclic.name.clone(),
            points,
            probes: Vec::new(),
            prescribed: Vec::new(),
        });
    }
    Ok(all)
}

/// Gives contact points at the ends of a sector the normals of the whole ring: on a curved side the facets within the
/// sector would be averaged without those of the neighbouring sector, so that sectors would interlock.
///
/// # Errors
/// A point there with more than two nodes: its opposite facets lie partly in the neighbouring sector.
fn turn_normals(
    contacts: &mut [Contact],
    (mesh, turn): (&Mesh, &Turn),
    pairs: &[[u32; 2]],
    what: &str,
) -> Result<(), InputError> {
    for contact in contacts {
        for (pair, [i, j]) in partner_points(contact, mesh, pairs) {
            let (a, b) = (&contact.points[i], &contact.points[j]);
            let turned = turn.by(turn.angle, a.normal());
            if length(difference(turned, b.normal())) <= SAME {
                continue;
            }
            if a.tag_b == -1 || b.tag_b == -1 {
                return Err(InputError::new(format!(
                    "{what}: the sides of contact '{}' are curved where they meet those of the sector, at node {}, and their \
                     nodes don't match, which isn't supported; expected nodes that do, flat sides there, a tie, or the whole ring",
                    contact.name, mesh.node_tags[pair[0] as usize]
                )));
            }
            let sum = advance(turned.map(|c| a.area * c), b.area, b.normal());
            let normal = sum.map(|c| c / length(sum));
            press_along(&mut contact.points[j], normal, mesh);
            press_along(&mut contact.points[i], turn.back(normal), mesh);
        }
    }
    Ok(())
}

/// Gives contact points at the second side of a sector the tangents of their partners, rotated: both have one slip then,
/// and share its force.
fn turn_tangents(contacts: &mut [Contact], (mesh, turn): (&Mesh, &Turn), pairs: &[[u32; 2]]) {
    for contact in contacts {
        for (_, [i, j]) in partner_points(contact, mesh, pairs) {
            if i == j {
                continue;
            }
            let first = turn.by(turn.angle, contact.points[i].frame.tangents[0]);
            let normal = contact.points[j].normal();
            let first = advance(first, -dot(first, normal), normal);
            let first = first.map(|c| c / length(first));
            contact.points[j].frame.tangents = [first, cross(normal, first)];
        }
    }
}

/// A warning of every contact of whose nodes at the ends of a sector each has a mean of its own over the other side.
fn uneven<'a>(
    contacts: &'a [Contact],
    mesh: &'a Mesh,
    pairs: &'a [[u32; 2]],
    what: &'a str,
) -> impl Iterator<Item = String> + 'a {
    contacts.iter().filter_map(move |contact| {
        let mut both = partner_points(contact, mesh, pairs).into_iter();
        let is_mean = |at: usize| contact.points[at].entries.len() > 2;
        let (pair, _) = both.find(|(_, [i, j])| i != j && (is_mean(*i) || is_mean(*j)))?;
        Some(format!(
            "{what}: the nodes of contact '{}' don't match at its ends, as at node {}, so that the pressures of single nodes \
             there are uneven, and with cohesion or a bound of its own friction is too weak; expected nodes that match",
            contact.name, mesh.node_tags[pair[0] as usize]
        ))
    })
}

/// The pairs of nodes that both have a point in a contact, and its indices.
fn partner_points(
    contact: &Contact,
    mesh: &Mesh,
    pairs: &[[u32; 2]],
) -> Vec<([u32; 2], [usize; 2])> {
    let unilateral = (contact.points.iter().enumerate()).filter(|(_, p)| !p.law.is_tied());
    let places: HashMap<i64, usize> = unilateral.map(|(i, point)| (point.tag(), i)).collect();
    let of_pair = |pair: &[u32; 2]| {
        let at = pair.map(|node| places.get(&mesh.node_tags[node as usize]).copied());
        let [Some(i), Some(j)] = at else { return None };
        Some((*pair, [i, j]))
    };
    pairs.iter().filter_map(of_pair).collect()
}

/// The equation of a pair along an axis of b, which is `back` on a; for a node that is its own partner, a support along
/// the axis.
fn point(mesh: &Mesh, [a, b]: [u32; 2], (axis, back): ([f64; 3], [f64; 3])) -> ContactPoint<u32> {
    let (entries, axes) = match a == b {
        true => (vec![(b, 1.0)], vec![axis]),
        false => (vec![(b, 1.0), (a, 1.0)], vec![axis, back.map(|c| -c)]),
    };
    let tag = mesh.node_tags[b as usize];
    ContactPoint {
        area: 1.0,
        law: Law::Tied,
        axes,
        ..ContactPoint::new(entries, axis, mesh.points[b as usize], tag)
    }
}

/// A rotation about an axis through a point.
struct Turn {
    point: [f64; 3],
    axis: [f64; 3],
    angle: f64,
}

impl Turn {
    /// R v, v rotated by an angle, with Rodrigues' formula.
    fn by(&self, angle: f64, v: [f64; 3]) -> [f64; 3] {
        let (sin, cos) = angle.sin_cos();
        let along = (1.0 - cos) * dot(self.axis, v);
        let turned = advance(v.map(|c| cos * c), sin, cross(self.axis, v));
        advance(turned, along, self.axis)
    }

    /// Rᵀ v.
    fn back(&self, v: [f64; 3]) -> [f64; 3] {
        self.by(-self.angle, v)
    }

    /// The position of a rotated point.
    fn place(&self, x: [f64; 3]) -> [f64; 3] {
        let turned = self.by(self.angle, difference(x, self.point));
        advance(turned, 1.0, self.point)
    }

    /// The directions of the equations of a pair; on the axis those perpendicular to it.
    fn held_axes(&self, on_axis: bool, dim: usize) -> Vec<[f64; 3]> {
        match on_axis {
            // In the plane the axis is z, and both tangents lie in the plane.
            true => LocalFrame::new(self.axis).tangents.to_vec(),
            false => (0..dim)
                .map(|k| std::array::from_fn(|i| f64::from(u8::from(i == k))))
                .collect(),
        }
    }
}

/// The rotation, in either sense, that maps side a onto side b, and the pairs of their nodes.
///
/// # Errors
/// Sides that no rotation maps onto each other.
fn partners(
    (bodies, cyclic): (&Bodies, &Cyclic),
    [a, b]: &[Vec<u32>; 2],
    what: &str,
) -> Result<(Turn, Vec<[u32; 2]>), InputError> {
    let mesh = &bodies.mesh;
    let axis = (cyclic.axis.as_ref()).map_or([0.0, 0.0, 1.0], |axis| axis.value);
    let axis = axis.map(|c| c / length(axis));
    let slack = NEAR * BoundingBox::around(&mesh.points).extent();
    let places = Places::new(bodies, b, slack);
    let mut most: (usize, Option<u32>) = (0, None);
    for sign in [1.0, -1.0] {
        let turn = Turn {
            point: cyclic.point.value,
            axis,
            angle: sign * std::f64::consts::TAU / f64::from(cyclic.sectors),
        };
        let partner = |&node: &u32| {
            let place = turn.place(mesh.points[node as usize]);
            Some([node, places.at(place, node)?])
        };
        let pairs: Vec<[u32; 2]> = a.iter().filter_map(partner).collect();
        if pairs.len() == a.len() && a.len() == b.len() {
            return Ok((turn, pairs));
        }
        if pairs.len() >= most.0 {
            let lacks = a.iter().find(|node| partner(node).is_none());
            most = (pairs.len(), lacks.copied());
        }
    }
    let where_to = match most.1 {
        Some(node) => format!(
            "node {} of side a has no partner on side b",
            mesh.node_tags[node as usize]
        ),
        None => format!("side a has {} nodes and side b {}", a.len(), b.len()),
    };
    Err(InputError::new(format!(
        "{what}: turned by 360°/{}, {where_to}; expected two sides whose meshes match (Gmsh: Periodic Surface)",
        cyclic.sectors
    )))
}

/// Nodes by their positions.
struct Places<'a> {
    mesh: &'a Mesh,
    slack: f64,
    by_box: HashMap<[i64; 3], Vec<u32>>,
    /// A body of every node.
    body: Vec<u32>,
}

impl<'a> Places<'a> {
    fn new(bodies: &'a Bodies, nodes: &[u32], slack: f64) -> Self {
        let mesh = &bodies.mesh;
        let mut by_box: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for &node in nodes {
            let key = Self::key(mesh.points[node as usize], slack);
            by_box.entry(key).or_default().push(node);
        }
        let mut body = vec![u32::MAX; mesh.points.len()];
        for ((_, nodes), &of_cell) in mesh.cells.iter().zip(&bodies.cell_body) {
            nodes.iter().for_each(|&node| body[node as usize] = of_cell);
        }
        Self {
            mesh,
            slack,
            by_box,
            body,
        }
    }

    fn key(x: [f64; 3], slack: f64) -> [i64; 3] {
        x.map(|c| (c / (4.0 * slack)).round() as i64)
    }

    /// The node at a position; of several the one of the body of node `of`, like on the sides of a contact.
    fn at(&self, x: [f64; 3], of: u32) -> Option<u32> {
        let [i, j, k] = Self::key(x, self.slack);
        let near = (-1..2).flat_map(|l| (-1..2).flat_map(move |m| (-1..2).map(move |n| [l, m, n])));
        let nodes = near
            .filter_map(|[l, m, n]| self.by_box.get(&[i + l, j + m, k + n]))
            .flatten();
        let is_here =
            |node: &&u32| length(difference(self.mesh.points[**node as usize], x)) <= self.slack;
        let here: Vec<u32> = nodes.filter(is_here).copied().collect();
        let is_of_body = |node: &u32| self.body[*node as usize] == self.body[of as usize];
        let own: Vec<u32> = here.iter().copied().filter(is_of_body).collect();
        match (&here[..], &own[..]) {
            ([one], _) | (_, [one]) => Some(*one),
            _ => None,
        }
    }
}
