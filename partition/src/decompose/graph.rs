//! The graph of a mesh: its vertices are cells or contact patches, its edges the facets between them.

use crate::lists::Lists;

/// A graph of cells and contact patches.
pub(super) struct Graph {
    /// Number of cells of every vertex.
    pub cells: Vec<u32>,
    /// Material of every vertex, that of most of its cells.
    pub material: Vec<u32>,
    /// The contacts of every vertex, ascending; empty unless it is a contact patch.
    pub contacts: Vec<Vec<u32>>,
    /// The neighbours of every vertex with the weight of the facets between them.
    pub edges: Lists<(u32, u32)>,
}

impl Graph {
    /// Makes a graph of directed edges (from, (to, weight)), both directions of each given; those
    /// that occur more than once add up.
    pub fn new(
        cells: Vec<u32>,
        material: Vec<u32>,
        contacts: Vec<Vec<u32>>,
        directed: impl Iterator<Item = (u32, (u32, u32))> + Clone,
    ) -> Self {
        let mut all = Lists::new(cells.len(), directed);
        all.sort();
        let added_up = all.iter().map(|list| {
            let same = list.chunk_by(|a, b| a.0 == b.0);
            same.map(|same| (same[0].0, same.iter().map(|&(_, weight)| weight).sum()))
        });
        Self {
            cells,
            material,
            contacts,
            edges: added_up.collect(),
        }
    }

    /// The graph of some of the vertices for each of several lists, none of which have a vertex in
    /// common; a vertex's number there is its place in the list.
    pub fn split(&self, lists: &[Vec<u32>]) -> Vec<Self> {
        let mut place = vec![(u32::MAX, 0); self.len()];
        for (list, vertices) in lists.iter().enumerate() {
            for (number, &vertex) in vertices.iter().enumerate() {
                place[vertex as usize] = (list as u32, number as u32);
            }
        }
        let part = |(list, vertices): (usize, &Vec<u32>)| {
            let place = &place;
            let within = |&vertex: &u32| {
                let edges = self.edges(vertex).iter();
                edges.filter_map(move |&(next, weight)| {
                    let (of, number) = place[next as usize];
                    (of as usize == list).then_some((number, weight))
                })
            };
            let of_vertices =
                |values: &[u32]| vertices.iter().map(|&a| values[a as usize]).collect();
            Self {
                cells: of_vertices(&self.cells),
                material: of_vertices(&self.material),
                contacts: (vertices.iter())
                    .map(|&vertex| self.contacts[vertex as usize].clone())
                    .collect(),
                edges: vertices.iter().map(within).collect(),
            }
        };
        lists.iter().enumerate().map(part).collect()
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// The neighbours of a vertex with the weight of the facets between them.
    pub fn edges(&self, vertex: u32) -> &[(u32, u32)] {
        self.edges.of(vertex as usize)
    }

    /// The vertices that a breadth-first search from `start` reaches, `start` first; `enters` tells
    /// whether it goes on to a vertex, and remembers where it was.
    pub fn reach(&self, start: u32, mut enters: impl FnMut(u32) -> bool) -> Vec<u32> {
        let mut reached = vec![start];
        let mut at = 0;
        while at < reached.len() {
            let edges = self.edges(reached[at]).iter().map(|&(next, _)| next);
            reached.extend(edges.filter(|&next| enters(next)));
            at += 1;
        }
        reached
    }

    /// The numbers of cells as weights.
    pub fn cell_weights(&self) -> Vec<u64> {
        self.cells.iter().map(|&n| u64::from(n)).collect()
    }

    /// Number of cells.
    pub fn size(&self) -> u64 {
        self.cell_weights().iter().sum()
    }

    /// Whether a vertex holds nodes with contact conditions.
    pub fn is_contact_patch(&self, vertex: u32) -> bool {
        !self.contacts[vertex as usize].is_empty()
    }

    /// Number of contact patches.
    pub fn contact_patches(&self) -> usize {
        self.contacts.iter().filter(|list| !list.is_empty()).count()
    }
}
