//! The nodes of Γ and the contact points on them, by the numbers of the catalog.

use std::collections::{BTreeMap, VecDeque};

use crate::contact_point::{ContactPoint, Law};
use crate::disjoint_sets::DisjointSets;
use crate::element::geometry::{cross, length};
use crate::lists::Lists;
use crate::problem::{Catalog, SubdomainNode};

/// The nodes of Γ, by number.
pub(super) struct Interface {
    /// The subdomains of each node, ascending.
    pub subdomains: Lists<u32>,
    /// The nodes of Γ of every subdomain.
    pub numbers: Lists<u32>,
    /// Nodes of Γ that belong to a single subdomain and to contact points.
    pub unshared: Vec<UnsharedNode>,
    /// The nodes of Γ of every contact point, in the order of its entries.
    pub of_points: Vec<Vec<u32>>,
}

/// A node of Γ that belongs to a single subdomain and to contact points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnsharedNode {
    /// The node.
    pub at: SubdomainNode,
    /// Its number on Γ.
    pub number: u32,
    /// The common normal of all points at the node, if they have one and neither friction nor ties: without supports,
    /// only its displacement along this normal is on Γ, and the tangential ones belong to the interior of the
    /// subdomain.
    pub slides: Option<[f64; 3]>,
}

/// Sine of the angle up to which normals count as parallel: the remainder is below the smallest significant entry of a
/// row of B.
const PARALLEL: f64 = 2e-15;
/// Smallest relative weight of a pivot node that other contact points share.
const LEADING: f64 = 0.5;
/// Smallest relative weight of a pivot node that no other contact point has. Other displacements enter the one that is
/// replaced with the reciprocal of its weight: a facet that another one hardly overlaps would make these factors so
/// large that nothing is left of the stiffness.
const ALONE: f64 = 0.1;

/// Contact points whose jumps replace displacements in one elimination step.
pub(super) struct System {
    /// The contact points, ascending.
    pub points: Vec<u32>,
    /// Other points at the displacements that are replaced, all in earlier systems: this system belongs to a tree node
    /// at or above theirs.
    pub above: Vec<u32>,
}

impl Interface {
    pub fn new(catalog: &Catalog) -> Self {
        let mut number: BTreeMap<SubdomainNode, Option<u32>> = BTreeMap::new();
        let mut slides: BTreeMap<SubdomainNode, Option<[f64; 3]>> = BTreeMap::new();
        for (point, nodes) in catalog.points.iter().zip(&catalog.point_nodes) {
            let may_slide = point.law == Law::Frictionless;
            let normal = may_slide.then(|| point.normal());
            for (&(node, _), of_node) in point.entries.iter().zip(nodes) {
                number.insert(node, of_node.interface);
                let along = slides.entry(node).or_insert(normal);
                *along = along
                    .zip(normal)
                    .filter(|&(along, normal)| length(cross(along, normal)) <= PARALLEL)
                    .map(|(along, _)| along);
            }
        }
        let mut count = catalog.interface_nodes as u32;
        let mut unshared = Vec::new();
        for (&node, number) in number.iter_mut().filter(|(_, number)| number.is_none()) {
            *number = Some(count);
            unshared.push(UnsharedNode {
                at: node,
                number: count,
                slides: slides[&node],
            });
            count += 1;
        }
        let shared = (0..).zip(&catalog.interface);
        let shared = shared.flat_map(|(s, list)| list.iter().map(move |&number| (s, number)));
        let own = unshared.iter().map(|own| (own.at.subdomain, own.number));
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

    /// The contact points, ordered so that their jumps can replace displacements one system after the other.
    ///
    /// A point with a node of its own is a system, as no other point needs the displacement that it replaces there. So
    /// is a point that shares all its nodes, but one of them only with earlier systems. The remaining points are
    /// grouped with those that share their nodes.
    pub fn systems(&self, catalog: &Catalog) -> Vec<System> {
        let on = (0..).zip(&self.of_points);
        let on = on.flat_map(|(j, list)| list.iter().map(move |&number| (number, j)));
        let mut users = Lists::new(self.subdomains.len(), on);
        users.sort();
        users.dedup();
        let mut systems = Vec::new();
        let mut is_waiting = vec![true; self.of_points.len()];
        let mut waiting: Vec<usize> = users.iter().map(<[u32]>::len).collect();
        let mut next: VecDeque<u32> = (0..self.of_points.len() as u32).collect();
        while let Some(j) = next.pop_front() {
            let entries = &catalog.points[j as usize].entries;
            let largest = entries.iter().fold(0.0, |m: f64, (_, w)| m.max(w.abs()));
            let can_go = |&(i, &number): &(usize, &u32)| {
                let (_, weight) = entries[i];
                let least = match users.of(number as usize).len() {
                    1 => ALONE,
                    _ => LEADING,
                };
                catalog.point_nodes[j as usize][i].is_free
                    && waiting[number as usize] == 1
                    && weight.abs() >= least * largest
            };
            let mut numbers = self.of_points[j as usize].iter().enumerate();
            let Some((_, &goes)) = numbers.find(can_go).filter(|_| is_waiting[j as usize]) else {
                continue;
            };
            systems.push(System {
                points: vec![j],
                above: others(users.of(goes as usize), &[j]),
            });
            is_waiting[j as usize] = false;
            let mut numbers = self.of_points[j as usize].clone();
            numbers.sort_unstable();
            numbers.dedup();
            for number in numbers {
                waiting[number as usize] -= 1;
                if waiting[number as usize] == 1 {
                    next.extend(
                        users
                            .of(number as usize)
                            .iter()
                            .filter(|&&k| is_waiting[k as usize]),
                    );
                }
            }
        }
        systems.extend(self.cyclic_systems(&users, &is_waiting));
        systems
    }

    /// The systems of the points that depend on each other in a cycle.
    fn cyclic_systems(&self, users: &Lists<u32>, is_waiting: &[bool]) -> Vec<System> {
        let mut sets = DisjointSets::new(self.of_points.len());
        for users in users.iter() {
            let mut stuck = users.iter().copied().filter(|&j| is_waiting[j as usize]);
            if let Some(first) = stuck.next() {
                stuck.for_each(|other| sets.unite(first, other));
            }
        }
        let mut stuck: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for j in (0..self.of_points.len() as u32).filter(|&j| is_waiting[j as usize]) {
            stuck.entry(sets.find(j)).or_default().push(j);
        }
        let system = |points: Vec<u32>| {
            let numbers = points.iter().flat_map(|&j| &self.of_points[j as usize]);
            let users = numbers.flat_map(|&number| users.of(number as usize));
            let mut users: Vec<u32> = users.copied().collect();
            users.sort_unstable();
            users.dedup();
            System {
                above: others(&users, &points),
                points,
            }
        };
        stuck.into_values().map(system).collect()
    }
}

/// The points among `users` that are not among `points`, both ascending.
fn others(users: &[u32], points: &[u32]) -> Vec<u32> {
    let is_other = |j: &&u32| points.binary_search(j).is_err();
    users.iter().filter(is_other).copied().collect()
}
