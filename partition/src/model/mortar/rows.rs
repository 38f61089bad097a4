//! The row of a condition, gathered facet by facet.

use super::super::ContactCondition;
use super::super::sides::SideNode;
use super::super::surface::Surface;
use super::Covered;
use crate::mesh::Mesh;

/// Coefficient below which a node of side b has no part in a condition: round-off of shape
/// functions that are orthogonal.
const ROUND_OFF: f64 = 1e-13;

/// ∫ ψ (u_a − u_b) and ∫ ψ g over what a multiplier's weight ψ covers.
pub(super) struct Row {
    /// ∫ ψ (m).
    share: f64,
    /// ∫ ψ N of the nodes of side a less those of side b, in the order along side a (m).
    terms: Vec<(u32, f64)>,
    /// ∫ ψ g (m²).
    gap: f64,
    /// The least gap where ψ isn't zero (m).
    least_gap: f64,
}

impl Default for Row {
    fn default() -> Self {
        Self {
            share: 0.0,
            terms: Vec::new(),
            gap: 0.0,
            least_gap: f64::INFINITY,
        }
    }
}

impl Row {
    /// Adds what a facet of side a contributes, `weight` being ψ at its samples.
    pub fn add(&mut self, on: &Covered, side_b: &Surface, weight: &[f64]) {
        let Covered { facet, cover } = on;
        self.least_gap = self.least_gap.min(cover.least_gap);
        for (sample, weight) in cover.samples.iter().zip(weight) {
            let weight = weight * sample.weight;
            self.share += weight;
            self.gap += weight * sample.gap;
            for (&node, n) in facet.nodes.iter().zip(&sample.shape) {
                self.add_term(node, weight * n);
            }
            let opposite = &side_b.facets[sample.opposite];
            for (&node, n) in opposite.nodes.iter().zip(&sample.opposite_shape) {
                self.add_term(node, -weight * n);
            }
        }
    }

    fn add_term(&mut self, node: u32, value: f64) {
        match self.terms.iter_mut().find(|(other, _)| *other == node) {
            Some((_, sum)) => *sum += value,
            None => self.terms.push((node, value)),
        }
    }

    /// The condition of node `a`, scaled so that the coefficients of side a sum to its normal: the
    /// multiplier is the force along it.
    ///
    /// The weight changes its sign, so that the weighted gap of uneven surfaces may be less than any
    /// of their gaps. No condition starts out violated more than they are: bodies that only touch
    /// carry no force without a load.
    pub fn condition(self, a: &SideNode, mesh: &Mesh) -> ContactCondition {
        let entries = self.terms.iter().filter_map(|&(node, value)| {
            let coefficient = value / self.share;
            (coefficient.abs() > ROUND_OFF).then(|| (node, a.normal.map(|c| c * coefficient)))
        });
        let mut entries: Vec<_> = entries.collect();
        // Its own node comes first.
        entries.sort_by_key(|&(node, _)| node != a.node);
        ContactCondition {
            entries,
            gap: (self.gap / self.share).max(self.least_gap.min(0.0)),
            share: self.share,
            position: a.position,
            normal: a.normal,
            tag_a: mesh.node_tags[a.node as usize],
            tag_b: -1,
        }
    }
}
