//! Sites, the runs of unknowns treated as one in orderings, and the elimination order of the interior ones.

use super::block::Block;
use crate::schur::ordering::nested_dissection;
use crate::schur::pattern::Cliques;

/// Runs of consecutive unknowns.
#[derive(Clone, Debug)]
pub(super) struct Sites {
    /// First entry of each site, and the end of the last.
    pub starts: Vec<u32>,
    /// The site of each node's own unknowns, if it has any.
    pub of_node: Vec<u32>,
    /// Number of the next unknown.
    pub next: u32,
}

impl Sites {
    pub fn new(nodes: usize) -> Self {
        let mut starts = Vec::with_capacity(nodes + 1);
        starts.push(0);
        Self {
            starts,
            of_node: vec![u32::MAX; nodes],
            next: 0,
        }
    }

    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Takes the number of the next unknown.
    pub fn unknown(&mut self) -> u32 {
        self.next += 1;
        self.next - 1
    }

    /// Ends the current site, unless it has no unknowns.
    pub fn end(&mut self) {
        if self.starts.last() != Some(&self.next) {
            self.starts.push(self.next);
        }
    }

    /// The site of an unknown.
    pub fn of(&self, dof: u32) -> u32 {
        self.starts.partition_point(|&start| start <= dof) as u32 - 1
    }
}

/// The order in which nodes with interior unknowns are eliminated.
pub(super) fn elimination_order(block: &Block, is_interior: impl Fn(u32) -> bool) -> Vec<u32> {
    let mut site = vec![u32::MAX; block.nodes()];
    let mut nodes = Vec::new();
    for node in 0..block.nodes() as u32 {
        if is_interior(node) {
            site[node as usize] = nodes.len() as u32;
            nodes.push(node);
        }
    }
    let mut cliques = Cliques::default();
    let mut list = Vec::new();
    for cell in block.cells() {
        list.clear();
        list.extend(cell.nodes().map(|node| site[node as usize]));
        list.retain(|&s| s != u32::MAX);
        list.sort_unstable();
        cliques.push(list.iter().copied());
    }
    let points: Vec<_> = nodes.iter().map(|&n| block.points()[n as usize]).collect();
    nested_dissection(&points, &cliques)
        .into_iter()
        .map(|s| nodes[s as usize])
        .collect()
}
