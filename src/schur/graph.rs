//! Which unknowns or sites meet in a matrix.

use super::pattern::Cliques;

/// The neighbours of every vertex.
#[derive(Clone, Debug)]
pub(super) struct Graph {
    offsets: Vec<usize>,
    neighbours: Vec<u32>,
}

impl Graph {
    /// The graph of `n` vertices in which the members of each clique are neighbours.
    pub fn new(n: usize, cliques: &Cliques) -> Self {
        let (places, lists) = cliques.transposed(n);
        let mut graph = Self {
            offsets: Vec::with_capacity(n + 1),
            neighbours: Vec::with_capacity(7 * n),
        };
        let mut seen = vec![u32::MAX; n];
        graph.offsets.push(0);
        for i in 0..n as u32 {
            seen[i as usize] = i;
            for &c in &lists[places[i as usize]..places[i as usize + 1]] {
                for &j in cliques.get(c as usize) {
                    if seen[j as usize] != i {
                        seen[j as usize] = i;
                        graph.neighbours.push(j);
                    }
                }
            }
            graph.offsets.push(graph.neighbours.len());
        }
        graph
    }

    /// The neighbours of vertex `i`.
    pub fn of(&self, i: u32) -> &[u32] {
        &self.neighbours[self.offsets[i as usize]..self.offsets[i as usize + 1]]
    }
}
