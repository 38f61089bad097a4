//! The graph to be dissected: its vertices are cells, or the subdomains prescribed by a scene; its edges are facets,
//! and contact points that tie the cells on both sides to each other.

use super::ties::{NODE, hinges, ties};
use crate::lists::Lists;
use crate::mesh::Mesh;
use crate::model::Model;

/// An edge, stored at one of its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Edge {
    /// The vertex at its other end.
    pub to: u32,
    /// Cost of cutting it; the lowest bit distinguishes facets from contacts.
    packed: u32,
}

impl Edge {
    /// An edge to a vertex.
    pub fn new(to: u32, weight: u32, is_facet: bool) -> Self {
        Self {
            to,
            packed: weight << 1 | u32::from(is_facet),
        }
    }

    /// This edge to another vertex.
    pub fn towards(self, to: u32) -> Self {
        Self { to, ..self }
    }

    /// The edge that replaces this one and another to the same vertex.
    pub fn joined(self, other: &Self) -> Self {
        let is_facet = self.is_facet() || other.is_facet();
        Self::new(self.to, self.weight() + other.weight(), is_facet)
    }

    /// Cost of cutting it: [`NODE`] for every node that both sides would share.
    pub fn weight(self) -> u32 {
        self.packed >> 1
    }

    /// True for a facet, false for a contact.
    pub fn is_facet(self) -> bool {
        self.packed & 1 == 1
    }
}

/// The dual graph of cells, or of subdomains.
#[derive(Clone, Debug)]
pub(super) struct Graph {
    /// Dimension of space, and the number of dofs of a node.
    pub dim: usize,
    /// The number of the cell, or of the subdomain, of each vertex.
    pub ids: Vec<u32>,
    /// Dofs of every vertex; each node is divided among the cells around it.
    pub dofs: Vec<f32>,
    /// Centre of every vertex, relative to the middle of the mesh.
    pub centres: Vec<[f32; 3]>,
    /// Weight of the edges from every vertex to vertices that are not in this graph.
    pub outside: Vec<u32>,
    /// The edges of every vertex, ascending.
    pub edges: Lists<Edge>,
}

impl Graph {
    /// An empty graph with room for `count` vertices.
    pub fn with_capacity(dim: usize, count: usize) -> Self {
        Self {
            dim,
            ids: (0..count as u32).collect(),
            dofs: Vec::with_capacity(count),
            centres: Vec::with_capacity(count),
            outside: Vec::with_capacity(count),
            edges: Lists::with_capacity(count, 6 * count),
        }
    }

    /// The graph of the cells of a model.
    pub fn new(model: &Model) -> Self {
        let mesh = &model.mesh;
        let ((dofs, centres), edges) = std::thread::scope(|scope| {
            let edges = scope.spawn(|| edges_of(model));
            let cells = dofs_and_centres(mesh);
            match edges.join() {
                Ok(edges) => (cells, edges),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        });
        Self {
            dim: mesh.dim,
            ids: (0..mesh.cells.len() as u32).collect(),
            outside: vec![0; dofs.len()],
            dofs,
            centres,
            edges,
        }
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Dofs of all vertices.
    pub fn size(&self) -> f64 {
        self.dofs.iter().map(|&dofs| f64::from(dofs)).sum()
    }

    /// Total dofs of the vertices of each of `count` labels.
    pub fn sizes_of(&self, labels: &[u32], count: usize) -> Vec<f64> {
        let mut sizes = vec![0.0; count];
        for (&label, &dofs) in labels.iter().zip(&self.dofs) {
            sizes[label as usize] += f64::from(dofs);
        }
        sizes
    }

    /// Total dofs of every piece.
    pub fn sizes_of_pieces(&self) -> Vec<f64> {
        let (piece, count) = self.pieces();
        self.sizes_of(&piece, count)
    }

    /// The edges of a vertex.
    pub fn edges(&self, vertex: usize) -> &[Edge] {
        self.edges.of(vertex)
    }

    /// Number of dofs of the nodes that this `weight` of edges represents.
    pub fn dofs_of(&self, weight: u64) -> f64 {
        (self.dim as u64 * weight) as f64 / f64::from(NODE)
    }

    /// The graphs of the vertices on the left and of the others.
    pub fn halves(self, left: &[bool]) -> [Self; 2] {
        let mut counts = [0; 2];
        let mut place = Vec::with_capacity(self.len());
        for &left in left {
            let count = &mut counts[usize::from(!left)];
            place.push(*count);
            *count += 1;
        }
        [true, false].map(|side| {
            let count = counts[usize::from(!side)] as usize;
            let mut half = Self {
                dim: self.dim,
                ids: Vec::with_capacity(count),
                dofs: Vec::with_capacity(count),
                centres: Vec::with_capacity(count),
                outside: Vec::with_capacity(count),
                edges: Lists::with_capacity(count, self.edges.items() / self.len().max(1) * count),
            };
            for vertex in (0..self.len()).filter(|&vertex| left[vertex] == side) {
                let mut outside = self.outside[vertex];
                let edges = self.edges(vertex).iter();
                half.edges.push(edges.filter_map(|edge| {
                    if left[edge.to as usize] != side {
                        outside += edge.weight();
                        return None;
                    }
                    let to = place[edge.to as usize];
                    Some(edge.towards(to))
                }));
                half.ids.push(self.ids[vertex]);
                half.dofs.push(self.dofs[vertex]);
                half.centres.push(self.centres[vertex]);
                half.outside.push(outside);
            }
            half
        })
    }

    /// The graph with one vertex for all vertices of a label, and the label as its id; labels are `0..count`.
    pub fn contracted(&self, labels: &[u32], count: usize) -> Self {
        let mut dofs = vec![0.0; count];
        let mut centres = vec![[0.0; 3]; count];
        let mut outside = vec![0; count];
        for (vertex, &label) in labels.iter().enumerate() {
            let label = label as usize;
            dofs[label] += self.dofs[vertex];
            outside[label] += self.outside[vertex];
            let centre = self.centres[vertex];
            for k in 0..3 {
                centres[label][k] += centre[k] * self.dofs[vertex];
            }
        }
        for (centre, &dofs) in centres.iter_mut().zip(&dofs) {
            *centre = centre.map(|c: f32| c / dofs);
        }
        let members = Lists::new(count, labels.iter().copied().zip(0u32..));
        let mut edges = Lists::with_capacity(count, 6 * count);
        let mut list: Vec<Edge> = Vec::new();
        let mut place = vec![u32::MAX; count];
        for (own, members) in (0..).zip(members.iter()) {
            for edge in members
                .iter()
                .flat_map(|&vertex| self.edges(vertex as usize))
            {
                let to = labels[edge.to as usize];
                let known = place[to as usize];
                if to == own {
                    continue;
                }
                match list.get_mut(known as usize).filter(|known| known.to == to) {
                    Some(known) => *known = known.joined(edge),
                    None => {
                        place[to as usize] = list.len() as u32;
                        list.push(edge.towards(to));
                    }
                }
            }
            list.sort_unstable();
            edges.push(list.drain(..));
        }
        Self {
            dim: self.dim,
            ids: (0..count as u32).collect(),
            dofs,
            centres,
            outside,
            edges,
        }
    }

    /// Total dofs and centre of some vertices.
    pub fn middle(&self, vertices: &[u32]) -> (f32, [f32; 3]) {
        let (mut dofs, mut centre) = (0.0, [0.0; 3]);
        for &vertex in vertices {
            let (own, at) = (self.dofs[vertex as usize], self.centres[vertex as usize]);
            dofs += own;
            centre = [0, 1, 2].map(|k| centre[k] + at[k] * own);
        }
        (dofs, centre.map(|c| c / dofs))
    }

    /// Aggregates of about `size` vertices each, connected by edges for which `joins` is true: that of every vertex,
    /// and their number.
    pub fn aggregates(&self, size: usize, joins: impl Fn(Edge) -> bool) -> (Vec<u32>, usize) {
        let mut of = vec![u32::MAX; self.len()];
        let mut count = 0;
        let mut members = Vec::with_capacity(size);
        for first in 0..self.len() {
            if of[first] != u32::MAX {
                continue;
            }
            members.clear();
            members.push(first);
            of[first] = count;
            let mut at = 0;
            while at < members.len() && members.len() < size {
                for edge in self.edges(members[at]) {
                    let to = edge.to as usize;
                    if joins(*edge) && of[to] == u32::MAX && members.len() < size {
                        of[to] = count;
                        members.push(to);
                    }
                }
                at += 1;
            }
            // A remnant between other aggregates joins one of them.
            if members.len() < size / 2 {
                let others = members.iter().flat_map(|&vertex| self.edges(vertex));
                let other = others
                    .filter(|&&edge| joins(edge))
                    .map(|edge| of[edge.to as usize])
                    .find(|&other| other != count && other != u32::MAX);
                if let Some(other) = other {
                    members.iter().for_each(|&vertex| of[vertex] = other);
                    continue;
                }
            }
            count += 1;
        }
        (of, count as usize)
    }

    /// Connected component of every vertex by edges for which `holds` is true, numbered in the order of first vertices,
    /// and the number of components.
    pub fn parts(&self, holds: impl Fn(usize, &Edge) -> bool) -> (Vec<u32>, usize) {
        let mut of = vec![u32::MAX; self.len()];
        let mut count = 0;
        let mut stack = Vec::new();
        for first in 0..self.len() {
            if of[first] != u32::MAX {
                continue;
            }
            of[first] = count;
            stack.push(first);
            while let Some(vertex) = stack.pop() {
                for edge in self.edges(vertex) {
                    let to = edge.to as usize;
                    if of[to] == u32::MAX && holds(vertex, edge) {
                        of[to] = count;
                        stack.push(to);
                    }
                }
            }
            count += 1;
        }
        (of, count as usize)
    }

    /// The components connected across facets.
    pub fn pieces(&self) -> (Vec<u32>, usize) {
        self.parts(|_, edge| edge.is_facet())
    }
}

/// Dofs and centre of every cell.
fn dofs_and_centres(mesh: &Mesh) -> (Vec<f32>, Vec<[f32; 3]>) {
    let mut valence = vec![0u32; mesh.points.len()];
    for &node in mesh.cells.connectivity() {
        valence[node as usize] += 1;
    }
    let share: Vec<f32> = valence
        .iter()
        .map(|&n| mesh.dim as f32 / n as f32)
        .collect();
    let count = mesh.points.len().max(1) as f64;
    let middle = [0, 1, 2].map(|k| mesh.points.iter().map(|p| p[k]).sum::<f64>() / count);
    let points: Vec<[f32; 3]> = (mesh.points.iter())
        .map(|p| [0, 1, 2].map(|k| (p[k] - middle[k]) as f32))
        .collect();
    let mut dofs = Vec::with_capacity(mesh.cells.len());
    let mut centres = Vec::with_capacity(mesh.cells.len());
    for (kind, nodes) in mesh.cells.iter() {
        dofs.push(nodes.iter().map(|&node| share[node as usize]).sum());
        let corners = &nodes[..kind.corners()];
        let mut centre = [0.0; 3];
        for &node in corners {
            let point = points[node as usize];
            centre = [0, 1, 2].map(|k| centre[k] + point[k] / corners.len() as f32);
        }
        centres.push(centre);
    }
    (dofs, centres)
}

/// The edges of every cell.
fn edges_of(model: &Model) -> Lists<Edge> {
    let (mesh, topology) = (&model.mesh, &model.topology);
    let mut ties = ties(model);
    ties.extend(hinges(model));
    let ties = ties.iter().flat_map(|&(a, b, weight)| {
        [(a, b), (b, a)].map(|(from, to)| (from, Edge::new(to, weight, false)))
    });
    let ties = Lists::new(mesh.cells.len(), ties);
    let mut edges = Lists::with_capacity(mesh.cells.len(), topology.pairs() + ties.items());
    let mut list = Vec::new();
    for cell in 0..mesh.cells.len() {
        let weight = facet_weight(model, cell);
        let facets = topology.neighbours(cell).iter();
        list.extend(facets.map(|&next| Edge::new(next, weight, true)));
        if !ties.of(cell).is_empty() {
            list.extend(ties.of(cell));
            list.sort_unstable();
        }
        edges.push(list.drain(..));
    }
    edges
}

/// Cost of cutting a facet of a cell: the weight of its nodes, each divided by the number of facets around it on a cut
/// surface: six triangles, four quadrilaterals or two lines at a corner, two facets on an edge.
fn facet_weight(model: &Model, cell: usize) -> u32 {
    let facets = model.mesh.cells.kind(cell).facets();
    let Some((facet, _)) = facets.first() else {
        return NODE;
    };
    let (nodes, corners) = (facet.nodes() as u32, facet.corners() as u32);
    let (around, on_edges) = match corners {
        2 => (2, 0),
        3 => (6, (nodes - corners).min(corners)),
        _ => (4, (nodes - corners).min(corners)),
    };
    let inside = nodes - corners - on_edges;
    corners * NODE / around + on_edges * NODE / 2 + inside * NODE
}
