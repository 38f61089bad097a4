//! The attributes of the file.

use super::attribute::Attribute;
use crate::error::InputError;
use crate::model::PlaneState;
use crate::name;
use crate::problem::strings::read_strings;
use crate::problem::vtkhdf::GRID;
use crate::problem::{FORMAT, VERSION};
use crate::scene::units::Units;

/// What the attributes of the file say.
pub(super) struct Header {
    pub title: String,
    pub dim: usize,
    pub units: Units,
    pub plane: PlaneState,
}

impl Header {
    /// Reads the other attributes; a title and units may be absent.
    pub fn read(file: &hdf5::File) -> Result<Self, InputError> {
        check_grid(file)?;
        Ok(Self {
            dim: read_dimension(file)?,
            title: read_title(file)?,
            units: read_units(file)?,
            plane: read_plane(file)?,
        })
    }
}

fn read_plane(file: &hdf5::File) -> Result<PlaneState, InputError> {
    let plane = text(file, "plane")?;
    let mut known = PlaneState::ALL.into_iter();
    known.find(|known| known.name() == plane).ok_or_else(|| {
        InputError::new(format!(
            "attribute plane is \"{plane}\"; expected \"strain\" or \"stress\""
        ))
    })
}

/// The units that results are meant in; m, N and Pa where the file doesn't say.
fn read_units(file: &hdf5::File) -> Result<Units, InputError> {
    let Some(attribute) = Attribute::find(file, "units")? else {
        return Ok(Units::default());
    };
    let name = attribute.text()?;
    let known = Units::ALL.into_iter().find(|known| known.length() == name);
    known.ok_or_else(|| attribute.error(&format!("is \"{name}\"; expected \"m\" or \"mm\"")))
}

/// The title; empty where there is none.
fn read_title(file: &hdf5::File) -> Result<String, InputError> {
    if file.attr("title").is_err() {
        return Ok(String::new());
    }
    let title = text(file, "title")?;
    name::check_text(&title).map_err(|reason| {
        InputError::new(format!(
            "attribute title: '{}' {reason}",
            name::shown(&title)
        ))
    })?;
    Ok(title)
}

/// What ParaView goes by, if it is there, is what is read here.
fn check_grid(file: &hdf5::File) -> Result<(), InputError> {
    let Ok(grid) = file.group("VTKHDF") else {
        return Ok(());
    };
    if let Ok(kind) = grid.attr("Type") {
        let kind = read_strings(&kind).map(|kinds| kinds.concat());
        if kind.as_deref() != Ok(GRID) {
            return Err(InputError::new(format!(
                "attribute Type of /VTKHDF is {}; expected \"{GRID}\"",
                kind.map_or_else(|reason| reason, |kind| format!("\"{kind}\""))
            )));
        }
    }
    if let Ok(version) = grid.attr("Version") {
        let version = version.read_raw::<i64>().unwrap_or_default();
        if version.len() != 2 || version[0] != 2 {
            return Err(InputError::new(format!(
                "attribute Version of /VTKHDF is {version:?}; expected [2, 0] or a later minor one"
            )));
        }
    }
    Ok(())
}

/// Checks that a file is a problem file of the version that is read here.
pub(super) fn check_format(file: &hdf5::File) -> Result<(), InputError> {
    let format = text(file, "format").map_err(|_| {
        InputError::new(format!(
            "is an HDF5 file, but no problem file: it has no attribute format = \"{FORMAT}\". \
             contact-dd-partition makes a problem file of a scene and a mesh"
        ))
    })?;
    if format != FORMAT {
        return Err(InputError::new(format!(
            "isn't a problem file: attribute format is \"{}\"; expected \"{FORMAT}\"",
            name::shown(&format)
        )));
    }
    match Attribute::open(file, "version")?.integer()? {
        VERSION => Ok(()),
        older if (1..VERSION).contains(&older) => Err(InputError::new(format!(
            "has version {older} of the format; expected {VERSION}. Make it again with \
             contact-dd-partition"
        ))),
        other => Err(InputError::new(format!(
            "has version {other} of the format; expected {VERSION}: make it again with \
             contact-dd-partition"
        ))),
    }
}

fn read_dimension(file: &hdf5::File) -> Result<usize, InputError> {
    match Attribute::open(file, "dimension")?.integer()? {
        2 => Ok(2),
        other => Err(InputError::new(format!(
            "attribute dimension is {other}; expected 2"
        ))),
    }
}

fn text(file: &hdf5::File, name: &str) -> Result<String, InputError> {
    Attribute::open(file, name)?.text()
}
