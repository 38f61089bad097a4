//! The probes.

use super::contents::Contents;
use super::entries::Entries;
use crate::contact_point::Probe;
use crate::error::InputError;
use crate::problem::{SubdomainNode, SubdomainSummary};

/// Tolerance of weights.
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
    let all = Entries::read(contents, "/probe", 'H', subdomains)?;
    let probe = |row: usize| {
        let entries = contents.rows('H', row).map(|at| all.entry(at));
        let entries = entries.collect::<Result<Vec<_>, _>>()?;
        let (sum, most) = entries
            .iter()
            .fold((0.0, 0.0), |(sum, most): (f64, f64), (_, weight)| {
                (sum + weight, most.max(weight.abs()))
            });
        if entries.is_empty() || sum.abs() > WEIGHT * most {
            let at = contents.rows('H', row).start;
            return Err(all
                .weight
                .error(at, "the weights of a probe don't sum to 0"));
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
