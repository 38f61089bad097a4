//! Bisection of a graph.

use super::flow::{Region, cheapest_cuts};
use super::graph::Graph;
use super::metis;
use crate::flops::{Front, condensation};

/// Number of vertices up to which all bisections are tried, and the best is taken.
const EXHAUSTIVE: usize = 8;

/// Number of vertices above which a graph is first cut between aggregates.
pub(super) const LARGE: usize = 8000;

/// Number of vertices of an aggregate.
const AGGREGATE: usize = 8;

/// Fractional part of the golden ratio.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The aim of a cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim {
    /// The desired share of dofs on the left.
    pub share: f64,
    /// Largest deviation from the share.
    pub slack: f64,
    /// Cost of that deviation, relative to the flops under the cut.
    pub price: f64,
    /// True if METIS proposes a cut, too.
    pub with_metis: bool,
    /// Effort of the search.
    pub effort: Effort,
}

/// Effort of the search for a cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// Number of directions across which cuts of a set are tried.
    pub directions: usize,
    /// Largest number of vertices in the sample that evaluates a direction.
    pub sample: usize,
    /// Layers of aggregates on each side of a cut within which the cut is shortened.
    pub layers: u32,
}

/// A cut with its score; lower is better.
struct Cut {
    left: Vec<bool>,
    score: f64,
}

/// Bisects a connected graph of at least two vertices at low cost of the front that merges both sides and of the
/// subtrees under it. Returns for each vertex whether it is on the left.
///
/// A large graph is first cut between aggregates of its vertices, and the cut is then shortened among the vertices near
/// it.
pub(super) fn bisect(graph: &Graph, aim: Aim) -> Vec<bool> {
    let count = graph.len();
    let in_halves = || (0..count).map(|i| i < count.div_ceil(2)).collect();
    let candidates: Vec<Vec<bool>> = if count > LARGE {
        let (aggregate, aggregates) = graph.aggregates(AGGREGATE, |_| true);
        let coarse = graph.contracted(&aggregate, aggregates);
        let left = bisect(&coarse, aim);
        refined(graph, &coarse, &aggregate, left, aim)
    } else if count > EXHAUSTIVE {
        let mut candidates = geometric(graph, aim);
        candidates.extend(
            aim.with_metis
                .then(|| metis::bisection(graph, aim.share))
                .flatten(),
        );
        candidates
    } else {
        let choices = 1..(1usize << count) - 1;
        choices
            .map(|choice| (0..count).map(|i| choice >> i & 1 == 1).collect())
            .collect()
    };
    best(graph, candidates, aim).unwrap_or_else(in_halves)
}

/// The best of several cuts; `None` if each has an empty side.
pub(super) fn best(graph: &Graph, candidates: Vec<Vec<bool>>, aim: Aim) -> Option<Vec<bool>> {
    let cuts = candidates
        .into_iter()
        .filter_map(|left| Cut::new(graph, left, aim));
    let best = cuts.min_by(|a, b| a.score.total_cmp(&b.score));
    best.map(|cut| cut.left)
}

/// A cut between aggregates, and the cheapest cuts near it.
fn refined(
    graph: &Graph,
    coarse: &Graph,
    aggregate: &[u32],
    left: Vec<bool>,
    aim: Aim,
) -> Vec<Vec<bool>> {
    let band = band(coarse, &left, aim);
    let places: Vec<Region> = aggregate
        .iter()
        .map(|&aggregate| band[aggregate as usize])
        .collect();
    let mut cuts: Vec<Vec<bool>> = cheapest_cuts(graph, &places).into();
    cuts.push(
        aggregate
            .iter()
            .map(|&aggregate| left[aggregate as usize])
            .collect(),
    );
    cuts
}

/// The band between the sides: layers of vertices next to a cut, limited so that neither side can lose more than the
/// aim allows.
pub(super) fn band(graph: &Graph, left: &[bool], aim: Aim) -> Vec<Region> {
    let most = aim.slack * graph.size();
    let mut distance = vec![u32::MAX; graph.len()];
    let is_at_cut = |vertex: usize| {
        let mut edges = graph.edges(vertex).iter();
        edges.any(|edge| left[edge.to as usize] != left[vertex])
    };
    let mut near: Vec<usize> = (0..graph.len())
        .filter(|&vertex| is_at_cut(vertex))
        .collect();
    near.iter().for_each(|&vertex| distance[vertex] = 1);
    let mut given = [0.0; 2];
    let mut at = 0;
    while at < near.len() {
        let vertex = near[at];
        at += 1;
        let given = &mut given[usize::from(left[vertex])];
        *given += f64::from(graph.dofs[vertex]);
        if distance[vertex] >= aim.effort.layers || *given > most {
            continue;
        }
        for edge in graph.edges(vertex) {
            let to = edge.to as usize;
            if distance[to] == u32::MAX {
                distance[to] = distance[vertex] + 1;
                near.push(to);
            }
        }
    }
    let place = |(&distance, &left): (&u32, &bool)| match (distance, left) {
        (u32::MAX, true) => Region::Left,
        (u32::MAX, false) => Region::Right,
        _ => Region::Between,
    };
    distance.iter().zip(left).map(place).collect()
}

impl Cut {
    /// Evaluates a cut; `None` if a side is empty.
    fn new(graph: &Graph, left: Vec<bool>, aim: Aim) -> Option<Self> {
        let mut dofs = [0.0; 2];
        let mut outside = [0; 2];
        let mut cut = 0;
        for (vertex, &on_left) in left.iter().enumerate() {
            let side = usize::from(!on_left);
            dofs[side] += f64::from(graph.dofs[vertex]);
            outside[side] += u64::from(graph.outside[vertex]);
            if on_left {
                let across = graph
                    .edges(vertex)
                    .iter()
                    .filter(|edge| !left[edge.to as usize]);
                cut += across.map(|edge| u64::from(edge.weight())).sum::<u64>();
            }
        }
        let front = Front {
            eliminated: graph.dofs_of(cut) as usize,
            kept: graph.dofs_of(outside[0] + outside[1]) as usize,
        };
        let below: f64 = [0, 1]
            .map(|side| {
                let kept = graph.dofs_of(outside[side] + cut);
                condensation((dofs[side] - kept).max(0.0), kept, graph.dim)
            })
            .iter()
            .sum();
        let uneven = (dofs[0] / (dofs[0] + dofs[1]) - aim.share).abs() / aim.slack;
        let score = front.flops() + below * (1.0 + aim.price * uneven);
        (dofs[0] > 0.0 && dofs[1] > 0.0).then_some(Self { left, score })
    }
}

/// The cheapest cuts across the best of several directions.
fn geometric(graph: &Graph, aim: Aim) -> Vec<Vec<bool>> {
    let sample = sample(graph.len(), aim.effort.sample);
    let mut slabs: Vec<(u64, Slab)> = directions(graph, &sample)
        .into_iter()
        .map(|direction| Slab::new(graph, &sample, direction, aim))
        .map(|slab| (slab.price(graph, &sample), slab))
        .collect();
    slabs.sort_by_key(|&(price, _)| price);
    let tried = slabs.iter().take(aim.effort.directions);
    tried.flat_map(|(_, slab)| slab.cuts(graph)).collect()
}

/// A sample of at most `most` of `len` vertices, spread evenly: at multiples of the golden ratio, as equal strides
/// through a regular mesh would pick its vertices from few rows.
fn sample(len: usize, most: usize) -> Vec<usize> {
    if len <= most {
        return (0..len).collect();
    }
    let place = |k: usize| (k as f64 * GOLDEN).fract();
    (0..most)
        .map(|k| (place(k) * len as f64) as usize)
        .collect()
}

/// The axes, the diagonals between two of them, and the principal axes of a sample of the vertices.
fn directions(graph: &Graph, sample: &[usize]) -> Vec<[f32; 3]> {
    let dim = graph.dim;
    let axis = |k: usize| [0, 1, 2].map(|i| if i == k { 1.0 } else { 0.0 });
    let mut directions: Vec<[f32; 3]> = (0..dim).map(axis).collect();
    for i in 0..dim {
        for j in 0..i {
            for sign in [1.0, -1.0] {
                let mut diagonal = axis(i);
                diagonal[j] = sign;
                directions.push(diagonal);
            }
        }
    }
    let count = sample.len() as f32;
    let centres = || sample.iter().map(|&vertex| graph.centres[vertex]);
    let mean = centres().fold([0.0; 3], |sum, c| [0, 1, 2].map(|k| sum[k] + c[k] / count));
    let mut spread = nalgebra::Matrix3::<f32>::zeros();
    for centre in centres() {
        let offset = nalgebra::Vector3::from_fn(|k, _| centre[k] - mean[k]);
        spread += offset * offset.transpose();
    }
    let axes = spread.symmetric_eigen().eigenvectors;
    let in_space = axes.column_iter().map(|axis| [axis[0], axis[1], axis[2]]);
    // In the plane one principal axis points out of it.
    directions.extend(in_space.filter(|axis| dim == 3 || axis[2].abs() < 0.5));
    directions
}

/// Vertices between two parallel lines, or planes, across a direction.
struct Slab {
    direction: [f32; 3],
    /// Start of the range, position at which both sides have their share, and end.
    bounds: [f32; 3],
}

impl Slab {
    fn new(graph: &Graph, sample: &[usize], direction: [f32; 3], aim: Aim) -> Self {
        let along = |&vertex: &usize| (along(direction, graph.centres[vertex]), graph.dofs[vertex]);
        let mut places: Vec<(f32, f32)> = sample.iter().map(along).collect();
        places.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let all: f64 = places.iter().map(|&(_, dofs)| f64::from(dofs)).sum();
        let Aim { share, slack, .. } = aim;
        let mut sums = [share - slack, share, share + slack].map(|share| share * all);
        let mut bounds = [f32::INFINITY; 3];
        for (place, dofs) in places {
            for (sum, bound) in sums.iter_mut().zip(&mut bounds) {
                *sum -= f64::from(dofs);
                if *sum <= 0.0 && *bound == f32::INFINITY {
                    *bound = place;
                }
            }
        }
        Self { direction, bounds }
    }

    /// Cost of the straight cut at that position, estimated from a sample of the vertices.
    fn price(&self, graph: &Graph, sample: &[usize]) -> u64 {
        let is_left = |vertex| along(self.direction, graph.centres[vertex]) < self.bounds[1];
        let across = sample.iter().flat_map(|&vertex| {
            let edges = graph.edges(vertex).iter();
            let side = is_left(vertex);
            edges.filter(move |edge| is_left(edge.to as usize) != side)
        });
        across.map(|edge| u64::from(edge.weight())).sum()
    }

    /// The cheapest cuts within the slab.
    fn cuts(&self, graph: &Graph) -> [Vec<bool>; 2] {
        let place = |&centre: &[f32; 3]| match along(self.direction, centre) {
            place if place < self.bounds[0] => Region::Left,
            place if place > self.bounds[2] => Region::Right,
            _ => Region::Between,
        };
        let places: Vec<Region> = graph.centres.iter().map(place).collect();
        cheapest_cuts(graph, &places)
    }
}

fn along(direction: [f32; 3], centre: [f32; 3]) -> f32 {
    direction[0] * centre[0] + direction[1] * centre[1] + direction[2] * centre[2]
}
