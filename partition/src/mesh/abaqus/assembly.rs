//! A whole deck: parts, their instances, and other content.

use std::collections::{BTreeMap, BTreeSet};

use super::blocks::{Block, LinePlace, Source};
use super::deck::{Deck, Face, Offsets, check_name};
use super::notes::Notes;
use super::position::{Point, Position};
use super::scope::Scope;
use crate::error::InputError;
use crate::name;

/// Keywords that generate nodes and elements from others, or change the meaning of coordinates.
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

/// Keywords without effect on the problem: texts, output and ends.
const WITHOUT_EFFECT: [&str; 8] = [
    "HEADING", "PREPRINT", "RESTART", "OUTPUT", "PRINT", "FILE", "END ", "ASSEMBLY",
];

/// The largest tag of an instance, so that the sum of two tags doesn't overflow.
const LARGEST_TAG: i64 = 1 << 60;

/// Largest number of instances whose numbers are listed individually.
const MOST_LISTED: usize = 20;

/// A deck whose parts are instantiated.
pub(crate) struct Whole {
    pub(crate) deck: Deck,
    /// Warnings.
    pub(crate) warnings: Vec<String>,
    /// Keywords that don't concern the mesh.
    pub(crate) left_out: Vec<String>,
}

impl Whole {
    /// Reads the mesh of a deck.
    ///
    /// # Errors
    /// The error in the deck, with file and line.
    pub(crate) fn read(source: &Source) -> Result<Self, InputError> {
        Assembly::read(source)
    }
}

/// A deck being assembled into one mesh.
#[derive(Default)]
struct Assembly<'a> {
    whole: Deck,
    /// Nodes and elements that belong to no part and no instance.
    own: Scope<'a>,
    parts: BTreeMap<String, Deck>,
    /// The part or instance being read.
    open: Option<Open<'a>>,
    skipped: BTreeSet<String>,
}

/// A part or an instance being read.
struct Open<'a> {
    kind: Kind,
    /// The name of the part or of the instance, in capitals.
    name: String,
    place: LinePlace,
    scope: Scope<'a>,
}

enum Kind {
    Part,
    /// Position of an instance, and the name of its part in capitals.
    Instance(Position, String),
}

impl Open<'_> {
    fn word(&self) -> &'static str {
        match self.kind {
            Kind::Part => "PART",
            Kind::Instance(..) => "INSTANCE",
        }
    }
}

impl<'a> Assembly<'a> {
    fn read(source: &'a Source) -> Result<Whole, InputError> {
        let mut assembly = Self::default();
        for block in &source.blocks {
            assembly.add(source, block)?;
        }
        if let Some(open) = assembly.open {
            let (word, name) = (open.word(), name::shown(&open.name));
            let message = format!(
                "the deck ends within the {} '{name}'; expected *END {word}",
                word.to_lowercase()
            );
            return Err(source.error(open.place, message));
        }
        assembly.own.read(source, &mut assembly.whole)?;
        let warnings = assembly.warnings(source);
        Ok(Whole {
            deck: assembly.whole,
            warnings,
            left_out: assembly.skipped.into_iter().collect(),
        })
    }

    fn add(&mut self, source: &'a Source, block: &'a Block) -> Result<(), InputError> {
        let keyword = block.keyword.as_str();
        let refuse = |message: String| Err(source.error(block.place, message));
        let scope = match &mut self.open {
            Some(open) => &mut open.scope,
            None => &mut self.own,
        };
        if scope.take(block) {
            return Ok(());
        }
        match keyword {
            "PART" | "INSTANCE" => {
                if let Some(open) = &self.open {
                    let word = open.word();
                    return refuse(format!(
                        "*{keyword} within the {} '{}'; expected *END {word} before it",
                        word.to_lowercase(),
                        name::shown(&open.name)
                    ));
                }
                let name = source.required(block, "NAME")?;
                check_name(source, block.place, name)?;
                let (kind, name) = match keyword {
                    "PART" => (Kind::Part, name.to_uppercase()),
                    _ => {
                        let part = self.part(source, block, name)?;
                        (
                            Kind::Instance(Position::read(source, block)?, part),
                            name.to_owned(),
                        )
                    }
                };
                self.open = Some(Open {
                    kind,
                    name,
                    place: block.place,
                    scope: Scope::default(),
                });
                Ok(())
            }
            "END PART" | "END INSTANCE" => self.close(source),
            _ if REFUSED.contains(&keyword) => refuse(format!(
                "*{keyword} isn't read; expected a deck that lists all nodes and elements, in Cartesian coordinates"
            )),
            _ => {
                if !WITHOUT_EFFECT.iter().any(|silent| keyword.contains(silent)) {
                    self.skipped.insert(format!("*{}", name::shown(keyword)));
                }
                Ok(())
            }
        }
    }

    /// The name of an `*INSTANCE`'s part.
    fn part(&self, source: &Source, block: &Block, name: &str) -> Result<String, InputError> {
        let part_name = source.required(block, "PART")?;
        let part = part_name.to_uppercase();
        if !self.parts.contains_key(&part) {
            let message = format!(
                "there is no part '{}' before this line",
                name::shown(part_name)
            );
            return Err(source.error(block.place, message));
        }
        if self.whole.instances.contains_key(&name.to_uppercase()) {
            let message = format!(
                "there are two instances '{}'; expected names that differ",
                name::shown(name)
            );
            return Err(source.error(block.place, message));
        }
        Ok(part)
    }

    /// Ends a part or an instance; an instance's own content, possibly its whole mesh, is added to its part.
    fn close(&mut self, source: &Source) -> Result<(), InputError> {
        let Some(open) = self.open.take() else {
            return Ok(());
        };
        match open.kind {
            Kind::Part => {
                let mut part = Deck::default();
                open.scope.read(source, &mut part)?;
                self.parts.insert(open.name, part);
            }
            Kind::Instance(position, part) => {
                let Some(part) = self.parts.get(&part) else {
                    return Ok(());
                };
                let mut own = None;
                if !open.scope.is_empty() {
                    // Notes of the part are reported with the part.
                    let own = own.insert(part.clone());
                    own.notes = Notes::default();
                    open.scope.read(source, own)?;
                    self.whole.notes.join(&own.notes);
                    self.whole.taken_as.extend(own.taken_as.iter().cloned());
                }
                let part = own.as_ref().unwrap_or(part);
                let placed = self.whole.place(part, &open.name, |at| position.of(at));
                placed.map_err(|message| source.error(open.place, message))?;
            }
        }
        Ok(())
    }

    fn warnings(&self, source: &Source) -> Vec<String> {
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
        let mut notes = source.notes.clone();
        let decks = self.parts.values().chain([&self.whole]);
        decks.for_each(|deck| notes.join(&deck.notes));
        warnings.extend(notes.warnings());
        let moved = self.whole.instances.iter();
        let mut moved = moved.filter(|(name, offsets)| offsets.nodes != 0 && !name.is_empty());
        let shifted = moved.by_ref().take(MOST_LISTED).map(|(instance, offsets)| {
            format!(
                "the nodes of the instance '{instance}' are numbered as in its part + {}, its elements + {}",
                offsets.nodes, offsets.elements
            )
        });
        warnings.extend(shifted);
        let more = moved.count();
        if more > 0 {
            warnings.push(format!(
                "{more} more instances are numbered on in the same way"
            ));
        }
        warnings
    }
}

impl Deck {
    /// Adds a part as an instance; tags that exist already are shifted beyond the highest tag.
    ///
    /// # Errors
    /// Tags or counts that are too large, in words.
    fn place(
        &mut self,
        part: &Self,
        instance: &str,
        place: impl Fn(Point) -> Point,
    ) -> Result<(), String> {
        let offset = |highest: i64, new: &[i64]| if new.is_empty() { 0 } else { highest };
        let offsets = Offsets {
            nodes: offset(self.highest.nodes, &part.node_tags),
            elements: offset(self.highest.elements, &part.element_tags),
        };
        let highest =
            (offsets.nodes + part.highest.nodes).max(offsets.elements + part.highest.elements);
        let count =
            (self.points.len() + part.points.len()).max(self.elements.len() + part.elements.len());
        if highest > LARGEST_TAG || count > u32::MAX as usize {
            return Err(format!(
                "the nodes or elements of the instance '{}' would be numbered up to {highest}, {count} of them; \
                 expected smaller numbers in its part, or fewer instances",
                name::shown(instance)
            ));
        }
        self.instances.insert(instance.to_uppercase(), offsets);
        let (first_node, first_element) = (self.points.len() as u32, self.elements.len() as u32);
        for (&tag, &point) in part.node_tags.iter().zip(&part.points) {
            self.push_node(tag + offsets.nodes, place(point));
        }
        for (element, (kind, nodes)) in part.elements.iter().enumerate() {
            let nodes: Vec<u32> = nodes.iter().map(|&node| node + first_node).collect();
            self.elements.push(kind, &nodes);
            let tag = part.element_tags[element] + offsets.elements;
            let formulation = (part.has_modes[element], part.is_reduced[element]);
            self.push_tag(tag, part.is_side[element], formulation);
        }
        self.place_sets(part, instance, (first_node, first_element));
        let all = first_element..self.elements.len() as u32;
        self.element_sets.extend(instance, false, all);
        Ok(())
    }

    /// Adds the sets and surfaces of a part as those of an instance, given its first node and element.
    fn place_sets(&mut self, part: &Self, instance: &str, (first_node, first_element): (u32, u32)) {
        let name = |set: &str| format!("{instance}.{set}");
        for set in part.node_sets.iter() {
            let members = set.members.list().iter().map(|&node| node + first_node);
            self.node_sets
                .extend(&name(&set.name), set.internal, members);
        }
        for set in part.element_sets.iter() {
            let members = set
                .members
                .list()
                .iter()
                .map(|&element| element + first_element);
            self.element_sets
                .extend(&name(&set.name), set.internal, members);
        }
        for set in part.node_surfaces.iter() {
            let members = set.members.list().iter().map(|&node| node + first_node);
            self.node_surfaces
                .extend(&name(&set.name), set.internal, members);
        }
        for surface in part.surfaces.iter() {
            let members = surface.members.list().iter().map(|&face| match face {
                Face::Of(element, number) => Face::Of(element + first_element, number),
                Face::Free(element) => Face::Free(element + first_element),
            });
            self.surfaces
                .extend(&name(&surface.name), surface.internal, members);
        }
    }
}
