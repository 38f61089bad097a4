//! `scripts/collect`, which tabulates many reports.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;
use tempfile::tempdir;

use super::report;
use crate::support::process::{Ended, Running};
use crate::support::solver::LIMIT;

/// The output of the script for these files; `None` without Python.
fn collect(files: &[&Path]) -> Option<Ended> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/collect");
    if Command::new("python3").arg("--version").output().is_err() {
        eprintln!("skipped: there is no python3");
        return None;
    }
    Some(Running::start(Command::new(script).args(files)).wait(LIMIT))
}

#[test]
fn every_report_is_a_row_of_the_same_columns() {
    let folder = tempdir().unwrap();
    let [whole, older] = ["whole.json", "older.json"].map(|name| folder.path().join(name));
    let mut report = report("granite", 2, &[], 0);
    fs::write(&whole, report.to_string()).unwrap();
    report.as_object_mut().unwrap().remove("hosts");
    report["error_estimate"] = Value::Null;
    report["warnings"] = serde_json::json!(["one, two", "three"]);
    fs::write(&older, report.to_string()).unwrap();
    let Some(ended) = collect(&[&whole, &older]) else {
        return;
    };
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let table = ended.stdout;
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 3, "{table}");
    let columns: Vec<&str> = lines[0].split(',').collect();
    let cells: Vec<&str> = lines[1].split(',').collect();
    // Only the name of the MPI library contains commas.
    let of = |name: &str| {
        let at = columns.iter().position(|column| *column == name);
        at.unwrap_or_else(|| panic!("no column {name} in {columns:?}"))
    };
    assert_eq!(cells[of("file")], whole.to_str().unwrap());
    assert_eq!(cells[of("status")], "converged");
    assert_eq!(cells[of("ranks")], "2");
    assert_eq!(cells[of("hosts")], "1");
    for name in [
        "seconds_total",
        "certificate_equilibrium",
        "error_estimate_relative",
    ] {
        assert!(cells[of(name)].parse::<f64>().unwrap() > 0.0, "{name}");
    }
    let older: Vec<&str> = lines[2].split(',').collect();
    assert_eq!(older[of("hosts")], "");
    assert_eq!(older[of("error_estimate_relative")], "");
    assert!(lines[2].contains("\"one, two | three\""), "{}", lines[2]);
}

#[test]
fn what_is_no_report_is_named() {
    let folder = tempdir().unwrap();
    let other = folder.path().join("other.json");
    for (content, words) in [
        ("{\"status\": 1}", "has no 'certificate'"),
        ("[]", "has no 'status'"),
        ("dofs,ranks", "isn't a report"),
    ] {
        fs::write(&other, content).unwrap();
        let Some(ended) = collect(&[&other]) else {
            return;
        };
        let printed = &ended.stderr;
        assert!(ended.code() == 2 && ended.stdout.is_empty());
        assert!(
            printed.contains("other.json") && printed.contains(words),
            "{printed}"
        );
    }
    let missing = folder.path().join("missing.json");
    if let Some(ended) = collect(&[&missing]) {
        assert!(ended.stderr.contains("missing.json: No such file"));
    }
}
