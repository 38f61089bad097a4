//! Refusals of the program: exit code 2, a message that says where, nothing written.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use tempfile::TempDir;

use crate::says::says;
use crate::table::cases;

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

/// Fails unless the scene is refused as expected and nothing is written.
fn refused(dir: &Path, args: &[&str], expected: &str) {
    let count = || fs::read_dir(dir).unwrap().count();
    let before = count();
    let mut command = program();
    let output = command.args(args).current_dir(dir).output().unwrap();
    let printed = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {printed}");
    assert!(printed.starts_with("error: "), "{printed}");
    says(&printed, expected);
    assert_eq!(count(), before, "{args:?} wrote something");
}

const WRONG: &str = r#"
"top" => "tap"
    scene.toml: pressure[1] … did you mean 'top'
"lower face" => "bottom"
    scene.toml: contact 'interface' … face
value = 1e6 => value = "1e119*1e3"
    scene.toml: line … at most 1e120
[bodies.lower] => [bodies.lowr]
    scene.toml: bodies: the mesh has no physical group 'lowr' … did you mean 'lower'
"mesh.msh" => "nowhere.msh"
    nowhere.msh … a mesh in Gmsh's format
"mesh.msh" => "/dev/zero"
    /dev/zero … it isn't a file
"mesh.msh" => "m\u0000.msh"
    m\0.msh … can't be read
"#;

#[test]
fn what_is_wrong_between_scene_and_mesh_is_said_with_the_scene() {
    let dir = scene();
    let path = dir.path().join("scene.toml");
    let good = fs::read_to_string(&path).unwrap();
    for (from, to, expected) in cases(WRONG) {
        assert!(good.contains(&from));
        fs::write(&path, good.replacen(&from, &to, 1)).unwrap();
        refused(dir.path(), &["scene.toml"], &expected);
    }
}

#[test]
fn a_scene_of_any_name_is_read() {
    let dir = scene();
    let path = dir.path();
    fs::rename(path.join("scene.toml"), path.join("scene.geo")).unwrap();
    let made = (program().args(["scene.geo", "-n", "2"]).current_dir(path)).output();
    assert!(made.unwrap().status.success());
}

#[test]
fn a_wrong_file_is_refused_with_what_was_expected() {
    let dir = scene();
    let mut command = program();
    let args = ["scene.toml", "-o", "problem.h5"];
    let made = command.args(args).current_dir(dir.path()).output().unwrap();
    assert!(made.status.success(), "{made:?}");
    fs::write(dir.path().join("block.geo"), "Point(1) = {0, 0, 0};").unwrap();
    fs::copy(dir.path().join("mesh.msh"), dir.path().join("mesh.txt")).unwrap();
    for (file, what) in [
        (
            "problem.h5",
            "is an HDF5 file, perhaps a problem file, which contact-dd-mpi solves",
        ),
        ("mesh.msh", "is a mesh in Gmsh's format"),
        ("mesh.txt", "is a mesh in Gmsh's format"),
        ("block.geo", "is a Gmsh geometry"),
    ] {
        let expected = format!("{file}: {what}; expected a scene in TOML, whose key 'mesh'");
        refused(dir.path(), &[file], &expected);
    }
    refused(dir.path(), &["nothing.geo"], "nothing.geo: can't be read");
    let path = dir.path().join("scene.toml");
    let text = fs::read_to_string(&path).unwrap();
    let wanted = "expected a mesh in Gmsh's format";
    for (file, expected) in [
        (
            "block.geo",
            format!("block.geo … {wanted} … gmsh -2 ./block.geo -o ./block.msh"),
        ),
        (
            "problem.h5",
            format!("problem.h5: is an HDF5 file … {wanted}"),
        ),
    ] {
        fs::write(&path, text.replacen("mesh.msh", file, 1)).unwrap();
        refused(dir.path(), &["./scene.toml"], &expected);
    }
}

#[test]
fn settings_of_a_scene_are_checked_where_they_stand() {
    let dir = scene();
    let path = dir.path().join("scene.toml");
    let good = fs::read_to_string(&path).unwrap();
    for (line, expected) in [
        ("method = 'newtn'", "solver.method … did you mean 'newton'"),
        ("tolerence = 1e-8", "tolerence … did you mean 'tolerance'"),
        ("tolerance = 0.0", "solver.tolerance … a positive number"),
        (
            "tolerance = '1e-8'",
            "it is the text \"1e-8\"; expected a number",
        ),
        ("max_sweeps = -1", "solver.max_sweeps … -1"),
        ("threads = 2", "solver.threads … unknown key"),
    ] {
        let text = format!("{good}\n[solver]\n{line}\n");
        let at = format!("scene.toml: line {}", text.lines().count());
        fs::write(&path, text).unwrap();
        refused(dir.path(), &["scene.toml"], &format!("{at} … {expected}"));
    }
}

#[test]
fn pipes_and_folders_are_refused_at_once() {
    let dir = scene();
    let pipe = dir.path().join("pipe");
    let made = Command::new("mkfifo").arg(&pipe).status().unwrap();
    assert!(made.success());
    let expected = "it isn't a file; expected a scene in TOML";
    refused(dir.path(), &["pipe"], expected);
    refused(dir.path(), &["."], expected);
    let path = dir.path().join("scene.toml");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replacen("mesh.msh", "pipe", 1)).unwrap();
    refused(dir.path(), &["scene.toml"], "pipe … it isn't a file");
}

#[test]
fn options_that_would_do_nothing_are_refused() {
    let dir = scene();
    for (args, expected) in [
        (&["--refine", "3"][..], "--refine"),
        (&["--element", "quad4"], "--element"),
        (&["--write-scene", "there"], "--write-scene"),
        (&["-n", "-1"], "invalid value '-1'"),
        (&["-n", "two"], "'two' for '--subdomains <N>'"),
        (&["-np", "2"], "'p' for '--subdomains <N>'"),
        (&["-n", "0"], "expected 2"),
        (&["-n", "9999999"], "9999999 subdomains can't be"),
    ] {
        refused(dir.path(), &[&["scene.toml"], args].concat(), expected);
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
