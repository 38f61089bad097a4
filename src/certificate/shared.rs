//! The check of nodes that blocks share: residuals are summed over them, displacements compared.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use super::most::Most;
use crate::schur::condensed::InterfaceDof;
use crate::vector::larger;

/// Contribution of a block to the check of nodes on Γ.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SharedCheck {
    /// Traces of the block on Γ.
    pub(super) trace_dofs: Vec<InterfaceDof>,
    /// Residual on these traces, to be summed over the blocks that share them.
    #[serde(with = "crate::bytes")]
    pub(super) residual: Vec<f64>,
    #[serde(with = "crate::bytes")]
    pub(super) scale: Vec<f64>,
    /// The nodes, and their displacements.
    pub(super) nodes: Vec<u32>,
    #[serde(with = "crate::bytes")]
    pub(super) displacement: Vec<f64>,
}

impl SharedCheck {
    /// Splits the check into `count` parts by nodes, each node always in the same part.
    pub fn parts(self, count: usize) -> Vec<Self> {
        if count == 1 {
            return vec![self];
        }
        let mut parts = vec![Self::default(); count];
        let traces = self.trace_dofs.into_iter().zip(self.residual);
        for ((dof, residual), scale) in traces.zip(self.scale) {
            let part = &mut parts[dof.node as usize % count];
            part.trace_dofs.push(dof);
            part.residual.push(residual);
            part.scale.push(scale);
        }
        let dim = self.displacement.len() / self.nodes.len().max(1);
        for (node, u) in (self.nodes.into_iter()).zip(self.displacement.chunks(dim.max(1))) {
            let part = &mut parts[node as usize % count];
            part.nodes.push(node);
            part.displacement.extend(u);
        }
        parts
    }
}

/// Largest values at the nodes of `checks`, in the order of blocks: the residual and its scale, and the jump of the
/// displacement.
pub fn at_shared_nodes<'a>(checks: impl Iterator<Item = &'a SharedCheck>) -> Most {
    let mut sums: HashMap<InterfaceDof, [f64; 2]> = HashMap::new();
    let mut known: HashMap<u32, &[f64]> = HashMap::new();
    let mut most = Most::default();
    for check in checks {
        let traces = check.trace_dofs.iter().zip(&check.residual);
        for ((&dof, residual), scale) in traces.zip(&check.scale) {
            let sum = sums.entry(dof).or_default();
            sum[0] += residual;
            sum[1] += scale;
        }
        let dim = check.displacement.len() / check.nodes.len().max(1);
        for (&node, u) in check
            .nodes
            .iter()
            .zip(check.displacement.chunks(dim.max(1)))
        {
            let first = known.entry(node).or_insert(u);
            for (a, b) in first.iter().zip(u) {
                most.jump = larger(most.jump, a - b);
            }
        }
    }
    for [residual, scale] in sums.into_values() {
        most.residual = larger(most.residual, residual);
        most.scale = larger(most.scale, scale);
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(nodes: &[u32], value: f64) -> SharedCheck {
        let dofs = nodes.iter().flat_map(|&node| {
            let dof = |axis| InterfaceDof { node, axis };
            [dof(0), dof(1)]
        });
        let values = |scale: f64| (0..2 * nodes.len()).map(move |i| scale * (value + i as f64));
        SharedCheck {
            trace_dofs: dofs.collect(),
            residual: values(1.0).collect(),
            scale: values(10.0).collect(),
            nodes: nodes.to_vec(),
            displacement: values(0.1).collect(),
        }
    }

    #[test]
    fn residuals_are_summed_and_displacements_compared_in_whatever_parts() {
        let checks = [
            check(&[0, 5, 3], 1.0),
            check(&[5, 7], -6.0),
            check(&[3], -9.0),
        ];
        let whole = at_shared_nodes(checks.iter());
        // Node 0: 1, 2; node 5: 3 - 6, 4 - 5; node 3: 5 - 9, 6 - 8; node 7: -4, -3.
        assert_eq!((whole.residual, whole.scale), (4.0, 40.0));
        assert!((whole.jump - 1.4).abs() < 1e-12, "{}", whole.jump);
        for count in [2, 3, 8] {
            let split: Vec<Vec<SharedCheck>> = checks
                .iter()
                .map(|check| check.clone().parts(count))
                .collect();
            let mut most = Most::default();
            for part in 0..count {
                most.include(at_shared_nodes(split.iter().map(|parts| &parts[part])));
            }
            assert_eq!(most, whole);
        }
    }
}
