//! A whole deck: parts, the instances of them, and what isn't mesh.

use std::collections::{BTreeMap, BTreeSet};

use super::blocks::{Block, Source};
use super::deck::{Deck, Face, Offsets};
use crate::element::geometry::{cross, difference, length};
use crate::error::InputError;

type Point = [f64; 3];

/// Keywords that make nodes and elements of others, or mean other coordinates than they say.
const REFUSED: [&str; 10] = [
    "NGEN",
    "NFILL",
    "NCOPY",
    "NMAP",
    "ELGEN",
    "ELCOPY",
    "SYSTEM",
    "IMPORT",
    "SUPERELEMENT",
    "SYMMETRIC MODEL GENERATION",
];

/// Keywords without a meaning for the problem: texts, output and ends.
const SILENT: [&str; 8] = [
    "HEADING", "PREPRINT", "RESTART", "OUTPUT", "PRINT", "FILE", "END ", "ASSEMBLY",
];

/// A deck on its way into one mesh.
#[derive(Default)]
pub(super) struct Assembly {
    whole: Deck,
    parts: BTreeMap<String, Deck>,
    /// The part whose lines are read, by its name in capitals.
    part: Option<(String, Deck)>,
    in_instance: bool,
    skipped: BTreeSet<String>,
}

impl Assembly {
    /// The whole deck, and what to warn of.
    pub(super) fn read(source: &Source) -> Result<(Deck, Vec<String>), InputError> {
        let mut assembly = Self::default();
        for block in &source.blocks {
            assembly.add(source, block)?;
        }
        if let Some((name, _)) = assembly.part {
            let message = format!("the deck ends within the part '{name}'; expected *END PART");
            return Err(InputError::new(message).in_file(source.path()));
        }
        let warnings = assembly.warnings();
        Ok((assembly.whole, warnings))
    }

    fn add(&mut self, source: &Source, block: &Block) -> Result<(), InputError> {
        let keyword = block.keyword.as_str();
        let refuse = |message: String| Err(source.error(block.place, message));
        if self.in_instance && ["NODE", "ELEMENT", "NSET", "ELSET", "SURFACE"].contains(&keyword) {
            return refuse(format!(
                "*{keyword} within an *INSTANCE isn't read; expected it in its *PART"
            ));
        }
        let deck = self.part.as_mut().map_or(&mut self.whole, |(_, deck)| deck);
        match keyword {
            "NODE" => deck.add_nodes(source, block),
            "ELEMENT" => deck.add_elements(source, block),
            "NSET" | "ELSET" => deck.add_set(source, block),
            "SURFACE" => deck.add_surface(source, block),
            "PART" => {
                let name = source.required(block, "NAME")?.to_uppercase();
                if self.part.is_some() {
                    return refuse("a *PART within another; expected *END PART before it".into());
                }
                self.part = Some((name, Deck::default()));
                Ok(())
            }
            "END PART" => {
                self.parts.extend(self.part.take());
                Ok(())
            }
            "INSTANCE" => {
                self.in_instance = true;
                self.add_instance(source, block)
            }
            "END INSTANCE" => {
                self.in_instance = false;
                Ok(())
            }
            _ if REFUSED.contains(&keyword) => refuse(format!(
                "*{keyword} isn't read; expected a deck that lists all nodes and elements, in Cartesian coordinates"
            )),
            _ => {
                if !SILENT.iter().any(|silent| keyword.contains(silent)) {
                    self.skipped.insert(format!("*{keyword}"));
                }
                Ok(())
            }
        }
    }

    /// `*INSTANCE`: a part with a shift and a rotation about the axis through two points, in degrees.
    fn add_instance(&mut self, source: &Source, block: &Block) -> Result<(), InputError> {
        let part_name = source.required(block, "PART")?;
        let name = source.required(block, "NAME")?;
        let Some(part) = self.parts.get(&part_name.to_uppercase()) else {
            let message = format!("there is no part '{part_name}' before this line");
            return Err(source.error(block.place, message));
        };
        if self.whole.instances.contains_key(&name.to_uppercase()) {
            let message = format!("there are two instances '{name}'; expected names that differ");
            return Err(source.error(block.place, message));
        }
        let mut rows = Vec::new();
        for data in &block.data {
            let items = source.items(data);
            let row = items
                .map(|item| source.real(data.place, item, "a number of a shift or a rotation"));
            rows.push((data.place, row.collect::<Result<Vec<_>, _>>()?));
        }
        let mut shift = [0.0; 3];
        if let Some((_, row)) = rows.first() {
            for (to, from) in shift.iter_mut().zip(row) {
                *to = *from;
            }
        }
        let turn = match rows.get(1) {
            None => None,
            Some((place, row)) => match row[..] {
                [a, b, c, d, e, f, angle] if [a, b, c] != [d, e, f] => {
                    Some(([a, b, c], [d, e, f], angle.to_radians()))
                }
                _ => {
                    let message =
                        "expected two points on the axis of the rotation and its angle, 7 numbers";
                    return Err(source.error(*place, message));
                }
            },
        };
        let place = |point: Point| {
            let shifted = [0, 1, 2].map(|k| point[k] + shift[k]);
            turn.map_or(shifted, |(a, b, angle)| turned(shifted, a, b, angle))
        };
        self.whole.place(part, name, place);
        Ok(())
    }

    fn warnings(&self) -> Vec<String> {
        let list = |words: &BTreeSet<String>| words.iter().cloned().collect::<Vec<_>>().join(", ");
        let decks = self.parts.values().chain([&self.whole]);
        let taken_as: BTreeSet<String> = decks
            .flat_map(|deck| deck.taken_as.iter().cloned())
            .collect();
        let mut warnings = Vec::new();
        if !taken_as.is_empty() {
            warnings.push(format!(
                "of the deck's elements are read {}",
                list(&taken_as)
            ));
        }
        if !self.skipped.is_empty() {
            warnings.push(format!(
                "of the deck the mesh alone is read; left out are {}",
                list(&self.skipped)
            ));
        }
        for (instance, offsets) in &self.whole.instances {
            if offsets.nodes != 0 && !instance.is_empty() {
                warnings.push(format!(
                    "the nodes of the instance '{instance}' are numbered as in its part + {}, its elements + {}",
                    offsets.nodes, offsets.elements
                ));
            }
        }
        warnings
    }
}

impl Deck {
    /// Adds a part as an instance; tags that are taken already are moved behind the highest.
    fn place(&mut self, part: &Self, instance: &str, place: impl Fn(Point) -> Point) {
        let offset = |taken: &[i64], new: &[i64]| match (taken.iter().max(), new.iter().min()) {
            (Some(&highest), Some(_)) => highest,
            _ => 0,
        };
        let offsets = Offsets {
            nodes: offset(&self.node_tags, &part.node_tags),
            elements: offset(&self.element_tags, &part.element_tags),
        };
        self.instances.insert(instance.to_uppercase(), offsets);
        let (first_node, first_element) = (self.points.len() as u32, self.elements.len() as u32);
        for (&tag, &point) in part.node_tags.iter().zip(&part.points) {
            self.node_of
                .insert(tag + offsets.nodes, self.points.len() as u32);
            self.node_tags.push(tag + offsets.nodes);
            self.points.push(place(point));
        }
        for (element, (kind, nodes)) in part.elements.iter().enumerate() {
            let tag = part.element_tags[element] + offsets.elements;
            self.element_of.insert(tag, self.elements.len() as u32);
            let nodes: Vec<u32> = nodes.iter().map(|&node| node + first_node).collect();
            self.elements.push(kind, &nodes);
            self.element_tags.push(tag);
            self.is_side.push(part.is_side[element]);
        }
        let name = |set: &str| format!("{instance}.{set}");
        for set in part.node_sets.iter() {
            let members = set.members.iter().map(|&node| node + first_node);
            self.node_sets
                .extend(&name(&set.name), set.internal, members);
        }
        for set in part.element_sets.iter() {
            let members = set.members.iter().map(|&element| element + first_element);
            self.element_sets
                .extend(&name(&set.name), set.internal, members);
        }
        for surface in part.surfaces.iter() {
            let members = surface.members.iter().map(|&face| match face {
                Face::Of(element, number) => Face::Of(element + first_element, number),
                Face::Free(element) => Face::Free(element + first_element),
            });
            self.surfaces
                .extend(&name(&surface.name), surface.internal, members);
        }
        let all = first_element..self.elements.len() as u32;
        self.element_sets.extend(instance, false, all);
    }
}

/// A point turned about the axis from `a` to `b` (Rodrigues).
fn turned(point: Point, a: Point, b: Point, angle: f64) -> Point {
    let axis = difference(b, a).map(|component| component / length(difference(b, a)));
    let arm = difference(point, a);
    let across = cross(axis, arm);
    let along: f64 = (0..3).map(|k| axis[k] * arm[k]).sum();
    let (sin, cos) = angle.sin_cos();
    [0, 1, 2].map(|k| a[k] + arm[k] * cos + across[k] * sin + axis[k] * along * (1.0 - cos))
}
