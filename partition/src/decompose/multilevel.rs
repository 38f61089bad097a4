//! The call of METIS.

use std::sync::{Mutex, PoisonError};

use metis::Idx;
use metis::option::{Contig, Seed, UFactor};

use crate::lists::Lists;

/// METIS draws from the C library's one generator: two calls at once would disturb each other.
static GENERATOR: Mutex<()> = Mutex::new(());

/// Largest sum of weights that METIS is given; its integers have 32 bits.
const LARGEST_SUM: u64 = 1 << 30;

/// What METIS is to split. Parts may come out empty or disconnected.
pub(crate) struct Request<'a> {
    /// The neighbours of every vertex with the weight of the edge, both directions of each.
    pub edges: &'a Lists<(u32, u32)>,
    /// Weights of the vertices.
    pub weights: &'a [u64],
    /// Number of parts.
    pub parts: usize,
    /// How much heavier than the mean a part may be, in thousandths.
    pub slack: i32,
    /// The answer is the same for the same seed.
    pub seed: u32,
}

impl Request<'_> {
    /// Splits k-way, which cuts little and keeps parts connected where the graph is. `None` where
    /// METIS gives up.
    pub fn k_way(&self) -> Option<Vec<u32>> {
        self.ask(|problem, part| problem.set_option(Contig(true)).part_kway(part))
    }

    /// Splits by recursive bisection, which balances well. `None` where METIS gives up.
    pub fn recursive(&self) -> Option<Vec<u32>> {
        self.ask(|problem, part| problem.part_recursive(part))
    }

    fn ask(
        &self,
        call: impl FnOnce(metis::Graph<'_>, &mut [Idx]) -> metis::Result<Idx>,
    ) -> Option<Vec<u32>> {
        let index = |x: usize| Idx::try_from(x).ok();
        let vertices = self.edges.len();
        let mut offsets = Vec::with_capacity(vertices + 1);
        let mut neighbours = Vec::new();
        let mut edge_weights = Vec::new();
        offsets.push(0);
        for list in self.edges.iter() {
            for &(next, weight) in list {
                neighbours.push(index(next as usize)?);
                edge_weights.push(index(weight as usize)?);
            }
            offsets.push(index(neighbours.len())?);
        }
        let shrink = self
            .weights
            .iter()
            .sum::<u64>()
            .div_ceil(LARGEST_SUM)
            .max(1);
        let weights = (self.weights.iter())
            .map(|&w| index((w / shrink).max(1) as usize))
            .collect::<Option<Vec<Idx>>>()?;
        let problem = metis::Graph::new(1, index(self.parts)?, &offsets, &neighbours)
            .ok()?
            .set_vwgt(&weights)
            .set_adjwgt(&edge_weights)
            .set_option(Seed(index(self.seed as usize)?))
            .set_option(UFactor(self.slack));
        let mut part = vec![0; vertices];
        let guard = GENERATOR.lock().unwrap_or_else(PoisonError::into_inner);
        let result = call(problem, &mut part);
        drop(guard);
        result.ok()?;
        Some(part.into_iter().map(|p| p as u32).collect())
    }
}
