//! `*FRICTION`: Coulomb's law.

use super::loads::item;
use super::parameters;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Source};

/// The numbers of a block.
#[derive(Default)]
pub(super) struct Friction {
    pub(super) coefficient: f64,
    /// CalculiX's stick slope.
    pub(super) stick_slope: Option<f64>,
}

impl Friction {
    /// Reads a block.
    ///
    /// # Errors
    /// Parameters that change the law, a negative coefficient, or several ones.
    pub(super) fn read(source: &Source, block: &Block) -> Result<Self, InputError> {
        if let Some(key) = parameters::refused(block) {
            let message =
                format!("*FRICTION with {key} isn't read; expected a coefficient of Coulomb's law");
            return Err(source.error(block.place, message));
        }
        let mut found: Option<Self> = None;
        for data in &block.data {
            let what = "a coefficient of friction";
            let coefficient = source.real(data.place, item(source, data, 0), what)?;
            if coefficient < 0.0 {
                let message =
                    format!("the coefficient of friction is {coefficient}; expected at least 0");
                return Err(source.error(data.place, message));
            }
            if found
                .as_ref()
                .is_some_and(|first| first.coefficient != coefficient)
            {
                let message = "the coefficient of friction varies with slip rate, pressure or temperature, which isn't \
                               supported; expected one coefficient";
                return Err(source.error(data.place, message));
            }
            let slope = source.real(data.place, item(source, data, 1), "a stick slope")?;
            // In a table of several lines the second number is a slip rate.
            let is_slope = slope > 0.0 && block.data.len() == 1;
            found = Some(Self {
                coefficient,
                stick_slope: is_slope.then_some(slope),
            });
        }
        Ok(found.unwrap_or_default())
    }
}
