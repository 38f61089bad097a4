//! The blocks of a part, of an instance, or of the rest of a deck, in any order.

use std::collections::HashMap;

use super::blocks::{Block, Source};
use super::deck::Deck;
use crate::error::InputError;

/// Keywords of the mesh.
const KEYWORDS: [&str; 5] = ["NODE", "ELEMENT", "ELSET", "NSET", "SURFACE"];

/// The mesh's blocks in a part, in an instance or outside of both.
#[derive(Default)]
pub(super) struct Scope<'a> {
    blocks: Vec<&'a Block>,
}

impl<'a> Scope<'a> {
    /// Adds a block if it belongs to the mesh; returns whether it does.
    pub(super) fn take(&mut self, block: &'a Block) -> bool {
        let is_mesh = KEYWORDS.contains(&block.keyword.as_str());
        if is_mesh {
            self.blocks.push(block);
        }
        is_mesh
    }

    /// True if there is no block.
    pub(super) fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Adds all blocks to a deck: nodes before elements, and these before sets and surfaces.
    pub(super) fn read(&self, source: &Source, deck: &mut Deck) -> Result<(), InputError> {
        for keyword in KEYWORDS {
            let blocks = self.blocks.iter().filter(|block| block.keyword == keyword);
            let blocks: Vec<&Block> = blocks.copied().collect();
            match keyword {
                "NODE" => (blocks.iter()).try_for_each(|block| deck.add_nodes(source, block))?,
                "ELEMENT" => {
                    (blocks.iter()).try_for_each(|block| deck.add_elements(source, block))?
                }
                _ => in_turn(source, deck, blocks)?,
            }
        }
        Ok(())
    }
}

/// Adds sets or surfaces in the order of their references.
fn in_turn(source: &Source, deck: &mut Deck, blocks: Vec<&Block>) -> Result<(), InputError> {
    let mut waiting = blocks;
    while !waiting.is_empty() {
        let mut to_come: HashMap<String, usize> = HashMap::new();
        for block in &waiting {
            *to_come.entry(made_by(block)).or_default() += 1;
        }
        let mut later = Vec::new();
        for &block in &waiting {
            let own = made_by(block);
            // A name that only the block itself defines counts as missing.
            let others = |name: &str| {
                let name = name.to_uppercase();
                let count = to_come.get(&name).copied().unwrap_or_default();
                count > usize::from(name == own)
            };
            match deck.undefined_name(source, block) {
                Some(name) if others(name) => later.push(block),
                _ => add(source, deck, block)?,
            }
        }
        if later.len() == waiting.len() {
            // References are cyclic: adding the first block reports the error.
            add(source, deck, later[0])?;
            later.remove(0);
        }
        waiting = later;
    }
    Ok(())
}

fn add(source: &Source, deck: &mut Deck, block: &Block) -> Result<(), InputError> {
    match block.keyword.as_str() {
        "SURFACE" => deck.add_surface(source, block),
        _ => deck.add_set(source, block),
    }
}

/// The name that a block defines, in capitals.
fn made_by(block: &Block) -> String {
    let name = match block.keyword.as_str() {
        "SURFACE" => block.parameter("NAME"),
        keyword => block.parameter(keyword),
    };
    name.unwrap_or_default().to_uppercase()
}
