//! Which nodes of side a carry a multiplier, and with what weight on each facet.

use std::collections::{HashMap, HashSet};

use nalgebra::DMatrix;

use super::super::sides::Sides;
use super::Covered;
use super::cover::Sample;
use super::dual::{dual_basis, integral};

/// Share of what is covered around a node that the integral of its shape function over it has to
/// have for the node to carry a multiplier. With less, its condition would extrapolate side b from
/// afar, and its multiplier be next to nothing. Wholly covered, nodes of straight facets have a half.
/// No round number: where sides overlap by a fifth of a facet, round-off would decide.
const LEAST: f64 = 0.098_765;
/// Share of a facet with less of which covered its shape functions can't be told apart reliably. No
/// round number either.
const SLIVER: f64 = 0.987_65e-3;

/// The nodes that carry multipliers. All others on what is covered, crack tips among them, hand
/// their part of the dual basis to those beside them, so that the weights sum to 1 everywhere: what
/// is integrated is lost nowhere, and a uniform pressure passes exactly.
pub(super) struct Weights {
    carrying: HashSet<u32>,
}

impl Weights {
    /// Chooses them: nodes that are covered themselves and not only what lies beside them, and the
    /// best of a facet without any.
    pub fn new(sides: &Sides, covered: &[Covered]) -> Self {
        let mut around: HashMap<u32, [f64; 2]> = HashMap::new();
        for Covered { facet, cover } in covered {
            for (i, &node) in facet.nodes.iter().enumerate() {
                let [own, all] = around.entry(node).or_default();
                *own += integral(&cover.samples, i);
                *all += measure(&cover.samples);
            }
        }
        let may_carry = |node: &&u32| !sides.shared.contains(node);
        let nodes = around.iter().filter(|(_, [own, all])| *own >= LEAST * all);
        let mut carrying: HashSet<u32> = nodes.map(|(node, _)| *node).collect();
        carrying.retain(|node| may_carry(&node));
        for Covered { facet, .. } in covered {
            if !facet.nodes.iter().any(|node| carrying.contains(node)) {
                let nodes = facet.nodes.iter().filter(may_carry);
                carrying.extend(nodes.max_by(|p, q| around[p][0].total_cmp(&around[q][0])));
            }
        }
        Self { carrying }
    }

    /// The weights on a facet of those of its nodes that carry a multiplier: at every sample.
    pub fn on(&self, covered: &Covered) -> Vec<(u32, Vec<f64>)> {
        let Covered { facet, cover } = covered;
        let samples = &cover.samples;
        let mut own: Vec<usize> = (0..facet.nodes.len())
            .filter(|&i| self.carrying.contains(&facet.nodes[i]))
            .collect();
        let is_sliver = measure(samples) < SLIVER * facet.measure;
        let basis = dual_basis(samples).filter(|_| !is_sliver);
        let Some(basis) = basis.filter(|_| own.len() > 1) else {
            own.sort_by(|&i, &k| integral(samples, k).total_cmp(&integral(samples, i)));
            let best = own
                .first()
                .map(|&i| (facet.nodes[i], vec![1.0; samples.len()]));
            return best.into_iter().collect();
        };
        let handed = handed_over(&basis, &own);
        let at = |j: usize| {
            let value = |shape: &[f64]| -> f64 {
                (0..shape.len()).map(|i| handed[(j, i)] * shape[i]).sum()
            };
            samples.iter().map(|s| value(&s.shape)).collect()
        };
        (0..own.len())
            .map(|j| (facet.nodes[own[j]], at(j)))
            .collect()
    }
}

/// What the samples of a facet cover (m).
fn measure(samples: &[Sample]) -> f64 {
    samples.iter().map(|s| s.weight).sum()
}

/// The rows of the dual basis that belong to `own`, each with its part of the others.
fn handed_over(basis: &DMatrix<f64>, own: &[usize]) -> DMatrix<f64> {
    let part = 1.0 / own.len() as f64;
    DMatrix::from_fn(own.len(), basis.ncols(), |j, i| {
        let others = (0..basis.nrows()).filter(|k| !own.contains(k));
        basis[(own[j], i)] + part * others.map(|k| basis[(k, i)]).sum::<f64>()
    })
}
