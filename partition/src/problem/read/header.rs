//! The attributes of the file.

use toml::Value;

use super::attribute;
use crate::error::InputError;
use crate::model::PlaneState;
use crate::name;
use crate::problem::{FORMAT, VERSION};
use crate::scene::units::Units;

/// The attributes of the file.
pub(super) struct Header {
    pub title: String,
    pub dim: usize,
    pub units: Units,
    pub plane: Option<PlaneState>,
}

impl Header {
    /// Checks that a file is a problem file of the supported version, and reads its other attributes; a title and units
    /// are optional.
    pub fn read(file: &hdf5::File) -> Result<Self, InputError> {
        check_format(file)?;
        let is_there = attribute::is_there(file, "dimension");
        let dim = match is_there
            .then(|| attribute::read(file, "dimension"))
            .transpose()?
        {
            Some(Value::Integer(2)) => 2,
            Some(Value::Integer(3)) => 3,
            _ => return Err(unexpected(file, "dimension", "2 or 3")),
        };
        let title = text(file, "title", "")?;
        name::check_text(&title).map_err(|reason| {
            let shown = name::shown(&title);
            InputError::new(format!("attribute title: '{shown}' {reason}"))
        })?;
        let named = text(file, "plane", "")?;
        let plane = PlaneState::ALL.into_iter().find(|p| p.name() == named);
        match dim {
            2 if plane.is_none() => {
                return Err(unexpected(
                    file,
                    "plane",
                    "\"strain\", \"stress\" or \"axisymmetric\"",
                ));
            }
            3 if !named.is_empty() => {
                return Err(unexpected(file, "plane", "none in 3 dimensions"));
            }
            _ => {}
        }
        let units = text(file, "units", Units::default().length())?;
        let units = Units::ALL.into_iter().find(|u| u.length() == units);
        Ok(Self {
            dim,
            title,
            units: units.ok_or_else(|| unexpected(file, "units", "\"m\" or \"mm\""))?,
            plane,
        })
    }
}

/// The text of an attribute, or `otherwise` if it is missing.
fn text(file: &hdf5::File, name: &str, otherwise: &str) -> Result<String, InputError> {
    if !attribute::is_there(file, name) {
        return Ok(otherwise.into());
    }
    match attribute::read(file, name)? {
        Value::String(text) => Ok(text),
        _ => Err(unexpected(file, name, "a line of text")),
    }
}

fn check_format(file: &hdf5::File) -> Result<(), InputError> {
    if !attribute::is_there(file, "format") {
        if attribute::is_there(file, "report") {
            return Err(InputError::new(
                "is a result of contact-dd-mpi; expected the problem file that it was made from",
            ));
        }
        return Err(InputError::new(format!(
            "is an HDF5 file, but no problem file: it has no attribute format = \"{FORMAT}\". \
             contact-dd-partition makes a problem file of a scene and a mesh"
        )));
    }
    if attribute::read(file, "format")?.as_str() != Some(FORMAT) {
        return Err(unexpected(
            file,
            "format",
            &format!("\"{FORMAT}\", that of a problem file"),
        ));
    }
    match attribute::read(file, "version")?.as_integer() {
        Some(VERSION) => Ok(()),
        Some(older) if (1..VERSION).contains(&older) => Err(InputError::new(format!(
            "has version {older} of the format; expected {VERSION}. Make it again with \
             contact-dd-partition"
        ))),
        _ => Err(unexpected(file, "version", &VERSION.to_string())),
    }
}

/// An error about an attribute of the file.
fn unexpected(file: &hdf5::File, name: &str, expected: &str) -> InputError {
    let found = attribute::read(file, name).map(|value| value.to_string());
    let found = found.unwrap_or_else(|error| error.to_string());
    let found = name::shown(&found);
    InputError::new(format!("attribute {name} is {found}; expected {expected}"))
}
