//! `*ORIENTATION`, and `*DISTRIBUTION` of orientations over elements.

use std::collections::BTreeMap;

use super::axes::System;
use super::loads::item;
use super::place::Places;
use super::sections::Section;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Of};

/// Local systems of elements.
struct Distribution {
    /// The system of all other elements.
    others: System,
    /// Elements with their systems.
    of_elements: Vec<(Vec<u32>, System)>,
}

/// All orientations of a deck.
#[derive(Default)]
pub(super) struct Orientations {
    /// Systems by name in capitals.
    pub(super) all: BTreeMap<String, System>,
    /// Distributions by name in capitals.
    distributions: BTreeMap<String, Distribution>,
    /// The elements of orientations with a distribution, each with the name of their system, by name in capitals.
    parts: BTreeMap<String, Vec<(Vec<u32>, String)>>,
}

impl Orientations {
    /// Reads a block.
    pub(super) fn read(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        let name = source.required(block, "NAME")?.to_uppercase();
        if block.keyword == "DISTRIBUTION" {
            self.distributions
                .insert(name, Distribution::read(places, block)?);
            return Ok(());
        }
        let first = block.data.first().map(|data| item(source, data, 0));
        let first = first.unwrap_or_default().to_uppercase();
        let Some(of) = self.distributions.get(&first) else {
            self.all.insert(name, System::of_material(source, block)?);
            return Ok(());
        };
        if let Some(data) = block.data.get(1) {
            let message = "*ORIENTATION turns the axes of a *DISTRIBUTION, which isn't read; expected its name alone";
            return Err(source.error(data.place, message));
        }
        let parts = (1..).zip(&of.of_elements);
        let part =
            |(k, (elements, _)): (usize, &(Vec<u32>, _))| (elements.clone(), format!("{name} {k}"));
        let parts: Vec<(Vec<u32>, String)> = parts.map(part).collect();
        for ((_, own), (_, system)) in parts.iter().zip(&of.of_elements) {
            self.all.insert(own.clone(), *system);
        }
        self.all.insert(name.clone(), of.others);
        self.parts.insert(name, parts);
        Ok(())
    }

    /// The parts of a section whose orientation differs from that of its other elements.
    pub(super) fn parts(&self, section: &Section) -> Vec<Section> {
        let name = section.orientation.as_deref().unwrap_or_default();
        let parts = self.parts.get(name).into_iter().flatten();
        let turned = parts.map(|(elements, name)| section.turned(elements, name));
        turned.collect()
    }
}

impl Distribution {
    /// Reads a distribution: each line has an element or a set, followed by six coordinates; the first line, without
    /// elements, defines the default.
    fn read(places: &mut Places, block: &Block) -> Result<Self, InputError> {
        let source = places.source;
        let mut others = None;
        let mut of_elements = Vec::new();
        for data in &block.data {
            let items = source.items(data).skip(1);
            let points: Result<Vec<f64>, InputError> = items
                .map(|item| source.real(data.place, item, "a coordinate"))
                .collect();
            let system = System::of_points(source, block, &points?, "RECTANGULAR")?;
            match item(source, data, 0) {
                "" => others = Some(system),
                of => of_elements.push((places.members(data.place, Of::Elements, of)?, system)),
            }
        }
        let message = "*DISTRIBUTION has no line of all other elements; expected one that begins with a comma";
        let others = others.ok_or_else(|| source.error(block.place, message))?;
        Ok(Self {
            others,
            of_elements,
        })
    }
}
