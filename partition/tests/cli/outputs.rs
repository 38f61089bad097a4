//! Files that the program writes, those that it leaves alone, and places where it can't write.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

fn program(args: &[&str], folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_contact-dd-partition"));
    command.args(args).current_dir(folder).output().unwrap()
}

/// The output of a program that ended with this exit code.
#[track_caller]
fn printed(output: &Output, code: i32) -> String {
    let printed = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{printed}");
    printed
}

#[test]
fn a_scene_that_was_edited_is_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let write = ["--example", "pin", "--write-scene", "here"];
    printed(&program(&write, folder.path()), 0);
    // What is there already may be written again.
    printed(&program(&write, folder.path()), 0);
    let here = folder.path().join("here");
    let files: Vec<_> = fs::read_dir(&here)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    assert!(files.len() > 1, "{files:?}");
    for file in &files {
        let before = fs::read(file).unwrap();
        let edited = [&before[..], b"\n"].concat();
        fs::write(file, &edited).unwrap();
        let words = printed(&program(&write, folder.path()), 5);
        let name = file.file_name().unwrap().to_str().unwrap();
        assert!(
            words.contains(name) && words.contains("expected"),
            "{words}"
        );
        assert_eq!(fs::read(file).unwrap(), edited);
        // Nothing else is written then.
        fs::remove_file(&files[0]).unwrap();
        if file != &files[0] {
            printed(&program(&write, folder.path()), 5);
            assert!(!files[0].exists());
        }
        fs::write(file, &before).unwrap();
        printed(&program(&write, folder.path()), 0);
    }
}

#[test]
fn a_problem_file_takes_the_place_of_no_file_that_it_is_made_from() {
    let folder = tempfile::tempdir().unwrap();
    let deck = "*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*INCLUDE,INPUT=part.inc\n";
    let part = "*ELEMENT,TYPE=CPE4,ELSET=block\n1,1,2,3,4\n*SURFACE,NAME=bottom\nblock,S1\n*SURFACE,NAME=top\nblock,S3\n";
    let scene = "mesh = 'deck.inp'\nplane = 'strain'\nmaterials.steel = {young = 2e11, poisson = 0.3}\n\
                 bodies.block.material = 'steel'\n[[displacement]]\non = 'bottom'\nx = 0\ny = 0\n\
                 [[pressure]]\non = 'top'\nvalue = 1e6\n";
    let inputs = [
        ("deck.inp", deck),
        ("part.inc", part),
        ("scene.toml", scene),
    ];
    for (name, text) in inputs {
        fs::write(folder.path().join(name), text).unwrap();
    }
    std::os::unix::fs::symlink("part.inc", folder.path().join("link.h5")).unwrap();
    for (output, _) in inputs.into_iter().chain([("link.h5", "")]) {
        let refused = program(&["scene.toml", "-o", output], folder.path());
        assert!(printed(&refused, 2).contains("would overwrite its input"));
    }
    for (name, text) in inputs {
        assert_eq!(fs::read_to_string(folder.path().join(name)).unwrap(), text);
    }
    printed(
        &program(&["scene.toml", "-o", "problem.h5"], folder.path()),
        0,
    );
    printed(
        &program(&["scene.toml", "-o", "problem.h5"], folder.path()),
        0,
    );
}

#[test]
fn what_cant_be_said_is_an_error_but_for_a_closed_pipe() {
    let folder = tempfile::tempdir().unwrap();
    let runs: [&[&str]; 5] = [
        &["--help"],
        &["--list-examples"],
        &["--generate", "man"],
        &["--example", "patch", "-o", "problem.h5"],
        &["--info", "problem.h5"],
    ];
    for args in runs {
        let mut command = Command::new(env!("CARGO_BIN_EXE_contact-dd-partition"));
        command.args(args).current_dir(folder.path());
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let output = command.stdout(full).output().unwrap();
        let words = printed(&output, 5);
        assert!(
            words.contains("stdout") && words.contains("No space left"),
            "{words}"
        );
        let mut running = command.stdout(Stdio::piped()).spawn().unwrap();
        drop(running.stdout.take());
        assert!(running.wait().unwrap().success(), "{args:?}");
    }
}

#[test]
fn without_memory_it_ends_with_words() {
    let folder = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_contact-dd-partition");
    let mut ended = Vec::new();
    for megabytes in [60, 90, 120, 150, 200] {
        let script = format!(
            "ulimit -v {}; exec \"$0\" --example granite --refine 5 -o g.h5",
            megabytes << 10
        );
        let mut command = Command::new("sh");
        command
            .args(["-c", &script, program])
            .current_dir(folder.path());
        let output = command.output().unwrap();
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            output.status.code().is_some(),
            "{megabytes} MB: {:?}, {words}",
            output.status
        );
        ended.push(words);
    }
    assert!(
        ended
            .iter()
            .any(|words| words.contains("error: out of memory")),
        "{ended:?}"
    );
}

/// `--restart` and whoever keeps files by their digests know a problem by its bytes.
#[test]
fn the_same_scene_is_the_same_bytes_whenever_it_is_written() {
    let folder = tempfile::tempdir().unwrap();
    // With friction and settings; with load steps in which bodies come and go; with mortar and its probes; in space.
    let write = |name: &str| -> Vec<Vec<u8>> {
        let scenes = ["granite-friction", "tunnel", "gears", "cube-crack"].into_iter();
        let written = scenes.map(|scene| {
            let args = ["--example", scene, "-n", "8", "-o", name];
            printed(&program(&args, folder.path()), 0);
            fs::read(folder.path().join(name)).unwrap()
        });
        written.collect()
    };
    let first = write("first.h5");
    // HDF5 counts the times of its objects in seconds.
    std::thread::sleep(std::time::Duration::from_millis(1100));
    assert!(first == write("second.h5"));
}
