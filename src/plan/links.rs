//! The ways between contact groups and the subdomains that have their nodes.

use std::collections::BTreeMap;

use contact_dd_partition::problem::tree::Tree;
use contact_dd_partition::problem::{Catalog, SubdomainNode};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::Plan;
use crate::comm::Comm;

/// A contact group: the contact points of one node of the hierarchy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GroupPlan {
    /// The node.
    pub node: usize,
    /// The nodes of its points, each once, in the order in which the group numbers them, and their numbers on Γ.
    pub nodes: Vec<(SubdomainNode, u32)>,
    /// The group's number of every node that a point names; copies of a node have one.
    pub numbers: BTreeMap<SubdomainNode, u32>,
    /// Number of conditions of its points.
    pub conditions: usize,
}

impl GroupPlan {
    /// The group of the contact points of node v of `tree`.
    pub fn new(catalog: &Catalog, tree: &Tree, v: usize) -> Self {
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
            conditions: tree.own_conditions(v),
        }
    }

    /// Its nodes, subdomain by subdomain.
    pub fn by_subdomain(&self) -> impl Iterator<Item = &[(SubdomainNode, u32)]> {
        self.nodes
            .chunk_by(|(a, _), (b, _)| a.subdomain == b.subdomain)
    }
}

impl Plan {
    /// Brings what blocks `say` of nodes to the groups that name them: for every group of this rank, node by
    /// node. Collective; `say` is asked on the owner of a block for some of its nodes.
    pub fn nodes_to_groups<T: Serialize + DeserializeOwned>(
        &self,
        comm: &Comm,
        say: impl Fn(usize, &[(SubdomainNode, u32)]) -> Vec<T>,
    ) -> BTreeMap<usize, Vec<T>> {
        let links = self.links();
        let owners = &self.node_owners;
        let mut arrived: BTreeMap<usize, Vec<T>> = BTreeMap::new();
        comm.route(
            links
                .iter()
                .map(|link| (owners[link.block], owners[self.groups[link.group].node])),
            |i| say(links[i].block, links[i].nodes),
            |i, said| arrived.entry(links[i].group).or_default().extend(said),
        );
        arrived
    }

    /// Brings what groups say of their nodes to the blocks that have them: node of the block and what was said,
    /// group after group. Collective.
    pub fn nodes_to_blocks<T: Clone + Serialize + DeserializeOwned>(
        &self,
        comm: &Comm,
        said: &BTreeMap<usize, Vec<T>>,
    ) -> BTreeMap<usize, Vec<(u32, T)>> {
        let links = self.links();
        let owners = &self.node_owners;
        let mut arrived: BTreeMap<usize, Vec<(u32, T)>> = BTreeMap::new();
        comm.route(
            links
                .iter()
                .map(|link| (owners[self.groups[link.group].node], owners[link.block])),
            |i| said[&links[i].group][links[i].first..][..links[i].nodes.len()].to_vec(),
            |i, said| {
                let nodes = links[i].nodes.iter().map(|(node, _)| node.node);
                let of_block = arrived.entry(links[i].block).or_default();
                of_block.extend(nodes.zip(said));
            },
        );
        arrived
    }

    fn links(&self) -> Vec<Link<'_>> {
        let mut links = Vec::new();
        for (group, plan) in self.groups.iter().enumerate() {
            let mut first = 0;
            for nodes in plan.by_subdomain() {
                links.push(Link {
                    group,
                    block: nodes[0].0.subdomain as usize,
                    first,
                    nodes,
                });
                first += nodes.len();
            }
        }
        links
    }
}

/// Some nodes that a group and a block have.
struct Link<'a> {
    group: usize,
    block: usize,
    /// The group's number of the first one.
    first: usize,
    nodes: &'a [(SubdomainNode, u32)],
}
