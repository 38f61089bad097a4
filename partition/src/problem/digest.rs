//! The digest of a problem file: a trailer after the HDF5 data, by which a damaged file is detected before the HDF5
//! library, which may crash on it, opens it.
//!
//! HDF5 ignores data after its end of file, and truncates them whenever it opens the file for writing. So the digest is
//! lost with the first edit of the file.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use twox_hash::XxHash3_128;

use crate::error::InputError;
use crate::source;

/// The last bytes of a file with a digest.
const MARK: &[u8; 16] = b"contact-dd XXH3\n";

/// Size of the trailer (bytes): the digest, the length of the data before it, both in little-endian order, and the
/// mark.
const TRAILER: usize = 16 + 8 + MARK.len();

/// Size of a read (bytes).
const PIECE: usize = 1 << 18;

/// State of a file's digest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Digest {
    /// The digest agrees with the file.
    Right,
    /// No digest: another program wrote or edited the file.
    Absent,
}

impl Digest {
    /// Reads all of a file and compares it with its digest, if any.
    ///
    /// # Errors
    /// A file that can't be read, or whose digest differs.
    pub fn of(path: &Path) -> Result<Self, InputError> {
        let mut file = source::open(path, "a problem file")?;
        let unreadable = |reason| InputError::new(format!("can't be read: {reason}"));
        let Some((digest, length)) = trailer(&mut file).map_err(unreadable)? else {
            return Ok(Self::Absent);
        };
        match digest == of_bytes(&mut file, length).map_err(unreadable)? {
            true => Ok(Self::Right),
            false => Err(InputError::new(
                "is damaged: its digest doesn't match; expected the file as contact-dd-partition wrote it. Copy \
                 it again, or make it again",
            )),
        }
    }
}

/// Appends the digest to a complete HDF5 file.
///
/// # Errors
/// The reason given by the system.
pub fn append(path: &Path) -> io::Result<()> {
    let mut file = File::options().read(true).append(true).open(path)?;
    let length = file.metadata()?.len();
    let digest = of_bytes(&mut file, length)?;
    let parts = [&digest.to_le_bytes(), &length.to_le_bytes()[..], MARK];
    file.write_all(&parts.concat())
}

/// The digest at the end of a file, and the number of bytes before it.
fn trailer(file: &mut File) -> io::Result<Option<(u128, u64)>> {
    let Some(length) = file.metadata()?.len().checked_sub(TRAILER as u64) else {
        return Ok(None);
    };
    let (mut digest, mut stated, mut mark) = ([0; 16], [0; 8], [0; MARK.len()]);
    file.seek(SeekFrom::Start(length))?;
    for part in [&mut digest[..], &mut stated, &mut mark] {
        file.read_exact(part)?;
    }
    // With another length, something was appended to a file with its trailer.
    let is_there = mark == *MARK && u64::from_le_bytes(stated) == length;
    Ok(is_there.then_some((u128::from_le_bytes(digest), length)))
}

/// XXH3 of 128 bits of the first `length` bytes.
fn of_bytes(file: &mut File, length: u64) -> io::Result<u128> {
    file.rewind()?;
    let mut rest = file.take(length);
    let mut hasher = XxHash3_128::new();
    let mut piece = vec![0; PIECE];
    loop {
        match rest.read(&mut piece)? {
            0 => return Ok(hasher.finish_128()),
            read => hasher.write(&piece[..read]),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_digest_holds_for_its_bytes_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        for length in [0, 1, TRAILER, PIECE, 2 * PIECE + 7] {
            let bytes: Vec<u8> = (0..length).map(|i| (i * i) as u8).collect();
            fs::write(&path, &bytes).unwrap();
            assert_eq!(Digest::of(&path), Ok(Digest::Absent));
            append(&path).unwrap();
            assert_eq!(Digest::of(&path), Ok(Digest::Right));
            let whole = fs::read(&path).unwrap();
            assert_eq!(whole.len(), length + TRAILER);
            for at in (0..length).step_by(length.div_ceil(5).max(1)) {
                let mut changed = whole.clone();
                changed[at] ^= 1;
                fs::write(&path, changed).unwrap();
                let error = Digest::of(&path).unwrap_err().to_string();
                assert!(error.contains("is damaged"), "{error}");
            }
        }
    }
}
