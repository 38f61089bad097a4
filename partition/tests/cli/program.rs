//! The program as a user starts it.

use std::path::Path;
use std::process::{Command, Output};

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::example::{self, EXAMPLES};
use contact_dd_partition::mesh::gmsh;

fn program(args: &[&str], dir: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_contact-dd-partition"))
        .args(args)
        .current_dir(dir)
        .output()
        .unwrap()
}

#[test]
fn the_program_writes_a_scene_to_start_from() {
    let dir = tempfile::tempdir().unwrap();
    let args = [
        "--example",
        "patch",
        "--refine",
        "1",
        "--write-scene",
        "a/b",
    ];
    let patch = example::find("patch").unwrap();
    for (more, mesh) in [
        (&[][..], patch.mesh(1)),
        (
            &["--element", "quad9"],
            patch.mesh_of(ElementKind::Quad9, 1),
        ),
    ] {
        let output = program(&[&args[..], more].concat(), dir.path());
        assert!(output.status.success(), "{output:?}");
        let read = gmsh::read(&dir.path().join("a/b/mesh.msh")).unwrap();
        assert_eq!(read, mesh.unwrap());
    }
    assert_eq!(
        std::fs::read_dir(dir.path().join("a/b")).unwrap().count(),
        2
    );
}

#[test]
fn the_program_says_how_the_sides_of_a_contact_are_paired() {
    let dir = tempfile::tempdir().unwrap();
    let written = program(&["--example", "patch", "--write-scene", "."], dir.path());
    assert!(written.status.success(), "{written:?}");
    let path = dir.path().join("scene.toml");
    let scene = std::fs::read_to_string(&path).unwrap();
    for (pairing, expected) in [
        ("", ", node by node"),
        ("[[contact]]\npairing = 'nodes'", ", node by node"),
        ("[[contact]]\npairing = 'mortar'", ", mortar"),
    ] {
        if !pairing.is_empty() {
            std::fs::write(&path, scene.replace("[[contact]]", pairing)).unwrap();
        }
        let output = program(&["scene.toml", "-n", "2"], dir.path());
        let printed = String::from_utf8(output.stdout).unwrap();
        assert!(
            printed.lines().any(|line| line.ends_with(expected)),
            "{printed}"
        );
    }
}

#[test]
fn what_is_printed_of_a_problem_is_in_words_and_has_no_empty_line() {
    let dir = tempfile::tempdir().unwrap();
    let written = program(&["--example", "patch", "--write-scene", "."], dir.path());
    assert!(written.status.success(), "{written:?}");
    let path = dir.path().join("scene.toml");
    let scene = std::fs::read_to_string(&path).unwrap();
    let untitled: Vec<&str> = scene
        .lines()
        .filter(|line| !line.starts_with("title"))
        .collect();
    std::fs::write(&path, untitled.join("\n")).unwrap();
    for args in [&["scene.toml", "-n", "4"][..], &["--info", "scene.h5"]] {
        let output = program(args, dir.path());
        let printed = String::from_utf8(output.stdout).unwrap();
        assert!(printed.contains("linked by contact"), "{printed}");
        assert!(printed.contains("the costliest part takes 1."), "{printed}");
        let is_empty = |line: &str| line.split_whitespace().count() == 1;
        assert!(!printed.lines().any(is_empty), "{printed}");
    }
}

#[test]
fn the_program_lists_every_example() {
    let output = program(&["--list-examples"], Path::new("."));
    let list = String::from_utf8(output.stdout).unwrap();
    assert_eq!(list.lines().count(), EXAMPLES.len());
    for example in EXAMPLES {
        assert!(list.contains(example.name) && list.contains(example.about));
    }
}

/// Fails unless the program ends with `code` and an error that holds `expected`.
#[track_caller]
fn refused(args: &[&str], dir: &Path, code: i32, expected: &str) {
    let output = program(args, dir);
    let printed = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{args:?}: {printed}");
    assert!(
        printed.starts_with("error: ") && printed.contains(expected),
        "{printed}"
    );
}

#[test]
fn bad_usage_ends_with_2_and_unwritable_output_with_5() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("file"), "").unwrap();
    std::fs::create_dir(dir.path().join("dir")).unwrap();
    let scene = example::find("patch").unwrap().scene;
    std::fs::write(dir.path().join("dir/scene.toml"), scene).unwrap();
    let patch = ["--example", "patch"];
    for (more, code, expected) in [
        (&["--refine", "40"][..], 2, "refined 40 times"),
        (&["--write-scene", "file/x"], 5, "file/x"),
        (&["-o", "file/x"], 5, "file/x"),
        (&["-o", "dir"], 5, "dir: can't be written: it isn't a file"),
        (&["-n", "0"], 2, "0 subdomains can't be; expected 2 "),
        (
            &["--element", "quad5"],
            2,
            "possible values: triangle3, triangle6",
        ),
        (
            &["-n", "abc"],
            2,
            "'abc' for '--subdomains <N>': expected a whole number, 0 or more",
        ),
        (&["-n", "-1"], 2, "'-1'"),
        (&["-n"], 2, "'--subdomains <N>'"),
        (&["--frobnicate"], 2, "'--frobnicate'"),
        (&["--refin", "1"], 2, "a similar argument exists"),
        (&["scene.toml"], 2, "cannot be used with"),
    ] {
        refused(&[&patch[..], more].concat(), dir.path(), code, expected);
    }
    for (args, expected) in [
        (&[][..], "<SCENE.toml>"),
        (&["--refine", "1"], "--example"),
        (
            &["--example", "granit"],
            "a similar value exists: 'granite'",
        ),
        (&["no-such-scene.toml"], "no-such-scene.toml"),
        (&["dir/scene.toml"], "error: dir/mesh.msh: "),
    ] {
        refused(args, dir.path(), 2, expected);
    }
}

#[test]
fn the_problem_file_never_takes_the_place_of_its_scene_or_mesh() {
    let dir = tempfile::tempdir().unwrap();
    let write = ["--example", "patch", "--write-scene", "a"];
    assert!(program(&write, dir.path()).status.success());
    let before = |name: &str| std::fs::read(dir.path().join("a").join(name)).unwrap();
    let (scene, mesh) = (before("scene.toml"), before("mesh.msh"));
    for output in ["a/scene.toml", "a/../a/mesh.msh"] {
        refused(&["a/scene.toml", "-o", output], dir.path(), 2, output);
        refused(
            &[&write[..], &["-o", output]].concat(),
            dir.path(),
            2,
            output,
        );
    }
    assert_eq!((before("scene.toml"), before("mesh.msh")), (scene, mesh));
    let output = program(&["a/scene.toml", "-o", "a/problem.h5"], dir.path());
    assert!(output.status.success(), "{output:?}");
}
