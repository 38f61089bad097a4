//! The dissection of the graph of blocks, top down.

use super::blocks::Blocks;
use super::cut::{Cut, Judge, Set};
use crate::decompose::multilevel::Request;
use crate::disjoint_sets::DisjointSets;
use crate::lists::Lists;

/// Sets of up to as many blocks are cut in all ways, and the best is taken.
const EXHAUSTIVE: usize = 8;

/// What METIS is asked for: how much heavier than the other one side may be, in thousandths.
const SLACKS: [i32; 3] = [20, 100, 300];

/// Groups that are tried as one side of a cut.
const GROUPS: usize = 4;

/// Blocks times passes that may be spent: the whole is dissected several times, with weights from
/// the tree before.
const BUDGET: usize = 3000;

/// Fewest and most passes.
const PASSES: [usize; 2] = [3, 12];

/// How much of the work under an inner node the larger side may have beyond one half.
const UNEVEN: f64 = 0.025;

/// Levels that many ranks can work on side by side.
const PARALLEL_LEVELS: usize = 3;

/// What an uneven cut costs, in flops under it, on those levels and below.
const PRICES: [f64; 2] = [1.0, 0.1];

/// Largest weight of a block for METIS.
const LARGEST_WEIGHT: f64 = 1e6;

/// A binary tree over blocks in the making.
pub(super) struct Dissection<'b> {
    blocks: &'b Blocks,
    edges: Lists<(u32, u32)>,
    judge: Judge<'b>,
    /// What each block costs with its part of the fronts above it in the last tree.
    weights: Vec<f64>,
    /// The same for the tree that grows.
    next_weights: Vec<f64>,
    /// The place of each block in the set that METIS is asked to cut.
    place: Vec<u32>,
    /// How often the connected part was dissected before.
    pass: u32,
    /// The children of the inner nodes, numbered behind the blocks.
    inner: Vec<[u32; 2]>,
}

/// A node of the tree with all that is under it.
#[derive(Clone, Copy, Default)]
struct Grown {
    number: u32,
    /// Estimated flops of all of it.
    work: f64,
    /// Estimated flops under each child.
    halves: [f64; 2],
}

impl<'b> Dissection<'b> {
    /// Dissects every connected part of the graph.
    pub fn new(blocks: &'b Blocks) -> Self {
        let costs: Vec<f64> = (0..blocks.len() as u32).map(|b| blocks.cost(b)).collect();
        let mut dissection = Self {
            blocks,
            edges: blocks.neighbours(),
            judge: Judge::new(blocks),
            next_weights: costs.clone(),
            weights: costs,
            place: vec![u32::MAX; blocks.len()],
            pass: 0,
            inner: Vec::new(),
        };
        for part in parts(blocks) {
            dissection.grow_best(&part);
        }
        dissection
    }

    /// The parent of every block and inner node.
    pub fn parents(&self) -> Vec<Option<u32>> {
        let blocks = self.blocks.len();
        let mut parents = vec![None; blocks + self.inner.len()];
        for (number, children) in (blocks as u32..).zip(&self.inner) {
            for &child in children {
                parents[child as usize] = Some(number);
            }
        }
        parents
    }

    /// Dissects a connected part several times, each time by weights that hold the fronts of the
    /// time before, and keeps the best tree: even halves first, then little work.
    fn grow_best(&mut self, part: &Set) {
        let start = self.inner.len();
        let mut least = (true, f64::INFINITY);
        let mut best = Vec::new();
        let passes = (BUDGET / part.blocks.len()).clamp(PASSES[0], PASSES[1]);
        for pass in 0..passes {
            self.pass = pass as u32;
            let Grown { work, halves, .. } = self.grow(part, 0);
            let tree = self.inner.split_off(start);
            let [left, right] = halves;
            let uneven = left.max(right) > (0.5 + UNEVEN) * (left + right);
            let badness = (uneven, work + PRICES[0] * (left - right).abs());
            if badness < least {
                (least, best) = (badness, tree);
            }
            for &block in &part.blocks {
                let cost = self.blocks.cost(block);
                let next = std::mem::replace(&mut self.next_weights[block as usize], cost);
                self.weights[block as usize] = next;
            }
        }
        self.inner.extend(best);
    }

    fn grow(&mut self, set: &Set, level: usize) -> Grown {
        let Some(cut) = self.best_cut(set, level) else {
            let number = set.blocks.first().copied().unwrap_or_default();
            let work = self.blocks.cost(number);
            return Grown {
                number,
                work,
                halves: [work, 0.0],
            };
        };
        let halves = self
            .judge
            .halves(set, &cut.left)
            .map(|half| self.grow(&half, level + 1));
        self.inner.push(halves.map(|half| half.number));
        let flops = cut.front.flops();
        if level > 0 {
            for &block in &set.blocks {
                self.next_weights[block as usize] += flops / set.blocks.len() as f64;
            }
        }
        let halves = halves.map(|half| half.work);
        Grown {
            number: (self.blocks.len() + self.inner.len() - 1) as u32,
            work: flops + halves[0] + halves[1],
            halves,
        }
    }

    /// The best cut that is found; `None` for a single block.
    fn best_cut(&mut self, set: &Set, level: usize) -> Option<Cut> {
        let count = set.blocks.len();
        let price = PRICES[usize::from(level >= PARALLEL_LEVELS)];
        let mut candidates: Vec<Vec<bool>> = Vec::new();
        if count <= EXHAUSTIVE {
            // The last block stays on the right, so that no cut is judged twice.
            let ways = 1..1usize << count.saturating_sub(1);
            candidates.extend(ways.map(|way| (0..count).map(|i| way >> i & 1 == 1).collect()));
        } else {
            // METIS may leave one side empty.
            candidates.push((0..count).map(|i| i < count / 2).collect());
            candidates.extend(self.metis(set));
            candidates.extend(self.with_most_conditions(set));
        }
        let cuts = candidates
            .into_iter()
            .map(|left| self.judge.judge(set, left, &self.weights, price));
        cuts.min_by(|a, b| a.score.total_cmp(&b.score))
    }

    /// Cuts that take one group away: its contact conditions stay in every front above it, so it
    /// may be merged best last.
    fn with_most_conditions(&self, set: &Set) -> Vec<Vec<bool>> {
        let conditions = |&place: &usize| self.blocks.conditions[set.blocks[place] as usize];
        let mut groups: Vec<usize> = (0..set.blocks.len()).collect();
        groups.retain(|place| conditions(place) > 0);
        groups.sort_by_key(|place| std::cmp::Reverse(conditions(place)));
        let alone = |&group: &usize| (0..set.blocks.len()).map(|i| i == group).collect();
        groups.iter().take(GROUPS).map(alone).collect()
    }

    fn metis(&mut self, set: &Set) -> Vec<Vec<bool>> {
        for (place, &block) in (0..).zip(&set.blocks) {
            self.place[block as usize] = place;
        }
        let inside = |&block: &u32| {
            let edges = self.edges.of(block as usize).iter();
            let edges = edges.map(|&(next, weight)| (self.place[next as usize], weight));
            edges.filter(|&(next, _)| next != u32::MAX)
        };
        let edges: Lists<_> = set.blocks.iter().map(inside).collect();
        for &block in &set.blocks {
            self.place[block as usize] = u32::MAX;
        }
        let weight = |&block: &u32| self.weights[block as usize];
        let largest = set.blocks.iter().map(weight).fold(1.0, f64::max);
        let scaled = |block| (weight(block) / largest * LARGEST_WEIGHT).max(1.0) as u64;
        let weights: Vec<u64> = set.blocks.iter().map(scaled).collect();
        let cuts = (0..).zip(SLACKS).filter_map(|(number, slack)| {
            let request = Request {
                edges: &edges,
                weights: &weights,
                parts: 2,
                slack,
                seed: number + self.pass * SLACKS.len() as u32,
            };
            request.recursive()
        });
        let cuts = cuts.map(|parts| parts.iter().map(|&part| part == 0).collect());
        cuts.filter(|left: &Vec<bool>| left.contains(&true) && left.contains(&false))
            .collect()
    }
}

/// The connected parts of the graph of blocks, in the order of their first blocks.
fn parts(blocks: &Blocks) -> Vec<Set> {
    let mut sets = DisjointSets::new(blocks.len());
    for list in blocks.sharing.iter() {
        for pair in list.windows(2) {
            sets.unite(pair[0], pair[1]);
        }
    }
    let mut number = vec![usize::MAX; blocks.len()];
    let mut parts: Vec<Set> = Vec::new();
    for block in 0..blocks.len() as u32 {
        let root = sets.find(block) as usize;
        if root == block as usize {
            number[root] = parts.len();
            parts.push(Set::default());
        }
        parts[number[root]].blocks.push(block);
    }
    for (seam, list) in (0..).zip(blocks.sharing.iter()) {
        parts[number[sets.find(list[0]) as usize]].seams.push(seam);
    }
    parts
}
