//! The cells near a cut between aggregates, and the cheapest cut through them.

use super::{Aggregates, NONE};
use crate::decompose::bisect::{Aim, band, best};
use crate::decompose::flow::{Region, cheapest_cuts};
use crate::decompose::graph::Graph;
use crate::lists::Lists;

/// The aggregates near a cut, and the side of their cells.
pub(super) struct Near {
    /// Side of every aggregate; those between the sides have cells on both.
    pub places: Vec<Region>,
    /// The number of the first cell of every aggregate between the sides.
    pub first: Vec<u32>,
    /// The graph of the cells between the sides, with one vertex for each side.
    pub graph: Graph,
    pub left: Vec<bool>,
}

impl Near {
    /// The side of a cell, given by its index in an aggregate, true for left, and its vertex there: that of the
    /// aggregate or, between the sides, of the cell.
    pub fn vertex_at(
        &self,
        (aggregate, place): (usize, usize),
        of_aggregates: &[u32],
        of_cells: &[u32],
    ) -> (bool, u32) {
        match self.places[aggregate] {
            Region::Between => {
                let cell = self.first[aggregate] as usize + place;
                (self.left[cell], of_cells[cell])
            }
            place => (place == Region::Left, of_aggregates[aggregate]),
        }
    }
}

impl Aggregates<'_> {
    /// The aggregates near a cut, and the cheapest cut through them.
    pub(super) fn near(&self, left: &[bool], aim: Aim) -> Near {
        let places = band(&self.graph, left, aim);
        let fine = &self.all.graph;
        let (first, count) = self.first_cells(&places);
        let mut graph = Graph {
            dim: fine.dim,
            ids: (0..count + 2).collect(),
            dofs: Vec::with_capacity(count as usize + 2),
            centres: Vec::new(),
            outside: Vec::with_capacity(count as usize + 2),
            edges: Lists::with_capacity(count as usize + 2, 5 * count as usize),
        };
        let mut was_left = Vec::with_capacity(count as usize + 2);
        let mut of_left = Vec::new();
        let mut list = Vec::new();
        let between = (0..places.len()).filter(|&aggregate| places[aggregate] == Region::Between);
        for (aggregate, &cell) in between.flat_map(|aggregate| {
            let members = self.cells.of(aggregate).iter();
            members.map(move |cell| (aggregate, cell))
        }) {
            let mut outside = 0;
            for edge in fine.edges(cell as usize) {
                let Some((aggregate, place)) = self.find(edge.to) else {
                    outside += edge.weight();
                    continue;
                };
                list.push(edge.towards(match places[aggregate] {
                    Region::Left => {
                        of_left.push(edge.towards(graph.dofs.len() as u32));
                        count
                    }
                    Region::Right => count + 1,
                    Region::Between => first[aggregate] + place as u32,
                }));
            }
            list.sort_unstable();
            graph.edges.push(list.drain(..));
            graph.dofs.push(fine.dofs[cell as usize]);
            graph.outside.push(outside);
            was_left.push(left[aggregate]);
        }
        graph.edges.push(of_left.into_iter());
        graph.edges.push(std::iter::empty());
        self.add_sides(&places, &mut graph, &mut was_left);
        let mut place_of = vec![Region::Between; count as usize];
        place_of.extend([Region::Left, Region::Right]);
        let mut candidates = Vec::from(cheapest_cuts(&graph, &place_of));
        candidates.push(was_left.clone());
        Near {
            left: best(&graph, candidates, aim).unwrap_or(was_left),
            places,
            first,
            graph,
        }
    }

    /// The number of the first cell of every aggregate between the sides, and the total number of their cells.
    fn first_cells(&self, places: &[Region]) -> (Vec<u32>, u32) {
        let mut first = vec![NONE; places.len()];
        let mut count = 0;
        for (aggregate, first) in first.iter_mut().enumerate() {
            if places[aggregate] == Region::Between {
                *first = count;
                count += self.cells.of(aggregate).len() as u32;
            }
        }
        (first, count)
    }

    /// Adds one vertex for each side, for everything beyond the aggregates near a cut, to their graph.
    fn add_sides(&self, places: &[Region], graph: &mut Graph, was_left: &mut Vec<bool>) {
        for side in [Region::Left, Region::Right] {
            let whole = || (0..places.len()).filter(|&aggregate| places[aggregate] == side);
            let dofs: f64 = whole()
                .map(|aggregate| f64::from(self.graph.dofs[aggregate]))
                .sum();
            graph.dofs.push(dofs as f32);
            graph
                .outside
                .push(whole().map(|aggregate| self.graph.outside[aggregate]).sum());
            was_left.push(side == Region::Left);
        }
    }
}
