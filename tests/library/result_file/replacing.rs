//! Files that a result file replaces, and places that it refuses.

use std::fs;

use contact_dd_mpi::output::result::SubdomainResults;
use contact_dd_mpi::output::vtkhdf::ResultFile;
use hdf5::File;

use super::{column, layout, row, strips, write};

#[test]
fn what_is_not_whole_replaces_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    fs::write(&path, "the result of yesterday").unwrap();
    let cells = [1, 2];

    let mut file = ResultFile::create(&path, &layout(&cells, &[])).unwrap();
    file.write_subdomains(&strips(1, &[2])).unwrap();
    let error = file.finish_step().unwrap_err().to_string();
    assert!(
        error.contains("result.vtkhdf") && error.contains("subdomain 0 is missing"),
        "{error}"
    );
    drop(file);

    let mut file = ResultFile::create(&path, &layout(&[], &[2])).unwrap();
    file.write_contacts(&[row(0, 1)]).unwrap();
    let error = file.finish_step().unwrap_err().to_string();
    assert!(
        error.contains("'crack 0': condition 0 is missing"),
        "{error}"
    );
    drop(file);

    let mut layout_in_steps = layout(&cells, &[]);
    layout_in_steps.times = vec![0.5, 0.75];
    let mut file = ResultFile::create(&path, &layout_in_steps).unwrap();
    file.write_subdomains(&strips(0, &cells)).unwrap();
    file.finish_step().unwrap();
    let error = file.finish("{}").unwrap_err().to_string();
    assert!(error.contains("step 1 is missing"), "{error}");

    drop(ResultFile::create(&path, &layout(&cells, &[])).unwrap());
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        "the result of yesterday"
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn what_has_no_place_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    let mut file = ResultFile::create(&path, &layout(&[2, 3], &[2])).unwrap();
    let mut refused = |results: SubdomainResults, words: &str| {
        let error = file.write_subdomains(&results).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    refused(strips(2, &[2]), "subdomain 2 of 2 has no place");
    refused(strips(1, &[3, 1]), "subdomain 2 of 2 has no place");
    refused(strips(0, &[2, 2]), "subdomain 1 has 4 points; expected 5");
    let mut short = strips(0, &[2]);
    short.displacement.pop();
    refused(short, "subdomain 0 has 3 displacements; expected 4");
    let mut short = strips(0, &[2, 3]);
    short.offsets.pop();
    refused(short, "subdomains 0 to 1 have 6 offsets; expected 7");
    assert!(file.write_contacts(&[row(1, 0)]).is_err());
    assert!(file.write_contacts(&[row(0, 1), row(0, 2)]).is_err());
}

#[test]
fn a_finished_file_replaces_the_one_before() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    write(&path, &[1], &[(0, 1)], "{}");
    write(&path, &[4], &[(0, 1)], "{}");
    let file = File::open(&path).unwrap();
    assert_eq!(column::<i64>(&file, "VTKHDF/NumberOfCells"), [4]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
