//! What is worth knowing about a decomposition.

use std::collections::HashMap;
use std::fmt;

use crate::problem::{ContactSummary, Problem};

/// A group of subdomains in contact.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GroupSummary {
    /// Its subdomains, ascending.
    pub subdomains: Vec<usize>,
    /// Number of contact conditions.
    pub conditions: usize,
}

/// Sizes and balance of a problem; its `Display` is what the partition tool prints.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Number of nodes, shared ones counted once.
    pub nodes: usize,
    /// Number of dofs, shared ones counted once.
    pub dofs: usize,
    /// Number of cells.
    pub cells: usize,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of subdomains.
    pub subdomains: usize,
    /// Number of subdomains without contact.
    pub linear_subdomains: usize,
    /// Cells of the largest subdomain over the mean.
    pub imbalance: f64,
    /// Number of nodes on Γ.
    pub interface_nodes: usize,
    /// Number of merges of the hierarchy.
    pub merges: usize,
    /// Flops of all its fronts.
    pub merge_flops: f64,
    /// Dofs of its largest front.
    pub largest_front: usize,
    /// Estimated work under the larger child of the root with most work, over the mean of both.
    pub uneven_halves: f64,
    /// Number of facets on Γ.
    pub cut_facets: usize,
    /// Number of contact conditions.
    pub contact_conditions: usize,
    /// Contacts.
    pub contacts: Vec<ContactSummary>,
    /// How the sides of each contact are paired, in words.
    pub pairings: Vec<&'static str>,
    /// Groups in contact.
    pub groups: Vec<GroupSummary>,
}

impl Problem {
    /// Sizes and balance.
    pub fn summary(&self) -> Summary {
        let catalog = &self.catalog;
        let count = catalog.subdomains.len();
        let cells: usize = catalog.subdomains.iter().map(|s| s.cells).sum();
        let largest = catalog.subdomains.iter().map(|s| s.cells).max();
        let work = catalog.hierarchy.work(catalog);
        let front_sizes = work.fronts.iter().map(|f| f.eliminated + f.kept);
        Summary {
            nodes: catalog.nodes(),
            dofs: catalog.dofs(),
            cells,
            bodies: catalog.bodies.len(),
            subdomains: count,
            linear_subdomains: catalog
                .subdomains
                .iter()
                .filter(|s| s.group.is_none())
                .count(),
            imbalance: largest.unwrap_or(0) as f64 * count as f64 / cells.max(1) as f64,
            interface_nodes: catalog.interface_nodes,
            merges: work.fronts.len(),
            merge_flops: work.of_fronts(),
            largest_front: front_sizes.max().unwrap_or(0),
            uneven_halves: catalog.hierarchy.uneven_halves(&work),
            cut_facets: self.cut_facets(),
            contact_conditions: catalog.conditions(),
            contacts: catalog.contacts.clone(),
            pairings: self.pairings(),
            groups: catalog
                .groups
                .iter()
                .enumerate()
                .map(|(group, &conditions)| GroupSummary {
                    subdomains: (0..count)
                        .filter(|&s| catalog.subdomains[s].group == Some(group))
                        .collect(),
                    conditions,
                })
                .collect(),
        }
    }

    /// How the sides of each contact are paired, as its points show.
    fn pairings(&self) -> Vec<&'static str> {
        let mut pairings = vec![""; self.catalog.contacts.len()];
        for point in self.points.iter().flatten() {
            pairings[point.contact as usize] = match (point.entries.len(), point.tag_b) {
                (1, _) => ", obstacle",
                (_, -1) => ", mortar",
                _ => ", node by node",
            };
        }
        pairings
    }

    /// Facets that cells of two subdomains share.
    fn cut_facets(&self) -> usize {
        let mut seen: HashMap<Vec<u32>, usize> = HashMap::new();
        for subdomain in &self.subdomains {
            let interface: HashMap<u32, u32> = subdomain
                .interface
                .iter()
                .map(|on| (on.node, on.interface))
                .collect();
            for (kind, nodes) in subdomain.cells.iter() {
                for (_, local) in kind.facets() {
                    let on: Option<Vec<u32>> = local
                        .iter()
                        .map(|&i| interface.get(&nodes[i]).copied())
                        .collect();
                    if let Some(mut key) = on {
                        key.sort_unstable();
                        // A facet inside a subdomain has both ends on Γ where that one is thin.
                        seen.entry(key)
                            .and_modify(|of| {
                                if *of != subdomain.index {
                                    *of = usize::MAX;
                                }
                            })
                            .or_insert(subdomain.index);
                    }
                }
            }
        }
        seen.values().filter(|&&of| of == usize::MAX).count()
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "mesh          {} nodes, {} cells",
            self.nodes, self.cells
        )?;
        writeln!(f, "dofs          {}", self.dofs)?;
        writeln!(
            f,
            "subdomains    {}, {} in contact",
            self.subdomains,
            self.subdomains - self.linear_subdomains
        )?;
        writeln!(
            f,
            "balance       {:.2} (largest subdomain over the mean, by cells)",
            self.imbalance
        )?;
        writeln!(
            f,
            "interface     {} nodes, {} facets cut",
            self.interface_nodes, self.cut_facets
        )?;
        writeln!(
            f,
            "hierarchy     {} merges, {:.3e} flops, largest front {} dofs, halves {:.3}",
            self.merges, self.merge_flops, self.largest_front, self.uneven_halves
        )?;
        writeln!(f, "contact       {} conditions", self.contact_conditions)?;
        for (contact, pairing) in self.contacts.iter().zip(&self.pairings) {
            writeln!(
                f,
                "              {:>6} on {}{pairing}",
                contact.conditions, contact.name
            )?;
        }
        write!(f, "groups        {}", self.sizes_of_groups())
    }
}

impl Summary {
    /// How many subdomains the groups in contact have, in words.
    fn sizes_of_groups(&self) -> String {
        let count = |wanted: fn(usize) -> bool| {
            let sizes = self.groups.iter().map(|group| group.subdomains.len());
            sizes.filter(|&size| wanted(size)).count()
        };
        let words = [
            (count(|size| size == 1), "single"),
            (count(|size| size == 2), "in pairs"),
            (count(|size| size > 2), "larger"),
        ];
        let words: Vec<String> = words
            .into_iter()
            .filter(|&(count, _)| count > 0)
            .map(|(count, word)| format!("{count} {word}"))
            .collect();
        match words.is_empty() {
            true => "none".into(),
            false => words.join(", "),
        }
    }
}
