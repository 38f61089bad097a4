//! Nested dissection: the tree of recursive bisections.

use super::aggregates::{Aggregates, Cells};
use super::bisect::{Aim, Effort, LARGE, bisect};
use super::graph::Graph;
use crate::problem::Hierarchy;

/// Total number of vertices, or aggregates, of all graphs passed to METIS, which takes some microseconds for each.
const METIS_VERTICES: usize = 300_000;

/// Number of vertices above which aggregates are dissected.
const AGGREGATEED: usize = 40_000;

/// Effort of the search for cuts; the second one is for small sets of aggregates, of which there are many.
const CAREFUL: Effort = Effort {
    directions: 4,
    sample: 1024,
    layers: 4,
};
const QUICK: Effort = Effort {
    directions: 2,
    sample: 256,
    layers: 3,
};

/// Ratio of the largest set with a cut through pieces to that with pieces kept whole, above which pieces are kept
/// whole.
const CROOKED: f64 = 1.2;

/// Number of levels that many ranks can process in parallel.
const PARALLEL_LEVELS: usize = 4;

/// Largest deviation of a side from its share of the dofs, and the cost of that deviation relative to the flops under a
/// cut: for a prescribed number of subdomains, on levels with work for many ranks, and below.
const EXACT: (f64, f64) = (0.03, 1.0);
const ABOVE: (f64, f64) = (0.08, 0.1);
const BELOW: (f64, f64) = (0.15, 0.02);

/// Number of dofs above which both sides of a cut are dissected in parallel.
const PARALLEL: f64 = 50_000.0;

/// Number of vertices below which fragments that a cut disconnects from a side move to the other side; in larger sets
/// later cuts take care of them.
const FRAGMENTS_MOVE_BELOW: usize = 50_000;

/// The condition at which a dissection ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Wanted {
    /// Sets of at most this many dofs, or single vertices.
    Dofs(f64),
    /// Exactly this many sets that are connected across facets.
    Sets(usize),
}

/// A set of vertices with all cuts through it.
#[derive(Clone, Debug)]
pub(super) enum Branch {
    /// A set that isn't cut further, by the ids of its vertices.
    Leaf(Vec<u32>),
    /// The sides of a cut, and whether edges cross it; or the pieces of a set.
    Inner(Vec<Branch>, bool),
}

impl Branch {
    /// Number of leaves.
    pub fn leaves(&self) -> usize {
        match self {
            Self::Leaf(_) => 1,
            Self::Inner(sides, _) => sides.iter().map(Self::leaves).sum(),
        }
    }

    /// The tree by numbers; `number` returns that of a leaf, and is called depth first. Unconnected sides at the top
    /// become separate roots.
    pub fn hierarchy(&self, mut number: impl FnMut(&[u32]) -> u32) -> Hierarchy {
        let mut parent = vec![None; self.leaves()];
        self.add_to_hierarchy(true, &mut number, &mut parent);
        Hierarchy {
            parent,
            clusters: Vec::new(),
        }
    }

    /// Numbers the descendants, and returns the children of the next node above: the branch itself, or its sides.
    fn add_to_hierarchy(
        &self,
        is_top: bool,
        number: &mut impl FnMut(&[u32]) -> u32,
        parent: &mut Vec<Option<u32>>,
    ) -> Vec<u32> {
        let (sides, is_joined) = match self {
            Self::Leaf(ids) => return vec![number(ids)],
            Self::Inner(sides, is_joined) => (sides, *is_joined),
        };
        let is_left_out = is_top && !is_joined;
        let under = sides
            .iter()
            .map(|side| side.add_to_hierarchy(is_left_out, number, parent));
        let under: Vec<u32> = under.collect::<Vec<_>>().concat();
        if is_left_out {
            return under;
        }
        let own = parent.len() as u32;
        parent.push(None);
        for node in under {
            parent[node as usize] = Some(own);
        }
        vec![own]
    }
}

/// Dissects a graph of at least one vertex. For [`Wanted::Sets`] the number lies between those of pieces and of
/// vertices.
pub(super) fn dissect(graph: Graph, wanted: Wanted) -> Branch {
    match wanted {
        Wanted::Dofs(most) if most > 0.0 && graph.len() > AGGREGATEED => {
            let cells = Cells::new(graph);
            branch(
                Set::Aggregates(cells.aggregates()),
                wanted,
                0,
                METIS_VERTICES,
            )
        }
        _ => branch(Set::Vertices(graph), wanted, 0, METIS_VERTICES),
    }
}

/// The set to be dissected.
enum Set<'a> {
    /// Vertices of a graph.
    Vertices(Graph),
    /// Aggregates of vertices, for large graphs.
    Aggregates(Aggregates<'a>),
}

impl Set<'_> {
    fn graph(&self) -> &Graph {
        match self {
            Self::Vertices(graph) => graph,
            Self::Aggregates(aggregates) => &aggregates.graph,
        }
    }

    /// The sides of a cut.
    fn halves(self, left: &[bool], aim: Aim) -> [Self; 2] {
        match self {
            Self::Vertices(graph) => graph.halves(left).map(Self::Vertices),
            Self::Aggregates(aggregates) => aggregates.halves(left, aim).map(Self::Aggregates),
        }
    }

    /// The ids of the items that a vertex of the graph represents.
    fn ids(&self, vertex: usize) -> &[u32] {
        match self {
            Self::Vertices(graph) => &graph.ids[vertex..=vertex],
            Self::Aggregates(aggregates) => aggregates.cells.of(vertex),
        }
    }
}

fn branch(set: Set, wanted: Wanted, level: usize, for_metis: usize) -> Branch {
    let graph = set.graph();
    let is_leaf = match wanted {
        Wanted::Dofs(most) => graph.len() == 1 || graph.size() <= most,
        Wanted::Sets(count) => count == 1,
    };
    if is_leaf {
        return leaf(&set);
    }
    let asked = graph.len().min(LARGE);
    let with_metis = asked <= for_metis;
    let (share, slack, price) = match wanted {
        Wanted::Sets(count) => {
            let share = (count / 2) as f64 / count as f64;
            (share, EXACT.0.min(share / 2.0), EXACT.1)
        }
        Wanted::Dofs(_) if level < PARALLEL_LEVELS => (0.5, ABOVE.0, ABOVE.1),
        Wanted::Dofs(_) => (0.5, BELOW.0, BELOW.1),
    };
    let aim = Aim {
        share,
        slack,
        price,
        with_metis,
        effort: match &set {
            Set::Aggregates(_) if level >= PARALLEL_LEVELS => QUICK,
            _ => CAREFUL,
        },
    };
    let left = sides(graph, aim, wanted);
    let rest = (for_metis - if with_metis { asked } else { 0 }) / 2;
    let is_large = graph.size() >= PARALLEL;
    let [a, b] = set.halves(&left, aim);
    let (of_a, of_b) = (a.graph(), b.graph());
    let is_joined = of_a
        .outside
        .iter()
        .chain(&of_b.outside)
        .any(|&weight| weight > 0);
    let wanted = wanted_of_halves(wanted, of_a, of_b);
    let sides = match is_large {
        false => vec![
            branch(a, wanted[0], level + 1, rest),
            branch(b, wanted[1], level + 1, rest),
        ],
        true => std::thread::scope(|scope| {
            let other = scope.spawn(|| branch(b, wanted[1], level + 1, rest));
            let one = branch(a, wanted[0], level + 1, rest);
            match other.join() {
                Ok(other) => vec![one, other],
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }),
    };
    Branch::Inner(sides, is_joined)
}

/// The end conditions of both halves of a graph, from that of the whole.
fn wanted_of_halves(wanted: Wanted, of_a: &Graph, of_b: &Graph) -> [Wanted; 2] {
    match wanted {
        Wanted::Sets(count) => {
            let (in_a, in_b) = (of_a.sizes_of_pieces(), of_b.sizes_of_pieces());
            let shares = sets_of_pieces(&[&in_a[..], &in_b].concat(), count);
            let share = shares[..in_a.len()].iter().sum::<usize>();
            let least = in_a.len().max(count.saturating_sub(of_b.len()));
            let most = of_a.len().min(count - in_b.len());
            let of_a = share.clamp(least, most);
            [Wanted::Sets(of_a), Wanted::Sets(count - of_a)]
        }
        dofs => [dofs; 2],
    }
}

/// The pieces of a set that isn't cut further.
fn leaf(set: &Set) -> Branch {
    let graph = set.graph();
    let (piece, count) = graph.pieces();
    let mut members = vec![Vec::new(); count];
    for (vertex, &piece) in piece.iter().enumerate() {
        members[piece as usize].extend(set.ids(vertex));
    }
    let mut leaves: Vec<Branch> = members.into_iter().map(Branch::Leaf).collect();
    if leaves.len() == 1 {
        return leaves.swap_remove(0);
    }
    let is_tied = graph.outside.iter().any(|&weight| weight > 0);
    let (_, parts) = graph.parts(|_, _| true);
    Branch::Inner(leaves, is_tied || parts < count)
}

/// The sides of a cut: disconnected parts of the graph, pieces that are linked only by contacts, or the result of
/// [`bisect`].
fn sides(graph: &Graph, aim: Aim, wanted: Wanted) -> Vec<bool> {
    let (part, count) = graph.parts(|_, _| true);
    if count > 1 {
        return whole(graph, &part, count, aim);
    }
    let mut left = bisect(graph, aim);
    let Wanted::Sets(sets) = wanted else {
        return match graph.len() < FRAGMENTS_MOVE_BELOW {
            true => with_connected_pieces(graph, left),
            false => left,
        };
    };
    left = with_connected_pieces(graph, left);
    let (piece, count) = graph.pieces();
    if count == 1 {
        return left;
    }
    let together = |vertex: usize, to: u32| left[vertex] == left[to as usize];
    let (part, parts) = graph.parts(|vertex, edge| edge.is_facet() && together(vertex, edge.to));
    let largest = |labels: &[u32], count: usize| {
        let sizes = graph.sizes_of(labels, count);
        let shares = sets_of_pieces(&sizes, sets);
        let means = sizes.iter().zip(shares);
        means.fold(0.0, |most: f64, (size, share)| {
            most.max(size / share as f64)
        })
    };
    match parts > sets || largest(&part, parts) > CROOKED * largest(&piece, count) {
        true => whole(graph, &piece, count, aim),
        false => left,
    }
}

/// Distribution of `count` sets among pieces: one each, and every further one to the piece with the largest sets.
fn sets_of_pieces(sizes: &[f64], count: usize) -> Vec<usize> {
    let mut shares = vec![1; sizes.len()];
    for _ in sizes.len()..count {
        let size = |i: usize| sizes[i] / shares[i] as f64;
        let next = (0..sizes.len()).max_by(|&a, &b| size(a).total_cmp(&size(b)).then(b.cmp(&a)));
        if let Some(next) = next {
            shares[next] += 1;
        }
    }
    shares
}

/// The sides of a cut that doesn't split vertices of equal labels.
fn whole(graph: &Graph, labels: &[u32], count: usize, aim: Aim) -> Vec<bool> {
    let left = bisect(&graph.contracted(labels, count), aim);
    labels.iter().map(|&label| left[label as usize]).collect()
}

/// The cut, changed so that each piece of the graph stays connected on either side.
fn with_connected_pieces(graph: &Graph, mut left: Vec<bool>) -> Vec<bool> {
    let (piece, count) = graph.pieces();
    for side in [true, false] {
        let together = |vertex: usize, to: u32| left[vertex] == left[to as usize];
        let (part, parts) = graph.parts(|v, edge| edge.is_facet() && together(v, edge.to));
        let mut dofs = vec![0.0f64; parts];
        for (vertex, &part) in part.iter().enumerate() {
            dofs[part as usize] += f64::from(graph.dofs[vertex]);
        }
        let mut largest = vec![(0.0, u32::MAX); count];
        for vertex in (0..graph.len()).filter(|&vertex| left[vertex] == side) {
            let largest = &mut largest[piece[vertex] as usize];
            let dofs = dofs[part[vertex] as usize];
            if dofs > largest.0 {
                *largest = (dofs, part[vertex]);
            }
        }
        for vertex in 0..graph.len() {
            if left[vertex] == side && part[vertex] != largest[piece[vertex] as usize].1 {
                left[vertex] = !side;
            }
        }
    }
    left
}
