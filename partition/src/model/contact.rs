//! Γ_c: contacts as rows of B u ≤ g.

use std::collections::{HashMap, HashSet};

use super::sight::{Met, Target};
use super::supports::PARALLEL;
use super::surface::Surface;
use super::{Contact, ContactCondition, Support, groups, obstacle};
use crate::element::geometry::{advance, dot, length};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;
use crate::scene::condition::{self, Names, Partner};

/// Interference up to which two sides face each other, relative to the smaller side: beyond it
/// the material lies between them.
const INTERFERENCE: f64 = 0.1;
/// Gaps are exact to this fraction of the scene's coordinates.
const ROUNDING: f64 = 1e-12;

/// What contacts are made from.
pub(super) struct Contacts<'a> {
    mesh: &'a Mesh,
    topology: &'a Topology,
    supports: HashMap<u32, Vec<Support>>,
    /// The largest coordinate (m).
    size: f64,
}

/// A node of side a with its outward normal, and its share of the side.
pub(super) struct SideNode {
    pub node: u32,
    pub position: [f64; 3],
    pub normal: [f64; 3],
    pub share: f64,
}

impl<'a> Contacts<'a> {
    pub fn new(mesh: &'a Mesh, topology: &'a Topology, supports: &[Support]) -> Self {
        let mut by_node: HashMap<u32, Vec<Support>> = HashMap::new();
        for support in supports {
            by_node.entry(support.node).or_default().push(*support);
        }
        let coordinates = mesh.points.iter().flatten();
        Self {
            mesh,
            topology,
            supports: by_node,
            size: coordinates.map(|c| c.abs()).fold(0.0, f64::max),
        }
    }

    /// The conditions of one contact of the scene, along side a.
    pub fn contact(
        &self,
        keys: &condition::Contact,
        warnings: &mut Vec<String>,
    ) -> Result<Contact, InputError> {
        let what = format!("contact '{}'", keys.name);
        let (facets, side_a) = self.side(&keys.side_a, &what)?;
        let mut conditions = match &keys.partner {
            Partner::Obstacle(obstacle) => {
                let nodes = self.nodes_of(&side_a, &what, &HashSet::new())?;
                obstacle::conditions(self.mesh, obstacle, nodes)
            }
            Partner::Side(names) => {
                let (facets_b, side_b) = self.side(names, &what)?;
                let on_a: HashSet<u32> = facets.into_iter().collect();
                if let Some(&both) = facets_b.iter().find(|facet| on_a.contains(facet)) {
                    Err(format!(
                        "the facet of nodes {} is on both sides",
                        self.mesh.tags_of(self.mesh.facets.nodes_of(both as usize))
                    ))
                } else {
                    self.pairs(&side_a, &side_b, &what)
                }
            }
        }
        .map_err(|reason| InputError::new(format!("{what}: {reason}")))?;
        if let Some(gap) = &keys.gap {
            for condition in &mut conditions {
                condition.gap = (gap.at(condition.position))
                    .map_err(|reason| InputError::new(format!("{what}.gap: {reason}")))?;
            }
        }
        let slack = ROUNDING * self.size;
        let deepest = conditions.iter().map(|c| c.gap).fold(0.0, f64::min);
        if deepest < -slack {
            let count = conditions.iter().filter(|c| c.gap < -slack).count();
            warnings.push(format!(
                "{what}: {count} of {} gaps are negative, an interference fit of up to {} m",
                conditions.len(),
                -deepest
            ));
        }
        let mut kept = Vec::with_capacity(conditions.len());
        for condition in conditions {
            match self.prescribed_approach(&condition) {
                None => kept.push(condition),
                Some(approach) if approach <= condition.gap + slack => {}
                Some(approach) => {
                    return Err(InputError::new(format!(
                        "{what}: at node {} displacements are prescribed on both sides that close \
                         the gap of {} m by {approach} m; expected no penetration",
                        condition.tag_a, condition.gap
                    )));
                }
            }
        }
        if kept.is_empty() {
            warnings.push(format!(
                "{what}: all its nodes are prescribed; it has no condition"
            ));
        }
        Ok(Contact {
            name: keys.name.clone(),
            conditions: kept,
        })
    }

    fn side(&self, names: &Names, what: &str) -> Result<(Vec<u32>, Surface), InputError> {
        let facets = groups::facets(self.mesh, names, what)?;
        let what = format!("{what}, side {names}");
        let surface = Surface::new(self.mesh, self.topology, &facets, &what)?;
        Ok((facets, surface))
    }

    /// The nodes along a side but for those in `shared`.
    fn nodes_of(
        &self,
        side: &Surface,
        what: &str,
        shared: &HashSet<u32>,
    ) -> Result<Vec<SideNode>, InputError> {
        let nodes = side.nodes();
        (side.in_order().into_iter())
            .filter(|node| !shared.contains(node))
            .map(|node| {
                let Some(normal) = nodes[&node].normal() else {
                    return Err(InputError::new(format!(
                        "{what}: the side has no normal at node {}, its facets there face \
                         opposite ways",
                        self.mesh.node_tags[node as usize]
                    )));
                };
                Ok(SideNode {
                    node,
                    position: self.mesh.points[node as usize],
                    normal,
                    share: nodes[&node].share,
                })
            })
            .collect()
    }

    /// A condition for every node of side a and its partner on side b.
    fn pairs(
        &self,
        side_a: &Surface,
        side_b: &Surface,
        what: &str,
    ) -> Result<Vec<ContactCondition>, String> {
        let mesh = self.mesh;
        let message = |error: InputError| error.to_string();
        let (on_a, on_b) = (side_a.around(), side_b.around());
        let shared: HashSet<u32> = on_a
            .keys()
            .copied()
            .filter(|n| on_b.contains_key(n))
            .collect();
        let nodes_a = self.nodes_of(side_a, what, &shared).map_err(message)?;
        let nodes_b = self.nodes_of(side_b, what, &shared).map_err(message)?;
        let behind = INTERFERENCE * side_a.extent().min(side_b.extent());
        let skip = |node: u32| shared.contains(&node);

        let (mid_a, mid_b) = (side_a.mid_nodes(), side_b.mid_nodes());
        let target = Target::new(side_b);
        let mut conditions = Vec::new();
        let mut partners = HashSet::new();
        let mut unmatched = Vec::new();
        let mut any_averted = false;
        for a in &nodes_a {
            match target.met(a.position, a.normal, behind, skip) {
                Met::Nodes(nodes, _) => {
                    partners.extend(nodes.iter().copied());
                    let is_mid = mid_a.contains(&a.node);
                    // Their shares of the force would differ.
                    if let Some(other) = nodes.iter().find(|&b| mid_b.contains(b) != is_mid) {
                        unmatched.push((a.node, &side_b.facets[on_b[other][0]]));
                        continue;
                    }
                    for (b, share) in opposite(a, nodes, [side_a, side_b], [&on_a, &on_b]) {
                        let to_b = advance(mesh.points[b as usize], -1.0, a.position);
                        conditions.push(ContactCondition {
                            entries: vec![(a.node, a.normal), (b, a.normal.map(|c| -c))],
                            gap: dot(to_b, a.normal),
                            share,
                            position: a.position,
                            normal: a.normal,
                            tag_a: mesh.node_tags[a.node as usize],
                            tag_b: mesh.node_tags[b as usize],
                        });
                    }
                }
                Met::Facet(facet) => unmatched.push((a.node, &side_b.facets[facet])),
                Met::Nothing { averted } => any_averted |= averted,
            }
        }
        let target = Target::new(side_a);
        for b in nodes_b.iter().filter(|b| !partners.contains(&b.node)) {
            if let Met::Facet(facet) = target.met(b.position, b.normal, behind, skip) {
                unmatched.push((b.node, &side_a.facets[facet]));
            }
        }
        if let Some((node, facet)) = unmatched.first() {
            let shown: Vec<u32> = unmatched.iter().take(5).map(|u| u.0).collect();
            return Err(format!(
                "the sides don't match at {} nodes (tags {}{}): the normal of node {} meets side \
                 {} between nodes {}; expected each corner opposite a corner and each node on an \
                 edge opposite another",
                unmatched.len(),
                mesh.tags_of(&shown),
                if unmatched.len() > 5 { ", …" } else { "" },
                mesh.node_tags[*node as usize],
                if on_a.contains_key(node) { "b" } else { "a" },
                mesh.tags_of(&facet.nodes)
            ));
        }
        if conditions.is_empty() {
            return Err(if any_averted {
                "the sides face the same way; expected them face to face".to_owned()
            } else {
                "no node of side a has one of side b on its outward normal; \
                 expected sides that face each other"
                    .to_owned()
            });
        }
        Ok(conditions)
    }

    /// Σ coefficient·u of a condition all of whose entries are prescribed. `None` if one is free.
    fn prescribed_approach(&self, condition: &ContactCondition) -> Option<f64> {
        condition.entries.iter().try_fold(0.0, |sum, &(node, row)| {
            let mut free = row;
            let mut approach = sum;
            for support in self.supports.get(&node)? {
                let along = dot(row, support.direction);
                free = advance(free, -along, support.direction);
                approach += along * support.value;
            }
            (length(free) <= PARALLEL).then_some(approach)
        })
    }
}

/// Which of the nodes `partners` in one place on side b node `a` of side a has conditions with, and
/// its share of each.
///
/// Where corners of several bodies meet in a point, two that lie diagonally across share nothing but
/// that point, and a condition between them would follow from those between neighbours.
fn opposite(
    a: &SideNode,
    partners: Vec<u32>,
    [side_a, side_b]: [&Surface; 2],
    [on_a, on_b]: [&HashMap<u32, Vec<usize>>; 2],
) -> Vec<(u32, f64)> {
    if let [only] = partners[..] {
        return vec![(only, a.share)];
    }
    let mut shares: Vec<f64> = vec![0.0; partners.len()];
    let mut alone = 0.0;
    for facet in on_a[&a.node].iter().map(|&f| &side_a.facets[f]) {
        let meets = |b: &u32| {
            let mut facets = on_b[b].iter().map(|&f| &side_b.facets[f]);
            facets.any(|other| facet.is_opposite(a.node, other, *b, a.normal))
        };
        let met: Vec<bool> = partners.iter().map(meets).collect();
        let count = met.iter().filter(|&&met| met).count();
        let own = facet.nodes.iter().position(|&node| node == a.node);
        let share = own.map_or(0.0, |i| facet.share(i));
        match count {
            0 => alone += share,
            _ => (shares.iter_mut().zip(met).filter(|(_, met)| *met))
                .for_each(|(sum, _)| *sum += share / count as f64),
        }
    }
    if shares.iter().all(|&share| share == 0.0) {
        let share = a.share / partners.len() as f64;
        return partners.into_iter().map(|b| (b, share)).collect();
    }
    let mut kept: Vec<(u32, f64)> = (partners.into_iter().zip(shares))
        .filter(|&(_, share)| share > 0.0)
        .collect();
    let alone = alone / kept.len() as f64;
    kept.iter_mut().for_each(|(_, share)| *share += alone);
    kept
}
