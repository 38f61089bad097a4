//! `*MODEL CHANGE`: pairs of contact that come and go with the steps.

use super::contacts::Pair;
use super::document::{Document, quoted};
use super::loads::item;
use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::Block;
use crate::name;

/// A pair that comes or goes.
pub(super) struct Change {
    /// The step, from 0 on.
    step: usize,
    /// The pair, by its place among all.
    pair: usize,
    /// Whether it is there from then on.
    comes: bool,
}

/// The changes of a block that stands in a `step`, which has a number where it stands in one.
///
/// # Errors
/// Others than those of pairs, or no such pair.
pub(super) fn read(
    places: &Places,
    block: &Block,
    pairs: &[Pair],
    step: Option<usize>,
) -> Result<Vec<Change>, InputError> {
    let source = places.source;
    let Some(step) = step else {
        let message = "*MODEL CHANGE stands in no step; expected it behind *STEP";
        return Err(source.error(block.place, message));
    };
    let kind = source.required(block, "TYPE")?;
    if !kind.eq_ignore_ascii_case("CONTACT PAIR") {
        let message = format!(
            "*MODEL CHANGE of TYPE={} isn't read; instead leave it out, convert the deck, and say in the scene's [[step]] \
             what is added and removed",
            name::shown(kind)
        );
        return Err(source.error(block.place, message));
    }
    let comes = match ["ADD", "REMOVE"].map(|key| block.parameter(key).is_some()) {
        [true, false] => true,
        [false, true] => false,
        _ => {
            let message =
                "*MODEL CHANGE with neither or both of ADD and REMOVE; expected one of them";
            return Err(source.error(block.place, message));
        }
    };
    let change = |data| {
        let [slave, master] = [0, 1].map(|place| item(source, data, place).to_uppercase());
        let is_it = |pair: &Pair| pair.slave == slave && pair.master == master;
        let pair = pairs.iter().position(is_it).ok_or_else(|| {
            let message = "there is no *CONTACT PAIR of this slave and master before this line";
            source.error(data.place, message)
        })?;
        Ok(Change { step, pair, comes })
    };
    block.data.iter().map(change).collect()
}

/// Writes what comes and goes in a step, by the `names` of all pairs.
pub(super) fn write(changes: &[Change], step: usize, names: &[String], document: &mut Document) {
    for (key, comes) in [("add", true), ("remove", false)] {
        let own = changes
            .iter()
            .filter(|of| of.step == step && of.comes == comes);
        let list: Vec<String> = own.map(|of| quoted(&names[of.pair])).collect();
        if !list.is_empty() {
            document.key(key, format!("[{}]", list.join(", ")));
        }
    }
}
