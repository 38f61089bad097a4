//! The contact points of one group.

use std::collections::{HashMap, HashSet};

use super::ProblemFile;
use super::consistency::Members;
use crate::contact_point::ContactPoint;
use crate::error::InputError;
use crate::problem::{Subdomain, SubdomainNode};

impl ProblemFile {
    pub(super) fn read_points(
        &self,
        group: usize,
        members: &[&Subdomain],
    ) -> Result<Vec<ContactPoint<SubdomainNode>>, InputError> {
        if group >= self.catalog.groups.len() {
            return Err(InputError::new(format!("there is no group {group}")));
        }
        let rows = self.contents.rows('R', group);
        let integers = |path| self.contents.integers(path, rows.clone());
        let numbers = |path| self.contents.numbers(path, rows.clone());
        let contact = integers("/contact/contact")?;
        let place = integers("/contact/place")?;
        let gap = numbers("/contact/gap")?;
        let area = numbers("/contact/area")?;
        let position = numbers("/contact/position")?.vectors(rows.clone());
        let force_point = numbers("/contact/force_point")?.vectors(rows.clone());
        let normal = numbers("/contact/normal")?.vectors(rows.clone());
        let tag_a = integers("/contact/node_a")?;
        let tag_b = integers("/contact/node_b")?;
        let entries = self.read_entries(group, members)?;
        let first = rows.start;
        let point = |(i, entries): (usize, _)| ContactPoint {
            // Checked when the file was opened: an index of a contact, and one of its places.
            contact: contact.all()[i] as u32,
            place: place.all()[i] as u32,
            gap: gap.all()[i],
            area: area.all()[i],
            force_point: force_point[i],
            tag_b: tag_b.all()[i],
            ..ContactPoint::new(entries, normal[i], position[i], tag_a.all()[i])
        };
        let list: Vec<_> = entries.into_iter().enumerate().map(point).collect();
        let members = Members::new(members);
        for (i, point) in list.iter().enumerate() {
            members.check(point, first + i)?;
        }
        Ok(list)
    }

    /// The nodes and weights of each point of a group.
    fn read_entries(
        &self,
        group: usize,
        members: &[&Subdomain],
    ) -> Result<Vec<Vec<(SubdomainNode, f64)>>, InputError> {
        let rows = self.contents.rows('R', group);
        let span = self.contents.rows_of('E', rows.clone());
        let subdomain = (self.contents).integers("/contact/entry_subdomain", span.clone())?;
        let node = (self.contents).integers("/contact/entry_node", span.clone())?;
        let weight = (self.contents).numbers("/contact/entry_weight", span.clone())?;
        let foreign = self.foreign_nodes(members);
        let mut entries = Vec::with_capacity(rows.len());
        let mut named = HashSet::new();
        for row in rows {
            let mut list = Vec::new();
            named.clear();
            for at in self.contents.rows('E', row) {
                let owner = subdomain.of(at..at + 1)[0] as u32;
                let summary = &self.catalog.subdomains[owner as usize];
                if summary.group != Some(group) {
                    let what = format!("subdomain {owner} isn't in group {group}");
                    return Err(subdomain.error(at, &what));
                }
                let what = format!("node of subdomain {owner}");
                let number = node.indices(at..at + 1, &what, summary.nodes)?[0];
                let named_node = SubdomainNode {
                    subdomain: owner,
                    node: number,
                };
                if foreign.contains(&named_node) {
                    let what = format!(
                        "a subdomain outside group {group} shares the node; expected all that \
                         share it in one group"
                    );
                    return Err(node.error(at, &what));
                }
                if !named.insert(named_node) {
                    return Err(node.error(at, "the point named the node before"));
                }
                list.push((named_node, weight.of(at..at + 1)[0]));
            }
            if list.iter().all(|&(_, weight)| weight == 0.0) {
                return Err(InputError::new(format!(
                    "dataset /contact/entry_offset, row {row}: expected weights that aren't all zero"
                )));
            }
            entries.push(list);
        }
        Ok(entries)
    }

    /// Nodes of a group that a subdomain outside it shares.
    fn foreign_nodes(&self, members: &[&Subdomain]) -> HashSet<SubdomainNode> {
        let mut inside: HashMap<u32, u32> = HashMap::new();
        for on in members.iter().flat_map(|member| &member.interface) {
            *inside.entry(on.interface).or_default() += 1;
        }
        let mut foreign = HashSet::new();
        for member in members {
            for on in &member.interface {
                if inside.get(&on.interface) != Some(&self.sharing[on.interface as usize]) {
                    foreign.insert(SubdomainNode {
                        subdomain: member.index as u32,
                        node: on.node,
                    });
                }
            }
        }
        foreign
    }
}
