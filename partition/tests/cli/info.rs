//! `--info`: the content of a problem file.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use contact_dd_partition::info::Info;

fn program(args: &[&str], dir: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_contact-dd-partition"))
        .args(args)
        .current_dir(dir)
        .output()
        .unwrap()
}

/// Makes a problem file of a built-in scene.
fn make(example: &str, count: &str, dir: &Path) {
    let args = ["--example", example, "-n", count, "-o", "problem.h5"];
    let output = program(&args, dir);
    assert!(output.status.success(), "{output:?}");
}

/// Makes scene.h5 of the granite block with `more` at the end of its scene; returns what was printed.
fn make_with(more: &str, dir: &Path) -> String {
    let written = program(&["--example", "granite", "--write-scene", "."], dir);
    assert!(written.status.success(), "{written:?}");
    let path = dir.join("scene.toml");
    let scene = fs::read_to_string(&path).unwrap();
    fs::write(&path, scene + more).unwrap();
    let made = program(&["scene.toml", "-n", "8"], dir);
    assert!(made.status.success(), "{made:?}");
    String::from_utf8(made.stdout).unwrap()
}

#[test]
fn the_sum_of_loads_is_what_pressures_and_lengths_say() {
    let dir = tempfile::tempdir().unwrap();
    make("granite", "8", dir.path());
    let info = Info::read(&dir.path().join("problem.h5")).unwrap();
    // 6 MPa on 6.5 m at the lower right and on 3.5 m at the upper left, 3 MPa on the top of 10 m.
    let (force, moment) = info.load(0);
    let expected = [6e6 * (3.5 - 6.5), -3e6 * 10.0];
    let about_origin = 6e6 * (6.5 * 6.5 - (100.0 - 6.5 * 6.5)) / 2.0 - 3e6 * 50.0;
    for (found, expected) in [
        (force[0], expected[0]),
        (force[1], expected[1]),
        (moment[2], about_origin),
    ] {
        assert!(
            (found - expected).abs() < 1e-9 * expected.abs(),
            "{found} {expected}"
        );
    }
    assert_eq!(force[2], 0.0);
    // The bottom of 10 m has cells of 0.25 m.
    assert_eq!(
        info.supported_nodes(),
        [("displacement[1] on 'bottom'", 41)]
    );
}

#[test]
fn loads_are_those_of_every_step() {
    let dir = tempfile::tempdir().unwrap();
    let steps = "\n[[step]]\nscale = -2\n[[step]]\nname = 'none'\npressure = []\n";
    make_with(steps, dir.path());
    let info = Info::read(&dir.path().join("scene.h5")).unwrap();
    let sums = [0, 1].map(|step| info.load(step).0[1]);
    assert!((sums[0] - 6e7).abs() < 1e-2 && sums[1] == 0.0, "{sums:?}");
    let said = info.to_string();
    for start in [
        "load          1 at 1: ",
        "load          none at 2: 0, 0 N/m in sum",
    ] {
        assert!(said.lines().any(|line| line.starts_with(start)), "{said}");
    }
}

#[test]
fn the_program_tells_what_is_in_the_file() {
    let dir = tempfile::tempdir().unwrap();
    let solver = "\n[solver]\nmethod = 'picard'\ntolerance = 1e-6\n";
    let said = make_with(solver, dir.path());
    let settings = "settings      method = picard, tolerance = 1e-6";
    assert!(said.lines().any(|line| line == settings), "{said}");
    let mut lines = said.lines();
    let subdomains = lines.find(|line| line.starts_with("subdomains    8, "));
    let told = program(&["--info", "scene.h5"], dir.path());
    assert!(told.status.success(), "{told:?}");
    let told = String::from_utf8(told.stdout).unwrap();
    for line in [
        "title         Loaded granite block with cracks",
        "plane         strain",
        subdomains.unwrap(),
        "contact       48 conditions",
        "                  24 on left crack, node by node",
        "gap           0 m on left crack",
        "material      granite: E 5.2e9 Pa, ν 0.18",
        "load          -1.8e7, -3e7 N/m in sum, moment -1.965e8 N about the origin",
        settings,
    ] {
        assert!(told.lines().any(|told| told == line), "{line} in\n{told}");
    }
}

#[test]
fn friction_is_told_of_contact_by_contact() {
    let dir = tempfile::tempdir().unwrap();
    let written = program(&["--example", "granite", "--write-scene", "."], dir.path());
    assert!(written.status.success(), "{written:?}");
    let path = dir.path().join("scene.toml");
    let scene = fs::read_to_string(&path).unwrap();
    for (name, keys) in [
        ("left crack", "tresca = '1e6*max(0, x-2)'"),
        ("right crack", "friction = 0.6\ncohesion = 1e5"),
    ] {
        let scene = fs::read_to_string(&path).unwrap();
        let start = scene.find(&format!("\"{name}\"")).unwrap();
        let (before, after) = scene.split_at(start + name.len() + 2);
        fs::write(&path, format!("{before}\n{keys}{after}")).unwrap();
    }
    assert_ne!(fs::read_to_string(&path).unwrap(), scene);
    let made = program(&["scene.toml", "-n", "8"], dir.path());
    assert!(made.status.success(), "{made:?}");
    let told = program(&["--info", "scene.h5"], dir.path());
    for said in [made, told].map(|output| String::from_utf8(output.stdout).unwrap()) {
        for line in [
            "24 on left crack, node by node, shear bound 1.25e5 to 8.75e5 Pa, on 7 of 24",
            "24 on right crack, node by node, friction 0.6, cohesion 1e5 Pa",
        ] {
            assert!(
                said.lines().any(|said| said.trim() == line),
                "{line} in\n{said}"
            );
        }
    }
}

#[test]
fn nothing_but_a_problem_file_is_told_of() {
    let dir = tempfile::tempdir().unwrap();
    let written = program(&["--example", "patch", "--write-scene", "."], dir.path());
    assert!(written.status.success(), "{written:?}");
    for (file, word) in [
        (
            "scene.toml",
            "contact-dd-partition scene.toml -o scene.h5 makes one",
        ),
        ("nothing.h5", "expected a problem file"),
        (".", "it isn't a file; expected a problem file"),
    ] {
        let output = program(&["--info", file], dir.path());
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(word), "{said}");
    }
}
