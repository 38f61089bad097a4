//! Clusters: the parts of the scene that the sweeps treat as one block each.

use contact_dd_partition::hierarchy::tree::Tree;
use contact_dd_partition::id::{GroupId, TreeNodeId};
use contact_dd_partition::numbered::Numbered;

/// Most contact constraints of a cluster of several groups, as its contact problem is dense.
const MAX_CONDITIONS: usize = 2_000;

/// Treatment of contact groups in the merging of Schur complements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Merging {
    /// Clusters may contain groups: S_CON is that of the groups with their surroundings.
    All,
    /// Only subdomains without contact are merged: S_0 and S_CON are those of the paper, (15).
    Linear,
    /// Contact groups are merged separately, so that Γ keeps away from contact and S_CON is as smooth as possible.
    Groups,
    /// Fronts without contact are merged once, the others again for every active set.
    ActiveSet,
    /// Fronts as in [`ActiveSet`](Self::ActiveSet), but up to the clusters only, between which the iterative interface
    /// solver works.
    Clusters,
}

impl Merging {
    /// True if active sets are fixed.
    pub fn has_active_set(self) -> bool {
        matches!(self, Self::ActiveSet | Self::Clusters)
    }

    /// The name of the solver in messages.
    pub fn solver(self) -> &'static str {
        match self {
            Self::Clusters => "the iterative interface solver",
            Self::ActiveSet => "the direct solver with fixed active sets",
            Self::All | Self::Linear | Self::Groups => "the direct solver",
        }
    }
}

/// The blocks below one node of the hierarchy, condensed onto the unknowns shared with other clusters and onto their
/// own contacts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClusterPlan {
    /// The node.
    pub node: TreeNodeId,
    /// The rank that owns the node.
    pub owner: usize,
    /// The groups, by their number in the plan, in the order in which they are merged.
    pub groups: Vec<GroupId>,
    /// Number of constraints of its contact points, without those of ties.
    pub conditions: usize,
}

impl ClusterPlan {
    /// True if the cluster contains contact points other than ties.
    pub fn is_in_contact(&self) -> bool {
        self.conditions > 0
    }
}

/// The nodes of `tree` that are clusters. Its roots are left to the interface problem, unless they have contact points;
/// a node with contact points forms one cluster with everything below it.
pub(super) fn cluster_nodes(
    tree: &Tree,
    merging: Merging,
    merge_roots: &[TreeNodeId],
) -> Vec<TreeNodeId> {
    let is_above_merge_roots = above(tree, merge_roots);
    tree.highest(|v| {
        let node = &tree.nodes[v];
        let below_root = |most| node.parent.is_some() && node.conditions <= most;
        match merging {
            Merging::All | Merging::Groups => !node.points.is_empty() || below_root(MAX_CONDITIONS),
            Merging::Linear => !node.points.is_empty() || below_root(0),
            Merging::ActiveSet | Merging::Clusters => {
                node.conditions == 0 && !is_above_merge_roots[v]
            }
        }
    })
}

/// Flags of the nodes of `tree` that are above all of these `nodes`.
fn above(tree: &Tree, nodes: &[TreeNodeId]) -> Numbered<TreeNodeId, bool> {
    let mut is_above = tree.nodes.like(true);
    for v in nodes.iter().flat_map(|&v| tree.subtree(v)) {
        is_above[v] = false;
    }
    is_above
}
