//! From a deck to a mesh: cells, the nodes they use, and the groups.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::deck::{Deck, Face};
use super::element_type;
use super::sets::{Set, Sets};
use crate::element::ElementKind;
use crate::error::InputError;
use crate::mesh::topology::{CellFacet, Topology};
use crate::mesh::{Group, Mesh, name_of_dim};

/// The mesh of a deck.
pub(super) fn mesh(deck: &Deck, warnings: Vec<String>) -> Result<Mesh, InputError> {
    let cells = (0..deck.elements.len()).filter(|&element| !deck.is_side[element]);
    let Some(dim) = cells.map(|cell| deck.elements.kind(cell).dim()).max() else {
        return Err(InputError::new(format!(
            "the deck has no cells; expected *ELEMENT of type {}",
            element_type::known()
        )));
    };
    let mut mesh = Mesh {
        dim,
        warnings,
        ..Mesh::default()
    };
    let node = add_nodes(deck, &mut mesh);
    let cell = add_cells(deck, &node, &mut mesh);
    mesh.flatten()?;
    mesh.orient_cells()?;
    let topology = Topology::new(&mesh);
    let (names, facets) = Grouping {
        deck,
        mesh: &mesh,
        topology: &topology,
        node: &node,
        cell: &cell,
        facets: Facets::default(),
    }
    .groups();
    // Loads are summed in the order of facets, which is to be that of cells.
    let mut order: Vec<usize> = (0..facets.listed.len()).collect();
    order.sort_by_key(|&place| facets.listed[place]);
    let mut new_place = vec![0; order.len()];
    for (new, &place) in (0..).zip(&order) {
        new_place[place] = new;
        let facet = facets.listed[place];
        let (kind, _) = mesh.cells.kind(facet.cell as usize).facets()[facet.facet as usize];
        mesh.facets.push(kind, &facet.nodes(&mesh.cells));
    }
    for ((name, group_dim), mut members) in named(names) {
        if group_dim + 1 == dim {
            (members.iter_mut()).for_each(|facet| *facet = new_place[*facet as usize]);
        }
        members.sort_unstable();
        members.dedup();
        let dim = group_dim;
        mesh.groups.insert(name, Group { dim, members });
    }
    Ok(mesh)
}

/// Gives `mesh` the nodes that its cells use, in ascending order of tags; returns the index there of every node
/// of the deck.
fn add_nodes(deck: &Deck, mesh: &mut Mesh) -> Vec<Option<u32>> {
    let mut index = vec![None; deck.points.len()];
    let mut is_used = vec![false; deck.points.len()];
    for (element, (kind, nodes)) in deck.elements.iter().enumerate() {
        if kind.dim() == mesh.dim && !deck.is_side[element] {
            nodes.iter().for_each(|&node| is_used[node as usize] = true);
        }
    }
    let mut used: Vec<usize> = (0..is_used.len()).filter(|&node| is_used[node]).collect();
    used.sort_by_key(|&node| deck.node_tags[node]);
    for node in used {
        index[node] = Some(mesh.points.len() as u32);
        mesh.points.push(deck.points[node]);
        mesh.node_tags.push(deck.node_tags[node]);
    }
    index
}

/// Gives `mesh` its cells, in ascending order of tags; returns the index there of every element.
fn add_cells(deck: &Deck, node: &[Option<u32>], mesh: &mut Mesh) -> Vec<Option<u32>> {
    let mut index = vec![None; deck.elements.len()];
    let mut order: Vec<usize> = (0..deck.elements.len())
        .filter(|&element| deck.elements.kind(element).dim() == mesh.dim && !deck.is_side[element])
        .collect();
    order.sort_by_key(|&element| deck.element_tags[element]);
    for element in order {
        index[element] = Some(mesh.cells.len() as u32);
        let nodes = deck.elements.nodes_of(element).iter();
        let nodes: Vec<u32> = nodes.filter_map(|&n| node[n as usize]).collect();
        mesh.cells.push(deck.elements.kind(element), &nodes);
        mesh.cell_tags.push(deck.element_tags[element]);
    }
    index
}

/// Facets of the mesh's list.
#[derive(Default)]
struct Facets {
    listed: Vec<CellFacet>,
    place: HashMap<CellFacet, u32>,
}

impl Facets {
    /// The place of a facet in the list, to which it is appended where it isn't there.
    fn place(&mut self, facet: CellFacet) -> u32 {
        *self.place.entry(facet).or_insert_with(|| {
            self.listed.push(facet);
            self.listed.len() as u32 - 1
        })
    }
}

/// Groups by name and dimension.
type Named = BTreeMap<(String, usize), Vec<u32>>;

/// What groups are made of.
struct Grouping<'a> {
    deck: &'a Deck,
    mesh: &'a Mesh,
    topology: &'a Topology,
    /// The mesh's index of every node of the deck, and of every element that is a cell.
    node: &'a [Option<u32>],
    cell: &'a [Option<u32>],
    facets: Facets,
}

impl Grouping<'_> {
    fn groups(mut self) -> (Named, Facets) {
        let deck = self.deck;
        let dim = self.mesh.dim;
        let mut groups = Named::new();
        let names = plain_names(deck);
        let plain = |name: &str| names[&name.to_uppercase()].clone();
        for set in shown(&deck.element_sets) {
            let members = set.members.iter();
            let cells: Vec<u32> = members.filter_map(|&e| self.cell[e as usize]).collect();
            let facets = self.listed(&set.members);
            for (dim, members) in [(dim, cells), (dim - 1, facets)] {
                if !members.is_empty() {
                    groups.insert((plain(&set.name), dim), members);
                }
            }
        }
        for surface in shown(&deck.surfaces) {
            let facets = self.surface(&surface.members);
            groups
                .entry((plain(&surface.name), dim - 1))
                .or_default()
                .extend(facets);
        }
        let boundary: Vec<CellFacet> = self.topology.boundary().collect();
        for set in shown(&deck.node_sets) {
            let members = set.members.iter();
            let nodes: BTreeSet<u32> = members.filter_map(|&n| self.node[n as usize]).collect();
            let name = plain(&set.name);
            let says_more = |dim| match groups.get(&(name.clone(), dim)) {
                Some(members) => self.nodes_of(dim, members) != nodes,
                None => true,
            };
            if !says_more(dim) || !says_more(dim - 1) {
                continue;
            }
            let side = self.side(&nodes, &boundary);
            match side.filter(|_| !groups.contains_key(&(name.clone(), dim - 1))) {
                Some(side) => groups.insert((name, dim - 1), side),
                None => groups.insert((name, 0), nodes.into_iter().collect()),
            };
        }
        (groups, self.facets)
    }

    /// The nodes of cells or facets.
    fn nodes_of(&self, dim: usize, members: &[u32]) -> BTreeSet<u32> {
        let cells = &self.mesh.cells;
        let nodes = members
            .iter()
            .flat_map(|&member| match dim == self.mesh.dim {
                true => cells.nodes_of(member as usize).to_vec(),
                false => self.facets.listed[member as usize].nodes(cells),
            });
        nodes.collect()
    }

    /// Those of `elements` that are facets of cells.
    fn listed(&mut self, elements: &[u32]) -> Vec<u32> {
        let mut found = Vec::new();
        for &element in elements {
            if self.deck.elements.kind(element as usize).dim() + 1 == self.mesh.dim {
                let nodes = self.deck.elements.nodes_of(element as usize);
                found.extend(self.facet_of(nodes));
            }
        }
        found
    }

    /// The facets of a surface.
    fn surface(&mut self, faces: &[Face]) -> Vec<u32> {
        let mut found = Vec::new();
        let mut free = BTreeSet::new();
        for face in faces {
            let (Face::Of(element, _) | Face::Free(element)) = *face;
            let Some(cell) = self.cell[element as usize] else {
                found.extend(self.listed(&[element]));
                continue;
            };
            match face {
                Face::Of(_, number) => found.extend(self.numbered(element, *number)),
                Face::Free(_) => _ = free.insert(cell),
            }
        }
        if !free.is_empty() {
            let boundary = self
                .topology
                .boundary()
                .filter(|facet| free.contains(&facet.cell));
            found.extend(boundary.map(|facet| self.facets.place(facet)));
        }
        found
    }

    /// The face of an element by Abaqus' number.
    fn numbered(&mut self, element: u32, number: usize) -> Option<u32> {
        let kind: ElementKind = self.deck.elements.kind(element as usize);
        let corners = element_type::face(kind, number)?;
        let (_, local) = kind.facets().iter().find(|(facet, local)| {
            let own = &local[..facet.corners()];
            corners.iter().all(|corner| own.contains(corner))
        })?;
        let nodes = self.deck.elements.nodes_of(element as usize);
        let nodes: Vec<u32> = local.iter().map(|&i| nodes[i]).collect();
        self.facet_of(&nodes)
    }

    /// The facet of a cell that has these nodes of the deck.
    fn facet_of(&mut self, nodes: &[u32]) -> Option<u32> {
        let nodes: Option<Vec<u32>> = nodes.iter().map(|&n| self.node[n as usize]).collect();
        let facet = *self.topology.cells_at(&nodes?).first()?;
        Some(self.facets.place(facet))
    }

    /// The facets of the boundary between `nodes`, where they have all of these.
    fn side(&mut self, nodes: &BTreeSet<u32>, boundary: &[CellFacet]) -> Option<Vec<u32>> {
        let mut covered = BTreeSet::new();
        let mut side = Vec::new();
        for facet in boundary {
            let of_facet = facet.nodes(&self.mesh.cells);
            if of_facet.iter().all(|node| nodes.contains(node)) {
                covered.extend(of_facet);
                side.push(*facet);
            }
        }
        let is_whole = !nodes.is_empty() && covered.len() == nodes.len();
        is_whole.then(|| {
            side.into_iter()
                .map(|facet| self.facets.place(facet))
                .collect()
        })
    }
}

/// The sets that a user has made.
fn shown<T>(sets: &Sets<T>) -> impl Iterator<Item = &Set<T>> {
    sets.iter().filter(|set| !set.internal)
}

/// What the sets of a deck are called, by their names in capitals: without the instance, where no other has
/// that name.
fn plain_names(deck: &Deck) -> BTreeMap<String, String> {
    let sets = (shown(&deck.element_sets).map(|set| &set.name))
        .chain(shown(&deck.surfaces).map(|set| &set.name))
        .chain(shown(&deck.node_sets).map(|set| &set.name));
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    for name in sets {
        names
            .entry(name.to_uppercase())
            .or_insert_with(|| name.clone());
    }
    let without_instance = |name: &str| {
        let (instance, own) = name.split_once('.')?;
        deck.instances
            .contains_key(&instance.to_uppercase())
            .then(|| own.to_owned())
    };
    let mut count: HashMap<String, usize> = HashMap::new();
    for name in names.values() {
        let own = without_instance(name).unwrap_or_else(|| name.clone());
        *count.entry(own.to_uppercase()).or_default() += 1;
    }
    let short = |name: String| match without_instance(&name) {
        Some(own) if count[&own.to_uppercase()] == 1 => own,
        _ => name,
    };
    names
        .into_iter()
        .map(|(key, name)| (key, short(name)))
        .collect()
}

/// The groups by their names, with the dimension behind those that groups of several dimensions have.
fn named(groups: Named) -> Vec<((String, usize), Vec<u32>)> {
    let mut count: HashMap<String, usize> = HashMap::new();
    for (name, _) in groups.keys() {
        *count.entry(name.clone()).or_default() += 1;
    }
    let name_of = |name: String, dim| match count[&name] {
        1 => name,
        _ => name_of_dim(&name, dim),
    };
    let groups = groups.into_iter();
    groups
        .map(|((name, dim), members)| ((name_of(name, dim), dim), members))
        .collect()
}
