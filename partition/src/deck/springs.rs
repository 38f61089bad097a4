//! `*SPRING` with elements of type SPRING1, springs between nodes and the ground, and of SPRING2 and SPRINGA, springs
//! between two nodes along an axis or the line between them.

use std::collections::BTreeMap;

use super::axes::System;
use super::conditions::{SceneEquation, Terms, Translator};
use super::document::{Document, Names, quoted, vector};
use super::groups::Groups;
use super::loads::item;
use super::parameters;
use super::place::Places;
use super::reference::Reference;
use crate::element::geometry::{difference, unit};
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Data, LinePlace, Of};
use crate::name;

/// The type of springs to the ground.
const TO_GROUND: &str = "SPRING1";

/// The type of springs between two nodes along an axis.
const ALONG_AXIS: &str = "SPRING2";

/// The type of springs between two nodes along their line.
const ALONG_LINE: &str = "SPRINGA";

/// Spring elements of one block.
struct Elements {
    place: LinePlace,
    /// Type of the elements in capitals.
    kind: String,
    /// Their set, by name in capitals.
    set: String,
    /// The ends of each element with its number in the deck; a spring to the ground has one end.
    ends: Vec<(i64, Vec<u32>)>,
}

/// The springs of a set of elements.
struct Property {
    place: LinePlace,
    /// Set by name in capitals.
    set: String,
    /// The degree of freedom of each end, from 0; `None` for the line between the ends.
    axes: Option<[usize; 2]>,
    stiffness: f64,
}

/// All springs of a deck.
#[derive(Default)]
pub(super) struct Springs {
    elements: Vec<Elements>,
    properties: Vec<Property>,
}

/// Springs in the syntax of the scene: the group of their nodes, or the groups of both ends and a name, and their
/// stiffness along the axes, or the line.
pub(super) struct SceneSpring {
    on: Vec<String>,
    name: String,
    stiffness: [f64; 3],
    axial: Option<f64>,
    dim: usize,
}

impl Springs {
    /// The nodes at the ends of all springs.
    pub(super) fn nodes(&self) -> impl Iterator<Item = u32> {
        let ends = self.elements.iter().flat_map(|elements| &elements.ends);
        ends.flat_map(|(_, nodes)| nodes.iter().copied())
    }

    /// Reads the nodes of a block of elements if these are springs.
    pub(super) fn elements(
        &mut self,
        places: &mut Places,
        block: &Block,
    ) -> Result<(), InputError> {
        let source = places.source;
        let kind = source.required(block, "TYPE")?.to_uppercase();
        if !kind.starts_with("SPRING") {
            return Ok(());
        }
        let count = match kind.as_str() {
            TO_GROUND => 1,
            ALONG_AXIS | ALONG_LINE => 2,
            _ => {
                let message = format!(
                    "elements of type {} aren't supported; expected {TO_GROUND}, {ALONG_AXIS} or {ALONG_LINE}",
                    name::shown(&kind)
                );
                return Err(source.error(block.place, message));
            }
        };
        let mut ends = Vec::new();
        for data in &block.data {
            let number = source.tag(
                data.place,
                item(source, data, 0),
                "the number of an element",
            )?;
            let mut nodes = Vec::new();
            for end in 1..=count {
                nodes.extend(places.members(data.place, Of::Nodes, item(source, data, end))?);
            }
            ends.push((number, nodes));
        }
        self.elements.push(Elements {
            place: block.place,
            kind,
            set: block.parameter("ELSET").unwrap_or_default().to_uppercase(),
            ends,
        });
        Ok(())
    }

    /// `*SPRING`: a degree of freedom, followed by a stiffness.
    pub(super) fn property(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        if let Some(key) = parameters::refused(block) {
            let message =
                format!("*SPRING with {key} isn't read; expected one stiffness along x, y or z");
            return Err(source.error(block.place, message));
        }
        let set = source.required(block, "ELSET")?.to_uppercase();
        let of = self.elements.iter().find(|of| of.set == set);
        let kind = of.map_or(TO_GROUND, |of| &of.kind);
        // For springs along a line, the first line of data may be empty.
        let rows = block.data.len();
        if let (ALONG_LINE, Some(row)) = (kind, block.data.last().filter(|_| rows <= 2)) {
            let stiffness = self.stiffness(places, row)?;
            self.properties.push(Property {
                place: block.place,
                set,
                axes: None,
                stiffness,
            });
            return Ok(());
        }
        let [head, row] = &block.data[..] else {
            let message = format!(
                "*SPRING has {} lines behind it; expected two, a degree of freedom and its stiffness, the same at all \
                 temperatures",
                block.data.len()
            );
            return Err(source.error(block.place, message));
        };
        let mut axes = [0; 2];
        for (at, axis) in axes.iter_mut().enumerate() {
            let end = if kind == ALONG_AXIS { at } else { 0 };
            let freedom = source.tag(head.place, item(source, head, end), "a degree of freedom")?;
            *axis = freedom as usize - 1;
        }
        let stiffness = self.stiffness(places, row)?;
        self.properties.push(Property {
            place: block.place,
            set,
            axes: Some(axes),
            stiffness,
        });
        Ok(())
    }

    /// The stiffness at the beginning of a line.
    fn stiffness(&self, places: &Places, row: &Data) -> Result<f64, InputError> {
        let source = places.source;
        let stiffness = source.real(row.place, item(source, row, 0), "a stiffness")?;
        match stiffness >= 0.0 {
            true => Ok(stiffness),
            false => {
                let message = format!("*SPRING: the stiffness is {stiffness}; expected at least 0");
                Err(source.error(row.place, message))
            }
        }
    }

    /// The springs with the groups of their nodes, which may have none of the local `systems`, under names that aren't
    /// in `names`, and those of reference points or between different axes; per `thickness` of plane sections.
    ///
    /// # Errors
    /// Elements without a stiffness, a stiffness without elements, nodes without cells or with local axes.
    pub(super) fn in_scene(
        &self,
        translator: &mut Translator,
        thickness: f64,
        (systems, references): (&BTreeMap<u32, System>, &BTreeMap<u32, Reference>),
        names: &mut Names,
    ) -> Result<(Vec<SceneSpring>, Vec<SceneEquation>), InputError> {
        let groups = &mut *translator.groups;
        let lacks = |of: &&Elements| {
            !self
                .properties
                .iter()
                .any(|property| property.set == of.set)
        };
        if let Some(of) = self.elements.iter().find(lacks) {
            let message = format!(
                "the springs have no *SPRING, ELSET={}; expected it",
                name::shown(&of.set)
            );
            return Err(groups.error(of.place, &message));
        }
        let mut at_nodes: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
        let (mut between, mut others) = (Vec::new(), Vec::new());
        for property in &self.properties {
            let elements = self.elements.iter().filter(|of| of.set == property.set);
            let ends: Vec<&(i64, Vec<u32>)> = elements.flat_map(|of| &of.ends).collect();
            if ends.is_empty() {
                let message = format!(
                    "there are no springs '{}'; expected *ELEMENT, TYPE={TO_GROUND} with this ELSET",
                    name::shown(&property.set)
                );
                return Err(groups.error(property.place, &message));
            }
            for (number, nodes) in ends {
                let terms = property.terms(groups, nodes, (systems, references))?;
                let is_plain = property.axes.is_none_or(|[a, b]| a == b)
                    && !nodes.iter().any(|node| references.contains_key(node));
                match (&nodes[..], property.axes) {
                    ([node], Some([axis, _])) if is_plain => {
                        at_nodes.entry(*node).or_default()[axis] += property.stiffness / thickness;
                    }
                    _ if property.stiffness == 0.0 => {}
                    _ if is_plain => {
                        between.push(property.between(groups, (*number, nodes), thickness, names));
                    }
                    _ => others.push((*number, terms, property.stiffness / thickness)),
                }
            }
        }
        let mut all = to_ground(groups, at_nodes);
        all.extend(between);
        let other = |(number, terms, stiffness): (i64, Terms, f64)| {
            translator.spring(names.unique(&format!("spring {number}")), &terms, stiffness)
        };
        Ok((all, others.into_iter().map(other).collect()))
    }
}

/// Springs to the ground, grouped by their stiffness.
fn to_ground(groups: &mut Groups, at_nodes: BTreeMap<u32, [f64; 3]>) -> Vec<SceneSpring> {
    // The bits of nonnegative numbers have the order of the numbers.
    let mut alike: BTreeMap<[u64; 3], Vec<u32>> = BTreeMap::new();
    for (node, stiffness) in at_nodes {
        let bits = stiffness.map(|k| (k + 0.0).to_bits());
        alike.entry(bits).or_default().push(node);
    }
    let dim = groups.dim();
    let spring = |(bits, nodes): ([u64; 3], Vec<u32>)| {
        Some(SceneSpring {
            on: vec![groups.of_points(&nodes, "spring")?],
            name: String::new(),
            stiffness: bits.map(f64::from_bits),
            axial: None,
            dim,
        })
    };
    alike.into_iter().filter_map(spring).collect()
}

impl Property {
    /// The displacement along a spring, by components of its ends.
    ///
    /// # Errors
    /// A node without cells, with local axes, or without the degree of freedom; ends at one place.
    fn terms(
        &self,
        groups: &Groups,
        nodes: &[u32],
        (systems, references): (&BTreeMap<u32, System>, &BTreeMap<u32, Reference>),
    ) -> Result<Terms, InputError> {
        let dim = groups.dim();
        let along = match (self.axes, nodes) {
            (None, &[a, b]) => {
                let along = unit(difference(groups.position(a), groups.position(b)));
                let refused =
                    || "*SPRING: its nodes lie at one place; expected a spring along axes";
                along.ok_or_else(|| groups.error(self.place, refused()))?
            }
            _ => [0.0; 3],
        };
        let mut terms = Terms::new();
        for (end, &node) in nodes.iter().enumerate() {
            let sign = if end == 0 { 1.0 } else { -1.0 };
            let reference = references.get(&node);
            let refused = |why: &str| {
                let message = format!("*SPRING: the node {} {why}", groups.tag(node));
                groups.error(self.place, &message)
            };
            if reference.is_none() && !groups.is_of_body(node) {
                return Err(refused(
                    "is none of a body; expected nodes of solids, or reference nodes of couplings",
                ));
            }
            if self.axes.is_some() && systems.contains_key(&node) {
                return Err(refused("has *TRANSFORM; expected springs along x, y and z"));
            }
            let parts: Vec<(usize, f64)> = match self.axes {
                Some(axes) => vec![(axes[end], 1.0)],
                None => (along.into_iter().enumerate().take(dim))
                    .filter(|(_, part)| *part != 0.0)
                    .collect(),
            };
            for (freedom, part) in parts {
                let component = match reference {
                    Some(reference) => reference.of_equation(freedom, dim).map_err(refused)?,
                    None if freedom < dim => (node, freedom),
                    None => {
                        let why = format!(
                            "has no degree of freedom {}; expected 1 to {dim}, of reference nodes to 6",
                            freedom + 1
                        );
                        return Err(refused(&why));
                    }
                };
                *terms.entry(component).or_default() += sign * part;
            }
        }
        Ok(terms)
    }

    /// A spring between two nodes.
    fn between(
        &self,
        groups: &mut Groups,
        (number, nodes): (i64, &[u32]),
        thickness: f64,
        names: &mut Names,
    ) -> SceneSpring {
        let stiffness = self.stiffness / thickness;
        let along = |axis: usize| [0, 1, 2].map(|k| if k == axis { stiffness } else { 0.0 });
        SceneSpring {
            on: (nodes.iter())
                .filter_map(|&node| groups.of_points(&[node], "end of spring"))
                .collect(),
            name: names.unique(&format!("spring {number}")),
            stiffness: self.axes.map_or([0.0; 3], |[axis, _]| along(axis)),
            axial: self.axes.is_none().then_some(stiffness),
            dim: groups.dim(),
        }
    }
}

impl SceneSpring {
    /// Writes the springs.
    pub(super) fn write(&self, document: &mut Document) {
        document.table("[[spring]]");
        match &self.on[..] {
            [on] => document.key("on", quoted(on)),
            ends => {
                let ends: Vec<String> = ends.iter().map(|end| quoted(end)).collect();
                document.key("name", quoted(&self.name));
                document.key("between", format!("[{}]", ends.join(", ")));
            }
        }
        match self.axial {
            Some(stiffness) => document.key("axial", format!("{stiffness:?}")),
            None => document.key("stiffness", vector(&self.stiffness, self.dim)),
        }
    }
}
