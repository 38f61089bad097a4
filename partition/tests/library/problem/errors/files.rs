//! Problem files that aren't whole, or can't be written.

use contact_dd_partition::problem::read::ProblemFile;

use super::{problem, write};

#[test]
fn a_file_cut_short_anywhere_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("problem.h5");
    write(&path);
    let whole = std::fs::read(&path).unwrap();
    for part in 0..20 {
        std::fs::write(&path, &whole[..whole.len() * part / 20]).unwrap();
        let message = ProblemFile::open(&path).unwrap_err().to_string();
        assert!(message.starts_with(path.to_str().unwrap()), "{message}");
    }
    for missing in [
        folder.path().join("nothing.h5"),
        folder.path().to_path_buf(),
    ] {
        let message = ProblemFile::open(&missing).unwrap_err().to_string();
        assert!(message.starts_with(missing.to_str().unwrap()), "{message}");
    }
}

#[test]
fn a_file_that_cannot_be_written_leaves_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("nowhere").join("problem.h5");
    let error = problem().write(&inside).unwrap_err();
    assert_eq!(error.path, inside);
    let error = problem().write(folder.path()).unwrap_err();
    assert!(error.to_string().contains("isn't a file"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);

    let path = folder.path().join("problem.h5");
    std::fs::write(&path, "something else").unwrap();
    write(&path);
    ProblemFile::open(&path).unwrap();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
