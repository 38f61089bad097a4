//! Build data of the program's report.

use std::path::Path;
use std::process::Command;
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let set = |name: &str, value: &str| println!("cargo::rustc-env={name}={value}");
    let given = |name: &str| env::var(name).unwrap_or_default();
    let profile = given("PROFILE");
    set("BUILD_PROFILE", &profile);
    set("BUILD_TARGET", &given("TARGET"));
    let compiler = said_by(&given("RUSTC"), &["--version"]);
    set("BUILD_COMPILER", &compiler.unwrap_or_default());
    // The source of a debug build is usually not committed, and every commit would cause another build.
    if profile != "release" {
        return;
    }
    for source in ["src", "partition/src", "Cargo.toml", "Cargo.lock"] {
        println!("cargo::rerun-if-changed={source}");
    }
    // Every commit and every checkout adds a line to it.
    if let Some(log) = said_by("git", &["rev-parse", "--git-path", "logs/HEAD"])
        && fs::exists(Path::new(&log)).is_ok_and(|exists| exists)
    {
        println!("cargo::rerun-if-changed={log}");
    }
    let describe = [
        "describe",
        "--always",
        "--dirty",
        "--abbrev=40",
        "--exclude=*",
    ];
    if let Some(commit) = said_by("git", &describe) {
        set("BUILD_COMMIT", &commit);
    }
}

/// Output of a program, in one line; `None` if it can't be run or fails.
fn said_by(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let said = String::from_utf8(output.stdout).ok()?;
    let line = said.trim();
    (output.status.success() && !line.is_empty()).then(|| line.replace('\n', " "))
}
