//! The report: its schema and its page in the docs are generated from the types, and reports conform to the schema.
//!
//! `WRITE_DOCS=1 cargo test --test cli report` rewrites docs/report.schema.json and docs/report.md.

mod collecting;
mod figures;
mod page;
mod schema;
mod summary;
use std::path::{Path, PathBuf};
use std::{env, fs};

use jsonschema::Validator;
use serde_json::{Value, json};

use crate::support::scenes::built_in_model;
use crate::support::solver::Case;

/// The report of a run of a built-in scene in eight subdomains.
fn report(scene: &str, ranks: usize, options: &[&str], code: i32) -> Value {
    let case = Case::of(&built_in_model(scene, 0), 8);
    let path = case.folder().join("report.json");
    let report = ["--report", path.to_str().unwrap()];
    let ended = case.run_on(ranks, &[options, &report].concat());
    assert_eq!(ended.code(), code, "{}{}", ended.stdout, ended.stderr);
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

/// Fails unless the file contains `text`, or writes it if requested.
fn is_up_to_date(path: &Path, text: &str) {
    if env::var_os("WRITE_DOCS").is_some() {
        fs::write(path, text).unwrap();
    }
    let found = fs::read_to_string(path).unwrap_or_default();
    assert!(
        found == text,
        "{} isn't what the types say; write it anew: WRITE_DOCS=1 cargo test --test cli report",
        path.display()
    );
}

#[test]
fn the_docs_hold_the_schema_of_the_types() {
    let text = serde_json::to_string_pretty(&schema::published()).unwrap() + "\n";
    is_up_to_date(&docs().join("report.schema.json"), &text);
}

#[test]
fn the_page_on_the_report_has_all_fields_of_the_types() {
    let path = docs().join("report.md");
    let text = fs::read_to_string(&path).unwrap_or_default();
    let (above, _) = (text.split_once(page::MARK)).expect("the page has the mark");
    is_up_to_date(&path, &page::below(above, &schema::published()));
}

/// The schema that allows no unknown fields in a report.
fn strict() -> Validator {
    let mut schema = schema::published();
    schema::close(&mut schema);
    jsonschema::draft202012::new(&schema).unwrap()
}

#[track_caller]
fn follows(validator: &Validator, report: &Value) {
    let errors: Vec<String> = (validator.iter_errors(report))
        .map(|error| format!("{}: {error}", error.instance_path()))
        .collect();
    assert!(errors.is_empty(), "{errors:#?}");
}

#[test]
fn reports_of_all_methods_on_any_number_of_ranks_follow_the_schema() {
    let validator = strict();
    for ranks in 1..=3 {
        for method in ["newton", "anderson", "picard"] {
            let options = ["--method", method, "--tolerance", "1e-6"];
            let report = report("granite", ranks, &options, 0);
            follows(&validator, &report);
            assert_eq!(report["per_rank"].as_array().unwrap().len(), ranks);
            assert_eq!(report["method"], method);
        }
    }
}

#[test]
fn reports_of_less_than_a_whole_run_follow_the_schema() {
    let validator = strict();
    let linear = report("plain", 1, &[], 0);
    follows(&validator, &linear);
    assert_eq!(linear["contacts"], json!([]));
    let unstressed = report("granite", 1, &["--no-stress"], 0);
    follows(&validator, &unstressed);
    assert_eq!(unstressed["error_estimate"], Value::Null);
    let options = ["--method", "picard", "--max-sweeps", "2"];
    let short = report("granite", 2, &options, 3);
    follows(&validator, &short);
    assert_eq!(short["status"], "not_converged");
}

#[test]
fn a_report_tells_what_sticks_and_slips_and_what_that_dissipates() {
    let validator = strict();
    let rough = report("raous", 2, &[], 0);
    follows(&validator, &rough);
    let friction = &rough["friction"];
    let [sticking, slipping] = ["sticking", "slipping"].map(|key| friction[key].as_u64().unwrap());
    assert!(sticking > 0 && slipping > 0);
    assert_eq!(rough["active_contacts"], sticking + slipping);
    assert!(friction["dissipated_work"].as_f64().unwrap() > 0.0);
    for key in ["sticking", "slipping", "dissipated_work"] {
        assert_eq!(rough["contacts"][0]["friction"][key], friction[key]);
    }
    assert_eq!(
        (&friction["increments"], &friction["other_solution"]),
        (&json!(1), &Value::Null)
    );
    let again = report("raous", 1, &["--second-start"], 0);
    assert!(again["friction"]["other_solution"].is_boolean());
    let smooth = report("granite", 1, &[], 0);
    assert_eq!(smooth["friction"], Value::Null);
    assert_eq!(smooth["contacts"][0]["friction"], Value::Null);
}

type Change = fn(&mut Value);

#[test]
fn what_is_no_report_does_not_follow_the_schema() {
    let validator = strict();
    let whole = report("granite", 1, &[], 0);
    follows(&validator, &whole);
    let changes: [(&str, Change); 6] = [
        ("a field is missing", |r| {
            r.as_object_mut().unwrap().remove("sweeps");
        }),
        ("a field too many", |r| r["more"] = json!(1)),
        ("a field too many inside", |r| {
            r["per_rank"][0]["more"] = json!(1);
        }),
        ("a word for a number", |r| r["dofs"] = json!("many")),
        ("an unknown word", |r| r["status"] = json!("done")),
        ("two components", |r| {
            r["contacts"][0]["force"] = json!([0, 1]);
        }),
    ];
    for (name, change) in changes {
        let mut report = whole.clone();
        change(&mut report);
        assert!(!validator.is_valid(&report), "{name}");
    }
    let mut infinite = whole;
    infinite["certificate"]["equilibrium"] = Value::Null;
    follows(&validator, &infinite);
}
