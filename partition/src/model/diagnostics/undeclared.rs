//! Bodies that touch without a contact between them, so that they may penetrate each other.

use std::collections::{BTreeMap, HashSet};

use super::Diagnostics;
use crate::mesh::topology::CellFacet;
use crate::model::groups;
use crate::model::pretension::other_side;
use crate::model::skin::{ROUND_OFF, Skin};

impl Diagnostics<'_> {
    /// Warnings, for each pair of bodies, of coincident facets on no side of a contact.
    pub(super) fn undeclared(&self) -> Vec<String> {
        let on_sides = self.on_sides();
        let is_free = |facet: &CellFacet| !on_sides.contains(facet);
        let skin = Skin::new(self.bodies, self.topology, self.scene.plane, is_free);
        let mut found: BTreeMap<[u32; 2], [f64; 3]> = BTreeMap::new();
        for pair in skin.facing(|size| ROUND_OFF * size) {
            let facets = pair.facets.map(|facet| &skin.facets[facet]);
            let mut bodies = facets.map(|facet| facet.body);
            bodies.sort_unstable();
            let place = facets[0].shape.middle();
            found.entry(bodies).or_insert(place);
        }
        let name = |body: u32| self.scene.bodies.keys().nth(body as usize);
        let warnings = found.into_iter().filter_map(|([a, b], place)| {
            let who = match a == b {
                true => format!("body '{}' touches itself", name(a)?),
                false => format!("bodies '{}' and '{}' touch", name(a)?, name(b)?),
            };
            Some(format!(
                "{who} without a contact, as at {}: nothing keeps them from passing through each other",
                self.place(place)
            ))
        });
        warnings.collect()
    }

    /// The facets of the sides of contacts.
    fn on_sides(&self) -> HashSet<CellFacet> {
        let mesh = &self.bodies.mesh;
        let mut on_sides = HashSet::new();
        let cuts = &self.scene.pretension;
        let cuts = cuts
            .iter()
            .flat_map(|of| [of.on.clone(), other_side(of).into()]);
        let declared = self
            .declared
            .iter()
            .flat_map(|of| of.contact.sides())
            .cloned();
        for names in declared.chain(cuts) {
            let facets = groups::facets(mesh, &names, "").unwrap_or_default();
            let nodes = facets.into_iter().map(|f| mesh.facets.nodes_of(f as usize));
            on_sides.extend(nodes.flat_map(|nodes| self.topology.cells_at(nodes)));
        }
        on_sides
    }
}
