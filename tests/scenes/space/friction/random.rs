//! Random scenes in space with friction and unusual results.

use crate::support::solver::{LIMIT, built};
use crate::support::stress::space::draw_frictional_in_space;
use crate::support::stress::trial::{Trial, Verdict};

/// The trial of a seed's scene on one rank and on `ranks` ranks.
fn trial(seed: u64, ranks: usize) -> Trial {
    let mut drawn = draw_frictional_in_space(seed, 2);
    drawn.ranks = ranks;
    Trial::of(&drawn, built(), LIMIT, None)
}

#[test]
fn an_answer_with_friction_in_space_is_the_same_on_any_ranks() {
    for (seed, ranks) in [(1, 2), (3, 3), (46, 2)] {
        let trial = trial(seed, ranks);
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
        let contacts = trial.report.unwrap()["active_contacts"].as_u64();
        assert!(contacts > Some(0), "{seed}");
    }
}

/// Points that would open if they stuck or slipped with their whole cohesion, and would penetrate without cohesion.
#[test]
fn what_is_about_to_open_in_space_slips_under_a_part_of_its_cohesion() {
    for seed in [11, 46, 122] {
        let trial = trial(seed, 0);
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
        let warnings = trial.report.unwrap()["warnings"].to_string();
        assert!(
            warnings.contains("on the verge of opening"),
            "{seed}: {warnings}"
        );
    }
}

/// Rigid blocks could be held, as their pressures may be chosen; the pressures of elastic ones are determined. A
/// sliding block arrives at an obstacle in the end, where Lemke's path finds it.
#[test]
fn a_block_in_space_that_slides_towards_an_obstacle_comes_to_rest_there() {
    for seed in [26, 82] {
        let trial = trial(seed, 0);
        assert!(trial.by_friction);
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
    }
}

/// Rigid blocks could be held, so that there is no proof that elastic ones slide.
#[test]
fn a_block_in_space_that_friction_could_hold_is_not_said_to_slide() {
    for seed in [20032, 20039, 20067] {
        let mut drawn = draw_frictional_in_space(seed, 12);
        drawn.ranks = 0;
        let trial = Trial::of(&drawn, built(), LIMIT, None);
        let is_known = [Verdict::Right, Verdict::NotConverged].contains(&trial.verdict);
        assert!(is_known, "{seed}: {:?} {}", trial.verdict, trial.reason);
    }
}
