//! Solids of a deck: elements that have a stiffness here.

use std::collections::BTreeSet;

use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Source};
use crate::name;

/// Beginnings of the types of solids.
const SOLIDS: [&str; 4] = ["C3D", "CPE", "CPS", "CAX"];

/// Beginnings of the types of beams.
const BEAMS: [&str; 4] = ["B2", "B3", "PIPE", "FRAME"];

/// Refuses decks without solids.
///
/// # Errors
/// The types of elements that a deck has instead.
pub(super) fn check(places: &Places) -> Result<(), InputError> {
    if places.dim() == 0 {
        return Err(InputError::new(format!(
            "the deck has no solid elements: {}; expected elements of types such as C3D8, C3D20, C3D4, C3D10, CPE4, CPS4 or \
             CAX4",
            instead(places)
        )));
    }
    Ok(())
}

/// Refuses a section of elements that have no stiffness here, as ignoring it would change the answer silently.
///
/// # Errors
/// A truss, a shell or a plane element in space, which can only be a side, or a beam, which is left out.
pub(super) fn check_section(
    places: &Places,
    block: &Block,
    set: &str,
    elements: &[u32],
) -> Result<(), InputError> {
    let deck = &places.deck;
    let dim = places.dim();
    let other = elements.iter().find(|&&e| !places.is_cell(e, dim));
    let what = match other.map(|&other| other as usize) {
        Some(plane) if !deck.is_side[plane] => {
            let message = format!(
                "the plane element {} stands beside solids in space; expected a deck for each",
                deck.element_tags[plane]
            );
            return Err(places.source.error(block.place, message));
        }
        Some(side) => format!(
            "element {}, a {}",
            deck.element_tags[side],
            deck.elements.kind(side).name()
        ),
        None if !elements.is_empty() || !places.is_placed() => return Ok(()),
        None => match type_of(places, set).filter(|kind| is_beam(kind)) {
            Some(kind) => format!("elements of type {}", name::shown(kind)),
            None => return Ok(()),
        },
    };
    let message = format!(
        "*SOLID SECTION of {what}: the stiffness of trusses, beams and shells isn't computed; expected solids, or *SPRING for \
         a truss"
    );
    Err(places.source.error(block.place, message))
}

/// The type of the elements of a set, by the block that lists them.
fn type_of<'a>(places: &Places<'a>, set: &str) -> Option<&'a str> {
    let source: &'a Source = places.source;
    let mut blocks = source.blocks.iter();
    let own = blocks.find(|block| {
        let own = block.parameter("ELSET").unwrap_or_default();
        block.keyword == "ELEMENT" && own.eq_ignore_ascii_case(set)
    });
    own.and_then(|own| own.parameter("TYPE"))
}

/// True for the type of a beam. CalculiX wants sections of other elements, too, such as `DCOUP3D`.
fn is_beam(kind: &str) -> bool {
    let kind = kind.to_uppercase();
    BEAMS.iter().any(|beam| kind.starts_with(beam))
}

/// The elements that a deck without solids has, in words.
fn instead(places: &Places) -> String {
    let blocks = places.source.blocks.iter();
    let types: BTreeSet<String> = blocks
        .filter(|block| block.keyword == "ELEMENT")
        .filter_map(|block| block.parameter("TYPE"))
        .map(|kind| name::shown(&kind.to_uppercase()))
        .collect();
    let is_solid = |kind: &String| SOLIDS.iter().any(|solid| kind.starts_with(solid));
    if types.iter().any(is_solid) {
        return "its parts have no *INSTANCE".into();
    }
    match types.is_empty() {
        true => "it has no *ELEMENT".into(),
        false => {
            let types: Vec<String> = types.into_iter().collect();
            format!(
                "its elements of type {} have no stiffness here",
                types.join(", ")
            )
        }
    }
}
