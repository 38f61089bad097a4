//! Parallel writing of the result file: its datasets have fixed places, so that every rank writes its results itself,
//! without sending them to the root.

use std::fs::{File, OpenOptions};
use std::os::unix::fs::{FileExt, MetadataExt};
use std::path::{Path, PathBuf};

use contact_dd_partition::destination;
use contact_dd_partition::error::OutputError;
use serde::{Deserialize, Serialize};

use super::super::result::SubdomainResults;
use super::Layout;
use super::grid::GridPlacement;

/// File systems on which ranks of several hosts see each other's writes immediately, by Linux' magic numbers: Lustre,
/// GPFS, BeeGFS, CephFS, OrangeFS.
const COHERENT: [u32; 5] = [
    0x0bd0_0bd0,
    0x4750_4653,
    0x1983_0326,
    0x00c3_6400,
    0x2003_0528,
];

/// The places of the datasets in the file.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Places {
    /// Path of the unfinished file.
    pub(super) path: PathBuf,
    /// Inode number.
    pub(super) inode: u64,
    /// The first byte of every dataset of the grid.
    pub(super) datasets: Vec<u64>,
    /// Number of load steps already in it.
    pub(super) finished: usize,
}

/// The result file on a rank that writes its own part.
#[derive(Debug)]
pub struct FileBeside {
    placement: GridPlacement,
    datasets: Vec<u64>,
    step: usize,
    /// Digest of each dataset as written in this load step.
    digests: Vec<u64>,
    file: File,
    /// Final name.
    path: PathBuf,
}

impl FileBeside {
    /// Opens the file that the root created for `path`; `None` if this rank doesn't see it, or if several `hosts` can't
    /// write to it at once.
    pub fn open(places: &Places, path: &Path, layout: &Layout, hosts: usize) -> Option<Self> {
        let file = OpenOptions::new().write(true).open(&places.path).ok()?;
        let is_same = file.metadata().ok()?.ino() == places.inode;
        let is_coherent = || {
            let status = rustix::fs::fstatfs(&file).ok()?;
            Some(COHERENT.contains(&(status.f_type as u32)))
        };
        (is_same && (hosts == 1 || is_coherent()?)).then(|| Self {
            placement: GridPlacement::new(layout),
            digests: vec![0; places.datasets.len()],
            datasets: places.datasets.clone(),
            step: places.finished,
            file,
            path: path.to_path_buf(),
        })
    }

    /// Writes the results of consecutive subdomains.
    ///
    /// # Errors
    /// The file can't be written, or `results` doesn't have the sizes of the layout.
    pub fn write(&mut self, results: &SubdomainResults) -> Result<(), OutputError> {
        let mut failed = None;
        let Self {
            placement,
            datasets,
            digests,
            file,
            ..
        } = self;
        let placed = placement.each(results, self.step, |dataset, row, list| {
            placement.sum(&mut digests[dataset], row, list);
            let at = datasets[dataset] + (row * list.row_bytes()) as u64;
            let written = file.write_all_at(list.bytes(), at);
            failed = failed.take().or(written.err());
            Ok(())
        });
        placed.map_err(|error| destination::failure(&self.path, error))?;
        failed.map_or(Ok(()), |error| Err(destination::failure(&self.path, error)))
    }

    /// Ends a load step, and makes it visible to all hosts; subsequent results belong to the next one. Returns the
    /// digests of the datasets.
    ///
    /// # Errors
    /// An error of the system.
    pub fn finish_step(&mut self, hosts: usize) -> Result<Vec<u64>, OutputError> {
        self.step += 1;
        if hosts > 1 {
            (self.file.sync_data()).map_err(|error| destination::failure(&self.path, error))?;
        }
        let none = vec![0; self.digests.len()];
        Ok(std::mem::replace(&mut self.digests, none))
    }
}
