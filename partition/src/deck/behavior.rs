//! `*SURFACE BEHAVIOR`: the pressure-overclosure law.

use super::loads::item;
use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::Block;
use crate::name;

/// The slope of a linear law of a `*SURFACE BEHAVIOR`.
pub(super) fn linear(places: &Places, block: &Block) -> Result<f64, InputError> {
    let source = places.source;
    let given = block
        .data
        .first()
        .map(|data| (data.place, item(source, data, 0)));
    let (place, text) = given.unwrap_or((block.place, ""));
    let slope = source.real(place, text, "the slope of pressure over overclosure")?;
    match slope > 0.0 {
        true => Ok(slope),
        false => {
            let message =
                format!("the slope of pressure over overclosure is {slope}; expected more than 0");
            Err(source.error(place, message))
        }
    }
}

/// Description of a softened `*SURFACE BEHAVIOR` that is replaced by hard contact.
pub(super) fn soft(places: &Places, block: &Block) -> Result<Option<String>, InputError> {
    let source = places.source;
    let law = block
        .parameter("PRESSURE-OVERCLOSURE")
        .unwrap_or("HARD")
        .to_uppercase();
    let number = |place| {
        let data = block.data.first();
        data.map_or("", |data| item(source, data, place)).to_owned()
    };
    let softness = match law.as_str() {
        "HARD" | "LINEAR" => return Ok(None),
        "EXPONENTIAL" => format!("p0 = {} at no clearance, 0 at {}", number(1), number(0)),
        "TABULAR" => "a table of pressures over overclosures".into(),
        "TIED" => {
            return Ok(Some(format!(
                "{}: the stiffness {} of a tied contact is left out: a tie is rigid",
                source.place(block.place),
                number(0)
            )));
        }
        _ => {
            let message = format!(
                "PRESSURE-OVERCLOSURE={} isn't read; expected HARD or LINEAR",
                name::shown(&law)
            );
            return Err(source.error(block.place, message));
        }
    };
    Ok(Some(format!(
        "{}: the {} law of contact ({softness}) is taken as hard contact, whose sides don't overlap",
        source.place(block.place),
        law.to_lowercase()
    )))
}
