//! Input decks of Abaqus and CalculiX, `.inp`: their mesh.
//!
//! The elements of the highest dimension are the cells. A set of elements is a group of cells; a surface is a group of
//! facets, and so are elements of one dimension less. A set of nodes is the group of those facets of the boundary all
//! of whose nodes are in it; where these leave out one of its nodes, it is a group of points. Names are
//! case-insensitive, and keep the spelling of their first occurrence. The sets of an instance are called
//! `instance.set`, or just `set` if no other set has that name. Content other than the mesh is left out, with a
//! warning; unsupported content that would change the mesh is refused.

mod assembly;
mod blocks;
mod deck;
mod element_type;
mod import;
mod members;
mod notes;
mod position;
mod scope;
mod sets;

use std::path::{Path, PathBuf};

use super::Mesh;
use crate::error::InputError;

pub(crate) use self::assembly::Whole;
pub(crate) use self::blocks::{Block, Data, LinePlace, Source};
pub(crate) use self::deck::{Deck, Face};
pub(crate) use self::import::mesh;
pub(crate) use self::members::Of;
pub(crate) use self::position::Position;

/// A deck and its included files; only the deck if it can't be read, as the error is left to its reader.
pub fn files(path: &Path) -> Vec<PathBuf> {
    match Source::read(path) {
        Ok(source) => source.paths().map(Path::to_path_buf).collect(),
        Err(_) => vec![path.to_path_buf()],
    }
}

/// Reads the mesh of a deck and its included files.
///
/// # Errors
/// The error in the deck, with file and line.
pub fn read(path: &Path) -> Result<Mesh, InputError> {
    let source = Source::read(path)?;
    let Whole {
        deck,
        mut warnings,
        left_out,
    } = Whole::read(&source)?;
    let is_reduced = (deck.elements.iter().zip(&deck.is_reduced))
        .any(|((kind, _), is_reduced)| *is_reduced && kind.reduced_points().is_some());
    if is_reduced {
        warnings.push(
            "of the deck's elements those of reduced integration are integrated in full, unless 'integration' of their body \
             says otherwise"
                .into(),
        );
    }
    if !left_out.is_empty() {
        warnings.push(format!(
            "of the deck the mesh alone is read; left out are {}",
            left_out.join(", ")
        ));
    }
    mesh(&deck, warnings).map_err(|error| error.in_file(path))
}
