//! Wrong files and invalid usage.

use std::path::Path;

use contact_dd_partition::example;

use super::granite;
use crate::support::process::Running;
use crate::support::solver::{LIMIT, program};

/// Fails unless the program ends with 2 and an error that contains all words.
#[track_caller]
fn refused(args: &[&str], folder: &Path, words: &[&str]) {
    let mut command = program(0);
    let ended = Running::start(command.args(args).current_dir(folder)).wait(LIMIT);
    assert_eq!(ended.code(), 2, "{args:?}: {}", ended.stderr);
    assert_eq!(ended.stderr.matches("error: ").count(), 1);
    assert!(ended.stderr.starts_with("error: "), "{}", ended.stderr);
    for word in words {
        assert!(ended.stderr.contains(word), "{word} in {}", ended.stderr);
    }
}

#[test]
fn a_wrong_file_is_refused_with_what_was_expected() {
    let case = granite("");
    let folder = case.folder();
    let patch = example::find("patch").unwrap();
    patch.write(&patch.mesh(0).unwrap(), folder).unwrap();
    for (file, words) in [
        (
            "scene.toml",
            "is a scene; expected a problem file: contact-dd-partition scene.toml -o scene.h5",
        ),
        (
            "mesh.msh",
            "is a mesh in Gmsh's format; expected a problem file, which contact-dd-partition makes",
        ),
    ] {
        refused(&[file], folder, &[file, words]);
    }
    assert_eq!(case.run(&[]).code(), 0);
    let result = case.result();
    let result = result.to_str().unwrap();
    refused(
        &[result],
        folder,
        &[
            result,
            "is a result of contact-dd-mpi; expected the problem file",
        ],
    );
    refused(&["nothing.h5"], folder, &["nothing.h5", "No such file"]);
}

#[test]
fn bad_usage_ends_with_a_hint() {
    let folder = tempfile::tempdir().unwrap();
    for (args, word) in [
        (&[][..], "<PROBLEM>"),
        (
            &["a.h5", "--metod", "newton"],
            "a similar argument exists: '--method'",
        ),
        (
            &["a.h5", "--method", "newtn"],
            "a similar value exists: 'newton'",
        ),
        (&["a.h5", "--tolerance", "0"], "expected a positive number"),
        (&["a.h5", "--tolerance"], "'--tolerance <X>'"),
        (
            &["a.h5", "--threads", "0"],
            "'--threads <N>': expected a whole number from 1 to 65535",
        ),
        (
            &["a.h5", "--max-sweeps", "1.5"],
            "'--max-sweeps <N>': expected a whole number, 0 or more",
        ),
        (&["a.h5", "-n", "2"], "'-n'"),
        (&["a.h5", "b.h5"], "'b.h5'"),
        (&["a.h5", "--generate", "man"], "cannot be used with"),
        (&["--generate", "woman"], "[possible values: man, "),
    ] {
        refused(args, folder.path(), &[word, "--help"]);
    }
}
