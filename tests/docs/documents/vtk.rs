//! Results and problem files opened by VTK's own reader, as ParaView and PyVista do.

use std::process::Command;

use super::page::root;
use super::run::{Folder, python};

/// Name, number of ranks, kind of cells and load steps.
pub const CASES: [(&str, usize, &str, &str); 5] = [
    ("on_1_rank", 1, "triangle3", ""),
    ("on_3_ranks", 3, "triangle6", ""),
    ("of_8_nodes", 1, "quad8", ""),
    ("of_9_nodes", 3, "quad9", ""),
    (
        "in_load_steps",
        2,
        "triangle6",
        "[[step]]\nscale = 0.1\n[[step]]\n[[step]]\nscale = 2\n",
    ),
];

/// Number of subdomains of the cases.
const SUBDOMAINS: &str = "6";

/// A test: `vtkHDFReader` finds the same partitions, points, cells and fields as h5py, in the result and in
/// the problem file.
pub fn reads_the_same(ranks: usize, element: &str, steps: &str) {
    let folder = Folder::new();
    let ranks = ranks.to_string();
    let python = python().expect("cases that need Python are ignored without it");
    let check = root().join("tests/docs/documents/opened_by_vtk.py");
    let mut write = Command::new("contact-dd-partition");
    write.args(["--example", "junction", "--element", element]);
    write.args(["--write-scene", "."]);
    let mut add_steps = Command::new("sh");
    add_steps.args(["-c", "printf '%s' \"$1\" >> scene.toml", "sh", steps]);
    let mut partition = Command::new("contact-dd-partition");
    partition.args(["scene.toml", "-n", SUBDOMAINS, "-o", "problem.h5"]);
    let mut solve = Command::new("mpirun");
    solve.args([
        "-n",
        &ranks,
        "contact-dd-mpi",
        "problem.h5",
        "-o",
        "result.vtkhdf",
    ]);
    let compare = |file: &str, fields: &[&str]| {
        let mut compare = Command::new(&python);
        compare.arg(&check).args([file, SUBDOMAINS]).args(fields);
        compare
    };
    let compare_problem = compare("problem.h5", &["CellData/Subdomain"]);
    let compare_result = compare(
        "result.vtkhdf",
        &[
            "PointData/Displacement",
            "PointData/Stress",
            "PointData/VonMises",
            "CellData/VonMises",
        ],
    );
    for mut command in [
        write,
        add_steps,
        partition,
        solve,
        compare_problem,
        compare_result,
    ] {
        let ended = folder.run(&mut command);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    }
}
