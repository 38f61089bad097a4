//! Weighted nodes: the entries of contact points and of probes.

use super::contents::Contents;
use super::slice::Slice;
use crate::error::InputError;
use crate::problem::{SubdomainNode, SubdomainSummary};

/// The datasets of all entries of a group.
pub(super) struct Entries<'a> {
    pub subdomain: Slice<i64>,
    pub node: Slice<i64>,
    pub weight: Slice<f64>,
    subdomains: &'a [SubdomainSummary],
}

impl<'a> Entries<'a> {
    /// Reads the entries of a `group`, counted by a `letter`.
    pub fn read(
        contents: &Contents,
        group: &str,
        letter: char,
        subdomains: &'a [SubdomainSummary],
    ) -> Result<Self, InputError> {
        let rows = 0..contents.count(letter);
        Ok(Self {
            subdomain: contents.integers(&format!("{group}/entry_subdomain"), rows.clone())?,
            node: contents.integers(&format!("{group}/entry_node"), rows.clone())?,
            weight: contents.numbers(&format!("{group}/entry_weight"), rows)?,
            subdomains,
        })
    }

    /// The subdomain of an entry, checked when it was read.
    pub fn owner(&self, at: usize) -> u32 {
        self.subdomain.all()[at] as u32
    }

    /// The node and the weight of an entry.
    pub fn entry(&self, at: usize) -> Result<(SubdomainNode, f64), InputError> {
        let subdomain = self.owner(at);
        let what = format!("node of subdomain {subdomain}");
        let nodes = self.subdomains[subdomain as usize].nodes;
        let node = self.node.indices(at..at + 1, &what, nodes)?[0];
        Ok((SubdomainNode { subdomain, node }, self.weight.all()[at]))
    }
}
