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

    /// The run may fail to converge if it reports so.
    #[test]
    fn a_random_scene_with_friction_is_not_answered_wrongly(seed in 0_u64..1_000_000) {
        let mut drawn = draw_frictional(seed, 4);
        // Runs on several ranks are tested elsewhere.
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

/// Stiffnesses are so different that the sweeps' forces are below round-off (895), that the sweeps stall (603) or can't
/// determine sticking points (865), in places without pressure (626): refinement has to.
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

/// Bodies are held only by Tresca friction far below the forces that deform them: the sweeps' round-off exceeds it
/// (930013, 930048), lets blocks drift away (906018) or violates the friction cone (930027). The problem is convex and
/// has a solution.
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

/// Cohesion that is lost when contacts open leaves points at the limit of opening, which Newton's method doesn't find
/// but Lemke's path does.
#[test]
fn cohesion_that_is_lost_as_contacts_open_is_solved_for_in_space() {
    for seed in [930_030, 961_070] {
        let mut drawn = draw_frictional_in_space(seed, 4);
        drawn.ranks = 2;
        let trial = Trial::of(&drawn, built(), LIMIT, None);
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
    }
}

/// Friction of a thousandth of the pressure leaves blocks one Newton step from sliding 800 m, where only round-off
/// resists (7112840); Lemke's path has to end where bounds decrease with their own cohesion, however large the total
/// bound of all contacts (7112946).
#[test]
fn slight_friction_holds_blocks_where_they_are() {
    for seed in [7_112_840, 7_112_946] {
        let mut drawn = draw_frictional(seed, 12);
        drawn.ranks = 2;
        let trial = Trial::of(&drawn, built(), LIMIT, None);
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
    }
}

/// Where all points may slip at once, the slip is indeterminate, and its large terms hide that forces violate their
/// bounds: Lemke's path leads to forces within the bounds.
#[test]
fn forces_keep_to_bounds_far_below_the_terms_of_a_slip() {
    let mut drawn = draw_frictional(8_100_009, 12);
    drawn.ranks = 2;
    let trial = Trial::of(&drawn, built(), LIMIT, None);
    assert_eq!(trial.verdict, Verdict::Right, "{}", trial.reason);
}

/// Friction far below the forces of an interference fit fulfils its own bound, also with iterations between clusters.
#[test]
fn given_friction_below_an_interference_fit_keeps_to_its_bound_between_clusters() {
    for seed in [961_004, 961_060] {
        let mut drawn = draw_frictional_in_space(seed, 4);
        drawn.ranks = 2;
        let trial = Trial::with(&drawn, built(), LIMIT, None, Interface::Iterative(4));
        assert_eq!(trial.verdict, Verdict::Right, "{seed}: {}", trial.reason);
    }
}

/// Cohesion holds a block that would fall onto an obstacle a million times its displacement away: the digits of that
/// closing motion aren't taken from those of the displacements.
#[test]
fn a_block_that_is_held_far_from_where_it_would_fall_loses_no_digits() {
    let mut drawn = draw_frictional_in_space(9_101_202, 4);
    drawn.ranks = 2;
    let trial = Trial::of(&drawn, built(), LIMIT, None);
    assert_eq!(trial.verdict, Verdict::Right, "{}", trial.reason);
}
