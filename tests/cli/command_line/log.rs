//! `--log json`: every line is an object described in the documentation.

use std::collections::BTreeSet;
use std::fs;

use serde_json::Value;

use super::{case, granite, report};
use crate::support::process::Ended;

/// All kinds of events.
const EVENTS: [&str; 10] = [
    "problem", "settings", "phase", "progress", "step", "sweep", "warning", "check", "finished",
    "error",
];

/// The events of a stream, each with its name.
fn events(stream: &str) -> Vec<(String, Value)> {
    let documents = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/command-line.md");
    let documents = fs::read_to_string(documents).unwrap();
    let parsed = stream.lines().map(|line| {
        let event: Value = serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}"));
        let name = event["event"].as_str().unwrap().to_owned();
        let row = documents
            .lines()
            .find(|row| row.starts_with(&format!("| `{name}` |")));
        let row = row.unwrap_or_else(|| panic!("{name} isn't documented"));
        for key in event
            .as_object()
            .unwrap()
            .keys()
            .filter(|&key| key != "event")
        {
            assert!(row.contains(&format!("`{key}`")), "{key} of {name}");
        }
        (name, event)
    });
    parsed.collect()
}

fn names(ended: &Ended) -> Vec<String> {
    let events = events(&ended.stdout).into_iter();
    events.map(|(name, _)| name).collect()
}

#[test]
fn every_line_is_an_event_that_the_documentation_names() {
    // The scene has a support that ends on Γ.
    let case = granite("");
    let report_file = case.folder().join("report.json");
    for ranks in [0, 2] {
        let args = ["--log", "json", "--report", report_file.to_str().unwrap()];
        let ended = case.run_on(ranks, &args);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        let events = events(&ended.stdout);
        let names: Vec<&str> = events.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names[..2], ["problem", "settings"]);
        assert_eq!(names.iter().filter(|&&name| name == "finished").count(), 1);
        let (last, finished) = events.last().unwrap();
        assert_eq!(last, "finished");
        assert_eq!(finished["exit_code"], 0);
        let report = report(&case);
        assert_eq!(finished["report"], report);
        // The bilateral start is an additional sweep.
        let sweeps = names.iter().filter(|&&name| name == "sweep").count();
        assert_eq!(sweeps as u64, report["sweeps"].as_u64().unwrap() + 1);
        for key in ["dofs", "interface_dofs", "subdomains", "contact_conditions"] {
            assert_eq!(events[0].1[key], report[key], "{key}");
        }
        assert_eq!(events[1].1["settings"], report["settings"]);
        assert_eq!(events[1].1["settings_from"]["log"], "command line");
        let phases = events.iter().filter(|(name, _)| name == "phase");
        let seconds: Vec<f64> = phases
            .map(|(_, e)| e["seconds"].as_f64().unwrap())
            .collect();
        assert!(seconds.is_sorted() && seconds.len() > 3);
    }
}

#[test]
fn load_steps_are_events_before_their_sweeps() {
    let ended = case("[[step]]\nname = 'half'\ntime = 0.5\nscale = 0.5\n[[step]]\ntime = 1.5")
        .run(&["--log=json"]);
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    let events = events(&ended.stdout);
    let told = events
        .iter()
        .filter(|(name, _)| name == "step" || name == "sweep");
    let told: Vec<&(String, Value)> = told.collect();
    let places: Vec<usize> = (0..told.len()).filter(|&i| told[i].0 == "step").collect();
    assert_eq!(places.len(), 2);
    for (place, expected) in places.into_iter().zip([(1, "half", 0.5), (2, "2", 1.5)]) {
        let event = &told[place].1;
        let (step, name, time) = expected;
        assert_eq!((&event["step"], &event["steps"]), (&step.into(), &2.into()));
        assert_eq!(
            (&event["name"], &event["time"]),
            (&name.into(), &time.into())
        );
        assert_eq!(told[place + 1].1["sweep"], 0);
    }
}

#[test]
fn errors_are_events_on_stderr_with_the_exit_code() {
    let good = case("");
    let args = ["--log=json", "--method", "picard", "--relaxation", "1"];
    for (args, code, word) in [
        (&["--log", "json", "--metod", "x"][..], 2, "'--metod'"),
        (
            &["--log=json", "-o", "/nowhere/at/all"],
            5,
            "/nowhere/at/all",
        ),
        (&["--log=json", "--max-sweeps", "0"], 3, "not converged"),
        (&args, 3, "not converged"),
    ] {
        for quiet in [false, true] {
            let args = [args, if quiet { &["--quiet"] } else { &[] }].concat();
            let ended = good.run(&args);
            assert_eq!(
                ended.code(),
                code,
                "{args:?} {}{}",
                ended.stdout,
                ended.stderr
            );
            let errors = events(&ended.stderr);
            let errors = errors.iter().filter(|(name, _)| name == "error");
            let errors: Vec<_> = errors.map(|(_, event)| event).collect();
            assert_eq!(errors.len(), 1, "{}", ended.stderr);
            assert_eq!(errors[0]["exit_code"], code);
            assert!(errors[0]["message"].as_str().unwrap().contains(word));
            assert!(!quiet || ended.stdout.is_empty(), "{}", ended.stdout);
            names(&ended);
        }
    }
}

#[test]
fn a_check_ends_with_what_solving_would_take() {
    let case = case("");
    let ended = case.run(&["--check", "--log", "json"]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let events = events(&ended.stdout);
    let (last, check) = events.last().unwrap();
    assert_eq!(last, "check");
    for key in ["memory_bytes", "flops", "available_bytes"] {
        assert!(check[key].as_f64().unwrap() > 0.0, "{key}");
    }
    // The chosen operator for contact constraints, and the reason, are the same in the log and in the report.
    let solved = self::events(&case.run(&["--log", "json"]).stdout);
    let choice = &solved.last().unwrap().1["report"]["interface_choice"];
    let words = choice.as_str().unwrap();
    assert!(words.contains(" conditions: "), "{words}");
    assert_eq!(&check["interface_choice"], choice);
    assert_eq!(&solved[0].1["interface_choice"], choice);
}

#[test]
fn the_documentation_names_no_other_events() {
    let documents = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/command-line.md");
    let documents = fs::read_to_string(documents).unwrap();
    let table = documents.split("| event |").nth(1).unwrap();
    let rows = table
        .lines()
        .skip(2)
        .take_while(|line| line.starts_with('|'));
    let named: BTreeSet<&str> = rows.map(|row| row.split('`').nth(1).unwrap()).collect();
    assert_eq!(named, BTreeSet::from(EVENTS));
}
