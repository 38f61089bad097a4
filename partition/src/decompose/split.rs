//! The partition of one region into subdomains.

use super::graph::Graph;
use super::multilevel::Request;
use super::regions::Regions;

/// What a contact patch weighs beside its cells, in shares of a subdomain's mean weight: the layers in
/// contact become thinner and their subdomains cheaper, as all of a pair is factorized together.
const LAYERS: [f64; 3] = [0.5, 0.65, 0.4];

/// Number of tries with each: every other one by recursive bisection, the rest k-way.
const SEEDS: usize = 4;

/// Contraction times tries times doublings of parts that may be spent; large meshes need fewer tries.
const BUDGET: usize = 5_000_000;

/// How much heavier than the mean METIS may make a part, in thousandths.
const SLACK: i32 = 40;

/// METIS isn't asked for parts of fewer vertices than these.
const FEWEST_VERTICES: usize = 8;

/// Splits the graph of a region into exactly `count` connected parts; `count` is at least one and at most the
/// number of vertices. Returns the part of every vertex.
pub(super) fn split(graph: &Graph, count: usize) -> Vec<u32> {
    if count == 1 {
        return vec![0; graph.len()];
    }
    let multilevel = graph.len() >= FEWEST_VERTICES * count;
    let seeds = if multilevel { SEEDS } else { 1 };
    let doublings = 1 + count.ilog2() as usize;
    let tries = (BUDGET / (graph.len() * doublings)).clamp(1, LAYERS.len() * seeds);
    let mut best: Option<(Score, Vec<u32>)> = None;
    for number in 0..tries {
        let weights = weights(graph, count, LAYERS[number % LAYERS.len()]);
        let request = Request {
            edges: &graph.edges,
            weights: &weights,
            parts: count,
            slack: SLACK,
            seed: number as u32,
        };
        // The boundaries of recursive bisection run straight through the whole region, so that the
        // hierarchy has smaller fronts; k-way cuts less where there are few parts.
        let parts = match (multilevel, number % 2) {
            (false, _) => None,
            (true, 0) => request.recursive(),
            (true, _) => request.k_way(),
        };
        let parts = parts.unwrap_or_else(|| vec![0; graph.len()]);
        let mut regions = Regions::of_parts(graph, &weights, &parts);
        regions.adjust(count);
        let score = Score::new(graph, &regions);
        if best.as_ref().is_none_or(|(least, _)| score < *least) {
            best = Some((score, regions.parts()));
        }
    }
    best.map_or_else(Vec::new, |(_, parts)| parts)
}

/// The cells of every vertex, and what a contact patch weighs beside them: no more than one subdomain, or
/// METIS would plan several where there is one vertex.
fn weights(graph: &Graph, count: usize, layer: f64) -> Vec<u64> {
    let mean = graph.size() as f64 / count as f64;
    let extra = (layer * mean).round() as u64;
    (0..graph.len() as u32)
        .map(|vertex| {
            let cells = u64::from(graph.cells[vertex as usize]);
            match graph.is_contact_patch(vertex) {
                true => (cells + extra).min(mean as u64).max(1),
                false => cells,
            }
        })
        .collect()
}

/// How bad a partition is; contact patches that share a part count first.
#[derive(PartialEq, PartialOrd)]
struct Score {
    crowded: usize,
    cost: f64,
}

impl Score {
    /// Cost: the largest part's over the mean, where a part in contact counts one half more, plus
    /// the cut against that of squares.
    fn new(graph: &Graph, regions: &Regions) -> Self {
        let count = regions.members().len();
        let mut crowded = 0;
        let mut largest = 0.0f64;
        for (region, members) in regions.members().iter().enumerate() {
            let contact_patches = regions.contact_patches(region);
            crowded += contact_patches.saturating_sub(1);
            let cells: u64 = members
                .iter()
                .map(|&a| u64::from(graph.cells[a as usize]))
                .sum();
            let share = if contact_patches > 0 { 1.5 } else { 1.0 };
            largest = largest.max(share * cells as f64);
        }
        let size = graph.size() as f64;
        let squares = 4.0 * (size * count as f64).sqrt();
        Self {
            crowded,
            cost: largest * count as f64 / size + 0.5 * regions.cut() as f64 / squares,
        }
    }
}
