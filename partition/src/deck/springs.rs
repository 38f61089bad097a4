//! `*SPRING` of elements of type SPRING1: springs between nodes and the ground.

use std::collections::BTreeMap;

use super::axes::System;
use super::document::{Document, quoted, vector};
use super::groups::Groups;
use super::loads::item;
use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace, Of};
use crate::name;

/// The type of elements that are springs to the ground.
const TO_GROUND: &str = "SPRING1";

/// Parameters of `*SPRING` that are something else than a stiffness along an axis.
const REFUSED: [&str; 3] = ["NONLINEAR", "ORIENTATION", "COMPLEX STIFFNESS"];

/// Elements of one block that are springs.
struct Elements {
    place: LinePlace,
    /// In capitals.
    kind: String,
    /// Their set, by name in capitals.
    set: String,
    nodes: Vec<u32>,
}

/// What a set of elements exerts.
struct Property {
    place: LinePlace,
    /// By name in capitals.
    set: String,
    axis: usize,
    stiffness: f64,
}

/// All springs of a deck.
#[derive(Default)]
pub(super) struct Springs {
    elements: Vec<Elements>,
    properties: Vec<Property>,
}

/// Springs in the words of the scene: the group of their nodes, and their stiffness along the axes.
pub(super) struct SceneSpring {
    on: String,
    stiffness: [f64; 3],
    dim: usize,
}

impl Springs {
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
        let mut nodes = Vec::new();
        for data in block.data.iter().filter(|_| kind == TO_GROUND) {
            nodes.extend(places.members(data.place, Of::Nodes, item(source, data, 1))?);
        }
        self.elements.push(Elements {
            place: block.place,
            kind,
            set: block.parameter("ELSET").unwrap_or_default().to_uppercase(),
            nodes,
        });
        Ok(())
    }

    /// `*SPRING`: a degree of freedom, and behind it a stiffness.
    pub(super) fn property(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        if let Some(key) = REFUSED.iter().find(|key| block.parameter(key).is_some()) {
            let message =
                format!("*SPRING with {key} isn't read; expected one stiffness along x, y or z");
            return Err(source.error(block.place, message));
        }
        let set = source.required(block, "ELSET")?.to_uppercase();
        let mut between = self.elements.iter().filter(|of| of.set == set);
        if let Some(of) = between.find(|of| of.kind != TO_GROUND) {
            let message = format!(
                "*SPRING of elements of type {} isn't supported: they are between two nodes; instead give {TO_GROUND} at a node \
                 whose other one stands still, along x, y or z",
                name::shown(&of.kind)
            );
            return Err(source.error(block.place, message));
        }
        let [head, row] = &block.data[..] else {
            let message = format!(
                "*SPRING has {} lines behind it; expected two, a degree of freedom and its stiffness, the same at all \
                 temperatures",
                block.data.len()
            );
            return Err(source.error(block.place, message));
        };
        let freedom = source.tag(head.place, item(source, head, 0), "a degree of freedom")?;
        let dim = places.dim();
        if freedom > dim as i64 {
            let message =
                format!("*SPRING along the degree of freedom {freedom}; expected 1 to {dim}");
            return Err(source.error(head.place, message));
        }
        let stiffness = source.real(row.place, item(source, row, 0), "a stiffness")?;
        if stiffness < 0.0 {
            let message = format!("*SPRING: the stiffness is {stiffness}; expected at least 0");
            return Err(source.error(row.place, message));
        }
        self.properties.push(Property {
            place: block.place,
            set,
            axis: freedom as usize - 1,
            stiffness,
        });
        Ok(())
    }

    /// The springs with the groups of their nodes, which none of `systems` turns; per `thickness` of plane sections.
    ///
    /// # Errors
    /// Elements without a stiffness, a stiffness without elements, nodes of no body or with axes of their own.
    pub(super) fn in_scene(
        &self,
        groups: &mut Groups,
        thickness: f64,
        systems: &BTreeMap<u32, System>,
    ) -> Result<Vec<SceneSpring>, InputError> {
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
        for property in &self.properties {
            let elements = self.elements.iter().filter(|of| of.set == property.set);
            let nodes: Vec<u32> = elements.flat_map(|of| &of.nodes).copied().collect();
            if nodes.is_empty() {
                let message = format!(
                    "there are no springs '{}'; expected *ELEMENT, TYPE={TO_GROUND} with this ELSET",
                    name::shown(&property.set)
                );
                return Err(groups.error(property.place, &message));
            }
            for node in nodes {
                let why = match (groups.is_of_body(node), systems.contains_key(&node)) {
                    (true, false) => None,
                    (true, true) => Some("has *TRANSFORM; expected springs along x, y and z"),
                    (false, _) => Some("is none of a body; expected nodes of solids"),
                };
                if let Some(why) = why {
                    let message = format!("*SPRING: the node {} {why}", groups.tag(node));
                    return Err(groups.error(property.place, &message));
                }
                at_nodes.entry(node).or_default()[property.axis] += property.stiffness / thickness;
            }
        }
        // Bits of numbers that aren't negative are in the order of these.
        let mut alike: BTreeMap<[u64; 3], Vec<u32>> = BTreeMap::new();
        for (node, stiffness) in at_nodes {
            let bits = stiffness.map(|k| (k + 0.0).to_bits());
            alike.entry(bits).or_default().push(node);
        }
        let dim = groups.dim();
        let spring = |(bits, nodes): ([u64; 3], Vec<u32>)| {
            Some(SceneSpring {
                on: groups.of_points(&nodes, "spring")?,
                stiffness: bits.map(f64::from_bits),
                dim,
            })
        };
        Ok(alike.into_iter().filter_map(spring).collect())
    }
}

impl SceneSpring {
    /// Writes the springs.
    pub(super) fn write(&self, document: &mut Document) {
        document.table("[[spring]]");
        document.key("on", quoted(&self.on));
        document.key("stiffness", vector(&self.stiffness, self.dim));
    }
}
