//! Small random scenes of every family, each with a verdict; `scripts/stress` runs the large suite.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod support;

use std::time::Duration;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use support::solver::built;
use support::stress::draw;
use support::stress::trial::{Trial, Verdict};

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 60,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// One that has no equilibrium is answered by the message that says so.
    #[test]
    fn a_random_scene_is_answered_rightly(seed in 0_u64..1_000_000) {
        let mut drawn = draw(seed, 4);
        // Tests of several ranks stand elsewhere.
        drawn.ranks = 0;
        let trial = Trial::of(&drawn, built(), Duration::from_secs(60), None);
        prop_assert_eq!(
            trial.verdict,
            Verdict::Right,
            "{}\n{}",
            trial.reason,
            drawn.described()
        );
    }
}
