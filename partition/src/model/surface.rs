//! A piece of the boundary: its facets with their outward normals.

mod facet;

use std::collections::{BTreeMap, HashMap, HashSet};

pub(super) use self::facet::SurfaceFacet;
use crate::element::geometry::{advance, dot, length};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::bounding_box::BoundingBox;
use crate::mesh::topology::{CellFacet, Topology};
use crate::scene::material::PlaneState;

/// Angle between two facets above which they form a corner (rad).
pub(super) const CORNER: f64 = std::f64::consts::FRAC_PI_4;

/// Angle between neighbouring facets up to which they may approximate a smooth curve (rad).
const SMOOTH: f64 = std::f64::consts::FRAC_PI_6;

/// Angle below which facets lie in one plane (rad).
const FLAT: f64 = 1e-4;

/// Angle at one end of a facet of a smooth curve, relative to that at its other end, at least.
const REGULAR: f64 = 0.5;

/// Sag of a facet on a curve, relative to the height of the kink, below which the facet is straight.
const STRAIGHT: f64 = 0.5;

/// The geometry of the surface at a node, from the facets around it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SurfaceNode {
    /// Σ measure·normal at the node, of the facets around it.
    pub area: [f64; 3],
    /// Σ measure of the facets around it.
    pub measure: f64,
    /// ∫ of the node's shape function over the surface.
    pub tributary_area: f64,
}

impl SurfaceNode {
    /// The average of the adjacent facets' outward normals at the node, weighted by their measure and normalized.
    /// `None` where they cancel.
    pub fn normal(&self) -> Option<[f64; 3]> {
        let size = length(self.area);
        (size > 1e-6 * self.measure).then(|| self.area.map(|c| c / size))
    }
}

/// The edge at which two facets meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// A common node.
    pub node: u32,
    /// The two facets, by their indices on the surface.
    facets: [usize; 2],
    /// The angle between their normals there (rad).
    pub angle: f64,
    /// The larger size of the two (m).
    size: f64,
    /// Distance of the straighter facet from its chords (m).
    edge_sagitta: f64,
}

impl Turn {
    /// Sagitta of chords that enclose the angle: an arc over the chord h with the angle α has the height h α/8 (m).
    fn height(&self) -> f64 {
        self.size * self.angle / 8.0
    }

    /// True if the sag of the straighter facet is small compared with that sagitta.
    fn is_straight(&self) -> bool {
        self.edge_sagitta <= STRAIGHT * self.height()
    }
}

/// True if all nodes of a facet belong to one face of a cell without forming it: three corners of four.
fn is_part_of_face(mesh: &Mesh, nodes: &[u32]) -> bool {
    mesh.cells.iter().any(|(kind, of_cell)| {
        let mut facets = kind.facets().iter();
        facets
            .any(|(_, local)| (nodes.iter()).all(|node| local.iter().any(|&i| of_cell[i] == *node)))
    })
}

/// A piece of the boundary.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub facets: Vec<SurfaceFacet>,
}

impl Surface {
    /// The surface of `facets` of the mesh, each of exactly one cell, in a plane state or in space. `what` names the
    /// key.
    pub fn new(
        mesh: &Mesh,
        topology: &Topology,
        plane: Option<PlaneState>,
        facets: &[u32],
        what: &str,
    ) -> Result<Self, InputError> {
        let facet_of = |&facet: &u32| {
            let listed = mesh.facets.nodes_of(facet as usize);
            let refused = |reason: &str| {
                let tags = mesh.tags_of(listed);
                InputError::new(format!("{what}: the facet of nodes {tags} {reason}"))
            };
            let cell_facet = match topology.cells_at(listed).as_slice() {
                [one] => *one,
                [] if mesh.dim == 3 && is_part_of_face(mesh, listed) => {
                    return Err(refused("is only a part of a face of a cell"));
                }
                [] => return Err(refused("belongs to no cell of a body")),
                [_, _] => {
                    return Err(refused(
                        "lies between two cells; expected one on the boundary \
                         (nodes on a crack or between bodies have to be there twice)",
                    ));
                }
                _ => return Err(refused("belongs to more than two cells")),
            };
            Ok(SurfaceFacet::of_cell(mesh, cell_facet, plane))
        };
        let facets = facets.iter().map(facet_of).collect::<Result<_, _>>()?;
        Ok(Self { facets })
    }

    /// The whole boundary of the bodies.
    pub fn of_all(mesh: &Mesh, topology: &Topology, plane: Option<PlaneState>) -> Self {
        let facets = topology.boundary();
        let facets = facets.map(|facet: CellFacet| SurfaceFacet::of_cell(mesh, facet, plane));
        Self {
            facets: facets.collect(),
        }
    }

    /// The same surface with reversed normals.
    pub fn turned(&self) -> Self {
        let turned = |facet: &SurfaceFacet| {
            let order = facet.kind.reversed();
            let nodes = order.iter().map(|&i| facet.nodes[i]).collect();
            let at = order.iter().map(|&i| facet.at[i]).collect();
            SurfaceFacet::new(facet.kind, nodes, at, facet.plane)
        };
        Self {
            facets: self.facets.iter().map(turned).collect(),
        }
    }

    /// Nodes with their normals and tributary areas.
    pub fn nodes(&self) -> HashMap<u32, SurfaceNode> {
        let mut nodes: HashMap<u32, SurfaceNode> = HashMap::new();
        for facet in &self.facets {
            let is_ring = facet.plane == Some(PlaneState::Axisymmetric);
            for (&node, at) in facet.nodes.iter().zip(&facet.at) {
                let sum = nodes.entry(node).or_default();
                sum.area = advance(sum.area, facet.measure, facet.normal_at(node));
                if is_ring && at[0] == 0.0 {
                    // By symmetry the normal on the axis is axial.
                    sum.area[0] = 0.0;
                }
                sum.measure += facet.measure;
                sum.tributary_area += facet.tributary_area(node);
            }
        }
        nodes
    }

    /// Nodes at which two facets meet, in space one end of every edge.
    pub fn turns(&self) -> Vec<Turn> {
        let turn = |(node, facets): (u32, &[usize])| {
            let [a, b] = *facets else {
                return None;
            };
            let both = [a, b];
            let (a, b) = (&self.facets[a], &self.facets[b]);
            let cosine = dot(a.normal_at(node), b.normal_at(node)).clamp(-1.0, 1.0);
            Some(Turn {
                node,
                facets: both,
                angle: cosine.acos(),
                size: a.size().max(b.size()),
                edge_sagitta: a.edge_sagitta().min(b.edge_sagitta()),
            })
        };
        if self.facets.iter().any(|facet| facet.kind.dim() > 1) {
            let mut edges: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
            for (index, facet) in self.facets.iter().enumerate() {
                for (_, edge) in facet.kind.facets() {
                    let [a, b] = [facet.nodes[edge[0]], facet.nodes[edge[1]]];
                    edges.entry([a.min(b), a.max(b)]).or_default().push(index);
                }
            }
            return (edges.iter())
                .filter_map(|(ends, facets)| turn((ends[0], facets)))
                .collect();
        }
        let around = self.around();
        let nodes = self.in_order().into_iter();
        nodes
            .filter_map(|node| turn((node, &around[&node])))
            .collect()
    }

    /// Largest distance of straight facets from the curve that they approximate (m).
    pub fn sagitta(&self) -> f64 {
        let turns = self.turns();
        Self::largest_height(turns.iter().filter(|turn| turn.is_straight()))
    }

    /// Largest sagitta of straight facets of a curve that continues beyond them: such a facet has an angle at both
    /// ends, whereas a facet at a corner between two flat parts has it at one end (m).
    pub fn sagitta_of_curve(&self) -> f64 {
        let mut heights = vec![[0.0_f64; 2]; self.facets.len()];
        for turn in self.turns() {
            if turn.is_straight() && turn.angle < CORNER {
                for facet in turn.facets {
                    let [most, second] = &mut heights[facet];
                    *second = second.max(turn.height().min(*most));
                    *most = most.max(turn.height());
                }
            }
        }
        let seconds = heights.into_iter().map(|[_, second]| second);
        seconds.fold(0.0, f64::max)
    }

    /// Largest sagitta of straight facets that turn like a smooth curve, by similar small angles at both ends (m), and a
    /// node of that facet; `None` without two such facets.
    pub fn stands_off_smooth_curve(&self) -> Option<(f64, u32)> {
        let mut ends: Vec<[Option<Turn>; 2]> = vec![[None; 2]; self.facets.len()];
        let angle = |of: &Option<Turn>| of.map_or(0.0, |turn| turn.angle);
        let bent = |turn: &Turn| turn.is_straight() && FLAT < turn.angle && turn.angle <= SMOOTH;
        for turn in self.turns().into_iter().filter(bent) {
            for facet in turn.facets {
                let [most, second] = &mut ends[facet];
                let mut other = Some(turn);
                if turn.angle > angle(most) {
                    std::mem::swap(most, &mut other);
                }
                if angle(&other) > angle(second) {
                    *second = other;
                }
            }
        }
        let regular = ends.iter().filter_map(|[most, second]| {
            let (most, second) = ((*most)?, (*second)?);
            (second.angle >= REGULAR * most.angle).then_some((second.height(), second.node))
        });
        match regular.clone().count() {
            0 | 1 => None,
            _ => regular.max_by(|a, b| a.0.total_cmp(&b.0)),
        }
    }

    /// The largest height of the kinks between facets: straight facets deviate from a curve by it, curved ones by less
    /// (m).
    pub fn kinks(&self) -> f64 {
        Self::largest_height(self.turns().iter())
    }

    fn largest_height<'a>(turns: impl Iterator<Item = &'a Turn>) -> f64 {
        let smooth = turns.filter(|turn| turn.angle < CORNER);
        smooth.map(Turn::height).fold(0.0, f64::max)
    }

    /// Nodes in the middle of edges and facets; the others are corners.
    pub fn mid_nodes(&self) -> HashSet<u32> {
        let of_facet = |facet: &'_ SurfaceFacet| facet.nodes[facet.kind.corners()..].to_vec();
        self.facets.iter().flat_map(of_facet).collect()
    }

    /// The facets around each node.
    pub fn around(&self) -> HashMap<u32, Vec<usize>> {
        let mut around: HashMap<u32, Vec<usize>> = HashMap::new();
        for (index, facet) in self.facets.iter().enumerate() {
            for &node in &facet.nodes {
                around.entry(node).or_default().push(index);
            }
        }
        around
    }

    /// Nodes in geometrical order, independent of their numbers: lines are followed from end to end with the body on
    /// the left, closed ones from their point of least coordinates; pieces are ordered by their start. The nodes of
    /// faces are sorted by coordinates.
    pub fn in_order(&self) -> Vec<u32> {
        if self.facets.iter().any(|facet| facet.kind.dim() > 1) {
            let all = self
                .facets
                .iter()
                .flat_map(|facet| facet.nodes.iter().zip(&facet.at));
            let nodes: BTreeMap<u32, [f64; 3]> = all.map(|(&node, &at)| (node, at)).collect();
            let mut order: Vec<u32> = nodes.keys().copied().collect();
            order.sort_by(|a, b| compare(nodes[a], nodes[b]));
            return order;
        }
        let mut facets: Vec<usize> = (0..self.facets.len()).collect();
        let start = |&f: &usize| self.facets[f].at[0];
        facets.sort_by(|a, b| compare(start(a), start(b)));
        let mut leaving: HashMap<u32, Vec<usize>> = HashMap::new();
        let mut entered: HashMap<u32, usize> = HashMap::new();
        for &f in facets.iter().rev() {
            let mut nodes = self.facets[f].along();
            if let Some(start) = nodes.next() {
                leaving.entry(start).or_default().push(f);
            }
            for node in nodes {
                *entered.entry(node).or_default() += 1;
            }
        }
        let is_end = |&&f: &&usize| !entered.contains_key(&self.facets[f].nodes[0]);
        let ends = facets.iter().filter(is_end);
        let mut done = vec![false; facets.len()];
        let mut seen = HashSet::new();
        let mut order = Vec::new();
        for &first in ends.chain(&facets) {
            let mut next = Some(first);
            while let Some(f) = next.filter(|&f| !done[f]) {
                done[f] = true;
                let nodes = self.facets[f].along();
                order.extend(nodes.filter(|&node| seen.insert(node)));
                next = (self.facets[f].along().last())
                    .and_then(|last| leaving.get(&last))
                    .and_then(|candidates| candidates.iter().rev().copied().find(|&f| !done[f]));
            }
        }
        order
    }

    /// The average diameter of its facets (m).
    pub fn facet_size(&self) -> f64 {
        let sizes = self.facets.iter().map(SurfaceFacet::size);
        sizes.sum::<f64>() / self.facets.len() as f64
    }

    /// The largest extent of its bounding box (m).
    pub fn extent(&self) -> f64 {
        BoundingBox::around(self.facets.iter().flat_map(|facet| &facet.at)).extent()
    }
}

/// The order of points by their coordinates.
pub(super) fn compare(a: [f64; 3], b: [f64; 3]) -> std::cmp::Ordering {
    (0..3).fold(std::cmp::Ordering::Equal, |order, i| {
        order.then(a[i].total_cmp(&b[i]))
    })
}
