//! Resolution of names and numbers in a block to nodes and elements of the whole deck.

use std::collections::BTreeMap;

use crate::error::InputError;
use crate::mesh::abaqus::{Block, Deck, LinePlace, Of, Position, Source};
use crate::name;

/// The part or instance of a block, by its name in capitals.
enum Scope {
    Whole,
    Part(String),
    Instance(String),
}

/// The deck's mesh, and the current part or instance.
pub(super) struct Places<'a> {
    pub(super) source: &'a Source,
    pub(super) deck: Deck,
    dim: usize,
    scope: Scope,
    /// Instances by their part's name in capitals.
    instances: BTreeMap<String, Vec<String>>,
    /// Positions by the instance's name in capitals.
    positions: BTreeMap<String, Position>,
}

/// Nodes or elements of an instance, with its position; without one outside of parts and instances.
type InInstance = (Option<Position>, Vec<u32>);

impl<'a> Places<'a> {
    /// The whole deck, outside of parts and instances.
    ///
    /// # Errors
    /// An invalid position of an instance.
    pub(super) fn new(source: &'a Source, deck: Deck) -> Result<Self, InputError> {
        let mut instances: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let mut positions = BTreeMap::new();
        for block in source
            .blocks
            .iter()
            .filter(|block| block.keyword == "INSTANCE")
        {
            let [name, part] =
                ["NAME", "PART"].map(|key| block.parameter(key).unwrap_or_default().to_uppercase());
            positions.insert(name.clone(), Position::read(source, block)?);
            instances.entry(part).or_default().push(name);
        }
        let cells = (0..deck.elements.len()).filter(|&element| !deck.is_side[element]);
        let dim = cells.map(|cell| deck.elements.kind(cell).dim()).max();
        Ok(Self {
            source,
            dim: dim.unwrap_or_default(),
            deck,
            scope: Scope::Whole,
            instances,
            positions,
        })
    }

    /// Enters or leaves a part or an instance.
    pub(super) fn enter(&mut self, block: &Block) {
        let name = || block.parameter("NAME").unwrap_or_default().to_uppercase();
        match block.keyword.as_str() {
            "PART" => self.scope = Scope::Part(name()),
            "INSTANCE" => self.scope = Scope::Instance(name()),
            "END PART" | "END INSTANCE" => self.scope = Scope::Whole,
            _ => {}
        }
    }

    /// The instances of the part or the instance being read, by name in capitals; none outside of both.
    pub(super) fn instances(&self) -> Vec<(String, Position)> {
        let names = match &self.scope {
            Scope::Whole => Vec::new(),
            Scope::Instance(name) => vec![name.clone()],
            Scope::Part(part) => self.instances.get(part).cloned().unwrap_or_default(),
        };
        names
            .into_iter()
            .filter_map(|name| {
                let position = *self.positions.get(&name)?;
                Some((name, position))
            })
            .collect()
    }

    /// True if the deck's mesh contains the part being read, as it doesn't without instances of it.
    pub(super) fn is_placed(&self) -> bool {
        !matches!(self.scope, Scope::Part(_)) || !self.instances().is_empty()
    }

    /// The nodes or elements of an item in each instance of the part being read, with the instance's position; outside of
    /// parts and instances in the whole deck, with none.
    pub(super) fn in_instances(
        &mut self,
        at: LinePlace,
        of: Of,
        item: &str,
    ) -> Result<Vec<InInstance>, InputError> {
        let instances: Vec<Option<(String, Position)>> = match self.scope {
            Scope::Whole => vec![None],
            _ => self.instances().into_iter().map(Some).collect(),
        };
        let mut found = Vec::new();
        for instance in instances {
            let name = instance.as_ref().map(|(name, _)| name.as_str());
            let own = self.deck.members(self.source, at, of, (name, item), item)?;
            found.push((instance.map(|(_, position)| position), own));
        }
        Ok(found)
    }

    /// The nodes or elements of an item, without repetition.
    ///
    /// # Errors
    /// An unknown number or name.
    pub(super) fn members(
        &mut self,
        at: LinePlace,
        of: Of,
        item: &str,
    ) -> Result<Vec<u32>, InputError> {
        let found = self.in_instances(at, of, item)?;
        let mut found: Vec<u32> = found.into_iter().flat_map(|(_, own)| own).collect();
        if found.is_empty() && item.parse::<i64>().is_ok() {
            let what = match of {
                Of::Nodes => "node",
                Of::Elements => "element of a body",
            };
            return Err(self
                .source
                .error(at, format!("there is no {what} {}", name::shown(item))));
        }
        found.sort_unstable();
        found.dedup();
        Ok(found)
    }

    /// The single node given by a parameter.
    pub(super) fn one_node(&mut self, block: &Block, key: &str) -> Result<u32, InputError> {
        let item = self.source.required(block, key)?;
        match self.members(block.place, Of::Nodes, item)?[..] {
            [node] => Ok(node),
            ref all => {
                let message = format!(
                    "*{}: {key} is {} nodes; expected one",
                    block.keyword,
                    all.len()
                );
                Err(self.source.error(block.place, message))
            }
        }
    }

    /// The name of a surface in capitals, in a part with that of its only instance before it.
    ///
    /// # Errors
    /// A surface that doesn't exist, or one of each of several instances.
    pub(super) fn surface(&self, at: LinePlace, name: &str) -> Result<String, InputError> {
        let name = name.to_uppercase();
        let deck = &self.deck;
        let is_there = |name: &String| {
            deck.surfaces.get(name).is_some() || deck.node_surfaces.get(name).is_some()
        };
        let instances = self.instances().into_iter();
        let own = instances.map(|(instance, _)| format!("{instance}.{name}"));
        let own: Vec<String> = own.filter(is_there).collect();
        let shown = name::shown(&name);
        let message = match &own[..] {
            [own] => return Ok(own.clone()),
            [] if is_there(&name) => return Ok(name),
            [] => format!("there is no surface '{shown}'"),
            _ => format!(
                "each of {} instances has a surface '{shown}'; expected one, behind *END INSTANCE",
                own.len()
            ),
        };
        Err(self.source.error(at, message))
    }

    /// The dimension of the cells; 0 without cells.
    pub(super) fn dim(&self) -> usize {
        self.dim
    }

    /// Flags of the nodes that belong to a cell.
    pub(super) fn with_cells(&self) -> Vec<bool> {
        let dim = self.dim();
        let mut has_cell = vec![false; self.deck.points.len()];
        for (element, (_, nodes)) in (0..).zip(self.deck.elements.iter()) {
            if self.is_cell(element, dim) {
                nodes
                    .iter()
                    .for_each(|&node| has_cell[node as usize] = true);
            }
        }
        has_cell
    }

    /// True if an element is a cell, in a mesh of dimension `dim`.
    pub(super) fn is_cell(&self, element: u32, dim: usize) -> bool {
        let element = element as usize;
        !self.deck.is_side[element] && self.deck.elements.kind(element).dim() == dim
    }
}
