//! Groups of the mesh for the scene to refer to: the deck's own sets, or new ones.

use std::collections::{BTreeMap, BTreeSet};

use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::{Face, LinePlace};

/// Names of groups by their members.
pub(super) struct Groups<'a, 'b> {
    places: &'a mut Places<'b>,
    /// Number of named sets of any kind, by name in capitals.
    count: BTreeMap<String, usize>,
    /// Sets by their members, for those whose name is that of a group.
    nodes: BTreeMap<Vec<u32>, String>,
    cells: BTreeMap<Vec<u32>, String>,
    faces: BTreeMap<Vec<(u32, usize)>, String>,
    has_cell: Vec<bool>,
}

impl<'a, 'b> Groups<'a, 'b> {
    pub(super) fn new(places: &'a mut Places<'b>) -> Self {
        let has_cell = places.with_cells();
        let deck = &places.deck;
        let mut count = BTreeMap::new();
        let names = (deck.node_sets.iter().map(|set| &set.name))
            .chain(deck.element_sets.iter().map(|set| &set.name))
            .chain(deck.surfaces.iter().map(|set| &set.name))
            .chain(deck.node_surfaces.iter().map(|set| &set.name));
        names.for_each(|name| *count.entry(name.to_uppercase()).or_default() += 1);
        let mut groups = Self {
            nodes: BTreeMap::new(),
            cells: BTreeMap::new(),
            faces: BTreeMap::new(),
            count,
            has_cell,
            places,
        };
        groups.list();
        groups
    }

    /// Lists the deck's own sets.
    fn list(&mut self) {
        let deck = &self.places.deck;
        let mut nodes = BTreeMap::new();
        for set in deck
            .node_sets
            .iter()
            .filter(|set| self.is_plain(&set.name, set.internal))
        {
            let members = self.with_cells(set.members.list());
            nodes.entry(members).or_insert_with(|| set.name.clone());
        }
        let mut cells = BTreeMap::new();
        for set in deck
            .element_sets
            .iter()
            .filter(|set| self.is_plain(&set.name, set.internal))
        {
            let members = distinct(set.members.list());
            cells.entry(members).or_insert_with(|| set.name.clone());
        }
        let mut all_faces = BTreeMap::new();
        for set in deck
            .surfaces
            .iter()
            .filter(|set| self.is_plain(&set.name, set.internal))
        {
            let faces = set.members.list().iter().map(|face| match *face {
                Face::Of(element, number) => Some((element, number)),
                Face::Free(_) => None,
            });
            if let Some(faces) = faces.collect::<Option<BTreeSet<_>>>() {
                let members = faces.into_iter().collect();
                all_faces.entry(members).or_insert_with(|| set.name.clone());
            }
        }
        (self.nodes, self.cells, self.faces) = (nodes, cells, all_faces);
    }

    /// True if the group of a set has the set's name: it is unique and belongs to no instance.
    fn is_plain(&self, name: &str, internal: bool) -> bool {
        !internal && self.count.get(&name.to_uppercase()) == Some(&1) && !name.contains('.')
    }

    /// Nodes that belong to cells, without repetition.
    fn with_cells(&self, nodes: &[u32]) -> Vec<u32> {
        let used = nodes
            .iter()
            .copied()
            .filter(|&node| self.has_cell[node as usize]);
        used.collect::<BTreeSet<u32>>().into_iter().collect()
    }

    /// A name that no set has yet: `word`, possibly with a number.
    fn fresh(&mut self, word: &str, numbered: bool) -> String {
        // The part of a name before a point might be taken for an instance.
        let word = word.replace('.', " ");
        let plain = (!numbered).then(|| word.clone());
        let names = plain
            .into_iter()
            .chain((1..).map(|number: usize| format!("{word} {number}")));
        let mut names = names.filter(|name| !self.count.contains_key(&name.to_uppercase()));
        let name = names.next().unwrap_or_default();
        self.count.insert(name.to_uppercase(), 1);
        name
    }

    /// True if a node belongs to a cell.
    pub(super) fn is_of_body(&self, node: u32) -> bool {
        self.has_cell[node as usize]
    }

    /// The number of a node in the deck.
    pub(super) fn tag(&self, node: u32) -> i64 {
        self.places.deck.node_tags[node as usize]
    }

    /// The position of a node.
    pub(super) fn position(&self, node: u32) -> [f64; 3] {
        self.places.deck.points[node as usize]
    }

    /// The dimension of the cells.
    pub(super) fn dim(&self) -> usize {
        self.places.dim()
    }

    /// An error at a place of the deck.
    pub(super) fn error(&self, at: LinePlace, message: &str) -> InputError {
        self.places.source.error(at, message)
    }

    /// The group of nodes; `None` if none of them belongs to a cell.
    pub(super) fn of_nodes(&mut self, nodes: &[u32], word: &str) -> Option<String> {
        let members = self.with_cells(nodes);
        if members.is_empty() {
            return None;
        }
        if let Some(name) = self.nodes.get(&members) {
            return Some(name.clone());
        }
        let name = self.fresh(word, true);
        self.places
            .deck
            .node_sets
            .extend(&name, false, members.iter().copied());
        self.nodes.insert(members, name.clone());
        Some(name)
    }

    /// The group of nodes as single points, even if they form faces; `None` if none belongs to a cell.
    pub(super) fn of_points(&mut self, nodes: &[u32], word: &str) -> Option<String> {
        let members = self.with_cells(nodes);
        if members.is_empty() {
            return None;
        }
        let name = self.fresh(word, true);
        let deck = &mut self.places.deck;
        deck.node_sets.extend(&name, false, members);
        deck.point_sets.insert(name.clone());
        Some(name)
    }

    /// The nodes of a node-based surface.
    pub(super) fn of_node_surface(&self, surface: &str) -> Option<Vec<u32>> {
        let surface = self.places.deck.node_surfaces.get(surface)?;
        Some(surface.members.list().to_vec())
    }

    /// The mean outward direction of a surface of faces.
    pub(super) fn outward(&self, surface: &str) -> [f64; 3] {
        self.places.deck.outward(surface)
    }

    /// The group of cells, which are all or some of the set `word`.
    pub(super) fn of_cells(&mut self, cells: &[u32], word: &str) -> String {
        if let Some(name) = self.cells.get(cells) {
            return name.clone();
        }
        let name = self.fresh(word, false);
        self.places
            .deck
            .element_sets
            .extend(&name, false, cells.iter().copied());
        name
    }

    /// The group of faces of elements.
    pub(super) fn of_faces(&mut self, faces: &[(u32, usize)]) -> String {
        if let Some(name) = self.faces.get(faces) {
            return name.clone();
        }
        let name = self.fresh("pressure", true);
        let members = faces
            .iter()
            .map(|&(element, number)| Face::Of(element, number));
        self.places.deck.surfaces.extend(&name, false, members);
        name
    }

    /// The group that a surface of the deck makes.
    pub(super) fn of_surface(&mut self, surface: &str) -> String {
        let own = |deck: &crate::mesh::abaqus::Deck| {
            let of_faces = deck
                .surfaces
                .get(surface)
                .map(|set| (set.name.clone(), set.internal));
            of_faces.or_else(|| {
                deck.node_surfaces
                    .get(surface)
                    .map(|set| (set.name.clone(), set.internal))
            })
        };
        let Some((name, internal)) = own(&self.places.deck) else {
            return surface.to_owned();
        };
        if self.is_plain(&name, internal) {
            return name;
        }
        let copy = format!("{} side", name.replace('.', " "));
        if self.count.insert(copy.to_uppercase(), 1).is_some() {
            // The group exists already.
            return copy;
        }
        let deck = &mut self.places.deck;
        if let Some(set) = deck.surfaces.get(surface).cloned() {
            deck.surfaces
                .extend(&copy, false, set.members.list().iter().copied());
        }
        if let Some(set) = deck.node_surfaces.get(surface).cloned() {
            deck.node_surfaces
                .extend(&copy, false, set.members.list().iter().copied());
        }
        copy
    }
}

fn distinct(members: &[u32]) -> Vec<u32> {
    let members: BTreeSet<u32> = members.iter().copied().collect();
    members.into_iter().collect()
}
