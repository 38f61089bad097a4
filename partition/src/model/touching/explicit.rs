//! The sides of contacts, ties and cuts declared by their groups in a scene.

use std::collections::{BTreeSet, HashMap};

use crate::mesh::Mesh;
use crate::mesh::topology::{CellFacet, Topology};
use crate::model::groups;
use crate::model::pretension::other_side;
use crate::scene::Scene;
use crate::scene::contact::Declaration;
use crate::scene::tie::Tie;

/// The sides of contacts declared by groups.
pub(super) struct Explicit {
    of_facet: HashMap<CellFacet, BTreeSet<(usize, usize)>>,
}

impl Explicit {
    pub fn new(scene: &Scene, mesh: &Mesh, topology: &Topology) -> Self {
        let mut of_facet: HashMap<CellFacet, BTreeSet<(usize, usize)>> = HashMap::new();
        let contacts = scene
            .contact
            .iter()
            .filter_map(Declaration::contact)
            .cloned();
        let ties = scene.tie.iter().map(Tie::contact);
        for (number, contact) in contacts.chain(ties).enumerate() {
            for (side, names) in contact.sides().enumerate() {
                // Invalid groups are reported when the contact is built.
                for facet in groups::facets(mesh, names, "").unwrap_or_default() {
                    for place in topology.cells_at(mesh.facets.nodes_of(facet as usize)) {
                        of_facet.entry(place).or_default().insert((number, side));
                    }
                }
            }
        }
        let cuts = scene
            .pretension
            .iter()
            .map(|bolt| [bolt.on.clone(), other_side(bolt).into()]);
        for (number, sides) in cuts.enumerate() {
            for (side, names) in sides.iter().enumerate() {
                for facet in groups::facets(mesh, names, "").unwrap_or_default() {
                    for place in topology.cells_at(mesh.facets.nodes_of(facet as usize)) {
                        let of_cut = (usize::MAX - number, side);
                        of_facet.entry(place).or_default().insert(of_cut);
                    }
                }
            }
        }
        Self { of_facet }
    }

    /// True if two facets are on different sides of one contact.
    pub fn has(&self, a: CellFacet, b: CellFacet) -> bool {
        let (Some(of_a), Some(of_b)) = (self.of_facet.get(&a), self.of_facet.get(&b)) else {
            return false;
        };
        (of_a.iter()).any(|&(number, side)| of_b.contains(&(number, 1 - side)))
    }
}
