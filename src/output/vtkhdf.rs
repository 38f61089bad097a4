//! The result file: `/VTKHDF`, `/contact`, `/convergence` and the attribute `report`.
//!
//! Every subdomain and every contact condition has its place from the start, so each is written
//! when it arrives, in any order; subdomains in slabs, so that one slab at a time is in memory.

mod column;
mod contact_table;
mod grid;
mod time_series;

use std::ops::Range;
use std::path::Path;

use contact_dd_partition::destination::Destination;
use contact_dd_partition::error::OutputError;
use contact_dd_partition::problem::{Catalog, ContactSummary, SubdomainSummary};
use contact_dd_partition::scene::units::Units;
use hdf5::File;
use hdf5::types::VarLenUnicode;

use self::contact_table::ContactTables;
use self::grid::Grid;
use super::result::{ContactRow, ConvergenceRow, PartitionSize, SubdomainResults};

/// How much room everything takes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// One entry a subdomain.
    pub partitions: Vec<PartitionSize>,
    /// One entry a contact.
    pub contacts: Vec<ContactSummary>,
    /// What every load step stands at on the axis of time; none where the problem has none.
    pub times: Vec<f64>,
    /// Whether there are stresses.
    pub stress: bool,
    /// The units that its numbers are meant in.
    pub units: Units,
}

impl Layout {
    /// The layout for `catalog`; `connectivity` has, for every subdomain, the sum of the number of
    /// nodes over its cells.
    pub fn new(catalog: &Catalog, connectivity: &[usize], stress: bool) -> Self {
        let size = |(subdomain, &connectivity): (&SubdomainSummary, &usize)| PartitionSize {
            points: subdomain.nodes,
            cells: subdomain.cells,
            connectivity,
        };
        Self {
            partitions: catalog
                .subdomains
                .iter()
                .zip(connectivity)
                .map(size)
                .collect(),
            contacts: catalog.contacts.clone(),
            times: catalog.steps.iter().map(|step| step.time).collect(),
            stress,
            units: catalog.units,
        }
    }
}

/// A result file that is being written, under a temporary name in the folder of the final one.
///
/// Dropped without [`finish`](Self::finish) it leaves nothing behind, and what stood under the
/// final name stays.
#[derive(Debug)]
pub struct ResultFile {
    grid: Grid,
    contacts: ContactTables,
    has_steps: bool,
    /// Number of load steps, one where the problem has none.
    steps: usize,
    /// The one that is being written.
    step: usize,
    // Closed before `destination` removes or renames it: fields are dropped in this order.
    file: File,
    destination: Destination,
}

impl ResultFile {
    /// Makes the file and everything in it that doesn't depend on the solution.
    ///
    /// # Errors
    /// The file can't be made: no such folder, no permission, a name that something else has.
    pub fn create(path: &Path, layout: &Layout) -> Result<Self, OutputError> {
        let destination = Destination::new(path)?;
        let make = || {
            let file = File::with_options()
                // A temporary file has no other reader, and not every file system can lock.
                .with_fapl(|access| access.file_locking(false))
                .create(destination.temporary())?;
            attribute(&file, "units", layout.units.length())?;
            let grid = Grid::create(&file, layout)?;
            let contacts = ContactTables::create(&file, &layout.contacts, layout.times.len())?;
            Ok((file, grid, contacts))
        };
        match make() {
            Ok((file, grid, contacts)) => Ok(Self {
                grid,
                contacts,
                has_steps: !layout.times.is_empty(),
                steps: layout.times.len().max(1),
                step: 0,
                file,
                destination,
            }),
            Err(error) => Err(failure(&destination, &error)),
        }
    }

    /// The runs of subdomains that are best written at once: all subdomains, in their order.
    pub fn slabs(&self) -> Vec<Range<usize>> {
        self.grid.slabs()
    }

    /// Writes what belongs to consecutive subdomains.
    ///
    /// # Errors
    /// The file can't be written, or `results` doesn't have the sizes of the layout.
    pub fn write_subdomains(&mut self, results: &SubdomainResults) -> Result<(), OutputError> {
        self.grid
            .write(results, self.step)
            .map_err(|error| failure(&self.destination, &error))
    }

    /// Writes contact conditions, each at its place in the table of its contact.
    ///
    /// # Errors
    /// The file can't be written, or a row has no place in the layout.
    pub fn write_contacts(&mut self, rows: &[ContactRow]) -> Result<(), OutputError> {
        self.contacts
            .write(rows, self.step)
            .map_err(|error| failure(&self.destination, &error))
    }

    /// Ends a load step: what is written from now on belongs to the next one.
    ///
    /// # Errors
    /// A subdomain or a contact condition is missing.
    pub fn finish_step(&mut self) -> Result<(), OutputError> {
        let grid = self.grid.finish_step();
        grid.and_then(|()| self.contacts.finish_step())
            .map_err(|error| failure(&self.destination, &error))?;
        self.step += 1;
        Ok(())
    }

    /// Writes `/convergence`: a row for the start and one for every sweep, load step by load step. Called
    /// once.
    ///
    /// # Errors
    /// The file can't be written.
    pub fn write_convergence(&mut self, rows: &[ConvergenceRow]) -> Result<(), OutputError> {
        let write = || {
            let group = self.file.create_group("convergence")?;
            if self.has_steps {
                column::whole(&group, "step", rows.iter().map(|row| row.step as i64))?;
            }
            column::whole(&group, "residual", rows.iter().map(|row| row.residual))?;
            column::whole(&group, "active", rows.iter().map(|row| row.active as i64))?;
            column::whole(&group, "seconds", rows.iter().map(|row| row.seconds))
        };
        write().map_err(|error: hdf5::Error| failure(&self.destination, &error))
    }

    /// Adds the report, brings the file to the disk and gives it its name.
    ///
    /// # Errors
    /// The file can't be written, or results are missing.
    pub fn finish(self, report_json: &str) -> Result<(), OutputError> {
        let Self {
            grid,
            contacts,
            steps,
            step,
            file,
            destination,
            ..
        } = self;
        let write = move || {
            if step != steps {
                return Err(format!("step {step} is missing").into());
            }
            // What is open keeps a file from being closed.
            drop((grid, contacts));
            attribute(&file, "report", report_json)?;
            file.flush()?;
            file.close()
        };
        write().map_err(|error| failure(&destination, &error))?;
        destination.commit()
    }
}

/// Writes text of any length: an attribute of fixed length ends at 64 KiB.
fn attribute(file: &File, name: &str, text: &str) -> hdf5::Result<()> {
    let text: VarLenUnicode = text
        .parse()
        .map_err(|error| hdf5::Error::from(format!("{name}: {error}")))?;
    let attribute = file.new_attr::<VarLenUnicode>().create(name)?;
    attribute.write_scalar(&text)
}

fn failure(destination: &Destination, error: &hdf5::Error) -> OutputError {
    destination.failure(error)
}
