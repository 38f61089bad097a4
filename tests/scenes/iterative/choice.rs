//! The choice of the interface solver, and the fallback without convergence.

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::model::Model;

use super::{ITERATIVE, difference};
use crate::support::blocks::joined;
use crate::support::scenes::{built_in_model, model};
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::{Case, LIMIT, built};
use crate::support::stress::draw_frictional;
use crate::support::stress::space::draw_frictional_in_space;
use crate::support::stress::trial::{Interface, Trial, Verdict};

#[test]
fn one_cluster_is_solved_directly_and_said_to_be() {
    let solution = Case::in_clusters(&built_in_model("plain", 0), 12, 1).solve(&ITERATIVE);
    assert_eq!(solution.report["interface_solver"], "direct");
    let warnings = solution.report["warnings"].to_string();
    assert!(warnings.contains("one cluster"), "{warnings}");
}

#[test]
fn the_operator_that_takes_least_time_is_chosen_and_said_to_be() {
    for name in [
        "cube-crack",
        "stack3d",
        "granite",
        "granite-friction",
        "sphere",
        "pin",
    ] {
        let solution = Case::in_clusters(&built_in_model(name, 0), 12, 6).solve(&[]);
        let choice = solution.report["interface_choice"].as_str().unwrap();
        let operator = match solution.report["contact_operator"].as_str().unwrap() {
            "dense" => "a dense matrix of ",
            "tree" => "fixed active sets",
            _ => "iterations between clusters: ",
        };
        assert!(choice.starts_with(operator), "{name}: {choice}");
        // Numbers with exponents are times, starting with that of the choice.
        let words = choice.split(' ').filter(|word| word.contains('e'));
        let times: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
        assert!(!times.is_empty(), "{name}: {choice}");
        assert!(
            times.iter().all(|time| *time >= times[0]),
            "{name}: {choice}"
        );
        // Excluded solvers are mentioned with a reason.
        assert!(
            times.len() == 3 || choice.contains("; "),
            "{name}: {choice}"
        );
    }
}

/// Few constraints have a dense matrix, whatever its time.
#[test]
fn iterations_are_considered_for_many_mortar_constraints() {
    let choice = |refinements, clusters| {
        let case = Case::in_clusters(&built_in_model("pin", refinements), 40, clusters);
        let checked = case.run(&["--check"]).stdout;
        let mut lines = checked.lines();
        lines
            .find(|line| line.contains("solved by"))
            .map(str::to_owned)
    };
    let few = choice(0, 6).unwrap();
    assert!(few.contains("iterations take longer with mortar"), "{few}");
    let many = choice(1, 12).unwrap();
    assert!(many.contains("for iterations between clusters"), "{many}");
}

/// Two blocks held together by friction, far below a ball to which one active set would lift the upper one.
fn blocks_below_a_ball(steps: &str, cells: [usize; 3]) -> Model {
    let block = |name, z: f64| {
        let box_of = between([0.0, 0.0, z], [2.0, 1.0, z + 1.0]);
        solid(name, Hexahedron8, cells, box_of)
    };
    let text = format!(
        "materials.steel = {{young = 210e9, poisson = 0.3}}
        [bodies]
        lower = {{material = 'steel', body_force = [0, 0, -77e3]}}
        upper = {{material = 'steel', body_force = [0, 0, -77e3]}}
        [[displacement]]
        on = 'lower z0'
        x = 0
        y = 0
        z = 0
        [[pressure]]
        on = 'upper z1'
        value = 1e6
        [[contact]]
        name = 'joint'
        between = ['lower', 'upper']
        within = 1e-3
        friction = 0.5
        [[contact]]
        name = 'ball'
        sides = ['upper z1']
        obstacle = {{center = [0.5, 0.5, 6.0], radius = 3.0}}
        {steps}"
    );
    model(&text, joined(block("lower", 0.0), block("upper", 1.0)))
}

#[test]
fn what_friction_holds_far_from_other_contacts_is_solved_as_directly() {
    let coming = "[[step]]\n[[step]]\nadd = 'upper'";
    for (steps, cells, clusters) in [
        ("", [2, 2, 2], 1),
        ("", [4, 2, 2], 4),
        (coming, [4, 2, 2], 4),
    ] {
        let case = Case::in_clusters(&blocks_below_a_ball(steps, cells), 8, clusters);
        let solved = |ranks, args: &[&str]| {
            let ended = case.run_on(ranks, args);
            assert_eq!(ended.code(), 0, "{clusters}: {}", ended.stderr);
            let mut all = Solution::increments(&case.result(), !steps.is_empty());
            all.iter().for_each(Solution::check_certificate);
            all.pop().unwrap()
        };
        let [direct, iterative, on_ranks] = [(0, &[][..]), (0, &ITERATIVE), (3, &ITERATIVE)]
            .map(|(ranks, args)| solved(ranks, args));
        assert_eq!(iterative.displacement, on_ranks.displacement);
        let taken = iterative.report["interface_iterations"].as_array();
        assert!(clusters == 1 || taken.is_some_and(|taken| !taken.is_empty()));
        let difference = difference(&direct, &iterative);
        assert!(difference < 1e-10, "{clusters}: {difference:e}");
        assert_eq!(direct.closed(), iterative.closed());
        // Newton's method stalls where no point holds the upper block, and starts again from the convex problem; where it
        // stalls differs with the clusters.
        let sweeps = &iterative.report["sweeps"];
        assert!(sweeps.as_u64() < Some(100), "{clusters}: {sweeps}");
    }
}

/// In the middle of load steps, and where an active set leaves combinations of unknowns to neither of two clusters.
#[test]
fn what_does_not_converge_between_clusters_is_solved_directly_from_there() {
    for drawn in [
        draw_frictional(685_154, 12),
        draw_frictional_in_space(910_050, 12),
    ] {
        let trial = Trial::with(&drawn, built(), LIMIT, None, Interface::Iterative(8));
        let seed = drawn.seed;
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
        let report = trial.report.unwrap();
        let words = "didn't converge";
        for printed in ["warnings", "fallbacks", "interface_choice"] {
            let is_said = report[printed].to_string().contains(words);
            assert!(is_said, "{seed}: {}", report[printed]);
        }
    }
}

/// In a later load step, on ranks that own other groups than in the steps before: friction continues from the slips of
/// the previous step.
#[test]
fn the_direct_solver_goes_on_from_the_slips_of_before_on_any_number_of_ranks() {
    let mut drawn = draw_frictional(685_154, 12);
    drawn.ranks = 2;
    let trial = Trial::with(&drawn, built(), LIMIT, None, Interface::Iterative(8));
    assert_eq!(trial.verdict, Verdict::Right, "{}", trial.reason);
    assert_eq!(trial.report.unwrap()["contact_operator"], "dense");
}

/// Some ranks have no cluster, and take part in every iteration all the same.
#[test]
fn ranks_without_clusters_keep_nobody_waiting() {
    for ranks in [2, 4] {
        let mut drawn = draw_frictional(125_703, 12);
        drawn.ranks = ranks;
        let trial = Trial::with(&drawn, built(), LIMIT, None, Interface::Iterative(8));
        assert_eq!(trial.verdict, Verdict::Right, "{ranks}: {}", trial.reason);
        assert_eq!(trial.report.unwrap()["contact_operator"], "bddc");
    }
}
