//! Problem files for which there is no space.

use std::process::Command;

use crate::mounted::Mounted;

#[test]
fn a_problem_file_without_space_leaves_the_older_one_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("output");
    // The problem file has some 380 kB.
    for (place, words) in [
        (Mounted::OfSize(4 << 10), "No space left on device"),
        (Mounted::OfSize(20 << 10), "No space left on device"),
        (Mounted::OfSize(150 << 10), "No space left on device"),
        (Mounted::OfSize(340 << 10), "No space left on device"),
        (Mounted::ReadOnly, "Read-only file system"),
    ] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_contact-dd-partition"));
        program.args(["--example", "granite", "-n", "8", "-o"]);
        program.arg(&output);
        let Some(mut program) = place.around(folder.path(), &program) else {
            eprintln!("skipped: nothing may be mounted here");
            return;
        };
        let ended = program.output().unwrap();
        let printed = String::from_utf8(ended.stderr).unwrap();
        assert_eq!(ended.status.code(), Some(5), "{place:?}: {printed}");
        assert_eq!(printed.lines().count(), 1, "{printed}");
        assert!(printed.contains(&output.display().to_string()), "{printed}");
        assert!(printed.contains(words), "{printed}");
    }
}
