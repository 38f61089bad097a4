//! `*PRE-TENSION SECTION`: bolts whose force or shortening is given at a reference node.

use std::collections::BTreeMap;

use super::axes::numbers;
use super::document::{Document, Names, quoted, vector};
use super::groups::Groups;
use super::place::Places;
use super::reference::Reference;
use super::steps::{LoadStep, Steps};
use crate::element::geometry::dot;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace, Position};

/// A pretension section.
struct Section {
    place: LinePlace,
    /// The surface, by name in capitals.
    surface: String,
    node: u32,
    direction: Option<[f64; 3]>,
}

/// All sections of a deck.
#[derive(Default)]
pub(super) struct Pretensions(Vec<Section>);

/// The load or displacement of the node in a step.
#[derive(Clone, Copy, PartialEq)]
enum Given {
    Force(f64),
    Shortening(f64),
    Lock,
}

/// A pretension section in the syntax of the scene.
pub(super) struct ScenePretension {
    /// Number of its node, and the sign of the node's force where the bolt is pulled.
    tag: i64,
    sense: f64,
    name: String,
    on: String,
    /// Away from the elements of the surface, whose nodes on the cut get new numbers, as in CalculiX.
    direction: Option<String>,
    /// Force or displacement by step.
    given: Vec<Given>,
}

impl Pretensions {
    /// Reads a pretension section.
    pub(super) fn read(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        if block.parameter("ELEMENT").is_some() {
            let message = "*PRE-TENSION SECTION of an ELEMENT, a beam, isn't read; expected SURFACE=… across a bolt of solids";
            return Err(source.error(block.place, message));
        }
        let surface = places.surface(block.place, source.required(block, "SURFACE")?)?;
        let node = places.one_node(block, "NODE")?;
        let direction = match block.data.first() {
            None => None,
            Some(data) => {
                let is_turned = |(_, position): &(String, Position)| position.is_turned();
                if places.instances().iter().any(is_turned) {
                    let message = "*PRE-TENSION SECTION gives a direction in a part whose instances are turned, which may \
                                   turn or not; expected none, for the normal of the faces, or the section outside \
                                   of the part";
                    return Err(source.error(data.place, message));
                }
                let mut direction = numbers(source, data, "a component of the direction")?;
                direction.resize(3, 0.0);
                Some([direction[0], direction[1], direction[2]])
            }
        };
        self.0.push(Section {
            place: block.place,
            surface,
            node,
            direction: direction.filter(|direction| *direction != [0.0; 3]),
        });
        Ok(())
    }

    /// The nodes of the sections.
    pub(super) fn nodes(&self) -> impl Iterator<Item = u32> {
        self.0.iter().map(|section| section.node)
    }

    /// Adds the nodes of pretension sections to the other reference nodes.
    ///
    /// # Errors
    /// A node that represents two reference points.
    pub(super) fn references(
        &self,
        places: &Places,
        mut references: BTreeMap<u32, Reference>,
    ) -> Result<BTreeMap<u32, Reference>, InputError> {
        for section in &self.0 {
            let own = Reference::of_pretension(section.node);
            if references.insert(section.node, own).is_some() {
                let message = format!(
                    "*PRE-TENSION SECTION: the node {} is a reference node already; expected one for each section",
                    places.deck.node_tags[section.node as usize]
                );
                return Err(places.source.error(section.place, message));
            }
        }
        Ok(references)
    }

    /// The sections with the groups of their faces and their loads or displacements in steps, per thickness of plane
    /// sections, under names that aren't in `names`.
    ///
    /// # Errors
    /// A node-based surface, a node of a body, alternating force and shortening.
    pub(super) fn in_scene(
        &self,
        groups: &mut Groups,
        steps: &Steps,
        thickness: f64,
        names: &mut Names,
    ) -> Result<Vec<ScenePretension>, InputError> {
        let mut all = Vec::with_capacity(self.0.len());
        for section in &self.0 {
            let tag = groups.tag(section.node);
            let wrong = if groups.of_node_surface(&section.surface).is_some() {
                Some("of a surface of nodes isn't read; expected one of faces".to_owned())
            } else if groups.is_of_body(section.node) {
                Some(format!(
                    "with the node {tag}, which is one of a body, isn't read; expected a node of its own"
                ))
            } else {
                None
            };
            if let Some(wrong) = wrong {
                let message = format!("*PRE-TENSION SECTION {wrong}");
                return Err(groups.error(section.place, &message));
            }
            let outward = groups.outward(&section.surface);
            let direction = section.direction.unwrap_or(outward);
            // A positive force is tensile if the direction points away from the elements of the surface.
            let sense = if dot(direction, outward) < 0.0 {
                -1.0
            } else {
                1.0
            };
            let given = section.given(groups, steps, (thickness, sense))?;
            let dim = groups.dim();
            all.push(ScenePretension {
                tag,
                sense,
                name: names.unique(&format!("bolt of {}", section.surface)),
                on: groups.of_surface(&section.surface),
                direction: (direction != [0.0; 3])
                    .then(|| vector(&direction.map(|c| sense * c), dim)),
                given,
            });
        }
        Ok(all)
    }
}

impl Section {
    /// The load or displacement of its node in every step.
    fn given(
        &self,
        groups: &Groups,
        steps: &Steps,
        (thickness, sense): (f64, f64),
    ) -> Result<Vec<Given>, InputError> {
        let in_step = |step: &LoadStep| {
            let at = step.references.get(&self.node).cloned().unwrap_or_default();
            match at.held[0] {
                Some(_) if steps.loads.fixed.contains(&(self.node, 0)) => Given::Lock,
                Some(length) => Given::Shortening(sense * length),
                None => Given::Force(sense * at.load[0] / thickness),
            }
        };
        let given: Vec<Given> = steps.done.iter().map(in_step).collect();
        let is_length = |given: &Given| matches!(given, Given::Shortening(_));
        let lengths = given.iter().filter(|given| is_length(given)).count();
        let wrong = match given.first() {
            Some(Given::Lock) => "is fixed before it has a force",
            _ if lengths > 0 && lengths < given.len() => {
                "has a force in one step and a displacement in another"
            }
            _ => return Ok(given),
        };
        let message = format!(
            "*PRE-TENSION SECTION: the node {} {wrong}; expected *CLOAD and then *BOUNDARY, FIXED, which keeps what it has \
             reached, or *BOUNDARY in all steps",
            groups.tag(self.node)
        );
        Err(groups.error(self.place, &message))
    }
}

impl ScenePretension {
    /// The number of its node, with its name and the sign of the node's force where the bolt is pulled.
    pub(super) fn printed(&self) -> (i64, (String, f64)) {
        (self.tag, (self.name.clone(), self.sense))
    }

    /// Writes the section, with its force or displacement in the first step.
    pub(super) fn write(&self, document: &mut Document) {
        document.table("[[pretension]]");
        document.key("name", quoted(&self.name));
        document.key("on", quoted(&self.on));
        if let Some(direction) = &self.direction {
            document.key("direction", direction);
        }
        if let Some(given) = self.given.first() {
            let (key, value) = given.key();
            document.key(key, value);
        }
    }
}

/// Writes forces and displacements of sections in a step.
pub(super) fn write_step(all: &[ScenePretension], step: usize, document: &mut Document) {
    if !all.is_empty() {
        document.table("[step.pretension]");
    }
    for section in all {
        let (key, value) = section.given[step].key();
        document.key(&quoted(&section.name), format!("{{ {key} = {value} }}"));
    }
}

impl Given {
    fn key(self) -> (&'static str, String) {
        match self {
            Self::Force(force) => ("force", format!("{:?}", force + 0.0)),
            Self::Shortening(length) => ("shortening", format!("{:?}", length + 0.0)),
            Self::Lock => ("lock", "true".into()),
        }
    }
}
