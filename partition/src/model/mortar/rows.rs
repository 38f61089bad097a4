//! The integrals of a multiplier's weight, summed facet by facet, and the resulting contact point.

use std::collections::HashMap;

use super::super::sides::SideNode;
use super::super::surface::{Surface, SurfaceFacet};
use super::cover::{Cover, Overlap, Pieces, Sample};
use super::covered::Covered;
use super::weights::Weight;
use crate::contact_point::{ContactPoint, LocalFrame};
use crate::element::geometry::{advance, difference, dot, length};
use crate::mesh::Mesh;
use crate::scene::material::PlaneState;

/// Weight below which a node of side b is left out of a point: round-off of orthogonal shape functions.
const ROUND_OFF: f64 = 1e-13;

/// Lower bound of the weighted gap, relative to the smallest gap around it: on non-matching curved sides the two are
/// about equal.
const LEAST_GAP_RATIO: f64 = 0.8;

/// A weighted gap, bounded by the smallest gap around it.
pub(in crate::model) fn bounded(gap: f64, least: f64) -> f64 {
    gap.max(least.min(LEAST_GAP_RATIO * least))
}

/// Mean square of the distances of nodes, relative to the part of side a, below which they coincide.
const COINCIDENT: f64 = 1e-8;

/// Integrals of a multiplier's weight ψ over the covered part.
pub(super) struct Row {
    /// ∫ ψ (m, in space m²).
    area: f64,
    /// ∫ ψ N of the nodes of side a, in the order along it (m, in space m²).
    side_a: Vec<(u32, f64)>,
    /// ∫ ψ N of the nodes of side b (m, in space m²).
    side_b: Vec<(u32, f64)>,
    /// ∫ ψ g (m², in space m³).
    gap: f64,
    /// The smallest gap where ψ isn't zero (m).
    pub least_gap: f64,
    /// ∫ g and ∫ 1 over the facets where ψ isn't zero.
    around: [f64; 2],
    /// True if one of these facets is covered in part.
    is_partial: bool,
}

impl Default for Row {
    fn default() -> Self {
        Self {
            area: 0.0,
            side_a: Vec::new(),
            side_b: Vec::new(),
            gap: 0.0,
            least_gap: f64::INFINITY,
            around: [0.0; 2],
            is_partial: false,
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
    /// Adds the contribution of a facet of side a, on which ψ is `weight`.
    pub fn add(&mut self, on: &Covered, side_b: &Surface, weight: &Weight) {
        let Covered { facet, cover, part } = on;
        self.is_partial |= part.is_some();
        self.least_gap = self.least_gap.min(cover.least_gap);
        self.around[0] += cover.gap;
        self.around[1] += cover.measure;
        match &cover.pieces {
            Pieces::Samples(samples) => {
                for sample in samples {
                    self.add_sample(facet, sample, side_b, weight);
                }
            }
            Pieces::Overlaps(overlaps) => {
                let coefficients = match weight {
                    Weight::One => vec![1.0; facet.nodes.len()],
                    Weight::Combination(coefficients) => coefficients.clone(),
                };
                self.add_overlaps(facet, cover, overlaps, side_b, &coefficients);
            }
        }
    }

    fn add_sample(
        &mut self,
        facet: &SurfaceFacet,
        sample: &Sample,
        side_b: &Surface,
        weight: &Weight,
    ) {
        let value = match weight {
            Weight::One => 1.0,
            Weight::Combination(c) => c.iter().zip(&sample.shape).map(|(c, n)| c * n).sum(),
        };
        let weight = value * sample.weight;
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

    fn add_overlaps(
        &mut self,
        facet: &SurfaceFacet,
        cover: &Cover,
        overlaps: &[Overlap],
        side_b: &Surface,
        coefficients: &[f64],
    ) {
        let product =
            |column: &[f64]| -> f64 { coefficients.iter().zip(column).map(|(c, n)| c * n).sum() };
        self.area += product(&cover.integrals);
        for (k, &node) in facet.nodes.iter().enumerate() {
            add(
                &mut self.side_a,
                node,
                product(cover.mass.column(k).as_slice()),
            );
        }
        for overlap in overlaps {
            self.gap += product(&overlap.gaps);
            let nodes = &side_b.facets[overlap.opposite].nodes;
            for (k, &node) in nodes.iter().enumerate() {
                add(
                    &mut self.side_b,
                    node,
                    product(overlap.products.column(k).as_slice()),
                );
            }
        }
    }

    /// The average of the gap over the facets where ψ isn't zero (m).
    pub fn mean_gap(&self) -> f64 {
        self.around[0] / self.around[1]
    }

    /// Shifts the weights of side b so that a common rotation of both sides leaves the gap unchanged, and the point's
    /// force has no moment: Σ s_a D_a = Σ s_b M_b with the positions s along side a.
    ///
    /// On straight sides this holds already. Without it, the polygonal facets of round bodies would resist their
    /// relative rotation.
    fn balance(&mut self, a: &SideNode, normal: [f64; 3], mesh: &Mesh, plane: Option<PlaneState>) {
        // Lengths are relative to the size of the point's part of side a, so that no square overflows.
        let size = if mesh.dim == 2 {
            self.area / PlaneState::thickness(plane, self.force_point(a, mesh))
        } else {
            self.area.sqrt()
        };
        let offset = |node: u32| difference(mesh.points[node as usize], a.position);
        // The shift is distributed by the existing weights.
        let before = self.side_b.clone();
        for axis in self.axes(a, normal, mesh) {
            let place = |node: u32| dot(axis, offset(node)) / size;
            let moment =
                |terms: &[(u32, f64)]| terms.iter().map(|&(n, c)| c * place(n)).sum::<f64>();
            let defect = moment(&self.side_a) - moment(&before);
            let parts = || before.iter().map(|&(n, c)| (c.abs(), place(n)));
            let total = parts().map(|(c, _)| c).sum::<f64>();
            let middle = parts().map(|(c, s)| c * s).sum::<f64>() / total;
            let spread: f64 = parts().map(|(c, s)| c * (s - middle).powi(2)).sum();
            if spread > COINCIDENT * total {
                for ((_, value), (c, s)) in self.side_b.iter_mut().zip(parts()) {
                    *value += defect * c * (s - middle) / spread;
                }
            }
        }
    }

    /// The principal axes, along side a, of the positions of side b's nodes, weighted by their weights: shifts along
    /// one of them don't affect the other.
    fn axes(&self, a: &SideNode, normal: [f64; 3], mesh: &Mesh) -> Vec<[f64; 3]> {
        let [t_1, t_2] = LocalFrame::new(normal).tangents;
        if mesh.dim == 2 {
            return vec![t_1];
        }
        let flat = |node: u32| {
            let offset = difference(mesh.points[node as usize], a.position);
            [dot(t_1, offset), dot(t_2, offset)]
        };
        let total: f64 = self.side_b.iter().map(|(_, c)| c.abs()).sum();
        let parts = || self.side_b.iter().map(|&(n, c)| (c.abs() / total, flat(n)));
        let middle = parts().fold([0.0; 2], |sum, (c, s)| {
            [sum[0] + c * s[0], sum[1] + c * s[1]]
        });
        let mut spread = [0.0; 3];
        for (c, s) in parts() {
            let [x, y] = [s[0] - middle[0], s[1] - middle[1]];
            spread = advance(spread, c, [x * x, y * y, x * y]);
        }
        let [xx, yy, xy] = spread;
        let (sin, cos) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
        vec![
            [0, 1, 2].map(|k| cos * t_1[k] + sin * t_2[k]),
            [0, 1, 2].map(|k| cos * t_2[k] - sin * t_1[k]),
        ]
    }

    /// Point of application of the force on side a: beside node `a` where nodes without a multiplier pass their part on
    /// to it.
    fn force_point(&self, a: &SideNode, mesh: &Mesh) -> [f64; 3] {
        (self.side_a.iter()).fold(a.position, |at, &(node, value)| {
            let offset = difference(mesh.points[node as usize], a.position);
            advance(at, value / self.area, offset)
        })
    }

    /// The normal at the point of application: that of node `a`, unless a facet is covered in part and the force acts
    /// beside the node.
    fn normal(&self, a: &SideNode, normals: &HashMap<u32, [f64; 3]>) -> [f64; 3] {
        if !self.is_partial {
            return a.normal;
        }
        let of_node = |node: &u32| normals.get(node).copied().unwrap_or(a.normal);
        let all = self.side_a.iter();
        let sum = all.fold([0.0; 3], |sum, (node, c)| advance(sum, *c, of_node(node)));
        let size = length(sum);
        sum.map(|c| c / size)
    }

    /// The contact point of node `a`, scaled so that the weights of side a sum to 1: the multiplier is the force along
    /// its normal.
    ///
    /// ψ changes its sign, so that the weighted gap of non-matching surfaces may be less than any of their gaps, by far
    /// where a curved side is partly covered. It is bounded by the smallest gap: sides that only touch carry no force
    /// without a load, and sides that are apart don't overlap.
    pub fn point(
        mut self,
        a: &SideNode,
        normals: &HashMap<u32, [f64; 3]>,
        mesh: &Mesh,
        plane: Option<PlaneState>,
    ) -> ContactPoint<u32> {
        let normal = self.normal(a, normals);
        self.balance(a, normal, mesh, plane);
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
            gap: bounded(self.gap / self.area, self.least_gap),
            area: self.area,
            force_point,
            ..ContactPoint::new(entries, normal, a.position, tag_a)
        }
    }
}
