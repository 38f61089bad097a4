//! Contact groups between clusters.

use std::collections::BTreeSet;

use contact_dd_partition::id::{GroupId, MergeRootId};
use contact_dd_partition::numbered::Numbered;

use crate::schur::condensed::InterfaceDof;

/// A contact group between clusters.
#[derive(Debug)]
pub struct Between {
    /// The number.
    pub number: GroupId,
    /// The rank that owns it.
    pub owner: usize,
    /// The unknowns, ascending.
    pub dofs: Vec<InterfaceDof>,
    /// The clusters with some of these unknowns, or others that these may be tied to, ascending.
    pub clusters: Vec<MergeRootId>,
}

/// The contact groups between clusters with these `dofs`, in the order of the hierarchy, each with its number, its
/// owner and its unknowns.
pub fn between(
    dofs: &Numbered<MergeRootId, Vec<InterfaceDof>>,
    groups: impl Iterator<Item = ((GroupId, usize), Vec<InterfaceDof>)>,
) -> Vec<Between> {
    let has_some = |c: MergeRootId, sought: &[InterfaceDof]| {
        (sought.iter()).any(|dof| dofs[c].binary_search(dof).is_ok())
    };
    let mut between: Vec<Between> = Vec::new();
    for ((number, owner), sought) in groups {
        let mut clusters: BTreeSet<MergeRootId> =
            dofs.ids().filter(|&c| has_some(c, &sought)).collect();
        // A lower group's ties may involve unknowns of this one.
        for below in &between {
            if (below.dofs.iter()).any(|dof| sought.binary_search(dof).is_ok()) {
                clusters.extend(&below.clusters);
            }
        }
        between.push(Between {
            number,
            owner,
            dofs: sought,
            clusters: clusters.into_iter().collect(),
        });
    }
    between
}
