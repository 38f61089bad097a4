//! The blocks of a part, of an instance, or of what belongs to neither, which may stand in any order.

use std::collections::HashMap;

use super::blocks::{Block, Source};
use super::deck::Deck;
use crate::error::InputError;

/// Keywords of the mesh.
const KEYWORDS: [&str; 5] = ["NODE", "ELEMENT", "ELSET", "NSET", "SURFACE"];

/// The blocks of the mesh in a part, in an instance or in neither.
#[derive(Default)]
pub(super) struct Scope<'a> {
    blocks: Vec<&'a Block>,
}

impl<'a> Scope<'a> {
    /// Takes a block of the mesh; whether it is one.
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

    /// Adds all of it to a deck: nodes before the elements that have them, and these before sets and surfaces.
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

/// Adds sets or surfaces, those that name others after these.
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
            // Where only the block itself makes it, nothing does.
            let others = |name: &str| {
                let name = name.to_uppercase();
                let count = to_come.get(&name).copied().unwrap_or_default();
                count > usize::from(name == own)
            };
            match deck.lacks(source, block) {
                Some(name) if others(name) => later.push(block),
                _ => add(source, deck, block)?,
            }
        }
        if later.len() == waiting.len() {
            // Each waits for another: the first has to say so.
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

/// The name of what a block makes, in capitals.
fn made_by(block: &Block) -> String {
    let name = match block.keyword.as_str() {
        "SURFACE" => block.parameter("NAME"),
        keyword => block.parameter(keyword),
    };
    name.unwrap_or_default().to_uppercase()
}
