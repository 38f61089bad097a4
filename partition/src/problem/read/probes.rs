//! The probes.

use super::contents::Contents;
use crate::contact_point::Probe;
use crate::error::InputError;
use crate::problem::{SubdomainNode, SubdomainSummary};

/// Round-off of weights.
const WEIGHT: f64 = 1e-6;

/// Reads all probes.
pub(super) fn read(
    contents: &Contents,
    subdomains: &[SubdomainSummary],
) -> Result<Vec<Probe<SubdomainNode>>, InputError> {
    let rows = 0..contents.count('V');
    if rows.is_empty() {
        return Ok(Vec::new());
    }
    let contact = contents.integers("/probe/contact", rows.clone())?;
    let tag = contents.integers("/probe/node", rows.clone())?;
    let normal = contents
        .numbers("/probe/normal", rows.clone())?
        .vectors(rows.clone());
    let gap = contents.numbers("/probe/gap", rows.clone())?;
    let span = 0..contents.count('H');
    let subdomain = contents.integers("/probe/entry_subdomain", span.clone())?;
    let node = contents.integers("/probe/entry_node", span.clone())?;
    let weight = contents.numbers("/probe/entry_weight", span)?;
    let probe = |row: usize| {
        let entry = |at: usize| {
            // Checked when it was read: the index of a subdomain.
            let owner = subdomain.all()[at] as u32;
            let count = subdomains[owner as usize].nodes;
            let what = format!("node of subdomain {owner}");
            let at_node = SubdomainNode {
                subdomain: owner,
                node: node.indices(at..at + 1, &what, count)?[0],
            };
            Ok((at_node, weight.all()[at]))
        };
        let entries: Result<Vec<_>, InputError> = contents.rows('H', row).map(entry).collect();
        let entries = entries?;
        let (sum, most) = entries
            .iter()
            .fold((0.0, 0.0), |(sum, most): (f64, f64), (_, weight)| {
                (sum + weight, most.max(weight.abs()))
            });
        if entries.is_empty() || sum.abs() > WEIGHT * most {
            let at = contents.rows('H', row).start;
            return Err(weight.error(at, "the weights of a probe don't sum to 0"));
        }
        Ok(Probe {
            contact: contact.all()[row] as u32,
            tag: tag.all()[row],
            entries,
            normal: normal[row],
            gap: gap.all()[row],
        })
    };
    rows.map(probe).collect()
}
