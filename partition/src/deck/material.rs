//! `*MATERIAL` and its subordinate keywords.

use super::axes::numbers;
use super::elastic::Elastic;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace, Source};
use crate::name;

/// A material being read.
pub(super) struct Material {
    pub(super) name: String,
    place: LinePlace,
    elastic: Option<Elastic>,
    /// Coefficient of thermal expansion, 0 by default.
    pub(super) expansion: f64,
    density: Option<f64>,
}

impl Material {
    pub(super) fn new(source: &Source, block: &Block) -> Result<Self, InputError> {
        let name = source.required(block, "NAME")?;
        name::check(name)
            .map_err(|reason| source.error(block.place, format!("the name {reason}")))?;
        Ok(Self {
            name: name.to_owned(),
            place: block.place,
            elastic: None,
            expansion: 0.0,
            density: None,
        })
    }

    /// Reads `*ELASTIC`, `*EXPANSION` or `*DENSITY`.
    pub(super) fn take(&mut self, source: &Source, block: &Block) -> Result<(), InputError> {
        match block.keyword.as_str() {
            "ELASTIC" => self.elastic = Some(Elastic::read(source, block)?),
            "EXPANSION" => self.expansion = expansion(source, block)?,
            "DENSITY" => self.density = Some(constant(source, block, "the density")?),
            _ => {}
        }
        Ok(())
    }

    /// The elastic law.
    pub(super) fn elastic(&self, source: &Source) -> Result<&Elastic, InputError> {
        self.elastic.as_ref().ok_or_else(|| {
            let name = name::shown(&self.name);
            source.error(
                self.place,
                format!("the material {name} has no *ELASTIC; expected it"),
            )
        })
    }

    /// The density, required by a load `label` in line `at`.
    pub(super) fn density(
        &self,
        source: &Source,
        at: LinePlace,
        label: &str,
    ) -> Result<f64, InputError> {
        self.density.ok_or_else(|| {
            let name = name::shown(&self.name);
            let message = format!(
                "{label} is per mass, but the material {name} has no *DENSITY; expected it"
            );
            source.error(at, message)
        })
    }
}

/// The coefficient of isotropic thermal expansion.
fn expansion(source: &Source, block: &Block) -> Result<f64, InputError> {
    let kind = block.parameter("TYPE").unwrap_or("ISO").to_uppercase();
    if kind == "ISO" || kind == "ISOTROPIC" {
        return constant(source, block, "the coefficient of expansion");
    }
    let directions = match block.data.first() {
        Some(data) => numbers(source, data, "a coefficient of expansion")?,
        None => Vec::new(),
    };
    match directions[..] {
        [a, b, c, ..] if kind.starts_with("ORTHO") && a == b && b == c => Ok(a),
        _ => {
            let kind = name::shown(&kind);
            let message = format!(
                "*EXPANSION of TYPE={kind} isn't read; expected one that is the same in all directions"
            );
            Err(source.error(block.place, message))
        }
    }
}

/// The value of a table that has to be independent of temperature.
fn constant(source: &Source, block: &Block, what: &str) -> Result<f64, InputError> {
    let mut found = None;
    for data in &block.data {
        let item = source.items(data).next().unwrap_or_default();
        let value = source.real(data.place, item, what)?;
        if found.is_some_and(|first| first != value) {
            let message = format!(
                "{what} depends on temperature; expected one that doesn't: that of the mean temperature"
            );
            return Err(source.error(data.place, message));
        }
        found = Some(value);
    }
    found.ok_or_else(|| {
        source.error(
            block.place,
            format!("*{} has no number; expected {what}", block.keyword),
        )
    })
}
