//! Sets and surfaces: the meaning of their lines.

use std::collections::{HashMap, HashSet};

use super::blocks::{Block, Data, LinePlace, Source};
use super::deck::{Deck, Face, Offsets, check_name};
use super::element_type;
use super::sets::{Members, Set};
use crate::error::InputError;
use crate::name;

/// Kinds of items in a set's data.
#[derive(Clone, Copy)]
pub(crate) enum Of {
    Nodes,
    Elements,
}

impl Of {
    fn word(self) -> &'static str {
        match self {
            Self::Nodes => "node",
            Self::Elements => "element",
        }
    }
}

/// The meaning of an item of data.
enum Meaning<'a> {
    Tag(Option<&'a str>, i64),
    Set(&'a Set<u32>),
    Unknown,
}

impl Deck {
    /// The name of a set or surface that a block refers to and that doesn't exist.
    pub(crate) fn undefined_name<'a>(
        &self,
        source: &'a Source,
        block: &'a Block,
    ) -> Option<&'a str> {
        let instance = block.parameter("INSTANCE");
        let of = match block.keyword.as_str() {
            "SURFACE" if block.parameter("COMBINE").is_some() => {
                let mut items = block.data.iter().flat_map(|data| source.items(data));
                return items.find(|item| !item.is_empty() && !self.has_surface(item));
            }
            "NSET" => Of::Nodes,
            "ELSET" => Of::Elements,
            _ => return None,
        };
        if block.parameter("GENERATE").is_some() {
            return None;
        }
        let mut items = block.data.iter().flat_map(|data| source.items(data));
        items.find(|item| {
            !item.is_empty() && matches!(self.meaning(of, instance, item), Meaning::Unknown)
        })
    }

    /// `*NSET` and `*ELSET`: tags and names of other sets, or with `GENERATE` first, last and increment.
    pub(crate) fn add_set(&mut self, source: &Source, block: &Block) -> Result<(), InputError> {
        let of = match block.keyword.as_str() {
            "NSET" => Of::Nodes,
            _ => Of::Elements,
        };
        let name = source.required(block, &block.keyword)?;
        check_name(source, block.place, name)?;
        let instance = block.parameter("INSTANCE");
        let mut members = Members::default();
        if let (Of::Nodes, Some(elements)) = (of, block.parameter("ELSET")) {
            let elements = self.members(
                source,
                block.place,
                Of::Elements,
                (instance, elements),
                name,
            )?;
            let nodes = |&element: &u32| self.elements.nodes_of(element as usize);
            members.extend(elements.iter().flat_map(nodes).copied());
        }
        // A repeated reference to a set adds nothing.
        let mut named = HashSet::new();
        for data in &block.data {
            if block.parameter("GENERATE").is_some() {
                members.extend(self.generated(source, data, of, instance)?);
                continue;
            }
            for item in source.items(data).filter(|item| !item.is_empty()) {
                if item.parse::<i64>().is_ok() || named.insert(item) {
                    members.extend(self.members(source, data.place, of, (instance, item), name)?);
                }
            }
        }
        let internal = block.parameter("INTERNAL").is_some();
        let members = members.list().iter().copied();
        match of {
            Of::Nodes => self.node_sets.extend(name, internal, members),
            Of::Elements => self.element_sets.extend(name, internal, members),
        }
        Ok(())
    }

    /// Members among the numbers from the first to the last.
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
        let count = (last - first) / step;
        // Ranges may contain many unused numbers or extend far beyond the last one.
        if count > indices.len() as i64 {
            let is_in = |tag: i64| (first..=last).contains(&tag) && (tag - first) % step == 0;
            let found = indices.iter().filter(|(tag, _)| is_in(**tag - offset));
            return Ok(found.map(|(_, &index)| index).collect());
        }
        let tags = (first..=last).step_by(step as usize);
        Ok(tags
            .filter_map(|tag| indices.get(&(tag + offset)).copied())
            .collect())
    }

    /// Indices by tag, and the offset of an instance's tags.
    fn numbered(
        &self,
        source: &Source,
        at: LinePlace,
        of: Of,
        instance: Option<&str>,
    ) -> Result<(&HashMap<i64, u32>, i64), InputError> {
        let offsets = self
            .instances
            .get(&instance.unwrap_or_default().to_uppercase());
        let offsets = match (offsets, instance) {
            (Some(offsets), _) => *offsets,
            (None, None) => Offsets::default(),
            (None, Some(instance)) => {
                let message = format!(
                    "there is no instance '{}' before this line",
                    name::shown(instance)
                );
                return Err(source.error(at, message));
            }
        };
        Ok(match of {
            Of::Nodes => (&self.node_of, offsets.nodes),
            Of::Elements => (&self.element_of, offsets.elements),
        })
    }

    /// Meaning of an item of data: `7`, `set`, `instance.7`, `instance.set`.
    fn meaning<'a>(&'a self, of: Of, instance: Option<&'a str>, item: &'a str) -> Meaning<'a> {
        let sets = match of {
            Of::Nodes => &self.node_sets,
            Of::Elements => &self.element_sets,
        };
        if let Ok(tag) = item.parse() {
            return Meaning::Tag(instance, tag);
        }
        let local = instance.and_then(|instance| sets.get(&format!("{instance}.{item}")));
        if let Some(set) = local.or_else(|| sets.get(item)) {
            return Meaning::Set(set);
        }
        match item
            .rsplit_once('.')
            .map(|(instance, tag)| (instance, tag.parse()))
        {
            Some((instance, Ok(tag))) => Meaning::Tag(Some(instance), tag),
            _ => Meaning::Unknown,
        }
    }

    /// The nodes or elements of an item in the set `set`, in an instance or in the whole deck; missing ones are left
    /// out.
    pub(crate) fn members(
        &mut self,
        source: &Source,
        at: LinePlace,
        of: Of,
        (instance, item): (Option<&str>, &str),
        set: &str,
    ) -> Result<Vec<u32>, InputError> {
        let what = of.word();
        let (instance, tag) = match self.meaning(of, instance, item) {
            Meaning::Set(found) => return Ok(found.members.list().to_vec()),
            Meaning::Tag(instance, tag) => (instance, tag),
            Meaning::Unknown => {
                let item = name::shown(item);
                let message = format!("there is no {what} and no set of {what}s '{item}'");
                return Err(source.error(at, message));
            }
        };
        let (indices, offset) = self.numbered(source, at, of, instance)?;
        let tag = tag.checked_add(offset);
        if let Some(&index) = tag.and_then(|tag: i64| indices.get(&tag)) {
            return Ok(vec![index]);
        }
        if !(matches!(of, Of::Elements) && tag.is_some_and(|tag| self.leaves_out(tag))) {
            let kind = format!("sets name {what}s that aren't there, which are left out");
            let (item, set) = (name::shown(item), name::shown(set));
            let item = format!("{item} of '{set}' ({})", source.place(at));
            self.notes.add(&kind, item);
        }
        Ok(Vec::new())
    }

    /// `*SURFACE`: elements or sets of them with a face each, nodes, or other surfaces.
    pub(crate) fn add_surface(&mut self, source: &Source, block: &Block) -> Result<(), InputError> {
        let name = source.required(block, "NAME")?;
        check_name(source, block.place, name)?;
        let internal = block.parameter("INTERNAL").is_some();
        if let Some(combined) = block.parameter("COMBINE") {
            return match combined.eq_ignore_ascii_case("UNION") {
                true => self.unite(source, block, name),
                false => {
                    let (name, combined) = (name::shown(name), name::shown(combined));
                    let message = format!(
                        "the surface '{name}' has COMBINE={combined}; expected COMBINE=UNION or faces"
                    );
                    Err(source.error(block.place, message))
                }
            };
        }
        let kind = block.parameter("TYPE").unwrap_or("ELEMENT").to_uppercase();
        if !["ELEMENT", "NODE"].contains(&kind.as_str()) {
            let message = format!(
                "the surface '{}' isn't made of faces; expected TYPE=ELEMENT or TYPE=NODE",
                name::shown(name)
            );
            return Err(source.error(block.place, message));
        }
        for data in &block.data {
            let mut items = source.items(data);
            let item = items.next().unwrap_or_default();
            let second = items.next().unwrap_or_default();
            if kind == "NODE" {
                let members = self.members(source, data.place, Of::Nodes, (None, item), name)?;
                self.node_surfaces.extend(name, internal, members);
                continue;
            }
            let mut faces = Vec::new();
            for element in self.members(source, data.place, Of::Elements, (None, item), name)? {
                faces.push(self.face(source, data.place, element, second)?);
            }
            self.surfaces.extend(name, internal, faces);
        }
        Ok(())
    }

    fn has_surface(&self, name: &str) -> bool {
        self.surfaces.get(name).is_some() || self.node_surfaces.get(name).is_some()
    }

    /// `*SURFACE, COMBINE=UNION`: the union of other surfaces.
    fn unite(&mut self, source: &Source, block: &Block, name: &str) -> Result<(), InputError> {
        let internal = block.parameter("INTERNAL").is_some();
        let mut named = HashSet::new();
        for data in &block.data {
            for item in source.items(data).filter(|item| !item.is_empty()) {
                if !named.insert(item) {
                    continue;
                }
                if !self.has_surface(item) {
                    let message = format!("there is no surface '{}'", name::shown(item));
                    return Err(source.error(data.place, message));
                }
                if let Some(set) = self.surfaces.get(item) {
                    let faces = set.members.list().to_vec();
                    self.surfaces.extend(name, internal, faces);
                }
                if let Some(set) = self.node_surfaces.get(item) {
                    let nodes = set.members.list().to_vec();
                    self.node_surfaces.extend(name, internal, nodes);
                }
            }
        }
        Ok(())
    }

    fn face(
        &self,
        source: &Source,
        at: LinePlace,
        element: u32,
        item: &str,
    ) -> Result<Face, InputError> {
        let side = item.to_uppercase();
        let is_side = self.is_side[element as usize];
        // Either side of a shell is the whole shell.
        if item.is_empty() || is_side && ["SPOS", "SNEG", "S1", "S2"].contains(&side.as_str()) {
            return Ok(Face::Free(element));
        }
        let kind = self.elements.kind(element as usize);
        let number = side
            .strip_prefix('S')
            .and_then(|number| number.parse().ok());
        let is_face = |&number: &usize| element_type::face(kind, number).is_some();
        if let Some(number) = number.filter(|number| !is_side && is_face(number)) {
            return Ok(Face::Of(element, number));
        }
        let expected = match is_side {
            true => "SPOS or SNEG".to_owned(),
            false => format!("S1 to S{}", kind.facets().len()),
        };
        let message = format!(
            "element {}, a {}, has no face `{}`; expected {expected}",
            self.element_tags[element as usize],
            kind.name(),
            name::shown(item),
        );
        Err(source.error(at, message))
    }
}
