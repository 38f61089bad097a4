//! The attributes of the file.

use crate::error::InputError;
use crate::model::PlaneState;
use crate::name;
use crate::problem::strings::read_strings;
use crate::problem::{FORMAT, VERSION};

/// Attribute `Type` of `/VTKHDF`.
const GRID: &str = "UnstructuredGrid";

/// What the attributes of the file say.
pub(super) struct Header {
    pub title: String,
    pub dim: usize,
    pub plane: PlaneState,
}

impl Header {
    /// Reads the attributes; a title may be absent.
    pub fn read(file: &hdf5::File) -> Result<Self, InputError> {
        read_format(file)?;
        check_grid(file)?;
        Ok(Self {
            dim: read_dimension(file)?,
            title: read_title(file)?,
            plane: match text(file, "plane")?.as_str() {
                "strain" => PlaneState::Strain,
                "stress" => PlaneState::Stress,
                other => {
                    return Err(InputError::new(format!(
                        "attribute plane is \"{other}\"; expected \"strain\" or \"stress\""
                    )));
                }
            },
        })
    }
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

fn read_format(file: &hdf5::File) -> Result<(), InputError> {
    let format = text(file, "format").map_err(|_| {
        InputError::new(format!(
            "isn't a problem file: expected the attribute format = \"{FORMAT}\""
        ))
    })?;
    if format != FORMAT {
        return Err(InputError::new(format!(
            "attribute format is \"{format}\"; expected \"{FORMAT}\""
        )));
    }
    match integer(file, "version")? {
        VERSION => Ok(()),
        other => Err(InputError::new(format!(
            "has version {other} of the format; expected {VERSION}"
        ))),
    }
}

fn read_dimension(file: &hdf5::File) -> Result<usize, InputError> {
    match integer(file, "dimension")? {
        2 => Ok(2),
        other => Err(InputError::new(format!(
            "attribute dimension is {other}; expected 2"
        ))),
    }
}

fn attribute(file: &hdf5::File, name: &str) -> Result<hdf5::Attribute, InputError> {
    let attribute = file
        .attr(name)
        .map_err(|_| InputError::new(format!("attribute {name} is missing")))?;
    match attribute.size() {
        1 => Ok(attribute),
        size => Err(InputError::new(format!(
            "attribute {name} holds {size} values; expected one"
        ))),
    }
}

fn text(file: &hdf5::File, name: &str) -> Result<String, InputError> {
    let mut strings = read_strings(&*attribute(file, name)?)
        .map_err(|reason| InputError::new(format!("attribute {name} {reason}")))?;
    Ok(strings.pop().unwrap_or_default())
}

fn integer(file: &hdf5::File, name: &str) -> Result<i64, InputError> {
    use hdf5::types::TypeDescriptor::{Integer, Unsigned};
    let attribute = attribute(file, name)?;
    let is_integer = attribute
        .dtype()
        .and_then(|dtype| dtype.to_descriptor())
        .is_ok_and(|dtype| matches!(dtype, Integer(_) | Unsigned(_)));
    let value = attribute
        .read_raw::<i64>()
        .ok()
        .and_then(|v| v.first().copied());
    value
        .filter(|_| is_integer)
        .ok_or_else(|| InputError::new(format!("attribute {name} isn't an integer")))
}
