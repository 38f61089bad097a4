//! Faults of `/settings`.

use std::path::Path;

use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::solver::{Method, SolverSettings};
use hdf5::types::VarLenUnicode;

use super::{Defect, problem, refuses};

/// A problem file with settings of the solver.
fn write_with_settings(path: &Path) {
    let mut problem = problem();
    problem.catalog.solver = SolverSettings {
        method: Some(Method::Picard),
        tolerance: "1e-8".parse().ok(),
        max_sweeps: Some(7),
        relaxation: "0.5".parse().ok(),
        no_stress: Some(true),
    };
    problem.write(path).unwrap();
    let read = ProblemFile::open(path).unwrap();
    assert_eq!(read.catalog().solver, problem.catalog.solver);
}

/// Replaces an attribute of `/settings`.
fn set_attribute<T: hdf5::H5Type>(file: &hdf5::File, name: &str, value: T) {
    let group = file.group("settings").unwrap();
    group.delete_attr(name).unwrap();
    let attribute = group.new_attr::<T>().create(name).unwrap();
    attribute.write_scalar(&value).unwrap();
}

#[test]
fn every_defect_of_the_settings_is_named() {
    let defects: &[Defect] = &[
        (
            "unknown method",
            |f| set_attribute(f, "method", "newtn".parse::<VarLenUnicode>().unwrap()),
            "method of /settings is \"newtn\"; expected \"newton\"",
        ),
        (
            "method by number",
            |f| set_attribute(f, "method", 1i64),
            "attribute method of /settings is 1; expected",
        ),
        (
            "tolerance of zero",
            |f| set_attribute(f, "tolerance", 0.0),
            "tolerance of /settings is 0.0 … above 0",
        ),
        (
            "relaxation that is no number",
            |f| set_attribute(f, "relaxation", f64::NAN),
            "relaxation of /settings is nan … above 0",
        ),
        (
            "sweeps below zero",
            |f| set_attribute(f, "max_sweeps", -1i64),
            "max_sweeps of /settings is -1",
        ),
        (
            "half a sweep",
            |f| set_attribute(f, "max_sweeps", 0.5),
            "max_sweeps of /settings is 0.5 … an integer",
        ),
        (
            "neither true nor false",
            |f| set_attribute(f, "no_stress", 2i64),
            "no_stress of /settings is 2; expected true",
        ),
        (
            "unknown setting",
            |f| {
                let group = f.group("settings").unwrap();
                let attribute = group.new_attr::<f64>().create("tolerence").unwrap();
                attribute.write_scalar(&1e-8).unwrap();
            },
            "attribute /settings/tolerence … did you mean 'tolerance'",
        ),
        (
            "dataset among the settings",
            |f| {
                let group = f.group("settings").unwrap();
                group.new_dataset::<f64>().create("tolerance").unwrap();
            },
            "/settings/tolerance … expected none here",
        ),
        (
            "settings that are no group",
            |f| {
                f.unlink("settings").unwrap();
                f.new_dataset::<f64>().create("settings").unwrap();
            },
            "/settings isn't a group",
        ),
    ];
    refuses(write_with_settings, defects);
}
