//! Checkpoints: digests by which the finished load steps of an unfinished result file are verified, and the data to
//! restore the rest of it.
//!
//! All columns have fixed places, and each load step has its rows in them: writing one step changes no other. A digest
//! for every column and step tells whether the rows are those written. The remainder of the file changes only at the
//! end; a copy from before is kept.

use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;

use hdf5::{Dataset, Result};
use serde::{Deserialize, Serialize};
use twox_hash::XxHash3_64;

/// Most bytes read at once.
const PIECE: usize = 1 << 20;

/// A digest of rows from row `first` of their column on: the sum of a hash (XXH3) of each row with its number,
/// independent of the order of writing and of the ranks that write.
pub(super) fn digest(first: usize, row_bytes: usize, rows: &[u8]) -> u64 {
    let rows = rows.chunks_exact(row_bytes.max(1));
    let hash = |(row, bytes): (u64, &[u8])| XxHash3_64::oneshot_with_seed(row, bytes);
    (first as u64..)
        .zip(rows)
        .map(hash)
        .fold(0, u64::wrapping_add)
}

/// A dataset by its place in the file.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Column {
    /// Path.
    name: String,
    first_byte: u64,
    row_bytes: usize,
    /// Number of rows, for each load step if they change.
    rows: usize,
    changes: bool,
}

impl Column {
    /// A dataset of `rows` rows: different ones in each of the `steps`, or the same in all.
    pub(super) fn new(dataset: &Dataset, rows: usize, steps: Option<usize>) -> Result<Self> {
        let bytes = dataset.size() * dataset.dtype()?.size();
        let place = dataset.offset().or((bytes == 0).then_some(0));
        Ok(Self {
            name: dataset.name(),
            first_byte: place.ok_or("a dataset has no place in the file")?,
            row_bytes: bytes / (rows * steps.unwrap_or(1)).max(1),
            rows,
            changes: steps.is_some(),
        })
    }

    /// Place and length in the file, for this number of load steps (bytes).
    fn bytes(&self, steps: usize) -> (u64, u64) {
        let steps = if self.changes { steps } else { 1 };
        let length = self.rows * self.row_bytes * steps;
        (self.first_byte, self.first_byte + length as u64)
    }

    /// The digest of its rows of load step `k`, read from the file.
    fn read(&self, file: &File, k: usize) -> io::Result<u64> {
        if k > 0 && !self.changes {
            return Ok(0);
        }
        let (mut sum, mut row) = (0_u64, k * self.rows);
        let end = row + self.rows;
        let at_once = (PIECE / self.row_bytes.max(1)).max(1);
        let mut bytes = vec![0; at_once * self.row_bytes];
        while row < end {
            let rows = at_once.min(end - row);
            let piece = &mut bytes[..rows * self.row_bytes];
            file.read_exact_at(piece, self.first_byte + (row * self.row_bytes) as u64)?;
            sum = sum.wrapping_add(digest(row, self.row_bytes, piece));
            row += rows;
        }
        Ok(sum)
    }
}

/// State of a result file after some finished load steps.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Length of the file (bytes).
    length: u64,
    columns: Vec<Column>,
    /// The parts of the file outside the columns, with their offsets.
    rest: Vec<(u64, Part)>,
    /// The digest of every column in each finished load step.
    digests: Vec<Vec<u64>>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Part(#[serde(with = "crate::bytes")] Vec<u8>);

impl Checkpoint {
    /// The checkpoint of a flushed file for this number of `steps`, none of them finished.
    ///
    /// # Errors
    /// The file can't be read.
    pub(super) fn new(file: &File, columns: Vec<Column>, steps: usize) -> io::Result<Self> {
        let length = file.metadata()?.len();
        let mut taken: Vec<(u64, u64)> = columns.iter().map(|c| c.bytes(steps)).collect();
        taken.sort_unstable();
        let (mut rest, mut at) = (Vec::new(), 0);
        for (start, end) in taken.into_iter().chain([(length, length)]) {
            if start > at {
                let mut bytes = vec![0; (start - at) as usize];
                file.read_exact_at(&mut bytes, at)?;
                rest.push((at, Part(bytes)));
            }
            at = at.max(end);
        }
        Ok(Self {
            length,
            columns,
            rest,
            digests: Vec::new(),
        })
    }

    /// Number of finished load steps.
    pub(super) fn finished(&self) -> usize {
        self.digests.len()
    }

    /// Finishes a load step with the digests of its data, column by column, after verifying them against the file.
    ///
    /// # Errors
    /// The first column whose rows differ from those written.
    pub(super) fn finish_step(&mut self, file: &File, digests: Vec<u64>) -> Result<(), String> {
        self.digests.push(digests);
        self.check(file, self.finished() - 1)
    }

    /// Verifies all finished load steps.
    ///
    /// # Errors
    /// The first column whose rows differ from those written.
    pub(super) fn check_all(&self, file: &File) -> Result<(), String> {
        (0..self.finished()).try_for_each(|k| self.check(file, k))
    }

    fn check(&self, file: &File, k: usize) -> Result<(), String> {
        for (column, &written) in self.columns.iter().zip(&self.digests[k]) {
            let why = match column.read(file, k) {
                Ok(found) if found == written => continue,
                Ok(_) => String::new(),
                Err(error) => format!(" ({error})"),
            };
            return Err(format!(
                "{} of load step {} isn't what was written{why}",
                column.name,
                k + 1
            ));
        }
        Ok(())
    }

    /// Restores the file to the state before any later load step.
    ///
    /// # Errors
    /// The file can't be written.
    pub(super) fn restore(&self, file: &File) -> io::Result<()> {
        for (at, Part(bytes)) in &self.rest {
            file.write_all_at(bytes, *at)?;
        }
        file.set_len(self.length)?;
        file.sync_data()
    }
}
