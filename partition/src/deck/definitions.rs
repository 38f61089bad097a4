//! Definitions of a deck: no two of a name, and no two laws of a kind in one material or interaction, of which only one
//! could count.

use std::collections::BTreeMap;

use crate::error::InputError;
use crate::mesh::abaqus::{LinePlace, Source};
use crate::name;

/// Keywords that define something under a name.
const NAMED: [&str; 4] = [
    "MATERIAL",
    "SURFACE INTERACTION",
    "AMPLITUDE",
    "ORIENTATION",
];

/// Keywords to which laws behind them belong.
const OWNERS: [&str; 4] = [
    "MATERIAL",
    "SURFACE INTERACTION",
    "CHANGE FRICTION",
    "CHANGE SURFACE BEHAVIOR",
];

/// Keywords of laws.
const LAWS: [&str; 5] = [
    "ELASTIC",
    "DENSITY",
    "EXPANSION",
    "FRICTION",
    "SURFACE BEHAVIOR",
];

/// Refuses repeated definitions. Sets and surfaces may be: another definition adds members, as in CalculiX.
///
/// # Errors
/// The second definition, with the line of the first.
pub(super) fn check(source: &Source) -> Result<(), InputError> {
    let mut known: BTreeMap<(String, &str, String), LinePlace> = BTreeMap::new();
    let (mut part, mut owner) = (String::new(), String::new());
    for (number, block) in source.blocks.iter().enumerate() {
        let keyword = block.keyword.as_str();
        let name = block.parameter("NAME").unwrap_or_default().to_uppercase();
        match keyword {
            "PART" | "INSTANCE" => part = format!("{keyword} {name}"),
            "END PART" | "END INSTANCE" => part.clear(),
            _ if OWNERS.contains(&keyword) => owner = number.to_string(),
            _ => {}
        }
        let (within, name) = match keyword {
            // Parts may have orientations of the same name.
            "ORIENTATION" => (part.clone(), name),
            _ if NAMED.contains(&keyword) => (String::new(), name),
            _ if LAWS.contains(&keyword) => (owner.clone(), String::new()),
            _ => continue,
        };
        let what = match name.is_empty() {
            true => format!("*{keyword}"),
            false => format!("*{keyword} '{}'", name::shown(&name)),
        };
        if let Some(first) = known.insert((within, keyword, name), block.place) {
            let first = source.place(first);
            let message = format!("{what} is given twice, first in {first}; expected one");
            return Err(source.error(block.place, message));
        }
    }
    Ok(())
}
