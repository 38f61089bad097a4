//! Reads `problem.h5`, a slice at a time.

use std::path::Path;

use super::{Catalog, ContactRow, Subdomain};
use crate::error::InputError;

/// An open problem file whose catalog was read and checked.
#[derive(Debug)]
pub struct ProblemFile {
    catalog: Catalog,
}

impl ProblemFile {
    /// Opens a problem file and checks its catalog.
    ///
    /// # Errors
    /// The dataset that is missing or not what it should be.
    pub fn open(_path: &Path) -> Result<Self, InputError> {
        Err(InputError::new("not yet"))
    }

    /// What every rank knows of the whole problem.
    pub fn catalog(&self) -> &Catalog {
        &self.catalog
    }

    /// Reads the slice of one subdomain.
    ///
    /// # Errors
    /// The dataset and the row that isn't what it should be.
    pub fn subdomain(&self, _index: usize) -> Result<Subdomain, InputError> {
        Err(InputError::new("not yet"))
    }

    /// Reads the contact rows of one group.
    ///
    /// # Errors
    /// The dataset and the row that isn't what it should be.
    pub fn rows(&self, _group: usize) -> Result<Vec<ContactRow>, InputError> {
        Err(InputError::new("not yet"))
    }
}
