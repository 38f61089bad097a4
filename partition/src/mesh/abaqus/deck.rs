//! Nodes, elements, sets and surfaces of a part, or of a deck without parts.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::blocks::{Block, Data, Place, Source};
use super::element_type;
use super::sets::Sets;
use crate::element::Elements;
use crate::error::InputError;
use crate::name;

/// A part of a surface.
#[derive(Clone, Copy)]
pub(super) enum Face {
    /// The face of an element, by Abaqus' number.
    Of(u32, usize),
    /// Those faces of an element that belong to no other.
    Free(u32),
}

/// Nodes, elements, sets and surfaces.
#[derive(Default)]
pub(super) struct Deck {
    pub(super) node_tags: Vec<i64>,
    pub(super) points: Vec<[f64; 3]>,
    pub(super) node_of: HashMap<i64, u32>,
    pub(super) elements: Elements,
    pub(super) element_tags: Vec<i64>,
    /// Elements that can be sides only.
    pub(super) is_side: Vec<bool>,
    pub(super) element_of: HashMap<i64, u32>,
    pub(super) node_sets: Sets<u32>,
    pub(super) element_sets: Sets<u32>,
    pub(super) surfaces: Sets<Face>,
    /// What is added to the tags of an instance, by its name in capitals, and under an empty one to those of
    /// the assembly itself.
    pub(super) instances: BTreeMap<String, Offsets>,
    /// Types that are read as others of the same shape, in words.
    pub(super) taken_as: BTreeSet<String>,
}

/// What is added to the tags of an instance's nodes and elements so that all of a deck differ.
#[derive(Clone, Copy, Default)]
pub(super) struct Offsets {
    pub(super) nodes: i64,
    pub(super) elements: i64,
}

/// What the items of a set's data are.
#[derive(Clone, Copy)]
enum Of {
    Nodes,
    Elements,
}

impl Deck {
    /// `*NODE`: tag and coordinates a line.
    pub(super) fn add_nodes(&mut self, source: &Source, block: &Block) -> Result<(), InputError> {
        if let Some(system) = block
            .parameter("SYSTEM")
            .filter(|s| !s.eq_ignore_ascii_case("R"))
        {
            let message = format!("*NODE has SYSTEM={system}; expected Cartesian coordinates");
            return Err(source.error(block.place, message));
        }
        let first = self.points.len() as u32;
        let offset = self.own_offsets().nodes;
        for data in &block.data {
            let mut items = source.items(data);
            let item = items.next().unwrap_or_default();
            let tag = offset + source.tag(data.place, item, "the number of a node")?;
            let mut point = [0.0; 3];
            for (coordinate, axis) in point.iter_mut().zip("xyz".chars()) {
                let item = items.next().unwrap_or_default();
                *coordinate = source.real(data.place, item, &format!("the {axis} coordinate"))?;
            }
            if self.node_of.insert(tag, self.points.len() as u32).is_some() {
                return Err(source.error(data.place, format!("the node {tag} occurs twice")));
            }
            self.node_tags.push(tag);
            self.points.push(point);
        }
        if let Some(set) = block.parameter("NSET") {
            check_name(source, block.place, set)?;
            self.node_sets
                .extend(set, false, first..self.points.len() as u32);
        }
        Ok(())
    }

    /// `*ELEMENT`: tag and nodes of each, on as many lines as it takes.
    pub(super) fn add_elements(
        &mut self,
        source: &Source,
        block: &Block,
    ) -> Result<(), InputError> {
        let name = source.required(block, "TYPE")?;
        let Some(found) = element_type::find(name) else {
            let known = element_type::known();
            let message = format!(
                "elements of type {name} aren't supported; expected one of {known}, also with another \
                 integration or formulation, such as C3D8R"
            );
            return Err(source.error(block.place, message));
        };
        match (found.is_side, found.plain) {
            (true, _) => self
                .taken_as
                .insert(format!("{} as sides", name.to_uppercase())),
            (_, Some(plain)) => self
                .taken_as
                .insert(format!("{} as {plain}", name.to_uppercase())),
            _ => false,
        };
        let first = self.elements.len() as u32;
        let offsets = self.own_offsets();
        let mut pending: Option<(Place, i64)> = None;
        let mut nodes = Vec::new();
        for data in &block.data {
            for item in source.items(data).filter(|item| !item.is_empty()) {
                let Some((_, element)) = pending else {
                    let tag = source.tag(data.place, item, "the number of an element")?;
                    pending = Some((data.place, offsets.elements + tag));
                    continue;
                };
                let tag = source.tag(data.place, item, "the number of a node")?;
                if nodes.len() == found.kind.nodes() {
                    let message = format!(
                        "element {element} of type {name} has more than {} nodes",
                        found.kind.nodes()
                    );
                    return Err(source.error(data.place, message));
                }
                nodes.push(self.node(source, data.place, offsets.nodes + tag, element)?);
            }
            if nodes.len() < found.kind.nodes() {
                continue;
            }
            if let Some((place, element)) = pending.take() {
                self.add_element(source, place, element, &found, &nodes)?;
            }
            nodes.clear();
        }
        if let Some((place, element)) = pending {
            let message = format!(
                "element {element} has {} nodes; expected {}, as it is of type {name}",
                nodes.len(),
                found.kind.nodes()
            );
            return Err(source.error(place, message));
        }
        if let Some(set) = block.parameter("ELSET") {
            check_name(source, block.place, set)?;
            self.element_sets
                .extend(set, false, first..self.elements.len() as u32);
        }
        Ok(())
    }

    /// What is added to tags that belong to no instance: instances have tags of their own.
    fn own_offsets(&mut self) -> Offsets {
        if self.instances.is_empty() {
            return Offsets::default();
        }
        let highest = |tags: &[i64]| tags.iter().max().copied().unwrap_or_default();
        let (nodes, elements) = (highest(&self.node_tags), highest(&self.element_tags));
        *(self.instances.entry(String::new())).or_insert(Offsets { nodes, elements })
    }

    fn node(&self, source: &Source, at: Place, tag: i64, element: i64) -> Result<u32, InputError> {
        let found = self.node_of.get(&tag).copied();
        found.ok_or_else(|| {
            let message =
                format!("element {element} has the node {tag}, which isn't defined before it");
            source.error(at, message)
        })
    }

    fn add_element(
        &mut self,
        source: &Source,
        at: Place,
        tag: i64,
        found: &element_type::ElementType,
        nodes: &[u32],
    ) -> Result<(), InputError> {
        if let Some(twice) = (1..nodes.len()).find(|&i| nodes[..i].contains(&nodes[i])) {
            let node = self.node_tags[nodes[twice] as usize];
            let message = format!(
                "element {tag} has the node {node} twice; expected a {} whose nodes all differ",
                found.kind.name()
            );
            return Err(source.error(at, message));
        }
        if self
            .element_of
            .insert(tag, self.elements.len() as u32)
            .is_some()
        {
            return Err(source.error(at, format!("the element {tag} occurs twice")));
        }
        self.elements.push(found.kind, nodes);
        self.element_tags.push(tag);
        self.is_side.push(found.is_side);
        Ok(())
    }

    /// `*NSET` and `*ELSET`: tags and names of other sets, or with `GENERATE` first, last and increment.
    pub(super) fn add_set(&mut self, source: &Source, block: &Block) -> Result<(), InputError> {
        let of = match block.keyword.as_str() {
            "NSET" => Of::Nodes,
            _ => Of::Elements,
        };
        let name = source.required(block, &block.keyword)?;
        check_name(source, block.place, name)?;
        let instance = block.parameter("INSTANCE");
        let mut members = Vec::new();
        if let (Of::Nodes, Some(elements)) = (of, block.parameter("ELSET")) {
            for element in self.members(source, block.place, Of::Elements, instance, elements)? {
                members.extend(self.elements.nodes_of(element as usize));
            }
        }
        for data in &block.data {
            if block.parameter("GENERATE").is_some() {
                members.extend(self.generated(source, data, of, instance)?);
                continue;
            }
            for item in source.items(data).filter(|item| !item.is_empty()) {
                members.extend(self.members(source, data.place, of, instance, item)?);
            }
        }
        let internal = block.parameter("INTERNAL").is_some();
        match of {
            Of::Nodes => self.node_sets.extend(name, internal, members),
            Of::Elements => self.element_sets.extend(name, internal, members),
        }
        Ok(())
    }

    /// What is there of the numbers from the first to the last.
    fn generated(
        &self,
        source: &Source,
        data: &Data,
        of: Of,
        instance: Option<&str>,
    ) -> Result<Vec<u32>, InputError> {
        let items = source.items(data).filter(|item| !item.is_empty());
        let numbers = items.map(|item| source.tag(data.place, item, "first, last and increment"));
        let (first, last, step) = match numbers.collect::<Result<Vec<_>, _>>()?[..] {
            [first, last] => (first, last, 1),
            [first, last, step] => (first, last, step),
            _ => {
                let message = "expected first, last and increment, as the set has GENERATE";
                return Err(source.error(data.place, message));
            }
        };
        let (indices, offset) = self.numbered(source, data.place, of, instance)?;
        // Numbers without anything are as common as ranges far beyond the last.
        let last = last.min(indices.keys().max().copied().unwrap_or_default() - offset);
        let tags = (first..=last).step_by(step as usize);
        Ok(tags
            .filter_map(|tag| indices.get(&(tag + offset)).copied())
            .collect())
    }

    /// Indices by tag, and what is added to the tags of an instance.
    fn numbered(
        &self,
        source: &Source,
        at: Place,
        of: Of,
        instance: Option<&str>,
    ) -> Result<(&HashMap<i64, u32>, i64), InputError> {
        let offsets = self
            .instances
            .get(&instance.unwrap_or_default().to_uppercase());
        let offsets = match (offsets, instance) {
            (Some(offsets), _) => *offsets,
            (None, None) => Offsets::default(),
            (None, Some(name)) => {
                let message = format!("there is no instance '{name}' before this line");
                return Err(source.error(at, message));
            }
        };
        Ok(match of {
            Of::Nodes => (&self.node_of, offsets.nodes),
            Of::Elements => (&self.element_of, offsets.elements),
        })
    }

    /// The nodes or elements that an item of data means: `7`, `set`, `instance.7`, `instance.set`.
    fn members(
        &self,
        source: &Source,
        at: Place,
        of: Of,
        instance: Option<&str>,
        item: &str,
    ) -> Result<Vec<u32>, InputError> {
        let (what, sets) = match of {
            Of::Nodes => ("node", &self.node_sets),
            Of::Elements => ("element", &self.element_sets),
        };
        let unknown = || {
            let message =
                format!("there is no {what} and no set of {what}s '{item}' before this line");
            source.error(at, message)
        };
        let by_tag = |instance, tag: i64| {
            let (indices, offset) = self.numbered(source, at, of, instance)?;
            let index = tag
                .checked_add(offset)
                .and_then(|tag: i64| indices.get(&tag));
            index.map(|&index| vec![index]).ok_or_else(unknown)
        };
        if let Ok(tag) = item.parse() {
            return by_tag(instance, tag);
        }
        let local = instance.and_then(|instance| sets.get(&format!("{instance}.{item}")));
        if let Some(set) = local.or_else(|| sets.get(item)) {
            return Ok(set.members.clone());
        }
        match item
            .rsplit_once('.')
            .map(|(instance, tag)| (instance, tag.parse()))
        {
            Some((instance, Ok(tag))) => by_tag(Some(instance), tag),
            _ => Err(unknown()),
        }
    }

    /// `*SURFACE`: elements or sets of them with a face each, or nodes.
    pub(super) fn add_surface(&mut self, source: &Source, block: &Block) -> Result<(), InputError> {
        let name = source.required(block, "NAME")?;
        check_name(source, block.place, name)?;
        let internal = block.parameter("INTERNAL").is_some();
        let kind = block.parameter("TYPE").unwrap_or("ELEMENT").to_uppercase();
        if !["ELEMENT", "NODE"].contains(&kind.as_str()) || block.parameter("COMBINE").is_some() {
            let message = format!(
                "the surface '{name}' isn't made of faces; expected TYPE=ELEMENT or TYPE=NODE"
            );
            return Err(source.error(block.place, message));
        }
        for data in &block.data {
            let mut items = source.items(data);
            let item = items.next().unwrap_or_default();
            let second = items.next().unwrap_or_default();
            if kind == "NODE" {
                let members = self.members(source, data.place, Of::Nodes, None, item)?;
                self.node_sets.extend(name, internal, members);
                continue;
            }
            let mut faces = Vec::new();
            for element in self.members(source, data.place, Of::Elements, None, item)? {
                faces.push(self.face(source, data.place, element, second)?);
            }
            self.surfaces.extend(name, internal, faces);
        }
        Ok(())
    }

    fn face(
        &self,
        source: &Source,
        at: Place,
        element: u32,
        item: &str,
    ) -> Result<Face, InputError> {
        if item.is_empty() {
            return Ok(Face::Free(element));
        }
        let kind = self.elements.kind(element as usize);
        let number = item
            .strip_prefix(['S', 's'])
            .and_then(|number| number.parse().ok());
        let known = number.filter(|&number| element_type::face(kind, number).is_some());
        known
            .map(|number| Face::Of(element, number))
            .ok_or_else(|| {
                let tag = self.element_tags[element as usize];
                let message = format!(
                    "element {tag}, a {}, has no face `{}`; expected S1 to S{}",
                    kind.name(),
                    item.escape_debug(),
                    kind.facets().len()
                );
                source.error(at, message)
            })
    }
}

fn check_name(source: &Source, at: Place, name: &str) -> Result<(), InputError> {
    name::check_text(name)
        .map_err(|reason| source.error(at, format!("'{}' {reason}", name::shown(name))))
}
