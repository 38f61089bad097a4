//! What a multiplier's weight covers, gathered facet by facet, and the contact point that comes of it.

use super::super::sides::SideNode;
use super::super::surface::Surface;
use super::Covered;
use super::field::cross;
use crate::contact_point::ContactPoint;
use crate::element::geometry::{advance, difference};
use crate::mesh::Mesh;

/// Weight below which a node of side b has no part in a point: round-off of shape
/// functions that are orthogonal.
const ROUND_OFF: f64 = 1e-13;

/// What a multiplier's weight ψ covers.
pub(super) struct Row {
    /// ∫ ψ (m).
    area: f64,
    /// ∫ ψ N of the nodes of side a, in the order along it (m).
    side_a: Vec<(u32, f64)>,
    /// The same of side b.
    side_b: Vec<(u32, f64)>,
    /// ∫ ψ g (m²).
    gap: f64,
    /// The least gap where ψ isn't zero (m).
    least_gap: f64,
}

impl Default for Row {
    fn default() -> Self {
        Self {
            area: 0.0,
            side_a: Vec::new(),
            side_b: Vec::new(),
            gap: 0.0,
            least_gap: f64::INFINITY,
        }
    }
}

fn add(terms: &mut Vec<(u32, f64)>, node: u32, value: f64) {
    match terms.iter_mut().find(|(other, _)| *other == node) {
        Some((_, sum)) => *sum += value,
        None => terms.push((node, value)),
    }
}

impl Row {
    /// Adds what a facet of side a contributes, `weight` being ψ at its samples.
    pub fn add(&mut self, on: &Covered, side_b: &Surface, weight: &[f64]) {
        let Covered { facet, cover } = on;
        self.least_gap = self.least_gap.min(cover.least_gap);
        for (sample, weight) in cover.samples.iter().zip(weight) {
            let weight = weight * sample.weight;
            self.area += weight;
            self.gap += weight * sample.gap;
            for (&node, n) in facet.nodes.iter().zip(&sample.shape) {
                add(&mut self.side_a, node, weight * n);
            }
            let opposite = &side_b.facets[sample.opposite];
            for (&node, n) in opposite.nodes.iter().zip(&sample.opposite_shape) {
                add(&mut self.side_b, node, weight * n);
            }
        }
    }

    /// Shifts what side b has of the row so that both sides turn together without changing the gap,
    /// and the point's force has no moment: Σ s_a D_a = Σ s_b M_b with the places s along side a.
    ///
    /// It is so already where the sides are straight. Without it, the ragged facets of round bodies
    /// would keep them from turning against each other.
    fn balance(&mut self, a: &SideNode, mesh: &Mesh) {
        // In multiples of its part of side a, so that no square of a length overflows.
        let place = |node: u32| {
            let way = difference(mesh.points[node as usize], a.position);
            cross(a.normal, way) / self.area
        };
        let moment = |terms: &[(u32, f64)]| terms.iter().map(|&(n, c)| c * place(n)).sum::<f64>();
        let defect = moment(&self.side_a) - moment(&self.side_b);
        // Each node takes part as it does already.
        let parts = || self.side_b.iter().map(|&(n, c)| (c.abs(), place(n)));
        let middle =
            parts().map(|(c, s)| c * s).sum::<f64>() / parts().map(|(c, _)| c).sum::<f64>();
        let spread: f64 = parts().map(|(c, s)| c * (s - middle).powi(2)).sum();
        if spread > 0.0 {
            let shift =
                |(n, c): (u32, f64)| (n, c + defect * c.abs() * (place(n) - middle) / spread);
            self.side_b = self.side_b.iter().copied().map(shift).collect();
        }
    }

    /// Where the force on side a acts: beside node `a` where others hand over to it.
    fn force_point(&self, a: &SideNode, mesh: &Mesh) -> [f64; 3] {
        (self.side_a.iter()).fold(a.position, |at, &(node, value)| {
            let way = difference(mesh.points[node as usize], a.position);
            advance(at, value / self.area, way)
        })
    }

    /// The contact point of node `a`, scaled so that the weights of side a sum to 1: the multiplier is the force
    /// along its normal.
    ///
    /// ψ changes its sign, so that the weighted gap of uneven surfaces may be less than any of their gaps. No
    /// point starts out violated more than they are: bodies that only touch carry no force without a load.
    pub fn point(mut self, a: &SideNode, mesh: &Mesh) -> ContactPoint<u32> {
        self.balance(a, mesh);
        let force_point = self.force_point(a, mesh);
        let mut terms = self.side_a;
        for (node, value) in self.side_b {
            add(&mut terms, node, -value);
        }
        let entries = terms.into_iter().filter_map(|(node, value)| {
            let weight = value / self.area;
            (weight.abs() > ROUND_OFF).then_some((node, weight))
        });
        let mut entries: Vec<_> = entries.collect();
        // Its own node comes first.
        entries.sort_by_key(|&(node, _)| node != a.node);
        let tag_a = mesh.node_tags[a.node as usize];
        ContactPoint {
            gap: (self.gap / self.area).max(self.least_gap.min(0.0)),
            area: self.area,
            force_point,
            ..ContactPoint::new(entries, a.normal, a.position, tag_a)
        }
    }
}
