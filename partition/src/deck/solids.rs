//! Solids of a deck: elements with a volume, or all of them in the plane.

use std::collections::BTreeSet;

use super::place::Places;
use crate::error::InputError;
use crate::name;

/// Beginnings of the types of solids.
const SOLIDS: [&str; 4] = ["C3D", "CPE", "CPS", "CAX"];

/// Refuses decks without solids, and those with plane elements beside solids in space, of which one would be lost.
///
/// # Errors
/// The types of elements that a deck has instead, or the line of the plane elements.
pub(super) fn check(places: &Places) -> Result<(), InputError> {
    let dim = places.dim();
    if dim == 0 {
        return Err(InputError::new(format!(
            "the deck has no solid elements: {}; expected elements of types such as C3D8, C3D20, C3D4, C3D10, CPE4, CPS4 or \
             CAX4",
            instead(places)
        )));
    }
    let deck = &places.deck;
    let is_flat = |&e: &usize| !deck.is_side[e] && deck.elements.kind(e).dim() < dim;
    let Some(flat) = (0..deck.elements.len()).find(is_flat) else {
        return Ok(());
    };
    let message = format!(
        "the plane element {} stands beside solids in space; expected a deck for each",
        deck.element_tags[flat]
    );
    let mut blocks = places.source.blocks.iter();
    let plane = blocks.find(|block| {
        let kind = block.parameter("TYPE").unwrap_or_default().to_uppercase();
        block.keyword == "ELEMENT" && SOLIDS[1..].iter().any(|solid| kind.starts_with(solid))
    });
    Err(match plane {
        Some(block) => places.source.error(block.place, message),
        None => InputError::new(message),
    })
}

/// What a deck has instead of solids.
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
