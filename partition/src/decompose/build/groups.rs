//! Contact groups: the subdomains linked by contact.

use super::owners::Owners;
use crate::disjoint_sets::DisjointSets;
use crate::error::InputError;
use crate::model::Model;

/// The contact groups, numbered in the order of their lowest subdomain.
pub(super) struct Groups {
    /// Number of groups.
    pub count: usize,
    /// Group of every subdomain; `None` for a subdomain without contact.
    pub of: Vec<Option<usize>>,
}

impl Groups {
    /// Links the subdomains of every contact constraint, including all that share one of its nodes, so that no node of
    /// a constraint lies on the interface between a group and the rest.
    ///
    /// # Errors
    /// A constraint without nodes.
    pub fn new(model: &Model, owners: &Owners) -> Result<Self, InputError> {
        let mut sets = DisjointSets::new(owners.count);
        let mut in_contact = vec![false; owners.count];
        for contact in &model.contacts {
            for (place, point) in contact.points.iter().enumerate() {
                let nodes = point.entries.iter().map(|&(node, _)| node);
                let linked: Vec<u32> = nodes
                    .flat_map(|node| owners.of.of(node as usize))
                    .map(|&(owner, _)| owner)
                    .collect();
                let Some(&first) = linked.first() else {
                    return Err(InputError::new(format!(
                        "contact \"{}\", point {place}: it has no nodes",
                        contact.name
                    )));
                };
                in_contact[first as usize] = true;
                for &other in &linked {
                    sets.unite(first, other);
                    in_contact[other as usize] = true;
                }
            }
        }
        let mut group_of_root = vec![None; owners.count];
        let mut count = 0;
        let of = (0..owners.count)
            .map(|subdomain| {
                in_contact[subdomain].then(|| {
                    let root = sets.find(subdomain as u32) as usize;
                    *group_of_root[root].get_or_insert_with(|| {
                        count += 1;
                        count - 1
                    })
                })
            })
            .collect();
        Ok(Self { count, of })
    }
}
