//! Contact groups.

use std::collections::BTreeMap;

use contact_dd_partition::hierarchy::tree::Tree;
use contact_dd_partition::id::TreeNodeId;
use contact_dd_partition::problem::{Catalog, SubdomainNode};

/// A contact group: the contact points of one node of the hierarchy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GroupPlan {
    /// The node.
    pub node: TreeNodeId,
    /// The nodes of its points, each once, in the order of the group's numbering, and their numbers on Γ.
    pub nodes: Vec<(SubdomainNode, u32)>,
    /// The group's number of every node of its points; copies of a node have the same.
    pub numbers: BTreeMap<SubdomainNode, u32>,
    /// Number of constraints of its points.
    pub conditions: usize,
}

impl GroupPlan {
    /// The group of the contact points of node v of `tree`.
    pub fn new(catalog: &Catalog, tree: &Tree, v: TreeNodeId) -> Self {
        let mut interface: BTreeMap<SubdomainNode, u32> = BTreeMap::new();
        for &j in &tree.nodes[v].points {
            let point = &catalog.points[j as usize];
            for (&(node, _), of_node) in point.entries.iter().zip(&catalog.point_nodes[j as usize])
            {
                let own = || tree.unshared.binary_search_by_key(&node, |own| own.at);
                let number = of_node
                    .interface
                    .or_else(|| Some(tree.unshared[own().ok()?].number));
                interface.insert(node, number.unwrap_or_default());
            }
        }
        let mut first: BTreeMap<u32, u32> = BTreeMap::new();
        let mut nodes = Vec::new();
        let mut numbers = BTreeMap::new();
        for (node, on_interface) in interface {
            let number = *first.entry(on_interface).or_insert(nodes.len() as u32);
            if number as usize == nodes.len() {
                nodes.push((node, on_interface));
            }
            numbers.insert(node, number);
        }
        Self {
            node: v,
            nodes,
            numbers,
            conditions: tree.own_conditions(v) + tree.nodes[v].tied,
        }
    }

    /// The nodes, subdomain by subdomain.
    pub fn by_subdomain(&self) -> impl Iterator<Item = &[(SubdomainNode, u32)]> {
        self.nodes
            .chunk_by(|(a, _), (b, _)| a.subdomain == b.subdomain)
    }
}
