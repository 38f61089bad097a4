//! Bytes of a problem file changed at random, in its headers and in its data: a file with digest is refused before the
//! HDF5 library reads it; without one, as written by other programs, a crash of the library is reported as a message.

use std::fs;
use std::path::Path;

use contact_dd_partition::problem::digest::Digest;
use contact_dd_partition::problem::trial;

use super::change::{Change, Type};
use super::everything::everything;
use super::walk::{places, without_locks};
use super::{Job, solve};

/// Random numbers by Marsaglia's xorshift.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end as u64) as usize
    }

    /// Changes one to eight bytes, half of them where HDF5 has its first headers.
    fn damage(&mut self, bytes: &mut [u8]) {
        let end = match self.below(2) {
            0 => bytes.len().min(HEADERS),
            _ => bytes.len(),
        };
        for _ in 0..=self.below(8) {
            bytes[self.below(end)] ^= 1 + self.below(255) as u8;
        }
    }
}

/// Places of most headers of the small problem (bytes).
const HEADERS: usize = 6000;

/// Size of the trailer after the end of the HDF5 file (bytes).
const TRAILER: usize = 40;

/// A file as other programs write it: strings of variable length, which are in HDF5's global heap, and no digest.
fn of_another_program(path: &Path) {
    everything().write(path).unwrap();
    for place in places(path) {
        if let "name" | "title" | "format" | "warnings" = place.name.as_str() {
            Change::Retype(Type::Text).apply(path, &place);
        }
    }
}

#[test]
fn no_changed_byte_reaches_the_hdf5_library_unless_the_digest_is_gone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("problem.h5");
    everything().write(&path).unwrap();
    let whole = fs::read(&path).unwrap();
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for _ in 0..300 {
        let mut bytes = whole.clone();
        let end = bytes.len() - TRAILER;
        random.damage(&mut bytes[..end]);
        if bytes == whole {
            continue;
        }
        fs::write(&path, &bytes).unwrap();
        let error = trial::check(&path, || false).unwrap_err().to_string();
        assert!(error.contains("problem.h5: is damaged"), "{error}");
    }
}

#[test]
fn whoever_opens_a_file_to_write_to_it_drops_its_digest() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("problem.h5");
    everything().write(&path).unwrap();
    assert_eq!(Digest::of(&path), Ok(Digest::Right));
    drop(without_locks().open(&path).unwrap());
    assert_eq!(Digest::of(&path), Ok(Digest::Right));
    let file = without_locks().open_rw(&path).unwrap();
    let gaps = file.dataset("contact/gap").unwrap();
    let doubled: Vec<f64> = gaps.read_raw().unwrap();
    let doubled: Vec<f64> = doubled.iter().map(|gap| 2.0 * gap).collect();
    gaps.write_raw(&doubled).unwrap();
    drop((gaps, file));
    assert_eq!(Digest::of(&path), Ok(Digest::Absent));
    let job = Job {
        what: "an edited file".into(),
        path,
        ranks: 2,
        codes: &[0],
    };
    assert_eq!(job.defect(), None);
}

#[test]
fn without_a_digest_what_crashes_the_library_or_keeps_it_is_an_error_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("whole.h5");
    of_another_program(&path);
    assert_eq!(Digest::of(&path), Ok(Digest::Absent));
    let whole = fs::read(&path).unwrap();
    // Every collection of the heap: its size, then objects with their number, a count and their size.
    let heaps: Vec<usize> = (whole.windows(4).enumerate())
        .filter_map(|(at, mark)| (mark == b"GCOL").then_some(at))
        .collect();
    assert!(!heaps.is_empty());
    let mut jobs = Vec::new();
    let mut add = |bytes: &[u8]| {
        let path = folder.path().join(format!("{}.h5", jobs.len()));
        fs::write(&path, bytes).unwrap();
        jobs.push(Job {
            what: format!("file {}", jobs.len()),
            path,
            ranks: if jobs.len() % 16 == 0 { 2 } else { 0 },
            codes: &[0, 2, 3, 4],
        });
    };
    for &heap in &heaps {
        for (at, value) in [
            (8, 0),
            (8, u64::MAX),
            (24, 0),
            (24, u64::MAX - 15),
            (24, 1 << 20),
        ] {
            let mut bytes = whole.clone();
            bytes[heap + at..heap + at + 8].copy_from_slice(&u64::to_le_bytes(value));
            add(&bytes);
        }
    }
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    for _ in 0..40 {
        let mut bytes = whole.clone();
        random.damage(&mut bytes);
        add(&bytes);
    }
    let defects = solve(&jobs);
    assert!(defects.is_empty(), "{}", defects.join("\n"));
}
