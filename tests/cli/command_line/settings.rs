//! The command line takes precedence over the problem file, and both over the defaults.

use super::{case, granite, report};
use crate::support::solution::datasets;

#[test]
fn a_relaxation_that_is_not_used_is_said_to_be_so() {
    for (method, word) in [("newton", true), ("anderson", true), ("picard", false)] {
        let case = granite("");
        let report_file = case.folder().join("report.json");
        let report_file = report_file.to_str().unwrap();
        let args = ["--relaxation", "0.08", "--tolerance", "1e-3", "--report"];
        let ended = case.run(&[&args[..], &[report_file, "--method", method]].concat());
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        let warnings = report(&case)["warnings"].to_string();
        let printed = warnings.contains("--relaxation goes with --method picard");
        assert_eq!(printed, word, "{method}: {warnings}");
    }
}

#[test]
fn the_command_line_goes_before_the_problem_file() {
    let case = case("[solver]\nmethod = 'anderson'\ntolerance = 1e-7\nmax_sweeps = 50\n");
    let report_file = case.folder().join("report.json");
    let report_file = report_file.to_str().unwrap();
    let ended = case.run(&["--max-sweeps", "70", "--report", report_file]);
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    let report = report(&case);
    let (settings, from) = (&report["settings"], &report["settings_from"]);
    for (name, value, origin) in [
        ("method", "\"anderson\"", "problem file"),
        ("tolerance", "1e-7", "problem file"),
        ("max_sweeps", "70", "command line"),
        ("threads", "1", "default"),
        ("relaxation", "null", "default"),
        ("no_stress", "false", "default"),
    ] {
        assert_eq!(settings[name].to_string(), value, "{name}");
        assert_eq!(from[name], origin, "{name}");
    }
    assert_eq!(report["method"], "anderson");
    for line in [
        "method       anderson (problem file)",
        "tolerance    1e-7 (problem file)",
        "sweeps       at most 70 (command line)",
    ] {
        assert!(ended.stdout.contains(line), "{}", ended.stdout);
    }
}

#[test]
fn options_mean_the_same_wherever_they_stand() {
    let plain = granite("");
    let ended = plain.run(&["--method", "picard", "--tolerance", "1e-4"]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let expected = datasets(&plain.result());
    let asking = granite("[solver]\nmethod = 'picard'\ntolerance = 1e-4\n");
    let ended = asking.run(&[]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    assert!(datasets(&asking.result()) == expected);
}

#[test]
fn the_command_line_takes_back_what_the_problem_says() {
    let case = case("[solver]\nno_stress = true\n");
    let has_stress = |args: &[&str]| {
        let ended = case.run(args);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        datasets(&case.result())
            .keys()
            .any(|name| name.contains("Stress"))
    };
    assert!(!has_stress(&[]));
    assert!(has_stress(&["--no-stress=false"]));
    assert_eq!(case.run(&["--quiet"]).stdout, "");
}
