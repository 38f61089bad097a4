//! Entries of lines of data: a keyword takes so many, and more of them are a mistake, such as a decimal comma.

use super::loads::item;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Data, Source};
use crate::name;

/// The keywords whose entries are counted here.
const COUNTED: [&str; 10] = [
    "BOUNDARY",
    "CLOAD",
    "DLOAD",
    "DSLOAD",
    "TEMPERATURE",
    "INITIAL CONDITIONS",
    "DENSITY",
    "FRICTION",
    "CONTACT PAIR",
    "TIE",
];

/// Refuses entries beyond those that a keyword takes; zeros may follow.
///
/// # Errors
/// The first entry too many, with its line.
pub(super) fn check(source: &Source) -> Result<(), InputError> {
    let blocks = source.blocks.iter();
    for block in blocks.filter(|block| COUNTED.contains(&block.keyword.as_str())) {
        for data in &block.data {
            let Some((count, what)) = taken(source, block, data) else {
                continue;
            };
            let mut others = source.items(data).skip(count);
            let is_number = |item: &&str| !item.is_empty() && item.parse::<f64>().ok() != Some(0.0);
            if let Some(other) = others.find(is_number) {
                let message = format!(
                    "*{} has `{}` behind its {count} entries; expected {what}, with points in numbers, not commas",
                    block.keyword,
                    name::shown(other)
                );
                return Err(source.error(data.place, message));
            }
        }
    }
    Ok(())
}

/// The number of entries that a line takes, and their meaning; `None` where its reader counts them, or where further ones
/// are no matter.
fn taken(source: &Source, block: &Block, data: &Data) -> Option<(usize, &'static str)> {
    let label = item(source, data, 1).to_uppercase();
    let kind = block.parameter("TYPE").unwrap_or_default().to_uppercase();
    let taken = match (block.keyword.as_str(), label.as_str()) {
        ("BOUNDARY", _) => (4, "nodes, two degrees of freedom and a displacement"),
        ("CLOAD", _) => (3, "nodes, a degree of freedom and a force"),
        ("DLOAD", "GRAV") => (6, "elements, GRAV, a magnitude and a direction"),
        ("DLOAD", "CENTRIF") => (9, "elements, CENTRIF, a magnitude, a point and a direction"),
        ("DSLOAD", "TRVEC") => (6, "a surface, TRVEC, a magnitude and a direction"),
        ("DLOAD", kind) if kind.starts_with(['P', 'B']) => {
            (3, "elements, the kind of a load and its magnitude")
        }
        ("DSLOAD", "P") => (3, "a surface, the kind of a load and its magnitude"),
        ("TEMPERATURE", _) => (2, "nodes and a temperature"),
        ("INITIAL CONDITIONS", _) if kind == "TEMPERATURE" => (2, "nodes and a temperature"),
        ("DENSITY", _) => (2, "a density and a temperature"),
        ("FRICTION", _) => (
            4,
            "a coefficient, a slope or rate, a pressure and a temperature",
        ),
        ("CONTACT PAIR" | "TIE", _) => (2, "two surfaces"),
        _ => return None,
    };
    Some(taken)
}
