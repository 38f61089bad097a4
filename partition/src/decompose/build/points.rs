//! The nodes of contact points in the catalog.

use std::collections::HashMap;

use crate::contact_point::ContactPoint;
use crate::problem::{PointNode, Problem, Subdomain, SubdomainNode};

impl Problem {
    /// Fills in the catalog's data on the nodes of its contact points.
    pub(super) fn describe_points(&mut self) {
        let on_interface = |s: &Subdomain| {
            let nodes = s.interface.iter();
            nodes.map(|on| (on.node, on.interface)).collect()
        };
        let numbers: Vec<HashMap<u32, u32>> = self.subdomains.iter().map(on_interface).collect();
        let of_point = |point: &ContactPoint<SubdomainNode>| {
            let nodes = point.entries.iter().enumerate().map(|(i, &(at, _))| {
                let subdomain = &self.subdomains[at.subdomain as usize];
                let supports = subdomain.supports.iter().filter(|s| s.node == at.node);
                let interface = numbers[at.subdomain as usize].get(&at.node).copied();
                let directions = point.directions_at(i, self.catalog.dim);
                PointNode::new(interface, directions, supports.map(|s| s.direction))
            });
            nodes.collect()
        };
        self.catalog.point_nodes = self.catalog.points.iter().map(of_point).collect();
    }
}
