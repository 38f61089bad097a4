//! Import of a deck: cells, their nodes, and the groups.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::deck::{Deck, Face};
use super::element_type;
use super::notes::Notes;
use super::sets::{Set, Sets};
use crate::element::ElementKind;
use crate::error::InputError;
use crate::lists::Lists;
use crate::mesh::topology::{CellFacet, Topology};
use crate::mesh::{Group, Mesh, name_of_dim};
use crate::name;

/// The mesh of a deck.
pub(crate) fn mesh(deck: &Deck, warnings: Vec<String>) -> Result<Mesh, InputError> {
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
    let grouping = Grouping {
        deck,
        mesh: &mesh,
        topology: &topology,
        boundary: Boundary::new(&mesh, &topology),
        node: &node,
        cell: &cell,
        facets: Facets::default(),
        notes: Notes::default(),
    };
    let (names, facets, notes) = grouping.groups();
    mesh.warnings.extend(notes.warnings());
    // Loads are summed in the order of facets, so that it has to be that of cells.
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

/// Adds the nodes of cells to `mesh`, in ascending order of tags; returns the index there of every node of the deck.
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

/// Adds the cells to `mesh`, in ascending order of tags; returns the index there of every element.
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
        mesh.has_modes.push(deck.has_modes[element]);
    }
    if !mesh.has_modes.contains(&true) {
        mesh.has_modes.clear();
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
    /// The index of a facet in the list, to which it is appended if missing.
    fn place(&mut self, facet: CellFacet) -> u32 {
        *self.place.entry(facet).or_insert_with(|| {
            self.listed.push(facet);
            self.listed.len() as u32 - 1
        })
    }
}

/// The facets of the boundary, by their smallest node.
struct Boundary(Lists<CellFacet>);

impl Boundary {
    fn new(mesh: &Mesh, topology: &Topology) -> Self {
        let smallest = |facet: CellFacet| {
            let node = facet.nodes(&mesh.cells).into_iter().min();
            (node.unwrap_or_default(), facet)
        };
        Self(Lists::new(
            mesh.points.len(),
            topology.boundary().map(smallest),
        ))
    }

    /// The facets all of whose nodes are among `nodes`, and the nodes of these facets.
    fn between(&self, mesh: &Mesh, nodes: &BTreeSet<u32>) -> (Vec<CellFacet>, BTreeSet<u32>) {
        let mut covered = BTreeSet::new();
        let mut side = Vec::new();
        for facet in nodes.iter().flat_map(|&node| self.0.of(node as usize)) {
            let of_facet = facet.nodes(&mesh.cells);
            if of_facet.iter().all(|node| nodes.contains(node)) {
                covered.extend(of_facet);
                side.push(*facet);
            }
        }
        (side, covered)
    }
}

/// Groups by name and dimension.
type Named = BTreeMap<(String, usize), Vec<u32>>;

/// Data for building groups.
struct Grouping<'a> {
    deck: &'a Deck,
    mesh: &'a Mesh,
    topology: &'a Topology,
    /// The mesh's index of every node of the deck, and of every element that is a cell.
    node: &'a [Option<u32>],
    cell: &'a [Option<u32>],
    boundary: Boundary,
    facets: Facets,
    /// Notes on sets and surfaces that are left out.
    notes: Notes,
}

impl Grouping<'_> {
    fn groups(mut self) -> (Named, Facets, Notes) {
        let deck = self.deck;
        let dim = self.mesh.dim;
        let mut groups = Named::new();
        let names = plain_names(deck);
        let plain = |name: &str| names[&name.to_uppercase()].clone();
        for set in shown(&deck.element_sets) {
            let members = set.members.list().iter();
            let cells: Vec<u32> = members.filter_map(|&e| self.cell[e as usize]).collect();
            let facets = self.listed(set.members.list());
            for (dim, members) in [(dim, cells), (dim - 1, facets)] {
                if !members.is_empty() {
                    groups.insert((plain(&set.name), dim), members);
                }
            }
        }
        for surface in shown(&deck.surfaces) {
            let facets = self.surface(surface.members.list());
            groups
                .entry((plain(&surface.name), dim - 1))
                .or_default()
                .extend(facets);
        }
        for surface in shown(&deck.node_surfaces) {
            self.add_side(surface, plain(&surface.name), &mut groups);
        }
        for set in shown(&deck.node_sets) {
            let nodes = self.own_nodes(set);
            let name = plain(&set.name);
            let says_more = |dim| match groups.get(&(name.clone(), dim)) {
                Some(members) => self.nodes_of(dim, members) != nodes,
                None => true,
            };
            if !says_more(dim) || !says_more(dim - 1) {
                continue;
            }
            let (side, covered) = self.boundary.between(self.mesh, &nodes);
            let is_whole = !side.is_empty()
                && covered.len() == nodes.len()
                && !deck.point_sets.contains(&set.name);
            match is_whole && !groups.contains_key(&(name.clone(), dim - 1)) {
                true => groups.insert((name, dim - 1), self.placed(side)),
                false => groups.insert((name, 0), nodes.into_iter().collect()),
            };
        }
        (groups, self.facets, self.notes)
    }

    /// Adds the facets all of whose nodes are in a node-based surface as a group of its name, or its nodes if there are
    /// no such facets.
    fn add_side(&mut self, surface: &Set<u32>, name: String, groups: &mut Named) {
        let nodes = self.own_nodes(surface);
        let (side, covered) = self.boundary.between(self.mesh, &nodes);
        if side.is_empty() {
            groups.insert((name, 0), nodes.into_iter().collect());
            return;
        }
        for &node in nodes.difference(&covered) {
            let tag = self.mesh.node_tags[node as usize];
            let item = format!("{tag} of '{}'", name::shown(&name));
            let what = "nodes of surfaces belong to no facet whose nodes all are in these, and are left out";
            self.notes.add(what, item);
        }
        let facets = self.placed(side);
        groups
            .entry((name, self.mesh.dim - 1))
            .or_default()
            .extend(facets);
    }

    /// The nodes of a set that belong to cells.
    fn own_nodes(&self, set: &Set<u32>) -> BTreeSet<u32> {
        let members = set.members.list().iter();
        members.filter_map(|&n| self.node[n as usize]).collect()
    }

    /// The indices of facets in the list.
    fn placed(&mut self, facets: Vec<CellFacet>) -> Vec<u32> {
        let facets = facets.into_iter();
        facets.map(|facet| self.facets.place(facet)).collect()
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

    /// The facets of cells that coincide with `elements`.
    fn listed(&mut self, elements: &[u32]) -> Vec<u32> {
        let mut found = Vec::new();
        for &element in elements {
            if self.deck.elements.kind(element as usize).dim() + 1 == self.mesh.dim {
                let nodes = self.deck.elements.nodes_of(element as usize);
                let facet = self.facet_of(nodes);
                if facet.is_none() {
                    let tag = self.deck.element_tags[element as usize];
                    let what = "elements that are no faces of cells are left out";
                    self.notes.add(what, tag.to_string());
                }
                found.extend(facet);
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

    /// The face of an element with Abaqus's number.
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

    /// The facet of a cell with these nodes of the deck.
    fn facet_of(&mut self, nodes: &[u32]) -> Option<u32> {
        let nodes: Option<Vec<u32>> = nodes.iter().map(|&n| self.node[n as usize]).collect();
        let facet = *self.topology.cells_at(&nodes?).first()?;
        Some(self.facets.place(facet))
    }
}

/// The sets defined by the user.
fn shown<T: Copy + Ord>(sets: &Sets<T>) -> impl Iterator<Item = &Set<T>> {
    sets.iter().filter(|set| !set.internal)
}

/// Plain names of the sets of a deck, by their names in capitals: without the instance if that is unique.
fn plain_names(deck: &Deck) -> BTreeMap<String, String> {
    let sets = (shown(&deck.element_sets).map(|set| &set.name))
        .chain(shown(&deck.surfaces).map(|set| &set.name))
        .chain(shown(&deck.node_surfaces).map(|set| &set.name))
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

/// The groups with their names, with the dimension appended where groups of several dimensions share a name.
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
