//! A checkpoint: how far sweeps had come, for another run of the same problem to go on from there.
//!
//! The file holds a line that names it, a digest of the rest, and the rest. The factorization isn't
//! in it: it is far larger than all else and the same again.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use blake3::Hasher;
use contact_dd_partition::destination::{failure, write_bytes};
use contact_dd_partition::error::OutputError;
use serde::{Deserialize, Serialize};

use crate::contact::pair::PairMemory;
use crate::interface::operator::Interface;
use crate::interface::s_con::ConState;
use crate::sweep::progress::Progress;

/// The first bytes of the file.
const HEAD: &[u8] = b"contact-dd-mpi checkpoint 3\n";

/// A digest of bytes.
pub type Digest = [u8; blake3::OUT_LEN];

/// What a run leaves to the one that goes on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// The program's version.
    pub version: String,
    /// The digest of the problem file.
    pub problem: Digest,
    /// The method's name.
    pub method: String,
    /// The load step that the sweeps are of.
    pub step: usize,
    /// U, and what the method remembers.
    pub progress: Progress,
    /// The answers of the pairs at U.
    pub state: ConState,
    /// What the pairs remember.
    pub memories: Vec<PairMemory>,
}

impl Checkpoint {
    /// Writes the checkpoint; the one that has the name takes that of `older`.
    ///
    /// # Errors
    /// The file can't be written.
    pub fn write(&self, path: &Path, older: &Path) -> Result<(), OutputError> {
        let rest = postcard::to_stdvec(self).map_err(|error| failure(path, error))?;
        let digest = blake3::hash(&rest);
        // A run that is killed in between leaves the older one, and a restart knows its name.
        if path.exists() {
            fs::rename(path, older).map_err(|error| failure(older, error))?;
        }
        write_bytes(path, |file| {
            file.write_all(HEAD)?;
            file.write_all(digest.as_bytes())?;
            file.write_all(&rest)
        })
    }

    /// Reads a checkpoint.
    ///
    /// # Errors
    /// What is wrong with the file, in words.
    pub fn read(path: &Path) -> Result<Self, String> {
        let bytes = fs::read(path).map_err(|error| error.to_string())?;
        let rest = (bytes.strip_prefix(HEAD)).ok_or("it isn't a checkpoint of this version")?;
        let (digest, rest) = rest
            .split_first_chunk::<{ blake3::OUT_LEN }>()
            .ok_or("it is cut short")?;
        if blake3::hash(rest) != *digest {
            return Err("it is damaged".into());
        }
        postcard::from_bytes(rest).map_err(|error| error.to_string())
    }

    /// Whether it has as many unknowns and pairs as `interface`.
    pub fn fits(&self, interface: &Interface) -> bool {
        self.progress.u.len() == interface.len
            && self.memories.len() == interface.pair_traces.len()
            && self.state.responses.len() == interface.pair_traces.len()
    }
}

/// The digest of a file.
///
/// # Errors
/// It can't be read.
pub fn digest(path: &Path) -> io::Result<Digest> {
    let mut hasher = Hasher::new();
    hasher.update_reader(File::open(path)?)?;
    Ok(*hasher.finalize().as_bytes())
}
