//! The numbers of a run in its report and result.

use std::fs;
use std::path::{Path, PathBuf};

use hdf5::File;
use serde_json::Value;

use super::expected::Expected;

/// Fails unless report and result in a folder contain all of the numbers.
pub fn has_numbers(folder: &Path, expected: &[Expected]) {
    assert!(!expected.is_empty(), "a page without numbers");
    let report = fs::read_to_string(the_one(folder, "json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    let result = File::open(the_one(folder, "vtkhdf")).unwrap();
    let wrong: Vec<String> = (expected.iter())
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

/// The only file with an extension.
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

/// The largest length of a dataset's rows, if these are vectors, otherwise its largest absolute value.
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
