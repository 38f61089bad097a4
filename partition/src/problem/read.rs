//! Reads `problem.h5`, a slice at a time.

mod attribute;
mod catalog;
mod consistency;
mod contents;
mod dataset;
mod header;
mod hierarchy;
mod materials;
mod points;
mod settings;
mod slice;
mod subdomain;

use std::ops::Range;
use std::path::{Path, PathBuf};

use self::contents::Contents;
use self::header::Header;
use super::copies::NodeCopies;
use super::{Catalog, Problem, Subdomain, SubdomainNode};
use crate::contact_point::ContactPoint;
use crate::error::InputError;
use crate::source;

/// An open problem file whose catalog was read and checked.
#[derive(Debug)]
pub struct ProblemFile {
    path: PathBuf,
    contents: Contents,
    catalog: Catalog,
    /// How many subdomains have each node of Γ.
    sharing: Vec<u32>,
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
        source::open(path, "a problem file")?;
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
        let header = Header::read(&file)?;
        let contents = Contents::open(&file, header.dim)?;
        let catalog = catalog::read(&file, header, &contents)?;
        let mut sharing = vec![0; catalog.interface_nodes];
        for &number in catalog.interface.iter().flatten() {
            sharing[number as usize] += 1;
        }
        Ok(Self {
            sharing,
            path: path.to_path_buf(),
            contents,
            catalog,
        })
    }

    /// An error about the file as a whole, found by comparing its parts.
    pub fn refuse(&self, error: InputError) -> InputError {
        error.in_file(&self.path)
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

    /// Reads and checks the contact points of one group, whose subdomains are `members`.
    ///
    /// # Errors
    /// The dataset and the row that isn't what it should be, or that says something else than the
    /// mesh of the members does.
    pub fn points(
        &self,
        group: usize,
        members: &[&Subdomain],
    ) -> Result<Vec<ContactPoint<SubdomainNode>>, InputError> {
        self.read_points(group, members)
            .map_err(|error| error.in_file(&self.path))
    }

    /// Reads everything and checks, beyond what the slices show, that subdomains agree on their
    /// nodes.
    ///
    /// # Errors
    /// The dataset and the row that isn't what it should be.
    pub fn problem(&self) -> Result<Problem, InputError> {
        let subdomains = self.subdomains(0..self.catalog.subdomains.len())?;
        let mut copies = NodeCopies::new(&self.catalog);
        for subdomain in &subdomains {
            copies.add(subdomain.index, subdomain.own_nodes());
        }
        (copies.check()).map_err(|error| error.in_file(&self.path))?;
        let points = (0..self.catalog.groups.len()).map(|group| {
            let of_group = |s: &&Subdomain| self.catalog.subdomains[s.index].group == Some(group);
            let members: Vec<&Subdomain> = subdomains.iter().filter(of_group).collect();
            self.points(group, &members)
        });
        Ok(Problem {
            catalog: self.catalog.clone(),
            points: points.collect::<Result<_, _>>()?,
            subdomains,
        })
    }
}
