//! The order in which the interior nodes of a block are eliminated.

use std::collections::BTreeMap;

use super::block::Block;
use crate::contact::approach::{Approaches, Variable};
use crate::schur::ordering::nested_dissection;
use crate::schur::pattern::Cliques;

/// The order in which nodes with interior unknowns are eliminated.
pub(super) fn elimination_order(
    block: &Block,
    approaches: &Approaches,
    is_interior: impl Fn(u32) -> bool,
) -> Vec<u32> {
    let dim = block.dim;
    let mut site = vec![u32::MAX; block.nodes()];
    let mut nodes = Vec::new();
    for node in 0..block.nodes() as u32 {
        if is_interior(node) {
            site[node as usize] = nodes.len() as u32;
            nodes.push(node);
        }
    }
    let mut partners: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let mut has_partners = vec![false; block.nodes()];
    for (&raw, value) in &approaches.replaced {
        let node = raw / dim as u32;
        for &(variable, _) in &value.terms {
            if let Variable::Displacement(v) = variable {
                has_partners[node as usize] = true;
                partners.entry(node).or_default().push(v / dim as u32);
            }
        }
    }
    let mut cliques = Cliques::default();
    let mut list = Vec::new();
    for cell in block.cells() {
        list.clear();
        for node in cell.nodes() {
            list.push(site[node as usize]);
            if has_partners[node as usize] {
                list.extend(partners[&node].iter().map(|&p| site[p as usize]));
            }
        }
        list.retain(|&s| s != u32::MAX);
        list.sort_unstable();
        list.dedup();
        cliques.push(list.iter().copied());
    }
    let points: Vec<_> = nodes.iter().map(|&n| block.points[n as usize]).collect();
    nested_dissection(&points, &cliques)
        .into_iter()
        .map(|s| nodes[s as usize])
        .collect()
}
