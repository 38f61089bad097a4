//! Settings of the solver: the attributes of `/settings`, with the keys of `[solver]` in a scene.

use toml::{Table, Value};

use super::attribute;
use crate::error::InputError;
use crate::name;
use crate::problem::schema;
use crate::solver::SolverSettings;

/// Reads and checks `/settings`, which is optional.
pub(super) fn read(file: &hdf5::File) -> Result<SolverSettings, InputError> {
    if !file.link_exists("settings") {
        return Ok(SolverSettings::default());
    }
    let group = file
        .group("settings")
        .map_err(|_| InputError::new("/settings isn't a group; expected one with attributes"))?;
    let mut settings = SolverSettings::default();
    let mut table = Table::new();
    for schema::Attribute {
        name,
        value: expected,
        ..
    } in schema::attributes_of("/settings")
    {
        if !attribute::is_there(&group, name) {
            continue;
        }
        let value = match attribute::read(&group, name)? {
            // Some languages have no Boolean type.
            Value::Integer(bit @ 0..=1) if *name == "no_stress" => Value::Boolean(bit == 1),
            value => value,
        };
        let shown = name::shown(&value.to_string());
        table.insert((*name).into(), value);
        settings = table.clone().try_into().map_err(|_| {
            let expected = expected.replace('`', "");
            InputError::new(format!(
                "attribute {name} of /settings is {shown}; expected {expected}"
            ))
        })?;
    }
    Ok(settings)
}
