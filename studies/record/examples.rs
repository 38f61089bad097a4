//! The results of the built-in scenes, kept as the program writes them.

use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode};

use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::example::EXAMPLES;
use contact_dd_partition::model::Model;
use contact_dd_partition::problem::Problem;

use crate::support::solution::difference;

/// Differences, relative to the largest value of a dataset, that are none.
const SAME: f64 = 1e-12;

/// Solves every built-in scene and keeps its result in a folder under its name.
pub fn record(binary: &Path, folder: &Path) -> ExitCode {
    fs::create_dir_all(folder).unwrap();
    let mut are_solved = true;
    for example in EXAMPLES {
        let (scene, mesh) = example.make(0).unwrap();
        let model = Model::new(&scene, mesh).unwrap();
        let decomposition = Decomposition::new(&model, Some(example.subdomains)).unwrap();
        let problem = folder.join(example.name).with_extension("h5");
        (Problem::new(&model, &decomposition).unwrap())
            .write(&problem)
            .unwrap();
        let result = folder.join(example.name).with_extension("vtkhdf");
        let status = Command::new(binary)
            .arg(&problem)
            .arg("-o")
            .arg(&result)
            .status()
            .unwrap();
        fs::remove_file(problem).unwrap();
        if !status.success() {
            println!("{}: {status}", example.name);
            are_solved = false;
        }
    }
    match are_solved {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}

/// Whether all results of a folder are in another one with the same numbers; says how far they are from that.
pub fn agree(old: &Path, new: &Path) -> bool {
    let mut names: Vec<_> = (fs::read_dir(old).unwrap())
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    let mut all = true;
    for name in names {
        let (before, now) = (old.join(&name), new.join(&name));
        let (is_same, words) = match now.exists() {
            true => {
                let (difference, dataset) = difference(&before, &now);
                let words = format!("{difference:.1e} of the largest value, in {dataset}");
                (difference <= SAME, words)
            }
            false => (false, "is missing".into()),
        };
        all &= is_same;
        let verdict = if is_same { "same" } else { "DIFFERS" };
        println!("{:<24} {verdict:<8} {words}", name.display());
    }
    all
}
