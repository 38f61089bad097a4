//! The command line goes before the settings file, that before the problem file, and all before the
//! defaults.

use std::fs;

use super::{case, granite, report};
use crate::support::solution::{Solution, datasets};

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
        let said = warnings.contains("--relaxation goes with --method picard");
        assert_eq!(said, word, "{method}: {warnings}");
    }
}

#[test]
fn the_first_to_say_something_settles_it() {
    let case = case("[solver]\nmethod = 'anderson'\ntolerance = 1e-7\nmax_sweeps = 50\n");
    let file = case.folder().join("settings.toml");
    let report_file = case.folder().join("report.json");
    let text = format!(
        "tolerance = 1e-8\nmax_sweeps = 60\nthreads = 2\nreport = '{}'\n",
        report_file.display()
    );
    fs::write(&file, text).unwrap();
    let args = ["--settings", file.to_str().unwrap(), "--max-sweeps", "70"];
    let ended = case.run(&args);
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    let report = report(&case);
    let (settings, from) = (&report["settings"], &report["settings_from"]);
    for (name, value, origin) in [
        ("method", "\"anderson\"", "problem file"),
        ("tolerance", "1e-8", "settings file"),
        ("max_sweeps", "70", "command line"),
        ("threads", "2", "settings file"),
        ("relaxation", "null", "default"),
        ("no_stress", "false", "default"),
    ] {
        assert_eq!(settings[name].to_string(), value, "{name}");
        assert_eq!(from[name], origin, "{name}");
    }
    assert_eq!(report["method"], "anderson");
    for line in [
        "method       anderson (problem file)",
        "tolerance    1e-8 (settings file)",
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
    let file = plain.folder().join("settings.toml");
    fs::write(&file, "method = 'picard'\ntolerance = 1e-4\n").unwrap();
    let ended = plain.run(&["--settings", file.to_str().unwrap()]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    assert!(datasets(&plain.result()) == expected);
}

#[test]
fn the_command_line_takes_back_what_a_file_says() {
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
    let file = case.folder().join("settings.toml");
    fs::write(&file, "quiet = true\nno_stress = false\n").unwrap();
    let settings = ["--settings", file.to_str().unwrap()];
    assert!(has_stress(&settings));
    assert!(!has_stress(&[&settings[..], &["--no-stress"]].concat()));
    assert_eq!(case.run(&settings).stdout, "");
    let loud = case.run(&[&settings[..], &["--quiet=false"]].concat());
    assert!(loud.stdout.contains("certificate"));
}

#[test]
fn results_never_take_the_place_of_the_settings() {
    let case = case("");
    let file = case.folder().join("settings.toml");
    fs::write(&file, "threads = 1\n").unwrap();
    let file = file.to_str().unwrap();
    for option in ["--output", "--report"] {
        let ended = case.run(&["--settings", file, option, file]);
        assert_eq!(ended.code(), 2);
        assert!(
            ended.stderr.contains("that is the settings file"),
            "{}",
            ended.stderr
        );
    }
    assert_eq!(fs::read_to_string(file).unwrap(), "threads = 1\n");
}
