//! Aggregates of cells as the vertices of dissection: cuts run between aggregates and are then shortened among the
//! cells near them, so that most cells aren't visited at every cut.

mod near;

use std::sync::atomic::{AtomicU32, Ordering};

use super::bisect::Aim;
use super::flow::Region;
use super::graph::{Edge, Graph};
use crate::lists::Lists;

/// Cells of an aggregate.
const AGGREGATE: usize = 8;

/// Marks an aggregate without a vertex.
const NONE: u32 = u32::MAX;

/// All cells of a mesh.
pub(super) struct Cells {
    graph: Graph,
    /// Number of the aggregate that every cell is in at present.
    aggregate: Vec<AtomicU32>,
}

/// A set of aggregates, each connected across facets.
pub(super) struct Aggregates<'a> {
    all: &'a Cells,
    /// The graph with the aggregates as vertices.
    pub graph: Graph,
    /// The cells of every aggregate.
    pub cells: Lists<u32>,
}

impl Cells {
    pub fn new(graph: Graph) -> Self {
        let aggregate = graph.ids.iter().map(|_| AtomicU32::new(NONE)).collect();
        Self { graph, aggregate }
    }

    /// The set of all cells in aggregates.
    pub fn aggregates(&self) -> Aggregates<'_> {
        let (of, count) = self.graph.aggregates(AGGREGATE, Edge::is_facet);
        let cells = Lists::new(count, of.iter().copied().zip(0..));
        Aggregates::new(self, self.graph.contracted(&of, count), cells)
    }
}

impl<'a> Aggregates<'a> {
    fn new(all: &'a Cells, graph: Graph, cells: Lists<u32>) -> Self {
        for (number, cells) in (0..).zip(cells.iter()) {
            for &cell in cells {
                all.aggregate[cell as usize].store(number, Ordering::Relaxed);
            }
        }
        Self { all, graph, cells }
    }

    /// The aggregate of a cell and the cell's index in it; `None` if the cell isn't in this set: then its number is
    /// that of an aggregate in another set, which another thread may be changing.
    fn find(&self, cell: u32) -> Option<(usize, usize)> {
        let aggregate = self.all.aggregate[cell as usize].load(Ordering::Relaxed) as usize;
        if aggregate >= self.graph.len() {
            return None;
        }
        let place = self.cells.of(aggregate).iter().position(|&c| c == cell)?;
        Some((aggregate, place))
    }

    /// The sides of a cut between aggregates, after shortening it among the cells near it.
    pub fn halves(self, left: &[bool], aim: Aim) -> [Self; 2] {
        let near = self.near(left, aim);
        let mut vertex_of_aggregate = vec![NONE; self.graph.len()];
        let mut vertex_of_cell = vec![NONE; near.left.len()];
        let mut cells = [0, 1].map(|_| Lists::with_capacity(left.len(), self.cells.items()));
        let mut aggregates = [Vec::new(), Vec::new()];
        let mut part = Vec::new();
        let mut stack = Vec::new();
        for (aggregate, members) in self.cells.iter().enumerate() {
            let whole = match near.places[aggregate] {
                Region::Left => Some(0),
                Region::Right => Some(1),
                Region::Between => None,
            };
            if let Some(side) = whole {
                vertex_of_aggregate[aggregate] = aggregates[side].len() as u32;
                aggregates[side].push(aggregate);
                cells[side].push(members.iter().copied());
                continue;
            }
            let first = near.first[aggregate] as usize;
            for start in first..first + members.len() {
                if vertex_of_cell[start] != NONE {
                    continue;
                }
                let side = usize::from(!near.left[start]);
                let vertex = aggregates[side].len() as u32;
                vertex_of_cell[start] = vertex;
                stack.push(start);
                while let Some(cell) = stack.pop() {
                    part.push(members[cell - first]);
                    for edge in near.graph.edges(cell) {
                        let to = edge.to as usize;
                        if edge.is_facet()
                            && (first..first + members.len()).contains(&to)
                            && near.left[to] == near.left[start]
                            && vertex_of_cell[to] == NONE
                        {
                            vertex_of_cell[to] = vertex;
                            stack.push(to);
                        }
                    }
                }
                aggregates[side].push(aggregate);
                cells[side].push(part.drain(..));
            }
        }
        let graphs = [0, 1].map(|side| {
            let vertex_at = |at| {
                let (is_left, vertex) = near.vertex_at(at, &vertex_of_aggregate, &vertex_of_cell);
                (is_left == (side == 0)).then_some(vertex)
            };
            self.half(&near.places, &aggregates[side], &cells[side], vertex_at)
        });
        let mut cells = cells.into_iter();
        graphs.map(|graph| Self::new(self.all, graph, cells.next().unwrap_or_default()))
    }

    /// The graph of one side, whose vertices are `aggregates` or the cells near the cut on that side; `vertex_at`
    /// returns the vertex of a cell if it is on this side.
    fn half(
        &self,
        places: &[Region],
        aggregates: &[usize],
        cells: &Lists<u32>,
        vertex_at: impl Fn((usize, usize)) -> Option<u32>,
    ) -> Graph {
        let fine = &self.all.graph;
        let count = aggregates.len();
        let mut half = Graph::with_capacity(fine.dim, count);
        let is_between = |aggregate: usize| places[aggregate] == Region::Between;
        let mut list: Vec<Edge> = Vec::new();
        for (vertex, &aggregate) in aggregates.iter().enumerate() {
            let members = cells.of(vertex);
            let is_cut = is_between(aggregate);
            let edges = self.graph.edges(aggregate);
            let mut outside = 0;
            if !is_cut {
                outside = self.graph.outside[aggregate];
                for edge in edges.iter().filter(|edge| !is_between(edge.to as usize)) {
                    match vertex_at((edge.to as usize, 0)) {
                        Some(to) => list.push(edge.towards(to)),
                        None => outside += edge.weight(),
                    }
                }
            }
            if is_cut || edges.iter().any(|edge| is_between(edge.to as usize)) {
                for edge in members.iter().flat_map(|&cell| fine.edges(cell as usize)) {
                    let at = self.find(edge.to);
                    if !is_cut && !at.is_some_and(|(aggregate, _)| is_between(aggregate)) {
                        continue;
                    }
                    match at.and_then(&vertex_at) {
                        Some(to) if to as usize == vertex => {}
                        Some(to) => match list.iter_mut().find(|known| known.to == to) {
                            Some(known) => *known = known.joined(edge),
                            None => list.push(edge.towards(to)),
                        },
                        None => outside += edge.weight(),
                    }
                }
                list.sort_unstable();
            }
            let (dofs, centre) = match members.len() == self.cells.of(aggregate).len() {
                true => (self.graph.dofs[aggregate], self.graph.centres[aggregate]),
                false => fine.middle(members),
            };
            half.dofs.push(dofs);
            half.centres.push(centre);
            half.outside.push(outside);
            half.edges.push(list.drain(..));
        }
        half
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decompose::bisect::Effort;

    const AIM: Aim = Aim {
        share: 0.5,
        slack: 0.1,
        price: 0.1,
        with_metis: false,
        effort: Effort {
            directions: 2,
            sample: 256,
            layers: 2,
        },
    };

    /// The graph of a grid of squares, with contacts between two of the rows.
    fn squares(rows: u32, columns: u32) -> Graph {
        let at = |row: u32, column: u32| row * columns + column;
        let mut edges = Vec::new();
        let mut tie =
            |a: u32, b: u32, edge: Edge| edges.extend([(a, edge.towards(b)), (b, edge.towards(a))]);
        for row in 0..rows {
            for column in 0..columns {
                let own = at(row, column);
                if column + 1 < columns {
                    tie(own, own + 1, Edge::new(0, 256, true));
                }
                if row + 1 < rows {
                    tie(
                        own,
                        at(row + 1, column),
                        Edge::new(0, 256, row + 1 != rows / 2),
                    );
                }
            }
        }
        let count = (rows * columns) as usize;
        let mut edges = Lists::new(count, edges.into_iter());
        edges.sort();
        Graph {
            dim: 2,
            ids: (0..count as u32).collect(),
            dofs: vec![2.0; count],
            centres: (0..rows)
                .flat_map(|row| (0..columns).map(move |column| [column as f32, row as f32, 0.0]))
                .collect(),
            outside: vec![0; count],
            edges,
        }
    }

    /// Cuts a set and its halves several times, and passes each of them with the graph of its cells to `check`.
    fn cut(set: Aggregates, times: usize, check: &mut impl FnMut(&Aggregates, Graph)) {
        let in_set = |cell| set.find(cell).is_some();
        let left: Vec<bool> = set.all.graph.ids.iter().map(|&cell| in_set(cell)).collect();
        let [own, _] = set.all.graph.clone().halves(&left);
        check(&set, own);
        if times > 0 {
            let middle = |k: usize| {
                let mut all: Vec<f32> = set.graph.centres.iter().map(|c| c[k]).collect();
                all.sort_by(f32::total_cmp);
                all[all.len() / 2]
            };
            let (k, sum) = (times % 2, middle(times % 2));
            let left: Vec<bool> = set.graph.centres.iter().map(|c| c[k] < sum).collect();
            for half in set.halves(&left, AIM) {
                cut(half, times - 1, check);
            }
        }
    }

    #[test]
    fn aggregates_know_what_lies_between_their_cells_after_every_cut() {
        let cells = Cells::new(squares(40, 60));
        let mut cut_apart = 0;
        cut(cells.aggregates(), 4, &mut |set, own| {
            let number = |&cell: &u32| set.find(cell).unwrap().0 as u32;
            let aggregate: Vec<u32> = own.ids.iter().map(number).collect();
            let expected = own.contracted(&aggregate, set.graph.len());
            assert_eq!(set.graph.edges, expected.edges);
            assert_eq!(set.graph.outside, expected.outside);
            assert_eq!(set.graph.dofs, expected.dofs);
            for (centre, expected) in set.graph.centres.iter().zip(expected.centres) {
                (0..3).for_each(|k| assert!((centre[k] - expected[k]).abs() < 1e-4));
            }
            let facet = |a: usize, edge: &Edge| {
                edge.is_facet() && aggregate[a] == aggregate[edge.to as usize]
            };
            assert_eq!(
                own.parts(facet).1,
                set.graph.len(),
                "an aggregate is in several pieces"
            );
            cut_apart += usize::from(set.cells.iter().any(|cells| cells.len() < 4));
        });
        assert!(cut_apart > 10, "no cut runs through aggregates");
    }
}
