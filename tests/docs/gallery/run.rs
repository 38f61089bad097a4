//! Runs the commands of a page and looks for its numbers.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use hdf5::File;
use serde_json::Value;

use super::page::Page;
use crate::process::Running;

/// Longer than any page takes on a machine that is busy with other tests.
const LIMIT: Duration = Duration::from_secs(300);

/// Fails unless the page's commands give all of its numbers; pictures are left out.
pub fn gives_numbers(page: &Page) {
    assert!(!page.expected.is_empty(), "a page without numbers");
    let folder = tempfile::tempdir().unwrap();
    let programs = Path::new(env!("CARGO_BIN_EXE_contact-dd-mpi")).parent();
    let mut path = vec![programs.unwrap().to_path_buf()];
    path.extend(env::split_paths(&env::var_os("PATH").unwrap_or_default()));
    let is_ours = |line: &&String| line.contains("contact-dd-");
    let commands: Vec<&str> = (page.commands.iter().filter(is_ours))
        .map(String::as_str)
        .collect();
    // Pages say mpirun; where another launcher is named, that is what they mean.
    let script = format!(
        "mpirun() {{ command ${{MPIEXEC:-mpirun}} \"$@\"; }}\n{}",
        commands.join("\n")
    );
    let mut shell = Command::new("bash");
    shell
        .args(["-euo", "pipefail", "-c", &script])
        .current_dir(folder.path())
        .env("PATH", env::join_paths(path).unwrap())
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_rmaps_base_oversubscribe", "1");
    let ended = Running::start(&mut shell).wait(LIMIT);
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);

    let report = fs::read_to_string(the_one(folder.path(), "json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    let result = File::open(the_one(folder.path(), "vtkhdf")).unwrap();
    let wrong: Vec<String> = (page.expected.iter())
        .filter_map(|expected| {
            let number = match expected.place.contains("Data/") {
                true => largest(&result, &expected.place),
                false => in_report(&report, &expected.place),
            };
            expected.fault(number)
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The file with an ending.
fn the_one(folder: &Path, ending: &str) -> PathBuf {
    let files = fs::read_dir(folder).unwrap();
    let mut files = files.map(|entry| entry.unwrap().path());
    let found = files.find(|path| path.extension().is_some_and(|e| e == ending));
    found.unwrap_or_else(|| panic!("the commands leave no .{ending}"))
}

/// The number at a path like `contacts/left crack/force/1`.
fn in_report(report: &Value, path: &str) -> f64 {
    let found = path.split('/').try_fold(report, |value, key| match value {
        Value::Array(entries) => key
            .parse()
            .ok()
            .and_then(|k: usize| entries.get(k))
            .or_else(|| {
                let is_meant = |entry: &&Value| entry["name"] == key || entry["support"] == key;
                entries.iter().find(is_meant)
            }),
        _ => value.get(key),
    });
    let number = found.and_then(Value::as_f64);
    number.unwrap_or_else(|| panic!("the report has no number at {path}"))
}

/// The largest length of a dataset's rows, where these are vectors, else its largest absolute value.
fn largest(result: &File, path: &str) -> f64 {
    let dataset = result.dataset(&format!("VTKHDF/{path}"));
    let dataset = dataset.unwrap_or_else(|_| panic!("the result has no {path}"));
    let width = dataset.shape().get(1).copied().unwrap_or(1);
    let values = dataset.read_raw::<f64>().unwrap();
    let of_row = |row: &[f64]| match width {
        3 => row.iter().map(|x| x * x).sum::<f64>().sqrt(),
        _ => row.iter().fold(0.0, |most: f64, x| most.max(x.abs())),
    };
    values.chunks(width).map(of_row).fold(0.0, f64::max)
}
