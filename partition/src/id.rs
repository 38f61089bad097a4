//! Indices of a problem's parts, with a separate type for each kind, so that they can't be confused.
//!
//! All count from 0 over the whole problem, equally on all ranks. `index` converts them to positions in files, messages
//! and lists, and `From` converts positions to indices.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

macro_rules! ids {
    ($($(#[$doc:meta])* $id:ident, $on:ident;)*) => {$(
        $(#[$doc])*
        #[derive(
            Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
        )]
        #[serde(transparent)]
        pub struct $id(usize);

        impl $id {
            /// The index of a position.
            pub const fn new(index: usize) -> Self {
                Self(index)
            }

            /// The position.
            pub const fn index(self) -> usize {
                self.0
            }
        }

        impl From<usize> for $id {
            fn from(index: usize) -> Self {
                Self(index)
            }
        }

        impl From<$id> for usize {
            fn from(id: $id) -> Self {
                id.0
            }
        }

        impl fmt::Display for $id {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }

        #[doc = concat!("Values by [`", stringify!($id), "`], in ascending order; not every index needs one.")]
        pub type $on<T> = BTreeMap<$id, T>;
    )*};
}

ids! {
    /// A block: a subdomain, by its position in the problem file.
    BlockId, OnBlocks;
    /// A node of the [hierarchy](crate::hierarchy::tree::Tree): first the blocks, then the inner nodes, children before
    /// parents.
    TreeNodeId, OnTreeNodes;
    /// A contact group: the contact points of one node of the hierarchy, in ascending order of the nodes with contact
    /// points.
    GroupId, OnGroups;
    /// A cluster: the blocks under one node of the hierarchy, condensed; the interface problem is assembled from the
    /// clusters. In the order of the hierarchy.
    ClusterId, OnClusters;
    /// A pair: a cluster in contact, by its position among these clusters.
    PairId, OnPairs;
    /// A root of merging: a node of the hierarchy above which nothing is merged with fixed active sets, by its position
    /// among these nodes, ascending. These are the clusters of the iterative interface solver.
    MergeRootId, OnMergeRoots;
}

impl From<BlockId> for TreeNodeId {
    /// The leaf of the hierarchy for a block.
    fn from(block: BlockId) -> Self {
        Self(block.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_written_as_a_plain_one() {
        let written = serde_json::to_string(&[GroupId::new(7)]).unwrap();
        assert_eq!(written, "[7]");
        let read: Vec<GroupId> = serde_json::from_str(&written).unwrap();
        assert_eq!((read[0].index(), read[0].to_string().as_str()), (7, "7"));
    }
}
