//! The iterative interface solver between clusters of subdomains.

mod choice;
mod dependent;

use contact_dd_partition::element::ElementKind::{Hexahedron8, Tetrahedron10};
use contact_dd_partition::model::Model;

use crate::space::contact::rocking_scene;
use crate::support::blocks::{Blocks, joined};
use crate::support::scenes::{built_in, built_in_model, checkerboard, columns, model};
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::{Case, LIMIT, built, problem};
use crate::support::stress::space::{draw_frictional_in_space, draw_in_space};
use crate::support::stress::trial::{Interface, Trial, Verdict};

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

#[test]
fn displacements_and_contacts_are_those_of_the_direct_solver_in_space() {
    // Sides with matching nodes, and sides of different widths.
    for (kind, wide, upper) in [
        (Hexahedron8, [0.0, 1.0], [6, 4, 3]),
        (Hexahedron8, [0.0, 1.2], [7, 4, 3]),
        (Tetrahedron10, [-0.1, 1.0], [3, 2, 1]),
    ] {
        let below = between([wide[0], 0.0, 0.0], [wide[1], 1.0, 0.5]);
        let above = between([0.0, 0.0, 0.5], [1.0, 1.0, 1.0]);
        let lower = if kind == Hexahedron8 {
            [6, 4, 3]
        } else {
            [4, 2, 1]
        };
        let mesh = joined(
            solid("lower", kind, lower, below),
            solid("upper", kind, upper, above),
        );
        let model = model(&rocking_scene().replace("1.3-1.6*x", "2.0-3.5*x"), mesh);
        let case = Case::in_clusters(&model, 10, 7);
        let (direct, iterative) = (case.solve(&[]), case.solve(&ITERATIVE));
        let difference = difference(&direct, &iterative);
        assert!(difference < 1e-10, "{kind:?}: {difference:e}");
        assert_eq!(direct.closed(), iterative.closed());
        assert!(
            (1..direct.points().count()).contains(&direct.closed()),
            "{kind:?}"
        );
        assert!(iterations(&iterative).into_iter().max() > Some(1));
    }
}

/// Active sets that recur with inaccurate solutions or with springs in some of them, bodies without contact pressure in
/// the end, and forces that are tiny compared with the largest but hold a body.
#[test]
fn scenes_in_space_that_are_hard_to_settle_are_solved_between_clusters() {
    for seed in [2, 29, 55, 220, 331] {
        let drawn = draw_in_space(seed, 12);
        let trial = Trial::with(&drawn, built(), LIMIT, None, Interface::Iterative(8));
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
    }
}

/// Subdomains compute displacements at closed contacts from those of the other side, each in its own order: the round-off of
/// a soft side would be much for a stiff one.
#[test]
fn subdomains_of_a_stiff_body_have_one_displacement_of_a_node() {
    let drawn = draw_frictional_in_space(41_000_454, 12);
    let trial = Trial::with(&drawn, built(), LIMIT, None, Interface::Iterative(8));
    assert_eq!(trial.verdict, Verdict::Right, "{}", trial.reason);
}

#[test]
fn contrast_and_nearly_incompressible_columns_take_few_more_iterations() {
    for (name, young, poisson, most) in [
        ("uniform", [1e9, 1e9], 0.3, 20),
        ("contrast", [1e9, 1e3], 0.3, 30),
        ("incompressible", [1e9, 1e9], 0.4999, 60),
    ] {
        let case = Case::in_clusters(&columns(young, poisson, 1, 6), 12, 8);
        let taken = iterations(&case.solve(&ITERATIVE))[0];
        assert!(taken <= most, "{name}: {taken}");
    }
}

#[test]
fn the_number_of_iterations_does_not_grow_with_that_of_clusters() {
    let plate = checkerboard([1e9, 1e9], 0.3, 1, 10);
    let of = |clusters| iterations(&Case::in_clusters(&plate, 100, clusters).solve(&ITERATIVE))[0];
    let (few, many) = (of(16), of(64));
    assert!(few <= 20 && many <= 20, "{few}, {many}");
    // By a fifth, for integers.
    assert!(many as f64 <= (1.2 * few as f64).ceil(), "{few}, {many}");
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
        // The accuracy of both solutions is limited by the condition number.
        let condition = direct.report["condition_number"].as_f64().unwrap();
        let limit = 4.0 * f64::EPSILON * condition;
        assert!(difference < limit, "{name}: {difference:e}, {limit:e}");
    }
}

#[test]
fn a_check_says_how_large_the_coarse_problem_will_be() {
    for (model, subdomains, clusters) in [
        (checkerboard([1e9, 1e9], 0.3, 1, 6), 40, 12),
        (columns([1e9, 1e9], 0.3, 1, 6), 12, 8),
    ] {
        let case = Case::in_clusters(&model, subdomains, clusters);
        let checked = case.run(&["--check", "--interface", "iterative"]);
        assert_eq!(checked.code(), 0, "{}", checked.stderr);
        let mut lines = checked.stdout.lines().map(str::trim_start);
        let line = lines.find(|line| line.starts_with("coarse")).unwrap();
        let estimated: f64 = line.split_whitespace().nth(1).unwrap().parse().unwrap();
        let made = &case.solve(&ITERATIVE).report["coarse_dofs"];
        let ratio = estimated / made.as_f64().unwrap();
        assert!((0.8..1.25).contains(&ratio), "{estimated}, {made}");
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

/// Tolerance of friction: statuses may differ where a force is within 1e-12 of its bound, and slipping points move by
/// more.
const FRICTION: f64 = 1e-9;

#[test]
fn friction_is_that_of_the_direct_solver() {
    for name in ["raous", "granite-friction", "mindlin", "shrink-fit"] {
        let model = built_in_model(name, 0);
        let case = Case::in_clusters(&model, 16, 6);
        let all = |args: &[&str]| {
            let ended = case.run(args);
            assert_eq!(ended.code(), 0, "{name}: {}", ended.stderr);
            let all = Solution::increments(&case.result(), !model.steps.is_empty());
            all.iter().for_each(Solution::check_certificate);
            all
        };
        let (direct, iterative) = (all(&[]), all(&ITERATIVE));
        for (direct, iterative) in direct.iter().zip(&iterative) {
            let difference = difference(direct, iterative);
            assert!(difference < FRICTION, "{name}: {difference:e}");
        }
        let report = Solution::read_report(&case.result());
        assert_eq!(report["interface_solver"], "iterative");
    }
}

#[test]
fn friction_is_that_of_the_direct_solver_in_space() {
    let scene = "
    materials.rock = {young = 20e9, poisson = 0.25}
    bodies.lower.material = 'rock'
    bodies.upper.material = 'rock'
    [[displacement]]
    on = 'lower z0'
    x = 0
    y = 0
    z = 0
    [[displacement]]
    on = 'upper z1'
    x = '1.2e-5*(1+y)'
    y = '6e-6*(1-x)'
    z = '-1e-4*(1-1.6*x)'
    [[contact]]
    name = 'joint'
    sides = ['upper z0', 'lower z1']
    ";
    for (law, upper) in [
        ("friction = 0.6", [4, 3, 2]),
        ("friction = 0.3\ncohesion = 1e6", [5, 4, 2]),
        ("tresca = 8e5", [4, 3, 2]),
    ] {
        let below = between([0.0; 3], [1.0, 1.0, 0.5]);
        let above = between([0.0, 0.0, 0.5], [1.0, 1.0, 1.0]);
        let mesh = joined(
            solid("lower", Hexahedron8, [5, 4, 2], below),
            solid("upper", Hexahedron8, upper, above),
        );
        let case = Case::in_clusters(&model(&format!("{scene}{law}"), mesh), 10, 6);
        let (direct, iterative) = (case.solve(&[]), case.solve(&ITERATIVE));
        let difference = difference(&direct, &iterative);
        assert!(difference < FRICTION, "{law}: {difference:e}");
        assert!(iterations(&iterative).into_iter().max() > Some(1));
        // Slip forces are found with the other unknowns, not by a solution for each of their products.
        let [solves, steps] = ["linear_solves", "active_set_iterations"]
            .map(|name| iterative.report[name].as_u64().unwrap());
        assert!(solves <= 3 * steps, "{law}: {solves} in {steps} steps");
        for acts in ["sticking", "slipping"] {
            let of = |solution: &Solution| solution.report["friction"][acts].as_u64();
            assert!(of(&direct) > Some(0), "{law}: none {acts}");
            assert_eq!(of(&direct), of(&iterative), "{law}: {acts}");
        }
    }
}

#[test]
fn what_is_more_robust_is_said_where_friction_does_not_converge() {
    let case = Case::in_clusters(&built_in_model("raous", 0), 16, 6);
    let ended = case.run(&["--interface", "iterative", "--max-sweeps", "1"]);
    assert_eq!(ended.code(), 3, "{}{}", ended.stdout, ended.stderr);
    assert!(
        ended.stdout.contains("--interface direct finds more"),
        "{}",
        ended.stdout
    );
    // Some of the points without convergence are named.
    assert!(ended.stdout.contains("node "), "{}", ended.stdout);
}

#[test]
fn what_friction_cannot_hold_slides() {
    let (scene, mesh) = built_in("incline", 0);
    for (friction, code) in [("0.5", 0), ("0.29", 4)] {
        let scene = scene.replace("friction = 0.5", &format!("friction = {friction}"));
        let case = Case::in_clusters(&model(&scene, mesh.clone()), 8, 4);
        let ended = case.run(&ITERATIVE);
        assert_eq!(
            ended.code(),
            code,
            "{friction}: {}{}",
            ended.stdout,
            ended.stderr
        );
    }
}

/// Blocks on top of each other under pressure and shear, with partial slip in the joints.
fn pile(names: &[&str], cells: usize) -> Model {
    let mesh = names
        .iter()
        .enumerate()
        .fold(Blocks::new(), |mesh, (k, name)| {
            let below = 0.2 * k as f64;
            mesh.rectangle(name, [0.0, 8.0], [below, below + 0.2], [cells, 2])
        });
    let highest = names[names.len() - 1];
    let mut scene = format!(
        "
    plane = 'strain'
    materials.rock = {{young = 20e9, poisson = 0.25}}
    bodies.base.material = 'rock'
    [[displacement]]
    on = 'base bottom'
    x = 0
    y = 0
    [[pressure]]
    on = '{highest} top'
    value = '2e5*(1+sin(2*x))'
    [[traction]]
    on = '{highest} left'
    value = [2e5, 0.0]
    "
    );
    for both in names.windows(2) {
        let [lower, upper] = [both[0], both[1]];
        scene += &format!(
            "[bodies.{upper}]
            material = 'rock'
            body_force = [0.0, -25e3]
            [[contact]]
            name = 'joint of {upper}'
            sides = ['{upper} bottom', '{lower} top']
            friction = 0.5
            "
        );
    }
    model(&scene, mesh.mesh)
}

/// In the tree for more than 3000 constraints, by a dense matrix in one cluster for more than 1000.
#[test]
fn many_conditions_with_friction_are_solved_alike_by_every_operator() {
    for (names, cells, operator) in [
        (
            &["base", "first", "second", "third", "fourth"][..],
            400,
            "tree",
        ),
        (&["base", "first"], 600, "dense"),
    ] {
        let case = Case::in_clusters(&pile(names, cells), 24, 5);
        let (direct, iterative) = (case.solve(&[]), case.solve(&ITERATIVE));
        assert_eq!(direct.report["contact_operator"], operator);
        assert!(iterations(&iterative).len() > 1);
        let difference = difference(&direct, &iterative);
        assert!(difference < FRICTION, "{operator}: {difference:e}");
        for acts in ["sticking", "slipping"] {
            let of = |solution: &Solution| solution.report["friction"][acts].as_u64();
            assert!(of(&direct) > Some(0), "{operator}: none {acts}");
            assert_eq!(of(&direct), of(&iterative), "{operator}: {acts}");
        }
        // A single cluster solves all its constraints before any sweep.
        let sweeps = direct.report["sweeps"].as_u64();
        assert_eq!(sweeps == Some(0), operator == "dense", "{sweeps:?}");
        let ended = case.run_on(2, &[]);
        assert_eq!(ended.code(), 0, "{operator}: {}", ended.stderr);
        let on_ranks = Solution::read(&case.result());
        assert_eq!(on_ranks.displacement, direct.displacement, "{operator}");
    }
}
