//! Checkpoints: load steps that are kept for a restart.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use contact_dd_partition::destination::unfinished;

use super::*;

const CELLS: [usize; 3] = [3, 1, 2];

fn in_steps() -> Layout {
    let mut layout = layout(&CELLS, &[2, 3]);
    layout.times = vec![0.5, 0.75, 1.0];
    layout
}

/// Writes load step `k`, and a checkpoint whose state names it.
fn write_step(file: &mut ResultFile, k: usize) {
    let mut results = strips(0, &CELLS);
    let moved = results.displacement.iter_mut();
    moved.for_each(|u| u[0] += k as f64);
    file.write_subdomains(&results).unwrap();
    let rows = [row(0, 0), row(1, 0), row(0, 1), row(1, 1), row(1, 2)];
    file.write_contacts(&rows).unwrap();
    file.finish_step().unwrap();
    if k < 2 {
        file.keep(format!("after {k}").as_bytes()).unwrap();
    }
}

/// Restarts after the steps that are kept for `path`, and returns their number.
fn go_on(path: &Path) -> usize {
    let kept = Kept::read(path).unwrap().unwrap();
    let state = String::from_utf8(kept.state.clone()).unwrap();
    let done: usize = state.strip_prefix("after ").unwrap().parse().unwrap();
    kept.check(path).unwrap();
    let mut file = ResultFile::resume(path, &in_steps(), kept).unwrap();
    (done + 1..3).for_each(|k| write_step(&mut file, k));
    file.finish("{}").unwrap();
    done + 1
}

/// The bytes of all that has numbers.
fn numbers(path: &Path) -> Vec<Vec<f64>> {
    let file = File::open(path).unwrap();
    let (mut groups, mut found) = (vec![file.as_group().unwrap()], Vec::new());
    while let Some(group) = groups.pop() {
        groups.extend(group.groups().unwrap());
        let datasets = group.datasets().unwrap();
        found.extend(
            datasets
                .iter()
                .map(|dataset| dataset.read_raw::<f64>().unwrap()),
        );
    }
    found
}

struct Folder(tempfile::TempDir);

impl Folder {
    /// A folder with a run that ended after `steps` load steps.
    fn after(steps: Range<usize>) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        let mut file = ResultFile::create(&folder.result(), &in_steps()).unwrap();
        steps.for_each(|k| write_step(&mut file, k));
        folder
    }

    fn result(&self) -> PathBuf {
        self.0.path().join("result.vtkhdf")
    }

    fn unfinished(&self) -> PathBuf {
        unfinished(&self.result())
    }

    fn state(&self) -> PathBuf {
        self.0.path().join("result.vtkhdf.unfinished.state")
    }
}

/// The file of a run that is never stopped.
fn expected() -> Vec<Vec<f64>> {
    let folder = Folder::after(0..0);
    let mut file = ResultFile::create(&folder.result(), &in_steps()).unwrap();
    (0..3).for_each(|k| write_step(&mut file, k));
    file.finish("{}").unwrap();
    numbers(&folder.result())
}

#[test]
fn whatever_becomes_of_the_next_step_and_of_the_end_those_before_are_gone_on_from() {
    let expected = expected();
    let first = Folder::after(0..1);
    let kept = fs::read(first.unfinished()).unwrap();
    let state = fs::read(first.state()).unwrap();
    // The file in a later state: with its next steps, and with the parts outside its columns written at the end.
    let later = Folder::after(0..0);
    let mut file = ResultFile::create(&later.result(), &in_steps()).unwrap();
    (0..3).for_each(|k| write_step(&mut file, k));
    file.write_convergence([].into_iter()).unwrap();
    file.finish(&"a long report ".repeat(1000)).unwrap();
    let later = fs::read(later.result()).unwrap();
    assert!(later.len() > kept.len());
    // Any part of it may have reached the disk; only ends at bytes that differ have to be distinguished.
    let changes = (0..later.len()).filter(|&at| kept.get(at) != Some(&later[at]));
    let changes: Vec<usize> = changes.collect();
    let ends = changes.iter().step_by(changes.len() / 23).copied();
    for end in ends.chain([later.len()]) {
        for is_begin in [true, false] {
            let mut half = kept.clone();
            half.resize(later.len(), 0);
            let reached = if is_begin { 0..end } else { end..later.len() };
            half[reached.clone()].copy_from_slice(&later[reached]);
            fs::write(first.unfinished(), &half).unwrap();
            fs::write(first.state(), &state).unwrap();
            assert_eq!(go_on(&first.result()), 1);
            assert_eq!(numbers(&first.result()), expected);
            assert_eq!(fs::read_dir(first.0.path()).unwrap().count(), 1);
        }
    }
}

#[test]
fn finished_steps_that_arent_what_was_written_are_refused_by_name() {
    let folder = Folder::after(0..2);
    let whole = fs::read(folder.unfinished()).unwrap();
    let file = File::open(folder.unfinished()).unwrap();
    let of_step = |name: &str, k: usize, steps: u64| {
        let dataset = file.dataset(name).unwrap();
        let length = dataset.storage_size() / steps;
        let start = dataset.offset().unwrap() + k as u64 * length;
        (
            start as usize..(start + length) as usize,
            format!("/{name} of load step {}", k + 1),
        )
    };
    let places = [
        of_step("VTKHDF/PointData/Displacement", 1, 3),
        of_step("VTKHDF/PointData/VonMises", 0, 3),
        of_step("VTKHDF/CellData/PrincipalStress", 1, 3),
        of_step("VTKHDF/Points", 0, 1),
        of_step("contact/crack 1/force", 1, 3),
        of_step("contact/crack 0/position", 0, 1),
    ];
    drop(file);
    let refused = || {
        let kept = Kept::read(&folder.result()).unwrap().unwrap();
        kept.check(&folder.result()).unwrap_err().to_string()
    };
    for (place, words) in places {
        let mut damaged = whole.clone();
        damaged[place.clone()].fill(0);
        fs::write(folder.unfinished(), &damaged).unwrap();
        let message = refused();
        assert!(message.contains(&words), "{message}\nlacks {words}");
        assert!(message.contains("result.vtkhdf.unfinished"), "{message}");
        // Rows that changed places, too.
        let mut damaged = whole.clone();
        damaged[place].rotate_left(24);
        if damaged != whole {
            fs::write(folder.unfinished(), &damaged).unwrap();
            assert!(refused().contains(&words));
        }
    }
    for length in [0, 1000, whole.len() / 2] {
        fs::write(folder.unfinished(), &whole[..length]).unwrap();
        assert!(refused().contains("isn't what was written"));
    }
    // A refused file isn't changed.
    assert_eq!(
        fs::read(folder.unfinished()).unwrap().len(),
        whole.len() / 2
    );
    fs::write(folder.unfinished(), &whole).unwrap();
    assert_eq!(go_on(&folder.result()), 2);
    assert_eq!(numbers(&folder.result()), expected());
}

#[test]
fn a_state_that_isnt_what_was_written_is_refused() {
    let folder = Folder::after(0..1);
    let whole = fs::read(folder.state()).unwrap();
    let refused = || match Kept::read(&folder.result()) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("it is taken"),
    };
    for at in (0..whole.len()).step_by(whole.len() / 50) {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x10;
        fs::write(folder.state(), &damaged).unwrap();
        let message = refused();
        assert!(message.contains("expected"), "{message}");
        fs::write(folder.state(), &whole[..at]).unwrap();
        assert!(refused().contains("expected"));
    }
    let version = env!("CARGO_PKG_VERSION").as_bytes();
    let at = whole
        .windows(version.len())
        .position(|w| w == version)
        .unwrap();
    let mut other = whole.clone();
    other[at] = b'9';
    fs::write(folder.state(), &other).unwrap();
    assert!(refused().contains("of version 9"), "{}", refused());
    // The state without its file, or the file without its state, is no checkpoint.
    fs::remove_file(folder.state()).unwrap();
    assert!(Kept::read(&folder.result()).unwrap().is_none());
    fs::write(folder.state(), &whole).unwrap();
    fs::remove_file(folder.unfinished()).unwrap();
    assert!(Kept::read(&folder.result()).unwrap().is_none());
}
