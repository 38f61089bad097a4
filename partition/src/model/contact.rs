//! Γ_c: contacts n·(u_a − u_b) ≤ g as rows of B u ≤ g.

use std::collections::{HashMap, HashSet};

use super::node_pairs::Unpaired;
use super::sides::{Sides, side_nodes};
use super::steps::Loads;
use super::supports::PARALLEL;
use super::surface::Surface;
use super::{Contact, ContactCondition, groups, mortar, node_pairs, obstacle};
use crate::element::geometry::{advance, dot, length};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;
use crate::scene::condition::{self, Names, Pairing, Partner};

/// Gaps are exact to this fraction of the scene's coordinates.
const ROUNDING: f64 = 1e-12;

/// A direction in which a node is held, and how far in each load step (m).
struct Held {
    direction: [f64; 3],
    values: Vec<f64>,
}

/// What contacts are made from.
pub(super) struct Contacts<'a> {
    mesh: &'a Mesh,
    topology: &'a Topology,
    supports: HashMap<u32, Vec<Held>>,
    /// The largest coordinate (m).
    size: f64,
}

impl<'a> Contacts<'a> {
    pub fn new(mesh: &'a Mesh, topology: &'a Topology, loads: &Loads) -> Self {
        let mut by_node: HashMap<u32, Vec<Held>> = HashMap::new();
        for (i, support) in loads.supports.iter().enumerate() {
            by_node.entry(support.node).or_default().push(Held {
                direction: support.direction,
                values: loads.values(i),
            });
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
                let nodes = side_nodes(self.mesh, &side_a, &what, &HashSet::new())?;
                obstacle::conditions(self.mesh, obstacle, nodes)
                    .map_err(|reason| InputError::new(format!("{what}: {reason}")))?
            }
            Partner::Side(names) => {
                let (facets_b, side_b) = self.side(names, &what)?;
                let on_a: HashSet<u32> = facets.into_iter().collect();
                if let Some(&both) = facets_b.iter().find(|facet| on_a.contains(facet)) {
                    return Err(InputError::new(format!(
                        "{what}: the facet of nodes {} is on both sides",
                        self.mesh.tags_of(self.mesh.facets.nodes_of(both as usize))
                    )));
                }
                self.pairs(&side_a, &side_b, keys.pairing, &what)?
            }
        };
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
                Some(approaches) => {
                    let closest = approaches.into_iter().fold(f64::NEG_INFINITY, f64::max);
                    if closest <= condition.gap + slack {
                        continue;
                    }
                    return Err(InputError::new(format!(
                        "{what}: at node {} displacements are prescribed on both sides that close \
                         the gap of {} m by {closest} m; expected no penetration",
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

    /// The conditions of two sides, paired as the scene asks or as their nodes allow.
    fn pairs(
        &self,
        side_a: &Surface,
        side_b: &Surface,
        pairing: Option<Pairing>,
        what: &str,
    ) -> Result<Vec<ContactCondition>, InputError> {
        let refused = |reason: String| InputError::new(format!("{what}: {reason}"));
        let sides = Sides::new(self.mesh, side_a, side_b, what)?;
        let matched = match pairing {
            Some(Pairing::Mortar) => return mortar::conditions(&sides).map_err(refused),
            Some(Pairing::Nodes) | None => node_pairs::conditions(&sides),
        };
        match (matched, pairing) {
            (Ok(conditions), _) => Ok(conditions),
            (Err(Unpaired::Unmatched(_)), None) => mortar::conditions(&sides).map_err(refused),
            (Err(Unpaired::Unmatched(reason) | Unpaired::Apart(reason)), _) => Err(refused(reason)),
        }
    }

    /// Σ coefficient·u in every load step of a condition all of whose entries are prescribed. `None` if one
    /// is free.
    fn prescribed_approach(&self, condition: &ContactCondition) -> Option<Vec<f64>> {
        let mut approaches = Vec::new();
        for &(node, row) in &condition.entries {
            let mut free = row;
            for held in self.supports.get(&node)? {
                let along = dot(row, held.direction);
                free = advance(free, -along, held.direction);
                approaches.resize(held.values.len(), 0.0);
                for (approach, value) in approaches.iter_mut().zip(&held.values) {
                    *approach += along * value;
                }
            }
            if length(free) > PARALLEL {
                return None;
            }
        }
        Some(approaches)
    }
}
