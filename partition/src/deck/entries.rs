//! Entries of lines of data: a keyword takes so many, and more of them are a mistake, such as a decimal comma. Where
//! temperatures or rates may follow, a decimal comma leaves no entry too many, but two entries that look like one number.

use super::loads::item;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Data, Source};
use crate::name;

/// The keywords whose entries are counted here.
const COUNTED: [&str; 15] = [
    "NODE",
    "INSTANCE",
    "SOLID SECTION",
    "PRE-TENSION SECTION",
    "BOUNDARY",
    "CLOAD",
    "DLOAD",
    "DSLOAD",
    "TEMPERATURE",
    "INITIAL CONDITIONS",
    "DENSITY",
    "EXPANSION",
    "FRICTION",
    "CONTACT PAIR",
    "TIE",
];

/// The keywords of numbers behind which temperatures, rates or pressures may stand.
const TABLES: [&str; 6] = [
    "ELASTIC",
    "EXPANSION",
    "DENSITY",
    "FRICTION",
    "SPRING",
    "SURFACE BEHAVIOR",
];

/// Refuses entries beyond those that a keyword takes, where zeros may follow, and two that may be one number with a
/// decimal comma.
///
/// # Errors
/// The first entry too many, or the first two that may be one, with the line.
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
    let isotropic = |block: &&Block| {
        let kind = block.parameter("TYPE").unwrap_or("ISO").to_uppercase();
        TABLES.contains(&block.keyword.as_str()) && kind.starts_with("ISO")
    };
    for block in source.blocks.iter().filter(isotropic) {
        // The last line of *SPRING has its stiffness, others degrees of freedom.
        let first = match block.keyword.as_str() {
            "SPRING" => block.data.len().saturating_sub(1),
            _ => 0,
        };
        for data in &block.data[first..] {
            if let Some([whole, digits]) = split(block, source.text(data)) {
                let message = format!(
                    "*{} has `{whole},{digits}`, which may be one number with a decimal comma, or two; expected {whole}.{digits}, or a \
                     point in the first of two, {whole}., {digits}",
                    block.keyword
                );
                return Err(source.error(data.place, message));
            }
        }
    }
    Ok(())
}

/// Two neighbouring entries without a point that may be the parts of one number: digits, and behind the comma directly
/// digits again. Zeros at the end of a line are no matter.
fn split<'a>(block: &Block, text: &'a str) -> Option<[&'a str; 2]> {
    let is_zero = |item: &str| item.trim().is_empty() || item.trim().parse() == Ok(0.0);
    let items: Vec<&str> = text.split(',').collect();
    let used = items.iter().rposition(|item| !is_zero(item))?;
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|c| c.is_ascii_digit());
    let pairs = items[..=used]
        .windows(2)
        .map(|pair| [pair[0].trim(), pair[1]]);
    pairs.into_iter().find(|[whole, rest]| {
        let (fraction, exponent) = rest
            .trim_end()
            .split_once(['e', 'E'])
            .unwrap_or((rest.trim_end(), ""));
        let power = exponent.trim_start_matches(['+', '-']);
        let has_power = digits(power);
        // The slope of a contact may stand before a pressure.
        let is_clear = has_power || block.keyword != "SURFACE BEHAVIOR";
        digits(whole.trim_start_matches(['+', '-']))
            && digits(fraction)
            && (exponent.is_empty() || has_power)
            && is_clear
    })
}

/// The number of entries that a line takes, and their meaning; `None` where its reader counts them, or where further ones
/// are no matter.
fn taken(source: &Source, block: &Block, data: &Data) -> Option<(usize, &'static str)> {
    // Decks have many of these lines.
    if block.keyword == "NODE" {
        return Some((4, "a number and three coordinates"));
    }
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
        ("INSTANCE", _) if block.data.first().map(|first| first.place) == Some(data.place) => {
            (3, "a shift")
        }
        ("SOLID SECTION", _) if block.parameter("COMPOSITE").is_none() => (1, "a thickness"),
        ("PRE-TENSION SECTION", _) => (3, "a direction"),
        ("EXPANSION", _) if kind.is_empty() || kind.starts_with("ISO") => {
            (2, "a coefficient and a temperature")
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decimal_comma_where_temperatures_follow_is_refused_and_tables_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("part.inp");
        let check_of = |text: &str| {
            std::fs::write(&path, text).unwrap();
            check(&Source::read(&path).unwrap())
        };
        for (text, number) in [
            ("*ELASTIC\n210000,0,0.3", "210000.0"),
            ("*ELASTIC\n210000.,0,3", "0.3"),
            ("*ELASTIC, TYPE=ISO\n2,1e5, 0.3", "2.1e5"),
            ("*DENSITY\n7,85E-09,", "7.85E-09"),
            ("*EXPANSION, ZERO=20\n1,2e-5", "1.2e-5"),
            ("*FRICTION\n0,15", "0.15"),
            ("*SPRING, ELSET=S\n3, 3\n2,5", "2.5"),
            (
                "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1,5e6",
                "1.5e6",
            ),
        ] {
            let error = check_of(text).unwrap_err().to_string();
            assert!(error.contains(&format!("expected {number}, or")), "{error}");
        }
        for text in [
            "*ELASTIC\n210000,0.3",
            "*ELASTIC\n210000,0",
            "*ELASTIC\n210000, 0, 20",
            "*ELASTIC\n210000.,.3,20\n200000.,.3,120",
            "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n10,10,10,0.2,0.2,0.2,3,3,\n3",
            "*DENSITY\n7800, 20",
            "*DENSITY\n7.85e-9,20",
            "*FRICTION\n0.2,50000",
            "*SPRING, ELSET=S\n3,3\n200.",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n50000,10",
        ] {
            assert!(check_of(text).is_ok(), "{text}");
        }
        for (text, entries) in [
            ("*NODE\n1, 0,5, 0, 1", 4),
            ("*INSTANCE, NAME=I, PART=P\n0, 1,5, 2", 3),
            ("*SOLID SECTION, ELSET=E, MATERIAL=M\n2,5", 1),
        ] {
            let error = check_of(text).unwrap_err().to_string();
            assert!(
                error.contains(&format!("behind its {entries} entries")),
                "{error}"
            );
        }
    }
}
