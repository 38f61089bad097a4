//! The springs of a subdomain, between nodes that share a cell.

use std::collections::HashSet;

use super::ProblemFile;
use super::subdomain::Slices;
use crate::element::Elements;
use crate::error::InputError;
use crate::model::SpringBlock;

impl ProblemFile {
    pub(super) fn take_springs(
        &self,
        slices: &Slices,
        index: usize,
        cells: &Elements,
    ) -> Result<Vec<SpringBlock>, InputError> {
        let rows = self.contents.rows('Y', index);
        let dim = self.catalog.dim;
        let (node, stiffness) = (&slices.spring_nodes, &slices.spring_stiffness);
        let (nodes, _) = node.of(rows.clone()).as_chunks::<2>();
        let sought: HashSet<[i64; 2]> = nodes.iter().copied().collect();
        let mut found = HashSet::new();
        for (_, of_cell) in cells.iter().filter(|_| !sought.is_empty()) {
            let of_cell = || of_cell.iter().map(|&node| i64::from(node));
            let pairs = of_cell().flat_map(|a| of_cell().map(move |b| [a, b]));
            found.extend(pairs.filter(|pair| sought.contains(pair)));
        }
        let blocks = stiffness.of(rows.clone()).chunks_exact(dim * dim);
        let conditions = slices.spring_conditions.of(rows.clone());
        let mut springs = Vec::with_capacity(rows.len());
        for (((row, pair), block), &condition) in rows.zip(nodes).zip(blocks).zip(conditions) {
            if !found.contains(pair) {
                return Err(node.error(row, "expected two nodes of one cell of the subdomain"));
            }
            let mut k = [[0.0; 3]; 3];
            for (k, row) in k.iter_mut().zip(block.chunks_exact(dim)) {
                k[..dim].copy_from_slice(row);
            }
            let differs = |i: usize, j: usize| k[i][j] != k[j][i];
            let is_unsymmetric = (0..dim).any(|i| (0..i).any(|j| differs(i, j)));
            if pair[0] == pair[1] && is_unsymmetric {
                return Err(stiffness.error(row, "expected a symmetric block of a node"));
            }
            springs.push(SpringBlock {
                nodes: pair.map(|node| node as u32),
                stiffness: k,
                condition: condition as u32,
            });
        }
        Ok(springs)
    }
}
