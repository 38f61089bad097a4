//! A block: a subdomain with its nodes on Γ.

use std::collections::BTreeMap;

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::hierarchy::tree::Tree;
use contact_dd_partition::problem::{Subdomain, SubdomainNode};

/// A subdomain of the problem file, with its interface.
#[derive(Clone, Debug)]
pub struct Block {
    /// The subdomain.
    pub subdomain: Subdomain,
    /// Nodes on Γ, which are those shared with other subdomains and those of contact points: node and number on Γ,
    /// ascending by the latter.
    pub interface: Vec<(u32, u32)>,
    /// Nodes without supports of whose displacement only the component along this normal is on Γ.
    pub slides: BTreeMap<u32, [f64; 3]>,
    /// Number of dofs of a node.
    pub dim: usize,
}

impl Block {
    /// The block of a subdomain; `tree` determines its nodes on Γ.
    pub fn new(subdomain: Subdomain, tree: &Tree, dim: usize) -> Self {
        let shared = subdomain.interface.iter();
        let mut interface: Vec<(u32, u32)> = shared.map(|on| (on.node, on.interface)).collect();
        let first = SubdomainNode {
            subdomain: subdomain.index as u32,
            node: 0,
        };
        let start = (tree.unshared).partition_point(|own| own.at < first);
        let own = tree.unshared[start..].iter();
        let own = own.take_while(|own| own.at.subdomain == first.subdomain);
        interface.extend(own.clone().map(|own| (own.at.node, own.number)));
        Self {
            subdomain,
            interface,
            slides: own
                .filter_map(|own| Some((own.at.node, own.slides?)))
                .collect(),
            dim,
        }
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.subdomain.points.len()
    }

    /// Coordinates of its nodes (m).
    pub fn points(&self) -> &[[f64; 3]] {
        &self.subdomain.points
    }

    /// Number of nodes of its body; [auxiliary] nodes come after them.
    ///
    /// [auxiliary]: contact_dd_partition::problem::auxiliary
    pub fn body_nodes(&self) -> usize {
        self.subdomain.body_nodes()
    }

    /// Coordinates of these nodes (m).
    pub fn body_points(&self) -> &[[f64; 3]] {
        &self.points()[..self.body_nodes()]
    }

    /// Flags of the nodes on Γ.
    pub fn is_on_interface(&self) -> Vec<bool> {
        let mut on_interface = vec![false; self.nodes()];
        for &(node, _) in &self.interface {
            on_interface[node as usize] = true;
        }
        on_interface
    }

    /// Cells: kind, nodes, material.
    pub fn cells(&self) -> impl Iterator<Item = BlockCell<'_>> {
        let materials = self.subdomain.cell_material.iter();
        (self.subdomain.cells.iter().zip(materials)).map(|((kind, nodes), &material)| BlockCell {
            kind,
            nodes,
            material: material as usize,
        })
    }
}

/// A cell of a block.
#[derive(Clone, Copy, Debug)]
pub struct BlockCell<'a> {
    /// Kind.
    pub kind: ElementKind,
    nodes: &'a [u32],
    /// Index of its material.
    pub material: usize,
}

impl BlockCell<'_> {
    /// Nodes.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = u32> + Clone {
        self.nodes.iter().copied()
    }
}
