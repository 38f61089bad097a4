//! How far contact patches grow into the bodies behind a contact surface.

use std::collections::BTreeMap;

use super::contraction::Around;
use crate::disjoint_sets::DisjointSets;
use crate::flops::{Front, condensation};
use crate::mesh::topology::Topology;
use crate::model::Model;

/// Estimated flops that growing saves at least.
const WORTH: f64 = 1e8;

/// What is left of the estimated flops, at most: a subdomain belongs to one rank, and large ones
/// leave the others less to do.
const LEFT: f64 = 0.5;

/// A cell that no contact patch reaches.
const UNREACHED: u32 = u32::MAX;

/// Adds to the contact patches, the `sets` of cells around nodes in contact, the layers of cells of their
/// material that make them cheapest, as long as `spared` cells stay outside.
///
/// A contact patch of one layer of cells has a boundary as long as Γ_c, and its S is dense. Where a mesh
/// becomes coarser behind Γ_c, the boundary of a contact patch of more layers is shorter; at last a whole
/// body is one subdomain and has none.
pub(super) fn grow(
    model: &Model,
    topology: &Topology,
    around: &Around,
    spared: usize,
    sets: &mut DisjointSets,
) {
    let layering = Layering::new(model, topology, around, sets);
    let groups = Groups::new(model, around, sets);
    let count = 1 + layering
        .layer
        .iter()
        .max()
        .map_or(0, |&layer| layer as usize);
    let mut of_group: BTreeMap<u32, Layers> = BTreeMap::new();
    for &cell in &layering.reached {
        let group = groups.of(layering.contact_patch[cell as usize]);
        let layers = of_group.entry(group).or_insert_with(|| Layers::new(count));
        let layer = layering.layer[cell as usize] as usize;
        layers.cells[layer] += 1;
        for &other in topology.neighbours(cell as usize) {
            let contact_patch = layering.contact_patch[other as usize];
            let is_within = contact_patch != UNREACHED && groups.of(contact_patch) == group;
            let other = is_within.then_some(layering.layer[other as usize] as usize);
            layers.add_facet(layer, other);
        }
    }
    let in_contact: usize = of_group.values().map(|layers| layers.cells[0]).sum();
    let mut outside = model.mesh.cells.len() - in_contact;
    let mut chosen = BTreeMap::new();
    for (group, layers) in of_group {
        let added = layers.cheapest(model, groups.conditions[group as usize], |cells| {
            outside >= spared + cells
        });
        outside -= layers.cells[1..=added].iter().sum::<usize>();
        chosen.insert(group, added as u32);
    }
    for &cell in &layering.reached {
        let contact_patch = layering.contact_patch[cell as usize];
        if layering.layer[cell as usize] <= chosen[&groups.of(contact_patch)] {
            sets.unite(cell, contact_patch);
        }
    }
}

/// The cells that contact patches reach across facets of one material.
struct Layering {
    /// The nearest contact patch of every cell, by a cell of it.
    contact_patch: Vec<u32>,
    /// The layer around it in which the cell is; 0 in the contact patch itself.
    layer: Vec<u32>,
    /// The cells that are reached, by layers.
    reached: Vec<u32>,
}

impl Layering {
    fn new(model: &Model, topology: &Topology, around: &Around, sets: &mut DisjointSets) -> Self {
        let cells = model.mesh.cells.len();
        let mut contact_patch = vec![UNREACHED; cells];
        let mut layer = vec![0; cells];
        let mut reached = Vec::new();
        for &(_, cell) in &around.cells {
            if contact_patch[cell as usize] == UNREACHED {
                contact_patch[cell as usize] = sets.find(cell);
                reached.push(cell);
            }
        }
        let mut next = 0;
        while next < reached.len() {
            let cell = reached[next] as usize;
            next += 1;
            for &other in topology.neighbours(cell) {
                let o = other as usize;
                let is_same = model.cell_material[o] == model.cell_material[cell];
                if is_same && contact_patch[o] == UNREACHED {
                    contact_patch[o] = contact_patch[cell];
                    layer[o] = layer[cell] + 1;
                    reached.push(other);
                }
            }
        }
        Self {
            contact_patch,
            layer,
            reached,
        }
    }
}

/// The contact patches that contacts link: what is factorized together.
struct Groups {
    /// The group of every contact patch, by its cell.
    of_patch: BTreeMap<u32, u32>,
    /// The number of conditions of every group.
    conditions: Vec<usize>,
}

impl Groups {
    fn new(model: &Model, around: &Around, sets: &mut DisjointSets) -> Self {
        let mut contacts = DisjointSets::new(model.contacts.len());
        let mut of_patch = BTreeMap::new();
        for &(node, cell) in &around.cells {
            for &contact in &around.contacts[node as usize] {
                let first = *of_patch.entry(sets.find(cell)).or_insert(contact);
                contacts.unite(first, contact);
            }
        }
        for group in of_patch.values_mut() {
            *group = contacts.find(*group);
        }
        let mut conditions = vec![0; model.contacts.len()];
        for (number, contact) in model.contacts.iter().enumerate() {
            conditions[contacts.find(number as u32) as usize] += contact.points.len();
        }
        Self {
            of_patch,
            conditions,
        }
    }

    fn of(&self, contact_patch: u32) -> u32 {
        self.of_patch[&contact_patch]
    }
}

/// The layers around the contact patches of a group.
struct Layers {
    /// The cells of every layer.
    cells: Vec<usize>,
    /// How many more facets the boundary around every layer has than that around the one before.
    facets: Vec<i64>,
}

impl Layers {
    /// None yet of so many layers.
    fn new(count: usize) -> Self {
        Self {
            cells: vec![0; count],
            facets: vec![0; count],
        }
    }

    /// Counts a facet of a cell of `layer`, the other cell of which is in layer `other`, or not
    /// in the group.
    fn add_facet(&mut self, layer: usize, other: Option<usize>) {
        if other.is_none_or(|other| other > layer) {
            self.facets[layer] += 1;
        }
        if let Some(other) = other.filter(|&other| other > layer) {
            self.facets[other] -= 1;
        }
    }

    /// The number of layers to be added for which condensing the group, eliminating its boundary,
    /// and the rest of the mesh cost least; of cells, as many as `may_take` allows.
    fn cheapest(
        &self,
        model: &Model,
        conditions: usize,
        may_take: impl Fn(usize) -> bool,
    ) -> usize {
        let dofs = (model.mesh.dim * model.mesh.points.len()) as f64;
        let per_cell = dofs / model.mesh.cells.len() as f64;
        // Facets of a closed line share their ends.
        let kinds = model.mesh.cells.iter().flat_map(|(kind, _)| kind.facets());
        let nodes = kinds.map(|(facet, _)| facet.nodes()).max().unwrap_or(1);
        let per_facet = model.mesh.dim * (nodes - 1).max(1);
        let (mut cells, mut facets) = (0, 0);
        let mut costs = Vec::with_capacity(self.cells.len());
        for (layer, &of_layer) in self.cells.iter().enumerate() {
            cells += of_layer;
            facets += self.facets[layer];
            if layer > 0 && !may_take(cells - self.cells[0]) {
                break;
            }
            let inside = (per_cell * cells as f64).min(dofs);
            let front = Front {
                eliminated: per_facet * facets as usize,
                kept: conditions,
            };
            let kept = (front.eliminated + front.kept) as f64;
            costs.push(
                condensation(inside, kept) + front.flops() + condensation(dofs - inside, 0.0),
            );
        }
        let least = (0..costs.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b]));
        least
            .filter(|&layer| costs[layer] <= LEFT * costs[0] && costs[layer] + WORTH <= costs[0])
            .unwrap_or(0)
    }
}
