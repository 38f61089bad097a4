//! The scripts: their messages before they install or build anything.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::{TempDir, tempdir};

use crate::support::process::{Ended, Running};
use crate::support::solver::LIMIT;

/// Programs of every Debian.
const ESSENTIAL: [&str; 12] = [
    "awk", "basename", "bash", "cat", "cut", "dirname", "env", "ls", "sed", "sh", "sort", "tail",
];

fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scripts")
        .join(name)
}

/// A folder with the `real` programs of this machine, and `fake` ones that only create the file `called`.
fn programs(real: &[&str], fake: &[&str]) -> TempDir {
    let folder = tempdir().unwrap();
    for name in real {
        let places = ["/usr/bin", "/bin"].map(|place| Path::new(place).join(name));
        if let Some(place) = places.iter().find(|place| place.exists()) {
            symlink(place, folder.path().join(name)).unwrap();
        }
    }
    for name in fake {
        let path = folder.path().join(name);
        let called = folder.path().join("called");
        fs::write(
            &path,
            format!("#!/bin/sh\necho \"$0 $*\" >>{}\nexit 1\n", called.display()),
        )
        .unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }
    folder
}

fn run(name: &str, args: &[&str], path: &str) -> Ended {
    let mut command = Command::new(script(name));
    command
        .args(args)
        .env("PATH", path)
        .env("HOME", "/nonexistent");
    for variable in ["FIGURES_PYTHON", "MPICC", "CARGO_TARGET_DIR"] {
        command.env_remove(variable);
    }
    Running::start(&mut command).wait(LIMIT)
}

#[test]
fn help_takes_nothing_but_a_shell() {
    let bare = programs(&ESSENTIAL, &[]);
    let path = bare.path().to_str().unwrap();
    for name in [
        "setup", "demo", "figures", "summary", "collect", "bench", "scaling",
    ] {
        let ended = run(name, &["--help"], path);
        assert_eq!(ended.code(), 0, "{name}: {}", ended.stderr);
        let usage = format!("scripts/{name}");
        assert!(ended.stdout.contains(&usage), "{name}: {}", ended.stdout);
    }
    let ended = run("collect", &["run.json"], path);
    assert_eq!(ended.code(), 1);
    assert!(
        ended
            .stderr
            .contains("there is no python3; scripts/setup --figures"),
        "{}",
        ended.stderr
    );
}

#[test]
fn what_cannot_be_done_is_refused_before_anything_is_installed() {
    let fake = programs(&[], &["apt-get", "cargo", "sudo"]);
    let path = format!(
        "{}:{}",
        fake.path().display(),
        std::env::var("PATH").unwrap()
    );
    let has_python = Command::new("python3").arg("--version").output().is_ok();
    let folder = tempdir().unwrap();
    let folder = folder.path().to_str().unwrap();
    for (name, args, words) in [
        (
            "setup",
            &["--nonsense"][..],
            "there is no option --nonsense",
        ),
        ("setup", &["--gmsh", "python"], "there is no option python"),
        (
            "figures",
            &["nothing.vtkhdf"],
            "nothing.vtkhdf: there is no such file",
        ),
        ("figures", &[], "no result is named"),
        (
            "summary",
            &["nothing.vtkhdf", "page.html"],
            "nothing.vtkhdf: there is no such file",
        ),
        ("bench", &["--nonsense"], "--nonsense"),
        ("bench", &["--sizes", "small"], "small"),
        (
            "bench",
            &["--walls", "door"],
            "there is no wall 'door'; expected wall, many",
        ),
        ("bench", &["--dim", "3", "--nonsense"], "--nonsense"),
        ("scaling", &[folder, "--nonsense"], "--nonsense"),
        ("scaling", &[folder, "--ranks", "1;2"], "1;2"),
    ] {
        if ["bench", "scaling"].contains(&name) && !has_python {
            eprintln!("skipped: there is no python3");
            continue;
        }
        let ended = run(name, args, &path);
        assert_eq!(ended.code(), 2, "{name} {args:?}: {}", ended.stderr);
        assert!(
            ended.stderr.contains(words),
            "{name} {args:?}: {}",
            ended.stderr
        );
        let called = fs::read_to_string(fake.path().join("called")).unwrap_or_default();
        assert_eq!(called, "", "{name} {args:?}");
    }
}

#[test]
fn sizes_alone_are_measured_without_walls() {
    let code = "import options\n\
                print(options.bench(['--sizes', '5k']).walls, options.bench([]).walls, \
                options.bench(['--sizes', '5k', '--walls', 'many']).walls)";
    let mut command = Command::new("python3");
    command
        .args(["-B", "-c", code])
        .env("PYTHONPATH", script("performance"));
    let Ok(printed) = command.output() else {
        eprintln!("skipped: there is no python3");
        return;
    };
    let expected = "[] ['wall', 'many'] ['many']\n";
    assert_eq!(
        String::from_utf8_lossy(&printed.stdout),
        expected,
        "{printed:?}"
    );
}

#[test]
fn the_set_up_checks_several_options_at_once() {
    let bare = programs(&ESSENTIAL, &[]);
    let path = bare.path().to_str().unwrap();
    let ended = run("setup", &["--run", "--slurm", "--check"], path);
    assert_eq!(ended.code(), 1);
    for package in ["munge", "openmpi-bin"] {
        assert!(ended.stderr.contains(package), "{}", ended.stderr);
    }
    // Without Rust everything else would fail.
    let ended = run("setup", &["--gmsh", "--python", "--check"], path);
    assert_eq!(ended.code(), 1);
    assert!(ended.stderr.contains("install Rust"), "{}", ended.stderr);
}
