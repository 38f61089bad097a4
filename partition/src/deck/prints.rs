//! `*NODE PRINT` and `*EL PRINT`: the tables requested by a deck, with their sets, for the program that writes them
//! from a result.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Of, Source};
use crate::name;

/// The quantities available for nodes and for elements.
const OF_NODES: [&str; 2] = ["U", "RF"];
const OF_ELEMENTS: [&str; 3] = ["S", "E", "EVOL"];

/// The tables of a deck.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Prints {
    /// Thickness of plane sections, by which loads are divided; 1 in space and around an axis.
    pub thickness: f64,
    /// The names of equations of the scene that are supports, whose forces are reactions.
    pub supports: BTreeSet<String>,
    /// The tables at the end of each step.
    pub steps: Vec<Vec<Table>>,
    /// Numbers of the nodes of sets, by name.
    pub nodes: BTreeMap<String, Vec<i64>>,
    /// Numbers of the elements of sets, by name.
    pub elements: BTreeMap<String, Vec<i64>>,
    /// The elements of these sets with their nodes.
    pub cells: BTreeMap<i64, Cell>,
    /// Numbers of the reference nodes of couplings, in the order of the couplings in the scene.
    pub references: Vec<i64>,
    /// The pretensions by the numbers of their nodes: the name in the scene, and 1 or −1 times which the force and the
    /// shortening are those of the node.
    pub bolts: BTreeMap<i64, (String, f64)>,
}

/// A table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Table {
    /// Label of the quantity: U, RF, S, E or EVOL.
    pub label: String,
    /// Name of the set.
    pub set: String,
    /// Totals: written in addition ("YES"), exclusively ("ONLY"), or not ("NO").
    pub totals: String,
}

/// An element in a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cell {
    /// Numbers of its nodes.
    pub nodes: Vec<i64>,
    /// True for a type with reduced integration, which has fewer integration points.
    pub is_reduced: bool,
}

/// A request for tables.
struct Request {
    /// Number of the step, from 0.
    step: usize,
    of_nodes: bool,
    tables: Vec<Table>,
}

/// The requests of a deck.
#[derive(Default)]
pub(super) struct Requests {
    all: Vec<Request>,
    nodes: BTreeMap<String, Vec<u32>>,
    elements: BTreeMap<String, Vec<u32>>,
    /// True if nodal tables, or element tables, are requested in local axes.
    has_local: [bool; 2],
    /// Descriptions of unavailable quantities.
    pub(super) left_out: BTreeSet<String>,
}

impl Requests {
    /// Reads a request in a step, by its number from 0; `None` outside of steps.
    ///
    /// # Errors
    /// A request outside of steps, a missing set, an invalid value of totals.
    pub(super) fn read(
        &mut self,
        places: &mut Places,
        block: &Block,
        step: Option<usize>,
        references: &[u32],
    ) -> Result<(), InputError> {
        let source = places.source;
        let of_nodes = block.keyword == "NODE PRINT";
        let (key, known) = match of_nodes {
            true => ("NSET", &OF_NODES[..]),
            false => ("ELSET", &OF_ELEMENTS[..]),
        };
        let Some(step) = step else {
            let message = format!(
                "*{} stands in no step; expected it behind *STEP",
                block.keyword
            );
            return Err(source.error(block.place, message));
        };
        let totals = block.parameter("TOTALS").unwrap_or("NO").to_uppercase();
        if !["NO", "YES", "ONLY"].contains(&totals.as_str()) {
            let message = format!(
                "*{} has TOTALS={totals}; expected YES, ONLY or NO",
                block.keyword
            );
            return Err(source.error(block.place, message));
        }
        let mut tables = Vec::new();
        let is_never = (block.parameter("FREQUENCY")).is_some_and(|value| value.trim() == "0");
        let set = block.parameter(key).filter(|set| !set.is_empty());
        match set.map(str::to_uppercase) {
            _ if is_never => {}
            None => {
                _ = self
                    .left_out
                    .insert(format!("*{} without {key}", block.keyword))
            }
            Some(set) => {
                self.take_set(places, block, &set, references)?;
                let labels = self.labels(source, block, known);
                tables.extend(labels.into_iter().map(|label| Table {
                    label,
                    set: set.clone(),
                    totals: totals.clone(),
                }));
            }
        }
        self.all.push(Request {
            step,
            of_nodes,
            tables,
        });
        Ok(())
    }

    /// Records the members of a request's set; for nodes only those of cells, and reference nodes.
    fn take_set(
        &mut self,
        places: &mut Places,
        block: &Block,
        set: &str,
        references: &[u32],
    ) -> Result<(), InputError> {
        let of_nodes = block.keyword == "NODE PRINT";
        let of = if of_nodes { Of::Nodes } else { Of::Elements };
        let mut members = places.members(block.place, of, set)?;
        let is_global = block.parameter("GLOBAL").unwrap_or("NO");
        self.has_local[usize::from(!of_nodes)] |= !is_global.eq_ignore_ascii_case("YES");
        if !of_nodes {
            let dim = places.dim();
            members.retain(|&member| places.is_cell(member, dim));
            if members.is_empty() {
                let what = format!("*EL PRINT of {}", name::shown(set));
                self.left_out.insert(what);
            }
            self.elements.insert(set.to_owned(), members);
            return Ok(());
        }
        let has_cell = places.with_cells();
        let moves = |node: &u32| has_cell[*node as usize] || references.contains(node);
        if let Some(&node) = members.iter().find(|node| !moves(node)) {
            let tag = places.deck.node_tags[node as usize];
            let note = format!("*NODE PRINT of nodes of no solid, such as {tag}");
            self.left_out.insert(note);
            members.retain(moves);
        }
        self.nodes.insert(set.to_owned(), members);
        Ok(())
    }

    /// The labels of a block that are among those `known`.
    fn labels(&mut self, source: &Source, block: &Block, known: &[&str]) -> Vec<String> {
        let mut labels = Vec::new();
        for label in block.data.iter().flat_map(|data| source.items(data)) {
            let label = label.to_uppercase();
            match known.contains(&label.as_str()) {
                true => labels.push(label),
                false if label.is_empty() => {}
                false => {
                    let what = format!("{} of *{}", name::shown(&label), block.keyword);
                    self.left_out.insert(what);
                }
            }
        }
        labels
    }

    /// Notes that tables in local axes of nodes or of materials aren't available, if any are requested.
    pub(super) fn note_axes(&mut self, of_nodes: bool, of_materials: bool) {
        let keywords = ["*NODE PRINT", "*EL PRINT"].into_iter().zip(self.has_local);
        for ((keyword, asks), has_axes) in keywords.zip([of_nodes, of_materials]) {
            if asks && has_axes {
                self.left_out.insert(format!("local axes of {keyword}"));
            }
        }
    }

    /// The tables at the end of every step, with what is known `of_scene`: nodal and element requests each stay valid
    /// until a step replaces them.
    pub(super) fn tables(
        &mut self,
        places: &Places,
        steps: usize,
        references: &[u32],
        of_scene: Prints,
    ) -> Prints {
        let mut current = [Vec::new(), Vec::new()];
        let of_step = |step: usize| {
            for (of_nodes, tables) in [true, false].into_iter().zip(&mut current) {
                let own = |request: &&Request| request.step == step && request.of_nodes == of_nodes;
                let mut own = self.all.iter().filter(own).peekable();
                if own.peek().is_some() {
                    *tables = own.flat_map(|request| request.tables.clone()).collect();
                }
            }
            current.concat()
        };
        let steps = (0..steps).map(of_step).collect();
        let elements = std::mem::take(&mut self.elements);
        let mut cells = BTreeMap::new();
        let deck = &places.deck;
        let of_elements = |(set, members): (String, Vec<u32>)| {
            let tags = members.into_iter().map(|member| {
                let tag = deck.element_tags[member as usize];
                cells.entry(tag).or_insert_with(|| Cell {
                    nodes: (deck.elements.nodes_of(member as usize).iter())
                        .map(|&node| deck.node_tags[node as usize])
                        .collect(),
                    is_reduced: deck.is_reduced[member as usize],
                });
                tag
            });
            (set, tags.collect())
        };
        let elements = elements.into_iter().map(of_elements).collect();
        let tag = |node: u32| deck.node_tags[node as usize];
        let nodes = std::mem::take(&mut self.nodes).into_iter();
        Prints {
            steps,
            nodes: nodes
                .map(|(set, members)| (set, members.into_iter().map(tag).collect()))
                .collect(),
            elements,
            cells,
            references: references.iter().map(|&node| tag(node)).collect(),
            ..of_scene
        }
    }
}
