//! Reads `problem.h5`, a slice at a time.

mod attribute;
mod catalog;
mod cells;
mod contents;
mod dataset;
mod entries;
mod goals;
mod header;
mod hierarchy;
mod materials;
mod points;
mod probes;
mod settings;
mod slice;
mod springs;
mod subdomain;
mod tips;

use std::ops::Range;
use std::path::{Path, PathBuf};

use self::contents::Contents;
use self::header::Header;
use super::auxiliary::AuxiliaryNodes;
use super::consistency::{NodePlace, Places};
use super::copies::NodeCopies;
use super::{Catalog, Problem, Subdomain, SubdomainNode};
use crate::error::InputError;
use crate::mesh::bounding_box::BoundingBox;
use crate::mesh::foreign;
use crate::source;

/// An open problem file with a valid catalog.
#[derive(Debug)]
pub struct ProblemFile {
    path: PathBuf,
    contents: Contents,
    catalog: Catalog,
    auxiliary: AuxiliaryNodes,
}

/// Signature of an HDF5 file.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

/// The error for a scene or a mesh, with the command that makes a problem file from it.
fn instead_of_problem(path: &Path) -> Option<InputError> {
    let head = source::head(path);
    if head.starts_with(HDF5) {
        return None;
    }
    let shown = path.display();
    let is_scene = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    let message = match foreign::instead_of_scene(path, &head) {
        _ if is_scene => format!(
            "is a scene; expected a problem file: contact-dd-partition {shown} -o {} makes one of it",
            path.with_extension("h5").display()
        ),
        Some(what) if path.extension().is_none_or(|ending| ending != "h5") => format!(
            "is {what}; expected a problem file, which contact-dd-partition makes of a scene in TOML that names the mesh"
        ),
        _ => return None,
    };
    Some(InputError::new(message))
}

impl ProblemFile {
    /// Opens a problem file and checks its catalog: shapes, offsets, names, materials and Γ.
    ///
    /// # Errors
    /// The dataset that is missing or invalid.
    pub fn open(path: &Path) -> Result<Self, InputError> {
        Self::open_unnamed(path).map_err(|error| error.in_file(path))
    }

    fn open_unnamed(path: &Path) -> Result<Self, InputError> {
        // The library distinguishes few reasons for which a file can't be opened.
        source::open(path, "a problem file")?;
        if let Some(error) = instead_of_problem(path) {
            return Err(error);
        }
        hdf5::silence_errors(true);
        // Locks fail on some network file systems, and are unnecessary, as no program writes a file in place under this
        // name.
        let file = hdf5::File::with_options()
            .with_fapl(|access| access.file_locking(false))
            .open(path)
            .map_err(|reason| {
                InputError::new(format!(
                    "isn't a whole HDF5 file ({reason}); expected one written by contact-dd-partition"
                ))
            })?;
        let header = Header::read(&file)?;
        let contents = Contents::open(&file, header.dim, header.plane)?;
        let mut catalog = catalog::read(&file, header, &contents)?;
        Ok(Self {
            auxiliary: catalog.add_auxiliary_nodes(),
            path: path.to_path_buf(),
            contents,
            catalog,
        })
    }

    /// An error about the file as a whole, found by comparing its parts.
    pub fn refuse(&self, error: InputError) -> InputError {
        error.in_file(&self.path)
    }

    /// The catalog of the whole problem, stored on every rank.
    pub fn catalog(&self) -> &Catalog {
        &self.catalog
    }

    /// Reads and checks the slice of one subdomain.
    ///
    /// # Errors
    /// The dataset and the invalid row.
    pub fn subdomain(&self, index: usize) -> Result<Subdomain, InputError> {
        let mut one = self.subdomains(index..index.saturating_add(1))?;
        one.pop().ok_or_else(|| {
            InputError::new(format!("there is no subdomain {index}")).in_file(&self.path)
        })
    }

    /// Reads and checks the slices of consecutive subdomains, each dataset in one go.
    ///
    /// # Errors
    /// The dataset and the invalid row.
    pub fn subdomains(&self, range: Range<usize>) -> Result<Vec<Subdomain>, InputError> {
        self.read_subdomains(range)
            .map_err(|error| error.in_file(&self.path))
    }

    /// Reads everything and, beyond the single slices, checks that subdomains agree on their nodes.
    ///
    /// # Errors
    /// The dataset and the invalid row.
    pub fn problem(&self) -> Result<Problem, InputError> {
        let subdomains = self.subdomains(0..self.catalog.subdomains.len())?;
        let mut copies = NodeCopies::default();
        for subdomain in &subdomains {
            copies.add(subdomain.index, subdomain.own_nodes());
        }
        if let Some(fault) = copies.check() {
            return Err(InputError::new(fault.message).in_file(&self.path));
        }
        let named = self.catalog.points.iter();
        let named = named.flat_map(|point| point.entries.iter().map(|&(node, _)| node));
        let place = |node: SubdomainNode| {
            let subdomain = &subdomains[node.subdomain as usize];
            let place = NodePlace {
                tag: subdomain.node_tags[node.node as usize],
                body: subdomain.body,
                at: subdomain.points[node.node as usize],
                is_auxiliary: node.node as usize >= subdomain.body_nodes(),
            };
            (node, place)
        };
        let places = Places {
            nodes: named.map(place).collect(),
            extent: BoundingBox::around(subdomains.iter().flat_map(|s| &s.points)).extent(),
            dim: self.catalog.dim,
            plane: self.catalog.plane,
        };
        for (row, point) in self.catalog.points.iter().enumerate() {
            (places.check(point, row)).map_err(|error| self.refuse(error))?;
        }
        Ok(Problem {
            catalog: self.catalog.clone(),
            subdomains,
        })
    }
}
