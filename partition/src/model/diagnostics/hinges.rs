//! Hinges: nodes, in space edges, that both sides of a contact share and at which the boundary of the bodies has further
//! facets. There the sides are joined like a hinge, whereas at the tip of a crack nothing but its two sides ends.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::Diagnostics;
use crate::element::ElementKind;
use crate::model::groups;
use crate::scene::condition::Names;
use crate::scene::contact::Contact;

/// A node of the plane, twice, or the ends of an edge in space, ascending: where facets meet.
type Ridge = [u32; 2];

/// The ridges of a facet with these nodes.
fn ridges(kind: ElementKind, nodes: &[u32]) -> Vec<Ridge> {
    let sorted = |a: u32, b: u32| [a.min(b), a.max(b)];
    match kind.dim() {
        1 => vec![[nodes[0]; 2], [nodes[1]; 2]],
        _ => (kind.facets().iter())
            .map(|(_, edge)| sorted(nodes[edge[0]], nodes[edge[1]]))
            .collect(),
    }
}

/// A contact between bodies, with the ridges of its two sides.
type Sides<'a> = (&'a Contact, [BTreeSet<Ridge>; 2]);

impl Diagnostics<'_> {
    /// Warnings of contacts with hinges, for each contact and what it meets there.
    pub(super) fn hinges(&self) -> Vec<String> {
        let all: Vec<Sides> = (self.declared.iter())
            .filter(|of| of.contact.tie.is_none())
            .filter_map(|of| {
                let mut sides = of.contact.sides().map(|side| self.ridges_of(side));
                Some((&of.contact, [sides.next()?, sides.next()?]))
            })
            .collect();
        let shared = |[a, b]: &[BTreeSet<Ridge>; 2]| a.intersection(b).copied().collect();
        let joined: Vec<Vec<Ridge>> = all.iter().map(|(_, sides)| shared(sides)).collect();
        let facets = self.facets_at(joined.iter().flatten());
        let mut warnings = Vec::new();
        for ((contact, _), joined) in all.iter().zip(joined) {
            let mut found: BTreeMap<Option<&str>, Vec<Ridge>> = BTreeMap::new();
            for ridge in joined.into_iter().filter(|ridge| facets[ridge] > 2) {
                let meets = |(other, sides): &&Sides| {
                    other.name != contact.name && sides.iter().any(|side| side.contains(&ridge))
                };
                let other = all.iter().find(meets).map(|(other, _)| &other.name[..]);
                found.entry(other).or_default().push(ridge);
            }
            let hinges = found.into_iter();
            warnings.extend(hinges.map(|(other, hinges)| self.hinge(contact, other, &hinges)));
        }
        warnings
    }

    /// The ridges of a side's facets.
    fn ridges_of(&self, side: &Names) -> BTreeSet<Ridge> {
        let mesh = &self.bodies.mesh;
        let facets = groups::facets(mesh, side, "").unwrap_or_default();
        let facets = facets.into_iter().map(|facet| facet as usize);
        facets
            .flat_map(|facet| ridges(mesh.facets.kind(facet), mesh.facets.nodes_of(facet)))
            .collect()
    }

    /// The number of facets of the boundary at each of these ridges.
    fn facets_at<'r>(&self, asked: impl Iterator<Item = &'r Ridge>) -> HashMap<Ridge, usize> {
        let mut count: HashMap<Ridge, usize> = asked.map(|&ridge| (ridge, 0)).collect();
        if count.is_empty() {
            return count;
        }
        let cells = &self.bodies.mesh.cells;
        for facet in self.topology.boundary() {
            let (kind, _) = cells.kind(facet.cell as usize).facets()[facet.facet as usize];
            for ridge in ridges(kind, &facet.nodes(cells)) {
                if let Some(count) = count.get_mut(&ridge) {
                    *count += 1;
                }
            }
        }
        count
    }

    /// The warning of the hinges of a contact, on the outer boundary or where it meets another contact.
    fn hinge(&self, contact: &Contact, other: Option<&str>, hinges: &[Ridge]) -> String {
        let mesh = &self.bodies.mesh;
        let node = hinges[0][0] as usize;
        let (name, tag, place) = (
            &contact.name,
            mesh.node_tags[node],
            self.place(mesh.points[node]),
        );
        let others = match hinges.len() {
            1 => String::new(),
            count => format!(", one of {count} such places"),
        };
        match other {
            None => format!(
                "contact '{name}': its sides share node {tag} at {place}{others}, although the outer boundary begins there: this \
                 holds the mouth of the crack together, and stresses, openings and stress intensity factors are wrong; \
                 expected a node for each side (in Gmsh OpenBoundaryPhysicalGroup of Plugin(Crack))"
            ),
            Some(other) => format!(
                "contact '{name}': its sides share node {tag} at {place}{others}, although it meets contact '{other}' there: this \
                 holds pieces of the bodies together, and stresses, openings and stress intensity factors are wrong; \
                 expected a node for each piece that the two contacts separate"
            ),
        }
    }
}
