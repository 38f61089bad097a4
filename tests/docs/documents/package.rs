//! The Python package: its own tests, file by file, with the programs of this build.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::page::root;
use super::run::{Folder, python};

/// The test files.
pub fn tests() -> Vec<PathBuf> {
    let files = fs::read_dir(root().join("python/tests")).unwrap();
    let files = files.map(|file| PathBuf::from(file.unwrap().file_name()));
    let mut files: Vec<PathBuf> = files
        .filter(|name| name.to_string_lossy().starts_with("test_"))
        .collect();
    files.sort();
    files
}

/// A test: pytest passes, without skipped tests.
pub fn passes(file: &Path) {
    let folder = Folder::new();
    let mut command = Command::new(python().expect("ignored without it"));
    command.args(["-m", "pytest", "-q", "-p", "no:cacheprovider"]);
    command.arg(root().join("python/tests").join(file));
    let ended = folder.run(&mut command);
    let printed = format!("{}{}", ended.stdout, ended.stderr);
    assert!(
        ended.code() == 0 && !printed.contains(" skipped"),
        "{printed}"
    );
}
