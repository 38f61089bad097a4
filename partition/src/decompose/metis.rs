//! The call of METIS.

use std::sync::{Mutex, PoisonError};

use metis::Idx;
use metis::option::{Seed, UFactor};

use super::graph::Graph;

/// METIS draws from the C library's global generator, which concurrent calls would disturb.
static GENERATOR: Mutex<()> = Mutex::new(());

/// Largest sum of weights passed to METIS, whose integers have 32 bits.
const LARGEST_SUM: f64 = (1 << 30) as f64;

/// The weight of a dof, if the sum allows it.
const WEIGHT_OF_DOF: f64 = 16.0;

/// Largest excess weight of a side, in thousandths.
const SLACK: i32 = 60;

/// Bisects a graph with a small weight of the cut edges and `share` of the dofs on the left: for each vertex whether it
/// is on the left. Deterministic; `None` if METIS fails.
pub(super) fn bisection(graph: &Graph, share: f64) -> Option<Vec<bool>> {
    let index = |x: usize| Idx::try_from(x).ok();
    let mut offsets = Vec::with_capacity(graph.len() + 1);
    let mut neighbours = Vec::new();
    let mut edge_weights = Vec::new();
    offsets.push(0);
    for vertex in 0..graph.len() {
        for edge in graph.edges(vertex) {
            neighbours.push(index(edge.to as usize)?);
            edge_weights.push(index(edge.weight() as usize)?);
        }
        offsets.push(index(neighbours.len())?);
    }
    let scale = WEIGHT_OF_DOF.min(LARGEST_SUM / graph.size());
    let weights = graph.dofs.iter().map(|&dofs| f64::from(dofs) * scale);
    let weights: Vec<Idx> = weights.map(|weight| (weight as Idx).max(1)).collect();
    let shares = [share as f32, 1.0 - share as f32];
    let request = metis::Graph::new(1, 2, &offsets, &neighbours)
        .ok()?
        .set_vwgt(&weights)
        .set_adjwgt(&edge_weights)
        .set_tpwgts(&shares)
        .set_option(Seed(0))
        .set_option(UFactor(SLACK));
    let mut part = vec![0; graph.len()];
    let guard = GENERATOR.lock().unwrap_or_else(PoisonError::into_inner);
    let result = request.part_recursive(&mut part);
    drop(guard);
    result.ok()?;
    Some(part.into_iter().map(|part| part == 0).collect())
}
