//! Groups: the subdomains that contact links.

use super::Owners;
use crate::disjoint_sets::DisjointSets;
use crate::error::InputError;
use crate::model::Model;

/// How many node tags a warning names.
const NAMED: usize = 5;

/// The groups in contact, numbered by their lowest subdomain.
pub(super) struct Groups {
    /// Number of groups.
    pub count: usize,
    /// Group of every subdomain; `None` for a linear one.
    pub of: Vec<Option<usize>>,
    /// Names the nodes at which Γ meets Γ_c, if there are any.
    pub warning: Option<String>,
}

impl Groups {
    /// Links the subdomains of every contact condition, among them all that share one of its
    /// nodes, so that no node of a condition lies between a group and the rest.
    ///
    /// # Errors
    /// A condition without nodes.
    pub fn new(model: &Model, owners: &Owners) -> Result<Self, InputError> {
        let mut sets = DisjointSets::new(owners.count);
        let mut in_contact = vec![false; owners.count];
        let mut meeting = Vec::new();
        for contact in &model.contacts {
            for (place, point) in contact.points.iter().enumerate() {
                let nodes = point.entries.iter().map(|&(node, _)| node);
                let linked: Vec<u32> = nodes
                    .clone()
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
                meeting.extend(nodes.filter(|&n| owners.of.of(n as usize).len() > 1));
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
        meeting.sort_unstable();
        meeting.dedup();
        Ok(Self {
            count,
            of,
            warning: warning(model, &meeting),
        })
    }
}

fn warning(model: &Model, meeting: &[u32]) -> Option<String> {
    let tags: Vec<String> = meeting
        .iter()
        .take(NAMED)
        .map(|&node| model.mesh.node_tags[node as usize].to_string())
        .collect();
    let more = match meeting.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    (!meeting.is_empty()).then(|| {
        format!(
            "the partition's boundaries meet contact surfaces at the nodes {}{more}; all subdomains around them are in one group",
            tags.join(", ")
        )
    })
}
