//! What the program refuses: exit code 2, a message that says where, nothing written.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use tempfile::TempDir;

fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_contact-dd-partition"))
}

/// A folder with the scene of an example.
fn scene() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    let mut command = program();
    let args = ["--example", "patch", "--write-scene", "."];
    let written = command.args(args).current_dir(dir.path()).output().unwrap();
    assert!(written.status.success(), "{written:?}");
    dir
}

/// Fails unless the scene is refused with all words and nothing is written.
fn refused(dir: &Path, args: &[&str], words: &[&str]) {
    let count = || fs::read_dir(dir).unwrap().count();
    let before = count();
    let mut command = program();
    let output = command.args(args).current_dir(dir).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {said}");
    assert!(said.starts_with("error: "), "{said}");
    for word in words {
        assert!(said.contains(word), "{word} in {said}");
    }
    assert_eq!(count(), before, "{args:?} wrote something");
}

#[test]
fn what_is_wrong_between_scene_and_mesh_is_said_with_the_scene() {
    let dir = scene();
    let path = dir.path().join("scene.toml");
    let good = fs::read_to_string(&path).unwrap();
    for (from, to, words) in [
        (
            "\"top\"",
            "\"tap\"",
            ["scene.toml: pressure[1]", "did you mean 'top'"],
        ),
        (
            "\"lower face\"",
            "\"bottom\"",
            ["scene.toml: contact 'interface'", "face"],
        ),
        (
            "value = 1e6",
            "value = \"1e119*1e3\"",
            ["scene.toml: line", "at most 1e120"],
        ),
        (
            "[bodies.lower]",
            "[bodies.lowr]",
            [
                "scene.toml: bodies: the mesh has no physical group 'lowr'",
                "did you mean 'lower'",
            ],
        ),
        (
            "\"mesh.msh\"",
            "\"nowhere.msh\"",
            ["nowhere.msh", "a mesh in Gmsh's format"],
        ),
        (
            "\"mesh.msh\"",
            "\"/dev/zero\"",
            ["/dev/zero", "it isn't a file"],
        ),
        (
            "\"mesh.msh\"",
            "\"m\\u0000.msh\"",
            ["m\\0.msh", "can't be read"],
        ),
    ] {
        assert!(good.contains(from));
        fs::write(&path, good.replacen(from, to, 1)).unwrap();
        refused(dir.path(), &["scene.toml"], &words);
    }
}

#[test]
fn a_wrong_file_is_refused_with_what_was_expected() {
    let dir = scene();
    let mut command = program();
    let args = ["scene.toml", "-o", "problem.h5"];
    let made = command.args(args).current_dir(dir.path()).output().unwrap();
    assert!(made.status.success(), "{made:?}");
    fs::write(dir.path().join("block.geo"), "Point(1) = {0, 0, 0};").unwrap();
    let words = ["isn't UTF-8 text; expected a scene in TOML"];
    refused(dir.path(), &["problem.h5"], &words);
    let path = dir.path().join("scene.toml");
    let text = fs::read_to_string(&path).unwrap();
    for (file, word) in [
        ("block.geo", "gmsh -2 ./block.geo -o ./block.msh"),
        ("problem.h5", "is an HDF5 file"),
    ] {
        fs::write(&path, text.replacen("mesh.msh", file, 1)).unwrap();
        let words = [file, word, "expected a mesh in Gmsh's format"];
        refused(dir.path(), &["./scene.toml"], &words);
    }
}

#[test]
fn settings_of_a_scene_are_checked_where_they_stand() {
    let dir = scene();
    let path = dir.path().join("scene.toml");
    let good = fs::read_to_string(&path).unwrap();
    for (line, words) in [
        (
            "method = 'newtn'",
            ["solver.method", "did you mean 'newton'"],
        ),
        (
            "tolerence = 1e-8",
            ["solver.tolerence", "did you mean 'tolerance'"],
        ),
        (
            "tolerance = 0.0",
            ["solver.tolerance", "expected a positive number"],
        ),
        (
            "tolerance = '1e-8'",
            ["solver.tolerance", "string \"1e-8\", expected f64"],
        ),
        ("max_sweeps = -1", ["solver.max_sweeps", "-1"]),
        ("threads = 2", ["solver.threads", "unknown key"]),
    ] {
        let text = format!("{good}\n[solver]\n{line}\n");
        let at = format!("scene.toml: line {}", text.lines().count());
        fs::write(&path, text).unwrap();
        refused(dir.path(), &["scene.toml"], &[&at, words[0], words[1]]);
    }
}

#[test]
fn pipes_and_folders_are_refused_at_once() {
    let dir = scene();
    let pipe = dir.path().join("pipe");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let words = ["it isn't a file; expected a scene in TOML"];
    refused(dir.path(), &["pipe"], &words);
    refused(dir.path(), &["."], &words);
    let path = dir.path().join("scene.toml");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replacen("mesh.msh", "pipe", 1)).unwrap();
    refused(dir.path(), &["scene.toml"], &["pipe", "it isn't a file"]);
}

#[test]
fn options_that_would_do_nothing_are_refused() {
    let dir = scene();
    for (args, word) in [
        (&["--refine", "3"][..], "--refine"),
        (&["--element", "quad4"], "--element"),
        (&["--write-scene", "there"], "--write-scene"),
        (&["-n", "-1"], "invalid value '-1'"),
        (&["-n", "two"], "'two' for '--subdomains <N>'"),
        (&["-np", "2"], "'p' for '--subdomains <N>'"),
        (&["-n", "0"], "expected 2"),
        (&["-n", "9999999"], "9999999 subdomains can't be"),
    ] {
        refused(dir.path(), &[&["scene.toml"], args].concat(), &[word]);
    }
}

#[test]
fn nobody_has_to_read_what_the_program_prints() {
    let dir = scene();
    let mut command = program();
    command.arg("scene.toml").current_dir(dir.path());
    let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
    assert!(dir.path().join("scene.h5").exists());
}
