//! Reads `problem.h5`, a slice at a time.

mod catalog;
mod header;
mod hierarchy;
mod materials;
mod rows;
mod sizes;
mod slabs;
mod subdomain;

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::dataset::Dataset;
use super::{Catalog, ContactRow, Problem, Subdomain};
use crate::error::InputError;

/// An open problem file whose catalog was read and checked.
#[derive(Debug)]
pub struct ProblemFile {
    path: PathBuf,
    file: hdf5::File,
    catalog: Catalog,
    offsets: Offsets,
    /// How many subdomains have each node of Γ.
    sharing: Vec<u32>,
}

/// Where the slice of every subdomain and group starts and ends.
#[derive(Debug)]
struct Offsets {
    points: Vec<usize>,
    cells: Vec<usize>,
    connectivity: Vec<usize>,
    interface: Vec<usize>,
    supports: Vec<usize>,
    forces: Vec<usize>,
    groups: Vec<usize>,
}

impl ProblemFile {
    /// Opens a problem file and checks its catalog: shapes, offsets, names, materials and Γ.
    ///
    /// # Errors
    /// The dataset that is missing or not what it should be.
    pub fn open(path: &Path) -> Result<Self, InputError> {
        Self::open_unnamed(path).map_err(|error| error.in_file(path))
    }

    fn open_unnamed(path: &Path) -> Result<Self, InputError> {
        // The library distinguishes few of the reasons for which a file doesn't open.
        let meta = std::fs::metadata(path)
            .map_err(|reason| InputError::new(format!("can't be read: {reason}")))?;
        if !meta.is_file() {
            return Err(InputError::new("isn't a file; expected a problem file"));
        }
        std::fs::File::open(path)
            .map_err(|reason| InputError::new(format!("can't be read: {reason}")))?;
        hdf5::silence_errors(true);
        // Locks fail on some network file systems, and nobody writes under this name in place.
        let file = hdf5::File::with_options()
            .with_fapl(|access| access.file_locking(false))
            .open(path)
            .map_err(|reason| {
                InputError::new(format!(
                    "isn't a whole HDF5 file ({reason}); expected one written by contact-dd-partition"
                ))
            })?;
        let (catalog, offsets) = catalog::read(&file)?;
        let mut sharing = vec![0; catalog.interface_nodes];
        for &number in catalog.interface.iter().flatten() {
            sharing[number as usize] += 1;
        }
        Ok(Self {
            sharing,
            path: path.to_path_buf(),
            file,
            catalog,
            offsets,
        })
    }

    /// What every rank knows of the whole problem.
    pub fn catalog(&self) -> &Catalog {
        &self.catalog
    }

    /// Reads and checks the slice of one subdomain.
    ///
    /// # Errors
    /// The dataset and the row that isn't what it should be.
    pub fn subdomain(&self, index: usize) -> Result<Subdomain, InputError> {
        let mut one = self.subdomains(index..index.saturating_add(1))?;
        one.pop().ok_or_else(|| {
            InputError::new(format!("there is no subdomain {index}")).in_file(&self.path)
        })
    }

    /// Reads and checks the slices of consecutive subdomains, each dataset in one go.
    ///
    /// # Errors
    /// The dataset and the row that isn't what it should be.
    pub fn subdomains(&self, range: Range<usize>) -> Result<Vec<Subdomain>, InputError> {
        self.read_subdomains(range)
            .map_err(|error| error.in_file(&self.path))
    }

    /// Reads and checks the contact rows of one group.
    ///
    /// # Errors
    /// The dataset and the row that isn't what it should be.
    pub fn rows(&self, group: usize) -> Result<Vec<ContactRow>, InputError> {
        self.read_rows(group)
            .map_err(|error| error.in_file(&self.path))
    }

    /// Reads everything and checks, beyond what the slices show, that subdomains agree on Γ.
    ///
    /// # Errors
    /// The dataset and the row that isn't what it should be.
    pub fn problem(&self) -> Result<Problem, InputError> {
        let problem = Problem {
            catalog: self.catalog.clone(),
            subdomains: self.subdomains(0..self.catalog.subdomains.len())?,
            rows: (0..self.catalog.groups.len())
                .map(|group| self.rows(group))
                .collect::<Result<_, _>>()?,
        };
        problem
            .check_interface()
            .map_err(|error| error.in_file(&self.path))?;
        Ok(problem)
    }

    fn column(&self, name: &'static str) -> Result<Dataset, InputError> {
        Dataset::column(&self.file, name, None)
    }

    fn table(&self, name: &'static str, width: usize) -> Result<Dataset, InputError> {
        Dataset::table(&self.file, name, None, width)
    }
}
