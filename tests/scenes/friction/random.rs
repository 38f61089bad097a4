//! Small random scenes with friction, each with a verdict; `scripts/stress` runs the large suite.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::support::solver::{LIMIT, built};
use crate::support::stress::draw_frictional;
use crate::support::stress::space::draw_frictional_in_space;
use crate::support::stress::trial::{Interface, Trial, Verdict};

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 40,
        rng_seed: RngSeed::Fixed(2),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// It may not converge, which it says.
    #[test]
    fn a_random_scene_with_friction_is_not_answered_wrongly(seed in 0_u64..1_000_000) {
        let mut drawn = draw_frictional(seed, 4);
        // Tests of several ranks stand elsewhere.
        drawn.ranks = 0;
        let trial = Trial::of(&drawn, built(), LIMIT, None);
        let is_fair = match trial.verdict {
            Verdict::Right | Verdict::NotConverged => true,
            Verdict::Unclear => trial.by_friction,
            _ => false,
        };
        prop_assert!(is_fair, "{seed}: {:?} {}\n{}", trial.verdict, trial.reason, drawn.described());
    }
}

/// Stiffnesses are so far apart that the sweeps know forces to less than round-off (895), get no further (603) or
/// don't even know what sticks (865), of what has no pressure at times (626): refinement has to.
#[test]
fn a_badly_conditioned_scene_with_friction_is_refined_to_round_off() {
    for seed in [603, 626, 865, 895] {
        let mut drawn = draw_frictional(seed, 12);
        drawn.ranks = 0;
        let trial = Trial::of(&drawn, built(), LIMIT, None);
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
        let findings = trial.findings.unwrap();
        assert!(findings.backward_error < 1e-14, "{seed}: {findings:?}");
    }
}

/// Given friction far below the forces that bodies are deformed by holds them alone: the sweeps' round-off exceeds it (930013,
/// 930048), lets blocks drift away (906018) or leaves a cone of friction (930027). The problem is convex and has a solution.
#[test]
fn given_friction_that_is_round_off_of_what_deforms_is_solved_for() {
    let drawn = [
        draw_frictional(906_018, 12),
        draw_frictional(930_013, 12),
        draw_frictional_in_space(930_027, 4),
        draw_frictional_in_space(930_048, 4),
    ];
    for mut drawn in drawn {
        drawn.ranks = 3;
        let trial = Trial::of(&drawn, built(), LIMIT, None);
        assert_eq!(trial.verdict, Verdict::Right, "{}", trial.reason);
        let findings = trial.findings.unwrap();
        assert!(findings.backward_error < 1e-14, "{findings:?}");
    }
}

/// Cohesion that is lost as contacts open leaves points at the verge of opening, which Newton's steps don't find and Lemke's path
/// does.
#[test]
fn cohesion_that_is_lost_as_contacts_open_is_solved_for_in_space() {
    for seed in [930_030, 961_070] {
        let mut drawn = draw_frictional_in_space(seed, 4);
        drawn.ranks = 2;
        let trial = Trial::of(&drawn, built(), LIMIT, None);
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
    }
}

/// Friction a thousandth of the pressure leaves blocks a Newton step away from sliding 800 m, where round-off resists
/// (7112840); Lemke's path has to end where bounds fall by their own cohesion, however large what all contacts would hold
/// (7112946).
#[test]
fn slight_friction_holds_blocks_where_they_are() {
    for seed in [7_112_840, 7_112_946] {
        let mut drawn = draw_frictional(seed, 12);
        drawn.ranks = 2;
        let trial = Trial::of(&drawn, built(), LIMIT, None);
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
    }
}

/// Where all points may slip at once a slip is of any size, and its terms hide that forces miss their bounds: Lemke's path
/// leads to where they don't.
#[test]
fn forces_keep_to_bounds_far_below_the_terms_of_a_slip() {
    let mut drawn = draw_frictional(8_100_009, 12);
    drawn.ranks = 2;
    let trial = Trial::of(&drawn, built(), LIMIT, None);
    assert_eq!(trial.verdict, Verdict::Right, "{}", trial.reason);
}

/// Friction far below the forces of an interference fit holds to its own bound, between clusters, too.
#[test]
fn given_friction_below_an_interference_fit_keeps_to_its_bound_between_clusters() {
    for seed in [961_004, 961_060] {
        let mut drawn = draw_frictional_in_space(seed, 4);
        drawn.ranks = 2;
        let trial = Trial::with(&drawn, built(), LIMIT, None, Interface::Iterative(4));
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
    }
}
