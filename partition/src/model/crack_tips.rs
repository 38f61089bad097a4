//! Crack tips: nodes of the outline at which the body spans an angle of 360°.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

use super::{Contact, PlaneState};
use crate::crack_tip::{CrackTip, FaceFacet};
use crate::element::geometry::{advance, difference, dot, length};
use crate::magnitude::short_point;
use crate::mesh::Mesh;
use crate::mesh::bounding_box::BoundingBox;
use crate::mesh::topology::Topology;

/// Angle between the faces at a tip up to which they form a crack and not a notch (rad).
const OPENING: f64 = 0.05;
/// Angle that is round-off (rad).
const ROUND_OFF: f64 = 1e-6;
/// Distance of a face from the straight line, over that from the tip, up to which the face is straight.
const STRAIGHT: f64 = 0.01;
/// Radius of the disc over the distance from the tip to the nearest disturbance of its near field.
const DISC_RATIO: f64 = 0.8;
/// Least number of facets of a crack face within the disc.
const FEWEST: f64 = 3.0;

/// Largest number of tips without stress intensity factors that the remark on them names.
const SHOWN: usize = 6;

/// An edge of the outline, with the body on its left, and its middle node.
struct Edge {
    cell: u32,
    ends: [u32; 2],
    middle: Option<u32>,
}

/// The outline of all bodies.
struct Outline<'a> {
    mesh: &'a Mesh,
    edges: Vec<Edge>,
    /// The edges that start and that end at a node.
    at: HashMap<u32, [Vec<usize>; 2]>,
}

/// A node at which two faces of a crack end, with the edges of these faces.
struct Ending {
    node: u32,
    direction: [f64; 3],
    /// The edges of the lower and of the upper face as far as they are straight.
    faces: [Vec<usize>; 2],
}

/// The crack tips of a plane mesh.
#[derive(Default)]
pub(super) struct CrackTips {
    /// The tips with enough facets around them, in the order of their positions, each with a cell that contains it.
    pub tips: Vec<(u32, CrackTip)>,
    /// The names of the others, each with its position.
    pub coarse: Vec<(String, [f64; 3])>,
}

impl CrackTips {
    /// Finds them. The tips of a contact are numbered in the order of their positions, those with too few facets
    /// included, so that a name doesn't depend on the mesh.
    pub fn find(
        (mesh, topology): (&Mesh, &Topology),
        plane: Option<PlaneState>,
        cell_material: &[u32],
        contacts: &[Contact],
    ) -> Self {
        let mut all = Self::default();
        if !matches!(plane, Some(PlaneState::Strain | PlaneState::Stress)) {
            return all;
        }
        let outline = Outline::new(mesh, topology);
        let mut endings: Vec<Ending> = (outline.at.keys().copied())
            .filter_map(|node| outline.ending(node))
            .collect();
        if endings.is_empty() {
            return all;
        }
        let at = |ending: &Ending| mesh.points[ending.node as usize];
        let grid = grid(mesh);
        endings.sort_by_cached_key(|ending| {
            let place = at(ending).map(|c| (c / grid).round() as i64);
            (place, ending.node)
        });
        let seams = seams(mesh, cell_material);
        let contact_of = contacts_of_nodes(contacts);
        let mut counts: HashMap<&str, usize> = HashMap::new();
        for ending in &endings {
            let first = &outline.edges[ending.faces[0][0]];
            let contact = first.ends.iter().find_map(|node| contact_of.get(node));
            let of = contact.map_or("", |&contact| &contacts[contact].name[..]);
            let count = counts.entry(of).or_default();
            *count += 1;
            let name = match of {
                "" => format!("tip {count}"),
                name => format!("{name}, tip {count}"),
            };
            let Some(radius) = outline.radius(ending, &seams) else {
                all.coarse.push((name, at(ending)));
                continue;
            };
            let tip = CrackTip {
                name,
                tag: mesh.node_tags[ending.node as usize],
                body: 0,
                material: cell_material[first.cell as usize],
                position: at(ending),
                direction: ending.direction,
                radius,
                facets: outline.facets(ending, radius),
            };
            all.tips.push((first.cell, tip));
        }
        all
    }

    /// The remark on crack tips whose mesh is too coarse for stress intensity factors. A warning would disturb all runs
    /// that don't need these factors.
    pub fn remark(&self) -> Option<String> {
        let shown = self.coarse.iter().take(SHOWN);
        let shown: Vec<String> = shown
            .map(|(name, at)| format!("'{name}' at {}", short_point(*at, 2)))
            .collect();
        let (count, are_all) = (self.coarse.len(), self.coarse.len() <= SHOWN);
        (count > 0).then(|| {
            format!(
                "{count} crack tip{} without stress intensity factors, {}{}: fewer than three facets of the crack faces lie \
                 between the tip and the next kink, end, boundary or other material",
                if count == 1 { "" } else { "s" },
                shown.join(", "),
                if are_all { "" } else { ", …" }
            )
        })
    }
}

/// The step to which coordinates are rounded before tips are sorted by them, so that tips above each other aren't
/// sorted by round-off: a power of two, of which decimal fractions aren't half a multiple.
fn grid(mesh: &Mesh) -> f64 {
    let extent = BoundingBox::around(&mesh.points).extent();
    (extent.log2().ceil() - 30.0).exp2()
}

/// The nodes at which cells of several materials meet.
fn seams(mesh: &Mesh, cell_material: &[u32]) -> Vec<u32> {
    let mut of_node = vec![u32::MAX; mesh.points.len()];
    let mut seams = HashSet::new();
    for ((_, nodes), &material) in mesh.cells.iter().zip(cell_material) {
        for &node in nodes {
            let first = &mut of_node[node as usize];
            match *first {
                u32::MAX => *first = material,
                other if other != material => {
                    seams.insert(node);
                }
                _ => {}
            }
        }
    }
    seams.into_iter().collect()
}

/// The contact of every node with contact points.
fn contacts_of_nodes(contacts: &[Contact]) -> HashMap<u32, usize> {
    let all = contacts.iter().enumerate();
    all.flat_map(|(c, contact)| {
        let entries = contact.points.iter().flat_map(|point| &point.entries);
        entries.map(move |&(node, _)| (node, c))
    })
    .collect()
}

impl<'a> Outline<'a> {
    fn new(mesh: &'a Mesh, topology: &Topology) -> Self {
        let edges: Vec<Edge> = (topology.boundary())
            .map(|facet| {
                let nodes = facet.nodes(&mesh.cells);
                Edge {
                    cell: facet.cell,
                    ends: [nodes[0], nodes[1]],
                    middle: nodes.get(2).copied(),
                }
            })
            .collect();
        let mut at: HashMap<u32, [Vec<usize>; 2]> = HashMap::new();
        for (e, edge) in edges.iter().enumerate() {
            for (end, node) in edge.ends.iter().enumerate() {
                at.entry(*node).or_default()[end].push(e);
            }
        }
        Self { mesh, edges, at }
    }

    /// The single edge that starts (0) or ends (1) at a node through which the outline passes only once.
    fn one(&self, node: u32, end: usize) -> Option<usize> {
        match &self.at.get(&node)? {
            [starts, ends] if starts.len() == 1 && ends.len() == 1 => Some([starts, ends][end][0]),
            _ => None,
        }
    }

    fn vector(&self, from: u32, to: u32) -> [f64; 3] {
        difference(
            self.mesh.points[to as usize],
            self.mesh.points[from as usize],
        )
    }

    /// The crack that ends at a node, if any: between its two edges the body spans 360°.
    fn ending(&self, node: u32) -> Option<Ending> {
        let [lower, upper] = [self.one(node, 0)?, self.one(node, 1)?];
        let away = [self.edges[lower].ends[1], self.edges[upper].ends[0]];
        let [below, above] = away.map(|end| {
            let vector = self.vector(node, end);
            vector.map(|x| x / length(vector))
        });
        // The angle of the body from the lower face to the upper one, counter-clockwise.
        let sine = below[0] * above[1] - below[1] * above[0];
        let turn = sine.atan2(dot(below, above)).rem_euclid(TAU);
        let is_notch = (ROUND_OFF..=TAU - OPENING).contains(&turn);
        if away[0] == away[1] || is_notch {
            return None;
        }
        let back = advance(below, 1.0, above);
        let direction = back.map(|x| -x / length(back));
        let faces = [0, 1].map(|face| self.face(node, direction, face));
        let is_there = faces.iter().all(|face| !face.is_empty());
        is_there.then_some(Ending {
            node,
            direction,
            faces,
        })
    }

    /// Distance of a node from a tip along the crack (m), and its distance from the crack's line over that.
    fn behind(&self, tip: u32, direction: [f64; 3], node: u32) -> (f64, f64) {
        let offset = self.vector(tip, node);
        let distance = -dot(offset, direction);
        let across = offset[1] * direction[0] - offset[0] * direction[1];
        (distance, (across / distance).abs())
    }

    /// The edges of the lower (0) or upper (1) face from a tip on, as far as they are straight.
    fn face(&self, tip: u32, direction: [f64; 3], face: usize) -> Vec<usize> {
        let mut edges = Vec::new();
        let (mut node, mut reached) = (tip, 0.0);
        while let Some(e) = self.one(node, face) {
            let edge = &self.edges[e];
            let next = edge.ends[1 - face];
            let (distance, off) = self.behind(tip, direction, next);
            let middle = edge.middle.map(|node| self.behind(tip, direction, node).1);
            if distance <= reached || off.max(middle.unwrap_or(0.0)) > STRAIGHT {
                break;
            }
            edges.push(e);
            (node, reached) = (next, distance);
        }
        edges
    }

    /// The radius of the largest disc around a tip with straight faces only and a single material (m), if it is large
    /// enough compared with the facets.
    fn radius(&self, ending: &Ending, seams: &[u32]) -> Option<f64> {
        let own: HashSet<usize> = ending.faces.iter().flatten().copied().collect();
        let tip = self.mesh.points[ending.node as usize];
        let others = (0..self.edges.len()).filter(|e| !own.contains(e));
        let edges = others.map(|e| {
            let [a, b] = self.edges[e].ends.map(|end| self.mesh.points[end as usize]);
            distance_to_line(tip, a, b)
        });
        let nodes = seams
            .iter()
            .map(|&node| length(self.vector(ending.node, node)));
        let ends = (ending.faces.iter()).map(|face| self.far_end(ending, face[face.len() - 1]));
        let free = edges.chain(nodes).chain(ends).fold(f64::INFINITY, f64::min);
        let sizes = ending
            .faces
            .iter()
            .map(|face| self.far_end(ending, face[0]));
        let radius = DISC_RATIO * free;
        (radius >= FEWEST * sizes.fold(0.0, f64::max)).then_some(radius)
    }

    /// Distance of the far end of an edge of a face from the tip (m).
    fn far_end(&self, ending: &Ending, edge: usize) -> f64 {
        let ends = self.edges[edge].ends.iter();
        let distances = ends.map(|&end| length(self.vector(ending.node, end)));
        distances.fold(0.0, f64::max)
    }

    /// The facets of both faces that start within a radius.
    fn facets(&self, ending: &Ending, radius: f64) -> Vec<FaceFacet> {
        let mut facets = Vec::new();
        for (face, edges) in ending.faces.iter().enumerate() {
            for &e in edges {
                let edge = &self.edges[e];
                let [near, far] = [edge.ends[face], edge.ends[1 - face]];
                let middle = edge.middle.unwrap_or(far);
                let nodes = [near, far, middle];
                let distances = nodes.map(|node| length(self.vector(ending.node, node)));
                if distances[0] >= radius {
                    break;
                }
                let tags = nodes.map(|node| self.mesh.node_tags[node as usize]);
                facets.push(FaceFacet {
                    is_upper: face == 1,
                    nodes: [tags[0], tags[1], edge.middle.map_or(-1, |_| tags[2])],
                    distances,
                });
            }
        }
        facets
    }
}

/// Distance of a point from the line between two others (m).
fn distance_to_line(point: [f64; 3], a: [f64; 3], b: [f64; 3]) -> f64 {
    let (along, from) = (difference(b, a), difference(point, a));
    let part = (dot(from, along) / dot(along, along)).clamp(0.0, 1.0);
    length(advance(from, -part, along))
}
