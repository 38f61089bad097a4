//! The result file: `/VTKHDF`, `/contact`, `/convergence` and the attribute `report`.
//!
//! Every subdomain and every contact constraint has a fixed place in the file, so that results are written when they
//! arrive, in any order. Subdomains are written in slabs, so that memory holds one slab at a time. After a load step
//! the file is unfinished but can be resumed, with the state [`kept`] beside it.

pub mod beside;
mod checkpoint;
pub(super) mod column;
mod contact_table;
mod grid;
pub mod kept;
mod layout;

use std::fs::{self, OpenOptions};
use std::io;
use std::ops::Range;
use std::os::unix::fs::MetadataExt;
use std::path::Path;

use contact_dd_partition::destination::Destination;
use contact_dd_partition::error::OutputError;
use hdf5::types::VarLenUnicode;
use hdf5::{File, FileBuilder};

use self::beside::Places;
use self::checkpoint::Checkpoint;
use self::contact_table::ContactTables;
use self::grid::Grid;
use self::kept::{Kept, forget};
pub use self::layout::Layout;
use super::result::SubdomainResults;
use crate::fem::contact_state::ContactRow;
use crate::sweep::SweepRecord;

/// A result file during writing, under a temporary name in the folder of the final one.
///
/// If dropped without [`finish`](Self::finish), it is removed, unless load steps are finished and [`kept`](Self::keep);
/// a file of the final name stays unchanged.
#[derive(Debug)]
pub struct ResultFile {
    grid: Grid,
    contacts: ContactTables,
    has_steps: bool,
    /// Number of load steps; 1 if the problem has none.
    steps: usize,
    /// Number of the load step that is being written.
    step: usize,
    /// The digests of load steps written since the last one was kept.
    digests: Vec<Vec<u64>>,
    /// The load steps kept so far.
    kept: Option<Kept>,
    // Closed before `destination` removes or renames it: fields are dropped in this order.
    file: File,
    destination: Destination,
}

impl ResultFile {
    /// Creates the file and everything in it that doesn't depend on the solution.
    ///
    /// # Errors
    /// The file can't be created: a missing folder, no permission, a name already in use.
    pub fn create(path: &Path, layout: &Layout) -> Result<Self, OutputError> {
        Self::open(Destination::new(path)?, layout, None)
    }

    /// Opens the file of a stopped run, to continue after its finished load steps, which are [checked](Kept::check).
    ///
    /// # Errors
    /// The file can't be opened or written, or has another layout.
    pub fn resume(path: &Path, layout: &Layout, kept: Kept) -> Result<Self, OutputError> {
        let destination = Destination::kept(path)?;
        let file = OpenOptions::new().write(true).open(destination.temporary());
        let restored = file.and_then(|file| kept.checkpoint.restore(&file));
        restored.map_err(|error| destination.failure(error))?;
        Self::open(destination, layout, Some(kept))
    }

    fn open(
        destination: Destination,
        layout: &Layout,
        kept: Option<Kept>,
    ) -> Result<Self, OutputError> {
        let make = || {
            let file = match kept {
                Some(_) => without_locks().open_rw(destination.temporary())?,
                None => without_locks().create(destination.temporary())?,
            };
            if kept.is_none() {
                attribute(&file, "title", &layout.title)?;
                attribute(&file, "units", layout.units.length())?;
                if let Some(plane) = layout.plane {
                    attribute(&file, "plane", plane.name())?;
                }
            }
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
                step: kept.as_ref().map_or(0, Kept::finished),
                digests: Vec::new(),
                kept,
                file,
                destination,
            }),
            Err(error) => Err(failure(&destination, &error)),
        }
    }

    /// The ranges of subdomains best written at once; together all subdomains, in their order.
    pub fn slabs(&self) -> Vec<Range<usize>> {
        self.grid.slabs()
    }

    /// Writes the results of consecutive subdomains.
    ///
    /// # Errors
    /// The file can't be written, or `results` doesn't have the sizes of the layout.
    pub fn write_subdomains(&mut self, results: &SubdomainResults) -> Result<(), OutputError> {
        let written = self.grid.write(results, self.step);
        written.map_err(|error| failure(&self.destination, &error))
    }

    /// Offsets of the datasets that other ranks fill themselves; `None` if one isn't allocated in the file yet, as in
    /// the file of an older version.
    pub fn places(&self) -> Option<Places> {
        let path = self.destination.temporary().to_path_buf();
        Some(Places {
            inode: fs::metadata(&path).ok()?.ino(),
            datasets: self.grid.places()?,
            finished: self.step,
            path,
        })
    }

    /// Marks all subdomains as written in this load step, after the ranks wrote their own to the [shared file](beside),
    /// with the `digests` of their data.
    pub fn take_as_written(&mut self, digests: &[Vec<u64>]) {
        self.grid.take_as_written(digests);
    }

    /// Writes contact constraints, each at its place in the table of its contact.
    ///
    /// # Errors
    /// The file can't be written, or a row has no place in the layout.
    pub fn write_contacts(&mut self, rows: &[ContactRow]) -> Result<(), OutputError> {
        let written = self.contacts.write(rows, self.step);
        written.map_err(|error| failure(&self.destination, &error))
    }

    /// Ends a load step: subsequent results belong to the next one.
    ///
    /// # Errors
    /// A subdomain or a contact constraint is missing.
    pub fn finish_step(&mut self) -> Result<(), OutputError> {
        let mut finish = || {
            let grid = self.grid.finish_step()?;
            Ok([grid, self.contacts.finish_step()?].concat())
        };
        let digests = finish().map_err(|error| failure(&self.destination, &error))?;
        self.digests.push(digests);
        self.step += 1;
        Ok(())
    }

    /// Keeps the finished load steps even if the run is stopped, with the `state` from which it continues, once the
    /// results are verified on disk.
    ///
    /// # Errors
    /// The file can't be written; what was kept before remains.
    pub fn keep(&mut self, state: &[u8]) -> Result<(), OutputError> {
        let Self {
            grid,
            contacts,
            steps,
            destination,
            ..
        } = self;
        let of_system = |error: io::Error| destination.failure(error);
        let of_hdf5 = |error: hdf5::Error| failure(destination, &error);
        self.file.flush().map_err(of_hdf5)?;
        let file = fs::File::open(destination.temporary()).map_err(of_system)?;
        file.sync_data().map_err(of_system)?;
        if self.kept.is_none() {
            let columns = grid
                .columns(*steps)
                .and_then(|grid| Ok([grid, contacts.columns()?].concat()));
            let columns = columns.map_err(of_hdf5)?;
            let checkpoint = Checkpoint::new(&file, columns, *steps).map_err(of_system)?;
            self.kept = Some(Kept::new(checkpoint));
        }
        let Some(kept) = &mut self.kept else {
            return Ok(());
        };
        for digests in self.digests.drain(..) {
            let finished = kept.checkpoint.finish_step(&file, digests);
            finished.map_err(|why| destination.failure(why))?;
        }
        if !destination.is_kept() {
            // The state of an older run doesn't belong to this one.
            forget(destination.path())?;
            destination.keep()?;
        }
        kept.state = state.to_vec();
        kept.write(destination.path())
    }

    /// Writes `/convergence`: a row for the start and one for every sweep, from the history of every load step. Called
    /// once.
    ///
    /// # Errors
    /// The file can't be written.
    pub fn write_convergence<'a>(
        &mut self,
        histories: impl Iterator<Item = &'a [SweepRecord]>,
    ) -> Result<(), OutputError> {
        let rows: Vec<(usize, &SweepRecord)> = histories
            .enumerate()
            .flat_map(|(step, history)| history.iter().map(move |row| (step, row)))
            .collect();
        let write = || {
            let group = self.file.create_group("convergence")?;
            if self.has_steps {
                column::whole(&group, "step", rows.iter().map(|row| row.0 as i64))?;
            }
            column::whole(&group, "residual", rows.iter().map(|row| row.1.residual))?;
            column::whole(&group, "active", rows.iter().map(|row| row.1.active as i64))?;
            column::whole(&group, "seconds", rows.iter().map(|row| row.1.seconds))
        };
        write().map_err(|error: hdf5::Error| failure(&self.destination, &error))
    }

    /// Adds the report, flushes the file to disk and gives it its final name.
    ///
    /// # Errors
    /// The file can't be written, or results are missing.
    pub fn finish(self, report_json: &str) -> Result<(), OutputError> {
        let Self {
            grid,
            contacts,
            steps,
            step,
            kept,
            file,
            destination,
            ..
        } = self;
        let write = move || {
            if step != steps {
                return Err(format!("step {step} is missing").into());
            }
            // Open groups would keep the file from being closed.
            drop((grid, contacts));
            attribute(&file, "report", report_json)?;
            file.flush()?;
            file.close()
        };
        write().map_err(|error| failure(&destination, &error))?;
        let path = destination.path().to_path_buf();
        destination.commit()?;
        // The result is complete; a state file left behind without its load steps does no harm.
        let _ = kept.map(|_| forget(&path));
        Ok(())
    }
}

/// Writes text of any length; attributes of fixed length are limited to 64 KiB.
fn attribute(file: &File, name: &str, text: &str) -> hdf5::Result<()> {
    let text: VarLenUnicode = text
        .parse()
        .map_err(|error| hdf5::Error::from(format!("{name}: {error}")))?;
    let attribute = file
        .attr(name)
        .or_else(|_| file.new_attr::<VarLenUnicode>().create(name))?;
    attribute.write_scalar(&text)
}

/// No locks: a temporary file has no other reader, and not every file system supports them.
fn without_locks() -> FileBuilder {
    let mut options = File::with_options();
    options.with_fapl(|access| access.file_locking(false));
    options
}

fn failure(destination: &Destination, error: &hdf5::Error) -> OutputError {
    destination.failure(error)
}
