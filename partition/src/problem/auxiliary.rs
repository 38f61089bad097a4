//! Auxiliary nodes of contact points, which belong to no cell and aren't stored in files.
//!
//! The moving obstacle of a point is a node with prescribed displacements in load steps. A compliant point has a node
//! on a spring: with its displacement s the constraint becomes rigid, n·(⟦u⟧ − s) ≤ g, and its force is that of the
//! spring, λ = k n·s. These nodes follow the other nodes of the subdomain of the point's first entry.

use std::collections::BTreeMap;

use super::{Catalog, PointNode, Subdomain, SubdomainNode};
use crate::contact_point::ContactPoint;
use crate::element::geometry::dot;
use crate::model::{SpringBlock, Support};

/// Marks supports and springs without a boundary condition in the scene, which no report lists.
const NO_CONDITION: u32 = u32::MAX;

/// The largest tag of an auxiliary node: below the tags in files, and below −1, which means no node.
const FIRST_TAG: i64 = -2;

/// Coordinate axes.
const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// An auxiliary node of a contact point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Auxiliary {
    /// The moving obstacle opposite the point.
    Moving,
    /// The end of its spring, the last of its entries.
    Sprung,
}

/// The auxiliary nodes of each subdomain, each with the index of its contact point in the catalog.
pub(super) type AuxiliaryNodes = BTreeMap<u32, Vec<(usize, Auxiliary)>>;

impl Auxiliary {
    /// The auxiliary nodes of a point.
    fn of<N: Copy>(point: &ContactPoint<N>) -> impl Iterator<Item = Self> + use<N> {
        let all = [
            (!point.motion.is_empty(), Self::Moving),
            (point.is_compliant(), Self::Sprung),
        ];
        all.into_iter()
            .filter_map(|(is_there, node)| is_there.then_some(node))
    }

    /// The directions in which it is held, in `dim` dimensions.
    fn held<N: Copy>(self, point: &ContactPoint<N>, dim: usize) -> Vec<[f64; 3]> {
        match self {
            Self::Moving => AXES[..dim].to_vec(),
            Self::Sprung if point.stiffness[1] > 0.0 => Vec::new(),
            Self::Sprung => point.frame.tangents[..dim - 1].to_vec(),
        }
    }

    /// Prescribed displacement in load step k along a `direction` (m).
    fn value<N: Copy>(self, point: &ContactPoint<N>, k: usize, direction: [f64; 3]) -> f64 {
        match self {
            Self::Moving => dot(point.motion[k], direction),
            Self::Sprung => 0.0,
        }
    }
}

impl Catalog {
    /// Adds the auxiliary nodes to the entries of the contact points.
    pub(super) fn add_auxiliary_nodes(&mut self) -> AuxiliaryNodes {
        let mut all = AuxiliaryNodes::new();
        let points = self.points.iter_mut().zip(&mut self.point_nodes);
        for (j, (point, nodes)) in points.enumerate() {
            let Some(&(first, _)) = point.entries.first() else {
                continue;
            };
            for node in Auxiliary::of(point) {
                let of_subdomain = all.entry(first.subdomain).or_default();
                let nodes_of_file = self.subdomains[first.subdomain as usize].nodes;
                let at = SubdomainNode {
                    subdomain: first.subdomain,
                    node: (nodes_of_file + of_subdomain.len()) as u32,
                };
                of_subdomain.push((j, node));
                let held = node.held(point, self.dim).into_iter();
                nodes.push(PointNode::new(None, point.directions(self.dim), held));
                if point.is_equation() {
                    point.axes.push(point.normal());
                }
                point.entries.push((at, -1.0));
            }
        }
        all
    }
}

impl Subdomain {
    /// Appends these auxiliary `nodes` of the points of a catalog, with their springs and supports.
    pub(super) fn add_auxiliary_nodes(&mut self, nodes: &[(usize, Auxiliary)], catalog: &Catalog) {
        for &(j, of_point) in nodes {
            let point = &catalog.points[j];
            let node = self.points.len() as u32;
            self.points.push(point.position);
            self.node_tags
                .push(FIRST_TAG - 2 * j as i64 - i64::from(of_point == Auxiliary::Sprung));
            self.auxiliary_nodes += 1;
            for direction in of_point.held(point, catalog.dim) {
                let value = |k: usize| of_point.value(point, k, direction);
                self.supports.push(Support {
                    node,
                    direction,
                    value: value(0),
                    condition: NO_CONDITION,
                });
                for (k, step) in self.steps.iter_mut().enumerate() {
                    step.supports.push(value(k));
                }
            }
            if of_point == Auxiliary::Sprung {
                self.springs.push(SpringBlock {
                    nodes: [node; 2],
                    stiffness: stiffness(point, catalog.dim),
                    condition: NO_CONDITION,
                });
            }
        }
        let stresses = self.steps.iter_mut().map(|step| &mut step.initial_stress);
        for stress in stresses.chain([&mut self.initial_stress]) {
            if !stress.nodes.is_empty() {
                stress.nodes.resize(self.points.len(), [0.0; 6]);
            }
        }
    }
}

/// The matrix of the spring of a compliant point, k_n n nᵀ + k_t Σ t tᵀ (N/m).
fn stiffness<N: Copy>(point: &ContactPoint<N>, dim: usize) -> [[f64; 3]; 3] {
    let [along, across] = point.stiffness;
    let tangents = point.frame.tangents[..dim - 1].iter();
    let axes = std::iter::once((along, point.normal())).chain(tangents.map(|t| (across, *t)));
    let mut k = [[0.0; 3]; 3];
    for (stiffness, axis) in axes {
        for (row, of_row) in k.iter_mut().zip(axis) {
            for (entry, of_column) in row.iter_mut().zip(axis) {
                *entry += stiffness * of_row * of_column;
            }
        }
    }
    k
}
