//! How the problem wants to be solved: the attributes of `/settings`.

use clap::ValueEnum;

use super::attribute::Attribute;
use crate::error::InputError;
use crate::scene::suggest::nearest;
use crate::solver::{Method, Positive, SolverSettings};

/// Reads and checks `/settings`; a file may have none.
pub(super) fn read(file: &hdf5::File) -> Result<SolverSettings, InputError> {
    if !file.link_exists("settings") {
        return Ok(SolverSettings::default());
    }
    let group = file
        .group("settings")
        .map_err(|_| InputError::new("/settings isn't a group; expected one with attributes"))?;
    let find = |name| Attribute::find(&group, name);
    Ok(SolverSettings {
        method: find("method")?.map(|found| method(&found)).transpose()?,
        tolerance: positive(find("tolerance")?)?,
        max_sweeps: find("max_sweeps")?.map(|n| count(&n)).transpose()?,
        relaxation: positive(find("relaxation")?)?,
        no_stress: find("no_stress")?.map(|found| found.truth()).transpose()?,
    })
}

fn method(attribute: &Attribute) -> Result<Method, InputError> {
    let name = attribute.text()?;
    Method::from_str(&name, false).map_err(|_| {
        let known = || Method::value_variants().iter().map(|method| method.name());
        let near = nearest(&name, known()).unwrap_or_default();
        let known = known().collect::<Vec<_>>().join(", ");
        attribute.error(&format!(
            "is '{}'; did you mean '{near}'? Known here: {known}",
            crate::name::shown(&name)
        ))
    })
}

fn positive(attribute: Option<Attribute>) -> Result<Option<Positive>, InputError> {
    let Some(attribute) = attribute else {
        return Ok(None);
    };
    let value = attribute.number()?;
    let value =
        Positive::try_from(value).map_err(|reason| attribute.error(&format!("is {reason}")));
    value.map(Some)
}

fn count(attribute: &Attribute) -> Result<usize, InputError> {
    let count = attribute.integer()?;
    usize::try_from(count)
        .map_err(|_| attribute.error(&format!("is {count}; expected a number of sweeps")))
}
