//! The nodes of Γ and the contact points on them, as the catalog names them.

use std::collections::BTreeMap;

use crate::contact_point::ContactPoint;
use crate::disjoint_sets::DisjointSets;
use crate::lists::Lists;
use crate::problem::{Catalog, SubdomainNode};

/// The nodes of Γ, by number.
pub(super) struct Interface {
    /// The subdomains of each, ascending.
    pub subdomains: Lists<u32>,
    /// Those of every subdomain.
    pub numbers: Lists<u32>,
    /// Those that one subdomain has, and contact points name.
    pub unshared: Vec<(SubdomainNode, u32)>,
    /// Those of every contact point, entry by entry.
    pub of_points: Vec<Vec<u32>>,
}

impl Interface {
    pub fn new(catalog: &Catalog) -> Self {
        let mut number: BTreeMap<SubdomainNode, Option<u32>> = BTreeMap::new();
        for (point, nodes) in catalog.points.iter().zip(&catalog.point_nodes) {
            for (&(node, _), of_node) in point.entries.iter().zip(nodes) {
                number.insert(node, of_node.interface);
            }
        }
        let mut count = catalog.interface_nodes as u32;
        let mut unshared = Vec::new();
        for (&node, number) in number.iter_mut().filter(|(_, number)| number.is_none()) {
            *number = Some(count);
            unshared.push((node, count));
            count += 1;
        }
        let shared = (0..).zip(&catalog.interface);
        let shared = shared.flat_map(|(s, list)| list.iter().map(move |&number| (s, number)));
        let own = unshared.iter().map(|&(node, n)| (node.subdomain, n));
        let all = shared.chain(own);
        let of_point = |point: &ContactPoint<SubdomainNode>| {
            let nodes = point.entries.iter();
            nodes.filter_map(|(node, _)| number[node]).collect()
        };
        Self {
            subdomains: Lists::new(count as usize, all.clone().map(|(s, n)| (n, s))),
            numbers: Lists::new(catalog.subdomains.len(), all.clone()),
            of_points: catalog.points.iter().map(of_point).collect(),
            unshared: unshared.clone(),
        }
    }

    /// Sets of contact points whose normal jumps take the place of displacements at once, every point in one
    /// of them: a point that has a node to itself which supports leave free along the normal is one, others
    /// are together with all that share their nodes.
    pub fn systems(&self, catalog: &Catalog) -> Vec<Vec<u32>> {
        let on = (0..).zip(&self.of_points);
        let on = on.flat_map(|(j, list)| list.iter().map(move |&number| (number, j)));
        let mut points = Lists::new(self.subdomains.len(), on);
        points.sort();
        points.dedup();
        let mut sets = DisjointSets::new(self.of_points.len());
        for (j, numbers) in self.of_points.iter().enumerate() {
            let mut nodes = numbers.iter().zip(&catalog.point_nodes[j]);
            let is_own = |&number: &u32| points.of(number as usize).len() == 1;
            if nodes.any(|(number, node)| node.is_free && is_own(number)) {
                continue;
            }
            for &number in numbers {
                for &other in points.of(number as usize) {
                    sets.unite(j as u32, other);
                }
            }
        }
        let mut systems: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for j in 0..self.of_points.len() as u32 {
            systems.entry(sets.find(j)).or_default().push(j);
        }
        systems.into_values().collect()
    }
}
