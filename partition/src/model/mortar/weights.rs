//! Nodes of side a that carry a multiplier, and their weights on each facet.

use std::collections::{BTreeMap, HashMap, HashSet};

use nalgebra::DMatrix;

use super::super::sides::Sides;
use super::bases::{Bases, Kind, lift};
use super::cover::Cover;
use super::covered::Covered;
use super::dual::dual_basis;

/// Covered share of a line below which its shape functions aren't reliably independent. Not a round number, as
/// round-off would decide at a typical ratio.
const SLIVER: f64 = 0.987_65e-3;
/// Least eigenvalues for the functions of all nodes of a facet, so that dual functions stay below 100, and for those of
/// the corners, which may become larger. Not round numbers either.
const FLOORS: [f64; 2] = [0.987_65e-3, 0.987_65e-7];

/// Covered part of a node's integral, relative to that of the nodes beside it, from which on the node carries a
/// multiplier. Below, its constraint would nearly repeat theirs, with a negligible multiplier. For 26 punches on
/// blocks, flat and round, in the plane and in space, any value from 0.05 to 0.6 gives depths with an average error of
/// 9 %, and a difference between the two orders of sides of 0.3 of the estimated error. Not a round number, as
/// round-off would decide where sides overlap by a fifth of a facet.
const LEAST: f64 = 0.320_987;

/// Part of a node's required integral that has to remain after other nodes have passed their parts on to it.
const KEPT: f64 = 0.5;

/// Least weight of a node in its own constraint, relative to the weight of all of side a. Values from 0.001 to 0.05
/// change none of those 26 punches.
const OWN: f64 = 0.009_876_5;

/// The weight ψ of a multiplier on a facet.
pub(super) enum Weight {
    /// ψ = 1.
    One,
    /// ψ = Σ c_i N_i.
    Combination(Vec<f64>),
}

impl Weight {
    /// ∫ ψ over the covered part (m, in space m²).
    fn integral(&self, cover: &Cover) -> f64 {
        match self {
            Self::One => cover.measure,
            Self::Combination(c) => c.iter().zip(&cover.integrals).map(|(c, n)| c * n).sum(),
        }
    }

    /// ∫ ψ N over the covered part, for a node of the facet (m, in space m²).
    fn at_node(&self, node: u32, on: &Covered) -> f64 {
        let Some(place) = on.facet.nodes.iter().position(|&own| own == node) else {
            return 0.0;
        };
        match self {
            Self::One => on.cover.integrals[place],
            Self::Combination(c) => c
                .iter()
                .zip(&on.cover.mass.column(place))
                .map(|(c, n)| c * n)
                .sum(),
        }
    }
}

/// The nodes that carry multipliers. All other nodes on the covered part, crack tips included, pass their part of the
/// dual basis on to neighbouring nodes, so that the weights sum to 1 everywhere: no part of the integrals is lost, and
/// a uniform pressure is transferred exactly.
struct MultiplierNodes {
    nodes: HashSet<u32>,
    bases: BTreeMap<Kind, Bases>,
}

/// The weights of the multipliers on each facet, by node.
pub(super) fn weights(sides: &Sides, covered: &[Covered]) -> Vec<Vec<(u32, Weight)>> {
    let bases = Bases::new(covered.iter().map(|on| on.facet));
    let mut around: HashMap<u32, [f64; 2]> = HashMap::new();
    for on in covered {
        let bases = &bases[&Bases::kind(on.facet)];
        let integrals = on.integrals(&bases.levels[0]);
        let area = on.facet.area();
        for (i, &node) in on.facet.nodes.iter().enumerate() {
            let [own, whole] = around.entry(node).or_default();
            *own += integrals[i];
            *whole += bases.shares[i] * area;
        }
    }
    // The integral that a node requires depends on how much is covered around it.
    let part = |node: &u32| around[node][0] / around[node][1];
    let mut most: HashMap<u32, f64> = HashMap::new();
    for Covered { facet, .. } in covered {
        let of_facet = facet.nodes.iter().map(part).fold(0.0, f64::max);
        for &node in &facet.nodes {
            let most = most.entry(node).or_default();
            *most = most.max(of_facet);
        }
    }
    for (node, [_, whole]) in &mut around {
        *whole *= LEAST * most[node];
    }
    around.retain(|node, _| !sides.shared.contains(node));
    let enough = (around.iter()).filter(|(_, [own, needed])| own >= needed);
    let nodes = enough.map(|(node, _)| *node).collect();
    let mut multipliers = MultiplierNodes { nodes, bases };
    loop {
        for Covered { facet, .. } in covered {
            if !facet
                .nodes
                .iter()
                .any(|node| multipliers.nodes.contains(node))
            {
                let nodes = facet.nodes.iter().filter(|node| around.contains_key(node));
                (multipliers.nodes)
                    .extend(nodes.max_by(|p, q| around[p][0].total_cmp(&around[q][0])));
            }
        }
        let weights: Vec<_> = covered.iter().map(|on| multipliers.on(on)).collect();
        let mut areas: HashMap<u32, [f64; 2]> = HashMap::new();
        for (on, weights) in covered.iter().zip(&weights) {
            for (node, weight) in weights {
                let [area, own] = areas.entry(*node).or_default();
                *area += weight.integral(&on.cover);
                *own += weight.at_node(*node, on);
            }
        }
        // The parts of other nodes may be negative where their functions are, and may be far from the node.
        let is_weak =
            |node: u32, [area, own]: [f64; 2]| area < KEPT * around[&node][1] || own < OWN * area;
        let weak = areas
            .into_iter()
            .filter(|&(node, sums)| is_weak(node, sums));
        let weak: HashSet<u32> = weak.map(|(node, _)| node).collect();
        if weak.is_empty() {
            return weights;
        }
        around.retain(|node, _| !weak.contains(node));
        multipliers.nodes.retain(|node| !weak.contains(node));
    }
}

impl Covered<'_> {
    /// The integrals of a basis over the covered part.
    fn integrals(&self, basis: &DMatrix<f64>) -> Vec<f64> {
        let cover = self.part.as_ref().map_or(&self.cover, |part| &part.cover);
        lift(basis, &cover.integrals)
    }

    /// The dual basis on the covered part.
    fn dual(&self, basis: &DMatrix<f64>, floor: f64) -> Option<DMatrix<f64>> {
        match &self.part {
            None => dual_basis(&self.cover, basis, floor),
            Some(part) => Some(dual_basis(&part.cover, basis, floor)? * &part.functions),
        }
    }
}

impl MultiplierNodes {
    /// The weights on a facet, for its nodes that carry a multiplier.
    fn on(&self, covered: &Covered) -> Vec<(u32, Weight)> {
        let Covered { facet, cover, .. } = covered;
        let levels = &self.bases[&Bases::kind(facet)].levels;
        let carries = |&i: &usize| self.nodes.contains(&facet.nodes[i]);
        let is_line = facet.kind.dim() == 1;
        for (basis, floor) in levels.iter().zip(FLOORS) {
            let own: Vec<usize> = (0..basis.nrows()).filter(carries).collect();
            let (is_told_apart, floor) = match is_line {
                true => (cover.measure >= SLIVER * facet.area(), 0.0),
                // The functions of linear facets are those of the corners.
                false if facet.kind.is_linear() => (true, FLOORS[1]),
                false => (true, floor),
            };
            if own.len() > 1
                && is_told_apart
                && let Some(dual) = covered.dual(basis, floor)
            {
                let handed = handed_over(&dual, &own);
                let row = |j: usize| handed.row(j).iter().copied().collect();
                return (0..own.len())
                    .map(|j| (facet.nodes[own[j]], Weight::Combination(row(j))))
                    .collect();
            }
        }
        let integrals = covered.integrals(&levels[0]);
        let own = (0..facet.nodes.len()).filter(carries);
        // The first one of equal maxima.
        let best = own
            .rev()
            .max_by(|&i, &k| integrals[i].total_cmp(&integrals[k]));
        best.map(|i| (facet.nodes[i], Weight::One))
            .into_iter()
            .collect()
    }
}

/// The rows of the dual basis for the nodes `own`, each with an equal part of the other rows.
fn handed_over(basis: &DMatrix<f64>, own: &[usize]) -> DMatrix<f64> {
    let part = 1.0 / own.len() as f64;
    DMatrix::from_fn(own.len(), basis.ncols(), |j, i| {
        let others = (0..basis.nrows()).filter(|k| !own.contains(k));
        basis[(own[j], i)] + part * others.map(|k| basis[(k, i)]).sum::<f64>()
    })
}
