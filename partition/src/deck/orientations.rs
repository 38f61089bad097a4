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
    /// Systems by name in capitals; those of parts by `instance.name`, as an instance has them.
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
        let instances = places.instances();
        let Some(of) = self.distributions.get(&first) else {
            let system = System::of_material(source, block)?;
            for (instance, position) in &instances {
                let own = format!("{instance}.{name}");
                self.all.insert(own, system.placed(position));
            }
            if instances.is_empty() {
                self.all.insert(name, system);
            }
            return Ok(());
        };
        if instances.iter().any(|(_, position)| position.is_turned()) {
            let message = "*ORIENTATION of a *DISTRIBUTION in a part whose instances are turned isn't read; expected the \
                           elements of the instances, outside of the part";
            return Err(source.error(block.place, message));
        }
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
    pub(super) fn parts(&self, places: &Places, section: &Section) -> Vec<Section> {
        let name = section.orientation.as_deref().unwrap_or_default();
        let mut parts = self.of_instances(places, name);
        if parts.is_empty() {
            parts = self.parts.get(name).cloned().unwrap_or_default();
        }
        let turned = parts
            .iter()
            .map(|(elements, name)| section.turned(elements, name));
        turned.collect()
    }

    /// The elements of the instances of the part being read, each with the name of their system; instances with equal
    /// axes share one, so that they share a body.
    fn of_instances(&self, places: &Places, name: &str) -> Vec<(Vec<u32>, String)> {
        let mut found: Vec<(Vec<u32>, String)> = Vec::new();
        for (instance, _) in places.instances() {
            let own = format!("{instance}.{name}");
            let Some(system) = self.all.get(&own) else {
                continue;
            };
            let elements = places.deck.element_sets.get(&instance);
            let elements = elements.map_or_else(Vec::new, |set| set.members.list().to_vec());
            let alike = |other: &String| self.all.get(other) == Some(system);
            match found.iter().position(|(_, other)| alike(other)) {
                Some(at) => found[at].0.extend(elements),
                None => found.push((elements, own)),
            }
        }
        for (elements, _) in &mut found {
            elements.sort_unstable();
        }
        found
    }

    /// The name by which an orientation is listed that a block refers to, in a part that of an instance.
    pub(super) fn listed(&self, places: &Places, name: &str) -> String {
        let name = name.to_uppercase();
        let instances = places.instances();
        let found = instances
            .iter()
            .map(|(instance, _)| format!("{instance}.{name}"))
            .find(|own| self.all.contains_key(own));
        found.unwrap_or(name)
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
