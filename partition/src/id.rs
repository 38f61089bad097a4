//! Numbers of what a problem consists of, a type for each sort of it, so that none is taken for another.
//!
//! All count from 0 over the whole problem, on all ranks the same. Numbers become places in files, messages and lists by
//! `index`, and places become numbers by `From`.

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
            /// That of a place among all of its sort.
            pub const fn new(index: usize) -> Self {
                Self(index)
            }

            /// The place among all of its sort.
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

        #[doc = concat!("Something for some of what [`", stringify!($id), "`] numbers, in the order of the numbers.")]
        pub type $on<T> = BTreeMap<$id, T>;
    )*};
}

ids! {
    /// A block: a subdomain, by its place in the problem file.
    BlockId, OnBlocks;
    /// A node of the [hierarchy](crate::hierarchy::tree::Tree): the blocks by their number, then the inner nodes, children
    /// before parents.
    TreeNodeId, OnTreeNodes;
    /// A contact group: the contact points of one node of the hierarchy. By ascending nodes, of those that have some.
    GroupId, OnGroups;
    /// A cluster: the blocks under one node of the hierarchy, condensed, of which the interface problem is assembled. In the
    /// order of the hierarchy.
    ClusterId, OnClusters;
    /// A pair: a cluster in contact, by its place among those alone.
    PairId, OnPairs;
    /// A node of the hierarchy above which nothing is merged where active sets are fixed, by its place among those alone,
    /// ascending: the clusters of the iterative interface solver.
    MergeRootId, OnMergeRoots;
}

impl From<BlockId> for TreeNodeId {
    /// The leaf of the hierarchy that the block is.
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
