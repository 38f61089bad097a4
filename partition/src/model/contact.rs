//! Γ_c: contacts n·(u_a − u_b) ≤ g as rows of B u ≤ g.

use std::collections::{HashMap, HashSet};

use super::doubts::short;
use super::node_pairs::Unpaired;
use super::sides::{Sides, side_nodes};
use super::steps::Loads;
use super::supports::PARALLEL;
use super::surface::{CORNER, Surface};
use super::{Contact, ContactCondition, groups, mortar, node_pairs, obstacle};
use crate::element::geometry::{advance, dot, length};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;
use crate::scene::condition::{self, Names, Pairing, Partner};

/// Gaps are exact to this fraction of the scene's coordinates.
const ROUNDING: f64 = 1e-12;

/// Negative gaps are worth a warning beyond this fraction of the side's extent: less is how quadratic
/// edges follow an arc.
const SEEN: f64 = 1e-8;

/// Part of an interference from which on it matters that straight facets stand off a curve.
const FELT: f64 = 0.1;

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
        let mut off = 0.0;
        let mut conditions = match &keys.partner {
            Partner::Obstacle(obstacle) => {
                let nodes = side_nodes(self.mesh, &side_a, &what, &HashSet::new())?;
                obstacle::conditions(self.mesh, obstacle, &side_a, nodes)
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
                let conditions = self.pairs(&side_a, &side_b, keys.pairing, &what)?;
                warnings.extend(self.corner(&side_a, &conditions, &what));
                off = side_a.stands_off().max(side_b.stands_off());
                conditions
            }
        };
        if let Some(gap) = &keys.gap {
            off = 0.0;
            let mut furthest = (0.0, 0.0, 0.0);
            for condition in &mut conditions {
                let given = (gap.at(condition.position))
                    .map_err(|reason| InputError::new(format!("{what}.gap: {reason}")))?;
                let measured = std::mem::replace(&mut condition.gap, given);
                furthest = match (given - measured).abs() {
                    away if away > furthest.0 => (away, given, measured),
                    _ => furthest,
                };
            }
            let (away, given, measured) = furthest;
            if away > side_a.extent() {
                warnings.push(format!(
                    "{what}.gap: it is {} m where the mesh has {} m, which is off by more than the side \
                     measures; are place and units right?",
                    short(given),
                    short(measured)
                ));
            }
        }
        let slack = ROUNDING * self.size;
        let deepest = conditions.iter().map(|c| c.gap).fold(0.0, f64::min);
        let seen = slack.max(SEEN * side_a.extent());
        if deepest < -seen {
            let count = conditions.iter().filter(|c| c.gap < -seen).count();
            let facets = match off > FELT * -deepest {
                true => format!(
                    "; straight facets stand off a curve by up to {} m of that: expected quadratic cells",
                    short(off)
                ),
                false => String::new(),
            };
            warnings.push(format!(
                "{what}: {count} of {} gaps are negative, an interference fit of up to {} m{facets}",
                conditions.len(),
                short(-deepest)
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

    /// The warning of a condition in a corner of side a, whose normal is that of neither facet.
    fn corner(
        &self,
        side_a: &Surface,
        conditions: &[ContactCondition],
        what: &str,
    ) -> Option<String> {
        let normals: HashMap<i64, [f64; 3]> = (conditions
            .iter()
            .map(|condition| (condition.tag_a, condition.normal)))
        .collect();
        let tag = |node: u32| self.mesh.node_tags[node as usize];
        let nodes = side_a.nodes();
        let is_mean = |node: u32| {
            let (used, mean) = (normals.get(&tag(node))?, nodes[&node].normal()?);
            Some(dot(*used, mean) > 1.0 - 1e-9)
        };
        let (node, angle, _) = (side_a.turns().into_iter())
            .find(|&(node, angle, _)| angle > CORNER && is_mean(node) == Some(true))?;
        let [x, y, _] = self.mesh.points[node as usize].map(short);
        Some(format!(
            "{what}: side a has a corner of {:.0}° at node {}, ({x}, {y}), where it presses along the mean of \
             both normals; expected sides without corners, a contact for each",
            angle.to_degrees(),
            tag(node)
        ))
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
