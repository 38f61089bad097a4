//! Results and problem files opened by VTK's reader, as in ParaView and PyVista.

use std::process::Command;

use super::page::root;
use super::run::{Folder, python};

/// A built-in scene to be solved and opened.
pub struct Case {
    pub name: &'static str,
    ranks: usize,
    example: &'static str,
    element: &'static str,
    steps: &'static str,
}

const fn case(
    name: &'static str,
    ranks: usize,
    example: &'static str,
    element: &'static str,
    steps: &'static str,
) -> Case {
    Case {
        name,
        ranks,
        example,
        element,
        steps,
    }
}

const STEPS: &str = "[[step]]\nscale = 0.1\n[[step]]\n[[step]]\nscale = 2\n";

pub const CASES: [Case; 9] = [
    case("on_1_rank", 1, "junction", "triangle3", ""),
    case("on_3_ranks", 3, "junction", "triangle6", ""),
    case("of_8_nodes", 1, "junction", "quad8", ""),
    case("of_9_nodes", 3, "junction", "quad9", ""),
    case("in_load_steps", 2, "junction", "triangle6", STEPS),
    case("that_come_and_go", 2, "tunnel", "quad8", ""),
    case("in_space", 2, "cube-crack", "tetrahedron4", STEPS),
    case("of_20_nodes", 1, "cube-crack", "hexahedron20", ""),
    case("of_27_nodes", 2, "pin", "hexahedron27", ""),
];

/// Number of subdomains of the cases.
const SUBDOMAINS: &str = "6";

/// A test: `vtkHDFReader` finds the same partitions, points, cells and fields as h5py, in the result and in the problem
/// file.
pub fn reads_the_same(case: &Case) {
    let folder = Folder::new();
    let ranks = case.ranks.to_string();
    let python = python().expect("cases that need Python are ignored without it");
    let check = root().join("tests/docs/documents/opened_by_vtk.py");
    let mut write = Command::new("contact-dd-partition");
    write.args(["--example", case.example, "--element", case.element]);
    write.args(["--write-scene", "."]);
    let mut add_steps = Command::new("sh");
    add_steps.args(["-c", "printf '%s' \"$1\" >> scene.toml", "sh", case.steps]);
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
