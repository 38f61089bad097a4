//! Cuts a model along a decomposition.

use super::Problem;
use crate::decompose::Decomposition;
use crate::error::InputError;
use crate::model::Model;

impl Problem {
    /// Gives every subdomain its slice of `model`.
    ///
    /// # Errors
    /// A partition of the user's that can't be.
    pub fn new(_model: &Model, _decomposition: &Decomposition) -> Result<Self, InputError> {
        Err(InputError::new("not yet"))
    }
}
