//! The iterative interface solver between clusters of subdomains.

use contact_dd_partition::model::Model;

use crate::support::blocks::{Blocks, jittered};
use crate::support::scenes::{built_in_model, model};
use crate::support::solution::Solution;
use crate::support::solver::{Case, problem};

const ITERATIVE: [&str; 2] = ["--interface", "iterative"];

/// The largest difference of displacements over the largest displacement.
fn difference(a: &Solution, b: &Solution) -> f64 {
    let of_node = |(tag, u): (&i64, &[f64; 3])| {
        let v = b.displacement[tag];
        (0..3).map(|i| (u[i] - v[i]).abs()).fold(0.0, f64::max)
    };
    let largest = a.displacement.iter().map(of_node).fold(0.0, f64::max);
    largest / a.largest_displacement()
}

fn iterations(solution: &Solution) -> Vec<u64> {
    assert_eq!(solution.report["interface_solver"], "iterative");
    let counts = solution.report["interface_iterations"].as_array().unwrap();
    counts.iter().filter_map(|count| count.as_u64()).collect()
}

#[test]
fn displacements_and_contacts_are_those_of_the_direct_solver() {
    for name in [
        "plain", "granite", "hertz", "patch", "crack", "junction", "stack",
    ] {
        let case = Case::in_clusters(&built_in_model(name, 0), 40, 14);
        let (direct, iterative) = (case.solve(&[]), case.solve(&ITERATIVE));
        let difference = difference(&direct, &iterative);
        assert!(difference < 1e-10, "{name}: {difference:e}");
        assert_eq!(direct.closed(), iterative.closed(), "{name}");
        let most = iterations(&iterative).into_iter().max();
        assert!(most.is_some_and(|most| most > 1), "{name}: {most:?}");
    }
}

/// A plate of squares of two materials, 7 along its height, held on the left and pulled on the right.
fn checkerboard(young: [f64; 2], poisson: f64, length: usize, cells: usize) -> Model {
    let mut blocks = Blocks::new();
    for i in 0..7 * length {
        for j in 0..7 {
            let end = match i {
                0 => " at the left",
                i if i + 1 == 7 * length => " at the right",
                _ => "",
            };
            let name = format!("{}{end}", ["even", "odd"][(i + j) % 2]);
            let side = |i: usize| [i as f64 / 7.0, (i + 1) as f64 / 7.0];
            blocks = blocks.rectangle(&name, side(i), side(j), [cells, cells]);
        }
    }
    let mesh = blocks.glued(|_, _| true).mesh;
    let mut scene = String::from("plane = 'strain'\n");
    for (kind, young) in ["even", "odd"].into_iter().zip(young) {
        scene += &format!("[materials.{kind}]\nyoung = {young}\npoisson = {poisson}\n");
        for end in ["", " at the left", " at the right"] {
            scene += &format!("[bodies.'{kind}{end}']\nmaterial = '{kind}'\n");
        }
    }
    for kind in ["even", "odd"] {
        scene += &format!("[[displacement]]\non = '{kind} at the left left'\nx = 0.0\ny = 0.0\n");
        scene += &format!("[[traction]]\non = '{kind} at the right right'\nvalue = [1e2, -2e2]\n");
    }
    let step = 1.0 / (7 * cells) as f64;
    model(&scene, jittered(mesh, 0.2 * step, 3))
}

#[test]
fn the_number_of_iterations_does_not_grow_with_that_of_clusters() {
    let plate = checkerboard([1e9, 1e9], 0.3, 1, 10);
    let of = |clusters| iterations(&Case::in_clusters(&plate, 100, clusters).solve(&ITERATIVE))[0];
    let (few, many) = (of(16), of(64));
    assert!(few <= 20 && many <= 20, "{few}, {many}");
    assert!(many as f64 <= 1.2 * few as f64, "{few}, {many}");
}

#[test]
fn contrast_and_slender_and_nearly_incompressible_bodies_take_few_more() {
    for (name, plate) in [
        ("contrast", checkerboard([1e9, 1e3], 0.3, 1, 8)),
        ("slender", checkerboard([1e9, 1e9], 0.3, 10, 3)),
        ("incompressible", checkerboard([1e9, 1e9], 0.4999, 1, 8)),
    ] {
        let case = Case::in_clusters(&plate, 100, 30);
        let (direct, iterative) = (case.solve(&[]), case.solve(&ITERATIVE));
        let taken = iterations(&iterative)[0];
        assert!(taken <= 40, "{name}: {taken}");
        let difference = difference(&direct, &iterative);
        // Either solution is as good as the condition number lets it be.
        let condition = direct.report["condition_number"].as_f64().unwrap();
        let limit = 4.0 * f64::EPSILON * condition;
        assert!(difference < limit, "{name}: {difference:e}, {limit:e}");
    }
}

#[test]
fn a_file_without_clusters_is_refused_in_words() {
    let mut problem = problem(&built_in_model("plain", 0), Some(4));
    problem.catalog.hierarchy.clusters.clear();
    let case = Case::new(&problem);
    assert_eq!(case.run(&[]).code(), 0);
    let ended = case.run(&ITERATIVE);
    assert_eq!(ended.code(), 2, "{}{}", ended.stdout, ended.stderr);
    assert!(ended.errors()[0].contains("/hierarchy/cluster is missing"));
}

#[test]
fn one_cluster_and_friction_are_solved_directly_and_said_to_be() {
    for (name, clusters, why) in [("plain", 1, "one cluster"), ("raous", 6, "friction")] {
        let solution = Case::in_clusters(&built_in_model(name, 0), 8, clusters).solve(&ITERATIVE);
        assert_eq!(solution.report["interface_solver"], "direct");
        let warnings = solution.report["warnings"].to_string();
        assert!(warnings.contains(why), "{warnings}");
    }
}
