//! Messages between contact groups and the subdomains that contain their nodes.

use std::collections::BTreeMap;

use contact_dd_partition::id::{BlockId, GroupId, OnBlocks, OnGroups, TreeNodeId};
use contact_dd_partition::numbered::Numbered;
use contact_dd_partition::problem::SubdomainNode;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::Plan;
use crate::comm::Comm;

impl Plan {
    /// Sends data of nodes from their blocks to the groups that use them: for every group of this rank, node by node.
    /// Collective; `data_of` returns the data of some nodes of a block, on the owner of the block.
    pub fn nodes_to_groups<T: Serialize + DeserializeOwned>(
        &self,
        comm: &Comm,
        data_of: impl Fn(BlockId, &[(SubdomainNode, u32)]) -> Vec<T>,
    ) -> OnGroups<Vec<T>> {
        let links = self.links();
        let mut arrived: OnGroups<Vec<T>> = BTreeMap::new();
        comm.route(
            links.iter().map(|link| self.ends(link)),
            |i| data_of(links[i].block, links[i].nodes),
            |i, data| arrived.entry(links[i].group).or_default().extend(data),
        );
        arrived
    }

    /// Sends data of groups about their nodes to the blocks that contain them: node of the block and datum, group after
    /// group. Collective.
    pub fn nodes_to_blocks<T: Clone + Serialize + DeserializeOwned>(
        &self,
        comm: &Comm,
        data: &OnGroups<Vec<T>>,
    ) -> OnBlocks<Vec<(u32, T)>> {
        let links = self.links();
        let mut arrived: OnBlocks<Vec<(u32, T)>> = BTreeMap::new();
        comm.route(
            (links.iter().map(|link| self.ends(link))).map(|(block, group)| (group, block)),
            |i| data[&links[i].group][links[i].first..][..links[i].nodes.len()].to_vec(),
            |i, data| {
                let nodes = links[i].nodes.iter().map(|(node, _)| node.node);
                let of_block = arrived.entry(links[i].block).or_default();
                of_block.extend(nodes.zip(data));
            },
        );
        arrived
    }

    /// Flags of the nodes of the hierarchy below clusters that contain nodes of contact points, and of these clusters.
    pub fn around_contact(&self) -> Numbered<TreeNodeId, bool> {
        let mut around = self.tree.nodes.like(false);
        for link in self.links() {
            around[link.block.into()] = true;
        }
        for cluster in &self.clusters {
            for v in self.tree.subtree(cluster.node) {
                let children = &self.tree.nodes[v].children;
                around[v] |= children.iter().any(|&child| around[child]);
            }
            around[cluster.node] = true;
        }
        around
    }

    /// The owners of the block and of the group.
    fn ends(&self, link: &Link<'_>) -> (usize, usize) {
        let owners = &self.node_owners;
        let group = owners[self.groups[link.group].node];
        (owners[link.block.into()], group)
    }

    fn links(&self) -> Vec<Link<'_>> {
        let mut links = Vec::new();
        for (group, plan) in self.groups.each() {
            let mut first = 0;
            for nodes in plan.by_subdomain() {
                links.push(Link {
                    group,
                    block: nodes[0].0.block(),
                    first,
                    nodes,
                });
                first += nodes.len();
            }
        }
        links
    }
}

/// Some nodes common to a group and a block.
struct Link<'a> {
    group: GroupId,
    block: BlockId,
    /// The group's number of the first node.
    first: usize,
    nodes: &'a [(SubdomainNode, u32)],
}
