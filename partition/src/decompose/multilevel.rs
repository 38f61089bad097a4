//! The call of METIS.

use std::sync::{Mutex, PoisonError};

use metis::Idx;
use metis::option::{Contig, Seed, UFactor};

use super::graph::Graph;

/// METIS draws from the C library's one generator: two calls at once would disturb each other.
static GENERATOR: Mutex<()> = Mutex::new(());

/// Largest sum of weights that METIS is given; its integers have 32 bits.
const LARGEST_SUM: u64 = 1 << 30;

/// Splits a graph into about `parts` parts of like weight, deterministically for each `seed`;
/// parts may be empty or disconnected. `None` where METIS gives up.
pub(super) fn partition(
    graph: &Graph,
    weights: &[u64],
    parts: usize,
    seed: u32,
) -> Option<Vec<u32>> {
    let n = graph.len();
    let index = |x: usize| Idx::try_from(x).ok();
    let mut offsets = Vec::with_capacity(n + 1);
    let mut neighbours = Vec::new();
    let mut edge_weights = Vec::new();
    offsets.push(0);
    for atom in 0..n as u32 {
        for &(next, weight) in graph.edges(atom) {
            neighbours.push(index(next as usize)?);
            edge_weights.push(index(weight as usize)?);
        }
        offsets.push(index(neighbours.len())?);
    }
    let shrink = weights.iter().sum::<u64>().div_ceil(LARGEST_SUM).max(1);
    let vertex_weights = weights
        .iter()
        .map(|&w| index((w / shrink).max(1) as usize))
        .collect::<Option<Vec<Idx>>>()?;
    let problem = metis::Graph::new(1, index(parts)?, &offsets, &neighbours)
        .ok()?
        .set_vwgt(&vertex_weights)
        .set_adjwgt(&edge_weights)
        .set_option(Seed(index(seed as usize)?))
        .set_option(UFactor(40));
    let mut part = vec![0; n];
    let guard = GENERATOR.lock().unwrap_or_else(PoisonError::into_inner);
    // Recursive bisection balances better, k-way cuts less and keeps parts connected.
    let result = match seed % 2 {
        0 => problem.set_option(Contig(true)).part_kway(&mut part),
        _ => problem.part_recursive(&mut part),
    };
    drop(guard);
    result.ok()?;
    Some(part.into_iter().map(|p| p as u32).collect())
}
