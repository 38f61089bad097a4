//! The minimum cut between two sides of a graph, by a maximum flow from one to the other (Dinic 1970).

use super::graph::Graph;

/// Region of a vertex: fixed on a side, or free between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Region {
    Left,
    Between,
    Right,
}

/// An edge of the network, stored at one of its ends.
#[derive(Clone, Copy)]
struct Arc {
    to: u32,
    /// The index of the same edge at its other end.
    reverse: u32,
    /// Residual capacity.
    capacity: u32,
}

/// The vertices between the sides.
struct Network {
    /// Start of the arcs of every vertex, and the end of the last.
    starts: Vec<u32>,
    arcs: Vec<Arc>,
    /// Residual capacity from the left side to every vertex, and from there to the right side.
    supply: Vec<u32>,
    demand: Vec<u32>,
}

/// Marks the distance of vertices that the search didn't reach.
const FAR: u32 = u32::MAX;

/// The minimum cuts between the `Left` and the `Right` region: for each vertex whether it is on the left, in the cut
/// nearest to the left side and in that nearest to the right side.
pub(super) fn cheapest_cuts(graph: &Graph, places: &[Region]) -> [Vec<bool>; 2] {
    let between: Vec<u32> = (0..graph.len() as u32)
        .filter(|&vertex| places[vertex as usize] == Region::Between)
        .collect();
    let mut network = Network::new(graph, places, &between);
    while network.augment() {}
    let from_left = network.reached(|network, vertex| network.supply[vertex] > 0, false);
    let from_right = network.reached(|network, vertex| network.demand[vertex] > 0, true);
    let fixed: Vec<bool> = places.iter().map(|&place| place == Region::Left).collect();
    let mut cuts = [fixed.clone(), fixed];
    for (at, &vertex) in between.iter().enumerate() {
        cuts[0][vertex as usize] = from_left[at];
        cuts[1][vertex as usize] = !from_right[at];
    }
    cuts
}

impl Network {
    fn new(graph: &Graph, places: &[Region], between: &[u32]) -> Self {
        let mut number = vec![FAR; graph.len()];
        for (at, &vertex) in (0..).zip(between) {
            number[vertex as usize] = at;
        }
        let mut network = Self {
            starts: vec![0],
            arcs: Vec::with_capacity(4 * between.len()),
            supply: vec![0; between.len()],
            demand: vec![0; between.len()],
        };
        // The lists of edges ascend, so that arcs to smaller vertices appear in the order of this loop.
        let mut next = Vec::with_capacity(between.len());
        for (at, &vertex) in between.iter().enumerate() {
            next.push(network.arcs.len() as u32);
            for edge in graph.edges(vertex as usize) {
                match places[edge.to as usize] {
                    Region::Left => network.supply[at] += edge.weight(),
                    Region::Right => network.demand[at] += edge.weight(),
                    Region::Between => {
                        let to = number[edge.to as usize];
                        let own = network.arcs.len() as u32;
                        let mut reverse = 0;
                        if (to as usize) < at {
                            reverse = next[to as usize];
                            while network.arcs[reverse as usize].to != at as u32 {
                                reverse += 1;
                            }
                            next[to as usize] = reverse + 1;
                            network.arcs[reverse as usize].reverse = own;
                        }
                        network.arcs.push(Arc {
                            to,
                            reverse,
                            capacity: edge.weight(),
                        });
                    }
                }
            }
            let through = network.supply[at].min(network.demand[at]);
            network.supply[at] -= through;
            network.demand[at] -= through;
            network.starts.push(network.arcs.len() as u32);
        }
        network
    }

    fn arcs_of(&self, vertex: usize) -> std::ops::Range<usize> {
        self.starts[vertex] as usize..self.starts[vertex + 1] as usize
    }

    /// The vertices reachable from those for which `starts` is true, along arcs or, with `backwards`, against them.
    fn reached(&self, starts: impl Fn(&Self, usize) -> bool, backwards: bool) -> Vec<bool> {
        let mut reached: Vec<bool> = (0..self.supply.len()).map(|v| starts(self, v)).collect();
        let mut stack: Vec<usize> = (0..reached.len()).filter(|&v| reached[v]).collect();
        while let Some(vertex) = stack.pop() {
            for arc in &self.arcs[self.arcs_of(vertex)] {
                let capacity = match backwards {
                    true => self.arcs[arc.reverse as usize].capacity,
                    false => arc.capacity,
                };
                let to = arc.to as usize;
                if capacity > 0 && !reached[to] {
                    reached[to] = true;
                    stack.push(to);
                }
            }
        }
        reached
    }

    /// Augments the flow along shortest paths; true if there was any.
    fn augment(&mut self) -> bool {
        let mut level = vec![FAR; self.supply.len()];
        let mut queue: Vec<u32> = (0..level.len() as u32)
            .filter(|&v| self.supply[v as usize] > 0)
            .collect();
        for &vertex in &queue {
            level[vertex as usize] = 0;
        }
        let sources = queue.len();
        let mut last = FAR;
        let mut at = 0;
        while at < queue.len() {
            let vertex = queue[at] as usize;
            at += 1;
            if level[vertex] >= last {
                break;
            }
            if self.demand[vertex] > 0 {
                last = level[vertex];
                continue;
            }
            for arc in &self.arcs[self.arcs_of(vertex)] {
                if arc.capacity > 0 && level[arc.to as usize] == FAR {
                    level[arc.to as usize] = level[vertex] + 1;
                    queue.push(arc.to);
                }
            }
        }
        if last == FAR {
            return false;
        }
        let mut next: Vec<u32> = self.starts[..level.len()].to_vec();
        let mut path: Vec<u32> = Vec::new();
        for &source in &queue[..sources] {
            self.push_from(source as usize, &mut level, &mut next, &mut path);
        }
        true
    }

    /// Pushes a blocking flow from one source along the levels; `next` has the first arc of every vertex that may still
    /// lead to the sink.
    fn push_from(
        &mut self,
        source: usize,
        level: &mut [u32],
        next: &mut [u32],
        path: &mut Vec<u32>,
    ) {
        path.clear();
        let mut vertex = source;
        while self.supply[source] > 0 {
            if self.demand[vertex] > 0 {
                let least = path.iter().map(|&a| self.arcs[a as usize].capacity);
                let flow = least.fold(self.supply[source].min(self.demand[vertex]), u32::min);
                self.supply[source] -= flow;
                self.demand[vertex] -= flow;
                let mut full = path.len();
                for (place, &a) in path.iter().enumerate().rev() {
                    let reverse = self.arcs[a as usize].reverse as usize;
                    self.arcs[reverse].capacity += flow;
                    self.arcs[a as usize].capacity -= flow;
                    if self.arcs[a as usize].capacity == 0 {
                        full = place;
                    }
                }
                if let Some(&a) = path.get(full) {
                    let reverse = self.arcs[a as usize].reverse as usize;
                    vertex = self.arcs[reverse].to as usize;
                    path.truncate(full);
                }
                continue;
            }
            let end = self.starts[vertex + 1];
            let leads_on = (next[vertex]..end).find(|&a| {
                let arc = self.arcs[a as usize];
                arc.capacity > 0 && level[arc.to as usize] == level[vertex].saturating_add(1)
            });
            match leads_on {
                Some(a) => {
                    next[vertex] = a;
                    path.push(a);
                    vertex = self.arcs[a as usize].to as usize;
                }
                None => {
                    next[vertex] = end;
                    level[vertex] = FAR;
                    let Some(a) = path.pop() else { return };
                    let reverse = self.arcs[a as usize].reverse as usize;
                    vertex = self.arcs[reverse].to as usize;
                }
            }
        }
    }
}
