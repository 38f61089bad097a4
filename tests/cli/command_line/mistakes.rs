//! One wrong file for another: one line that says what it is and what to do with it.

use std::path::Path;

use contact_dd_partition::example;

use super::granite;
use crate::support::process::Running;
use crate::support::solver::{LIMIT, program};

/// Fails unless the program ends with 2 and one line with all words.
#[track_caller]
fn refused(args: &[&str], folder: &Path, words: &[&str]) {
    let mut command = program(0);
    let ended = Running::start(command.args(args).current_dir(folder)).wait(LIMIT);
    assert_eq!(ended.code(), 2, "{args:?}: {}", ended.stderr);
    assert_eq!(ended.stderr.lines().count(), 1, "{}", ended.stderr);
    assert!(ended.stderr.starts_with("error: "), "{}", ended.stderr);
    for word in words {
        assert!(ended.stderr.contains(word), "{word} in {}", ended.stderr);
    }
}

#[test]
fn whoever_gives_the_wrong_file_is_told_what_to_do_with_it() {
    let case = granite("[solver]\nmethod = 'picard'\ntolerance = 1e-4\n");
    let folder = case.folder();
    let solved = case.run(&["--max-sweeps", "3", "--checkpoint-every", "2"]);
    assert_eq!(solved.code(), 3, "{}", solved.stderr);
    let patch = example::find("patch").unwrap();
    patch.write(&patch.mesh(0).unwrap(), folder).unwrap();
    for (file, words) in [
        (
            "scene.toml",
            ["is a scene", "contact-dd-partition scene.toml makes"],
        ),
        ("mesh.msh", ["is a mesh", "mesh = \"mesh.msh\""]),
        (
            "problem.vtkhdf",
            ["is a result of contact-dd-mpi", "ParaView"],
        ),
        (
            "problem.vtkhdf.checkpoint",
            ["is a checkpoint", "--restart"],
        ),
    ] {
        let words = [words[0], words[1], "expected a problem file"];
        refused(&[file], folder, &words);
    }
    let words = ["is a problem file; expected settings in TOML"];
    refused(&["problem.h5", "--settings", "problem.h5"], folder, &words);
    let words = ["scene.toml: line 3", "unknown key 'title'"];
    refused(&["problem.h5", "--settings", "scene.toml"], folder, &words);
    refused(&["nothing.h5"], folder, &["nothing.h5", "No such file"]);
}

#[test]
fn bad_usage_is_one_line_with_a_hint() {
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
            "'--threads <N>': expected 1 or more",
        ),
        (&["a.h5", "-n", "2"], "mpirun -n N contact-dd-mpi (--help"),
        (&["a.h5", "b.h5"], "'b.h5'"),
        (&["a.h5", "--generate", "man"], "cannot be used with"),
        (&["--generate", "woman"], "[possible values: man, "),
    ] {
        refused(args, folder.path(), &[word, "(--help tells more)"]);
    }
}
