//! Ties of sides, and linear equations between displacements.

mod convergence;
mod elsewhere;
mod equation;
mod patch;
mod refused;
mod seam;

use contact_dd_partition::model::Model;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::model;
use crate::support::solution::{Solution, datasets, difference};
use crate::support::solver::{Case, solve};
use crate::support::sorts::SORTS;

/// Plane state, material and bodies.
const ROCK: &str = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.22}
bodies.lower.material = 'rock'
bodies.upper.material = 'rock'
";

/// The tie of the upper block to the lower one.
const WELD: &str = "
[[tie]]
name = 'weld'
sides = ['upper bottom', 'lower top']
";

/// Support of the lower block, and tension, shear and bending of the upper one.
const LOADED: &str = "
[[displacement]]
on = 'lower bottom'
x = 0.0
y = 0.0
[[traction]]
on = 'upper top'
value = ['1e6*x', '-2e6*(x-0.3)']
[[pressure]]
on = 'upper right'
value = '1e6*y'
";

/// Fails unless two solutions have the same displacements at coincident nodes.
#[track_caller]
fn same_displacements(one: (&Model, &Solution), other: (&Model, &Solution), slack: f64) {
    let scale = one.1.largest_displacement();
    let at = |model: &Model, solution: &Solution| -> Vec<([f64; 3], [f64; 3])> {
        let nodes = model.mesh.points.iter().zip(&model.mesh.node_tags);
        nodes
            .map(|(x, tag)| (*x, solution.displacement[tag]))
            .collect()
    };
    let others = at(other.0, other.1);
    for (x, u) in at(one.0, one.1) {
        let near = |y: &[f64; 3]| (0..3).all(|k| (x[k] - y[k]).abs() < 1e-9);
        let found = others.iter().filter(|(y, _)| near(y));
        let mut count = 0;
        for (_, v) in found {
            (0..3).for_each(|k| close(v[k], u[k], slack * scale));
            count += 1;
        }
        assert!(count > 0, "no node at {x:?}");
    }
}

/// A tie of matching sides is equivalent to merging their nodes, in all kinds of cells.
#[test]
fn sides_that_match_are_as_if_they_shared_nodes() {
    let two = Blocks::new()
        .rectangle("lower", [0.0, 1.0], [0.0, 1.0], [4, 3])
        .rectangle("upper", [0.0, 1.0], [1.0, 2.5], [4, 5]);
    let one = two.clone().glued(|_, y| (y - 1.0).abs() < 1e-9);
    for sort in SORTS {
        let tied = model(&format!("{ROCK}{LOADED}{WELD}"), sort.of(&two.mesh));
        let shared = model(&format!("{ROCK}{LOADED}"), sort.of(&one.mesh));
        let expected = solve(&shared, 1);
        for count in [2, 6] {
            let solution = solve(&tied, count);
            same_displacements((&tied, &solution), (&shared, &expected), 1e-10);
        }
    }
}

/// The tie of a model as rows of equations: every jump is 0 along every axis.
fn rows(model: &Model) -> Vec<Vec<(usize, f64)>> {
    let dim = model.mesh.dim;
    let points = model.contacts.iter().flat_map(|contact| &contact.points);
    let of_axis = |k: usize| {
        points.clone().map(move |point| {
            let entries = point.entries.iter();
            entries
                .map(|&(node, w)| (node as usize * dim + k, w))
                .collect()
        })
    };
    (0..dim).flat_map(of_axis).collect()
}

/// The system of the whole mesh with a multiplier for every component of every jump.
#[test]
fn a_tie_is_what_lagrange_multipliers_make_of_the_whole_mesh() {
    let mesh = Blocks::new()
        .rectangle("lower", [0.0, 1.0], [0.0, 1.0], [4, 3])
        .rectangle("upper", [0.0, 1.0], [1.0, 2.5], [7, 5])
        .mesh;
    let tied = model(&format!("{ROCK}{LOADED}{WELD}"), mesh);
    let mut free = tied.clone();
    free.contacts.clear();
    let expected = Monolithic::with(&free, rows(&tied));
    let solution = solve(&tied, 5);
    let scale = solution.largest_displacement();
    for (u, v) in solution.dofs(&tied).iter().zip(&expected.u) {
        close(*u, *v, 1e-11 * scale);
    }
}

/// The force of a tie balances the loads beyond it.
#[test]
fn a_tie_carries_what_acts_beyond_it() {
    let mesh = Blocks::new()
        .rectangle("lower", [0.0, 1.0], [0.0, 1.0], [4, 3])
        .rectangle("upper", [0.0, 1.0], [1.0, 2.0], [6, 5])
        .mesh;
    let text = format!(
        "{ROCK}{WELD}
[[displacement]]
on = 'lower bottom'
x = 0.0
y = 0.0
[[traction]]
on = 'upper top'
value = [2e6, 3e6]
"
    );
    let solution = solve(&model(&text, mesh), 4);
    let weld = &solution.report["contacts"][0];
    assert_eq!(weld["name"], "weld");
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    // The force of the lower block on the upper one, side a.
    close(number(&weld["force"][0]), -2e6, 1e-8 * 2e6);
    close(number(&weld["force"][1]), -3e6, 1e-8 * 2e6);
    // The moment about the origin: it includes that of the traction, 1 m above the tie.
    let moment = -(0.5 * 3e6 - 2.0 * 2e6);
    close(number(&weld["moment"][2]), moment, 1e-8 * 2e6);
    assert!(
        solution.contacts["weld"]
            .iter()
            .all(|point| point.closed && point.gap == 0.0)
    );
    assert!(
        solution.contacts["weld"]
            .iter()
            .any(|point| point.force < -1e5)
    );
}

/// The solution has the same bits on any number of ranks, and both solvers agree.
#[test]
fn ranks_and_solvers_make_no_difference() {
    let mesh = Blocks::new()
        .rectangle("lower", [0.0, 4.0], [0.0, 1.0], [16, 4])
        .rectangle("upper", [0.0, 4.0], [1.0, 2.0], [23, 5])
        .mesh;
    let tied = model(&format!("{ROCK}{LOADED}{WELD}"), mesh);
    for clusters in [1, 4] {
        let case = Case::in_clusters(&tied, 9, clusters);
        case.solve(&[]);
        let direct = case.folder().join("direct.vtkhdf");
        std::fs::rename(case.result(), &direct).unwrap();
        let expected = datasets(&direct);
        for ranks in [2, 3, 4] {
            let ended = case.run_on(ranks, &[]);
            assert_eq!(ended.code(), 0, "{}", ended.stderr);
            assert!(datasets(&case.result()) == expected, "{ranks} ranks");
        }
        case.solve(&["--interface", "iterative"]);
        let (apart, at) = difference(&direct, &case.result());
        assert!(apart < 1e-9, "{apart:e} in {at}");
        let one = datasets(&case.result());
        for ranks in [2, 3] {
            let ended = case.run_on(ranks, &["--interface", "iterative"]);
            assert_eq!(ended.code(), 0, "{}", ended.stderr);
            assert!(datasets(&case.result()) == one, "{ranks} ranks");
        }
    }
}
