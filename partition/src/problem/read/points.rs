//! The contact points of one group.

use std::collections::{HashMap, HashSet};

use super::ProblemFile;
use super::consistency::Members;
use super::subdomain::slice;
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
        let dim = self.catalog.dim;
        let rows = slice(&self.offsets.groups, group);
        let total = self.column("/contact/contact")?.rows();
        let column = |name| self.column(name)?.shaped(Some(total), &[]);
        let table = |name| self.table(name, dim)?.shaped(Some(total), &[dim]);
        let contact = column("/contact/contact")?.integers(rows.clone())?;
        let place = column("/contact/place")?.integers(rows.clone())?;
        let gap = column("/contact/gap")?.floats(rows.clone())?;
        let areas = column("/contact/area")?;
        let area = areas.floats(rows.clone())?;
        if let Some(at) = area.iter().position(|&a| a <= 0.0) {
            return Err(areas.row_error(
                rows.start + at,
                &format!("{}; expected a positive area", area[at]),
            ));
        }
        let position = table("/contact/position")?.vectors(rows.clone(), dim)?;
        let force_point = table("/contact/force_point")?.vectors(rows.clone(), dim)?;
        let normal = table("/contact/normal")?.unit_vectors(rows.clone(), dim)?;
        let tag_a = column("/contact/node_a")?.integers(rows.clone())?;
        let tag_b = column("/contact/node_b")?.integers(rows.clone())?;
        let entries = self.read_entries(group, members)?;
        let first = rows.start;
        let point = |(i, entries): (usize, _)| ContactPoint {
            // Checked when the file was opened: an index of a contact, and one of its places.
            contact: contact[i] as u32,
            place: place[i] as u32,
            gap: gap[i],
            area: area[i],
            force_point: force_point[i],
            tag_b: tag_b[i],
            ..ContactPoint::new(entries, normal[i], position[i], tag_a[i])
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
        let rows = slice(&self.offsets.groups, group);
        let subdomain = self.column("/contact/entry_subdomain")?;
        let total = subdomain.rows();
        let offset = self
            .column("/contact/entry_offset")?
            .shaped(self.offsets.groups.last().map(|m| m + 1), &[])?;
        let offsets = offset.offsets(total)?;
        let node = self
            .column("/contact/entry_node")?
            .shaped(Some(total), &[])?;
        let weight = self
            .column("/contact/entry_weight")?
            .shaped(Some(total), &[])?;
        let span = offsets[rows.start]..offsets[rows.end];
        let subdomains =
            subdomain.indices(span.clone(), self.catalog.subdomains.len(), "subdomain")?;
        let nodes = node.integers(span.clone())?;
        let weights = weight.floats(span.clone())?;
        let foreign = self.foreign_nodes(members);
        let mut entries = Vec::with_capacity(rows.len());
        let mut named = HashSet::new();
        for row in rows {
            let mut list = Vec::with_capacity(offsets[row + 1] - offsets[row]);
            named.clear();
            for at in offsets[row]..offsets[row + 1] {
                let i = at - span.start;
                let summary = &self.catalog.subdomains[subdomains[i] as usize];
                if summary.group != Some(group) {
                    return Err(subdomain.row_error(
                        at,
                        &format!("subdomain {} isn't in group {group}", subdomains[i]),
                    ));
                }
                let number = u32::try_from(nodes[i])
                    .ok()
                    .filter(|&n| (n as usize) < summary.nodes)
                    .ok_or_else(|| {
                        node.row_error(
                            at,
                            &format!(
                                "{} is no node of subdomain {}; expected 0 to {}",
                                nodes[i],
                                subdomains[i],
                                summary.nodes - 1
                            ),
                        )
                    })?;
                if foreign.contains(&(subdomains[i], number)) {
                    return Err(node.row_error(
                        at,
                        &format!(
                            "a subdomain outside group {group} shares the node; expected all that share it in one group"
                        ),
                    ));
                }
                if !named.insert((subdomains[i], number)) {
                    return Err(node.row_error(at, "the point named the node before"));
                }
                let node = SubdomainNode {
                    subdomain: subdomains[i],
                    node: number,
                };
                list.push((node, weights[i]));
            }
            if list.iter().all(|&(_, weight)| weight == 0.0) {
                return Err(offset.row_error(row, "expected weights that aren't all zero"));
            }
            entries.push(list);
        }
        Ok(entries)
    }

    /// Nodes of a group (subdomain, node) that a subdomain outside it shares.
    fn foreign_nodes(&self, members: &[&Subdomain]) -> HashSet<(u32, u32)> {
        let mut inside: HashMap<u32, u32> = HashMap::new();
        for on in members.iter().flat_map(|member| &member.interface) {
            *inside.entry(on.interface).or_default() += 1;
        }
        let mut foreign = HashSet::new();
        for member in members {
            for on in &member.interface {
                if inside.get(&on.interface) != Some(&self.sharing[on.interface as usize]) {
                    foreign.insert((member.index as u32, on.node));
                }
            }
        }
        foreign
    }
}
