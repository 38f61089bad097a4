//! Bodies bonded to each other by common nodes of facets.

use std::collections::BTreeMap;

use crate::mesh::topology::Topology;
use crate::model::bodies::Bodies;
use crate::scene::contact::Between;

/// Number of facets whose nodes two bodies share, by the numbers of the bodies, the smaller first.
pub(super) struct Ties(BTreeMap<[u32; 2], usize>);

impl Ties {
    /// The bonds between all bodies. O(cells).
    pub(super) fn new(bodies: &Bodies, topology: &Topology) -> Self {
        let mut ties = BTreeMap::new();
        for (cell, &body) in bodies.cell_body.iter().enumerate() {
            for &other in topology.neighbours(cell) {
                let other = bodies.cell_body[other as usize];
                // Each pair of cells occurs twice, once from each side.
                if body < other {
                    *ties.entry([body, other]).or_default() += 1;
                }
            }
        }
        Self(ties)
    }

    /// The bonded bodies among those between which contacts are requested, in words.
    pub(super) fn of(&self, between: &Between, names: &[&str]) -> Option<String> {
        let name = |body: u32| names[body as usize];
        let wanted = |[a, b]: [u32; 2]| between.bodies.has(name(a), name(b));
        let mut tied = self.0.iter().filter(|(pair, _)| wanted(**pair));
        let (&[a, b], count) = tied.next()?;
        let facets = match count {
            1 => "a facet".to_owned(),
            count => format!("{count} facets"),
        };
        let more = match tied.count() {
            0 => String::new(),
            more => format!(" (and {more} more pairs of bodies)"),
        };
        Some(format!(
            "'{}' and '{}' share the nodes of {facets} and are tied there{more}; expected bodies with nodes of their \
             own: mesh each by itself, in Gmsh without BooleanFragments and Coherence between them",
            name(a),
            name(b)
        ))
    }
}
