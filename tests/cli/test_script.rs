//! `scripts/test`, with a Cargo that only pretends to test.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use crate::support::process::{Ended, Running};

/// Runs the script with a time limit, and a Cargo whose builds take two seconds and whose second program takes `sleeps`
/// seconds.
fn tested(limit: &str, sleeps: &str) -> Ended {
    let folder = tempfile::tempdir().unwrap();
    let cargo = folder.path().join("cargo");
    let script = format!(
        "#!/bin/sh\ncase \" $* \" in\n\
         *' --no-run '*) sleep 1; echo '  Executable a'; echo '  Executable b'; exit ;;\nesac\n\
         echo '     Running a' >&2\nsleep 0.2\necho 'test one ... ok'\necho 'test two ... ok'\n\
         sleep 0.2\necho '     Running b' >&2\nsleep {sleeps}\necho 'test three ... ok'\n"
    );
    fs::write(&cargo, script).unwrap();
    fs::set_permissions(&cargo, fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!(
        "{}:{}",
        folder.path().display(),
        std::env::var("PATH").unwrap()
    );
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/test");
    let mut command = Command::new(script);
    (command.arg("--lib").env("PATH", path)).env("TEST_TIMEOUT", limit);
    Running::start(&mut command).wait(Duration::from_secs(100))
}

#[test]
fn scripts_test_says_how_far_it_is() {
    let ended = tested("60", "0.2");
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let second = "test: program 2 of 2, 2 tests done after ";
    assert!(ended.stdout.contains(second), "{}", ended.stdout);
    let all = "test: 3 tests in 2 of 2 programs done after ";
    assert!(ended.stdout.contains(all), "{}", ended.stdout);
}

#[test]
fn the_time_out_of_scripts_test_counts_no_build_and_says_where_it_was() {
    // The build alone exceeds the limit.
    let ended = tested("2", "60");
    assert_eq!(ended.code(), 124, "{}", ended.stderr);
    assert!(
        ended.stdout.contains("2 tests in 2 of 2 programs"),
        "{}",
        ended.stdout
    );
    let named = "stopped after 2 s, in the program named last; TEST_TIMEOUT=4";
    assert!(ended.stderr.contains(named), "{}", ended.stderr);
}
