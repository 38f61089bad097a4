//! Load steps on several ranks.

use super::*;

/// The two blocks with loads that open and close their joint.
pub fn two_blocks_in_steps() -> Model {
    let steps = "
        [[step]]
        scale = 0.5
        [[step]]
        [[step.pressure]]
        on = 'upper top'
        value = '1e6*(0.1+1.9*x)'
        [[step]]
        scale = { pressure = 2, displacement = 3 }
        body_force = { upper = [0.0, -1e6] }";
    let text = format!("{}{steps}", two_block_scene());
    model(&text, two_blocks().mesh)
}

/// A step that has no solution ends the run before anything is solved, and names itself.
pub fn no_equilibrium(trials: &mut Trials) {
    trials.on_all_ranks("steps::lifted", |ranks| {
        let lift =
            "[[step]]\n[[step]]\nname = 'lift'\n[[step.pressure]]\non = 'upper top'\nvalue = -1e6";
        let scene = format!("{}{lift}", two_block_scene());
        let case = Case::of(&model(&scene, two_blocks().mesh), 6);
        let words = ["step 'lift'", "'upper' can move freely"];
        failed_once(&run(&case, ranks, &[]), 4, &words);
        assert_eq!(case.files(), ["problem.h5"]);
    });
}

/// A step that doesn't converge is flagged, and the next ones are solved all the same.
pub fn not_converged(trials: &mut Trials) {
    trials.on_all_ranks("steps::not_converged", |ranks| {
        let case = Case::of(&two_blocks_in_steps(), 6);
        let ended = run(&case, ranks, &["--max-sweeps", "0"]);
        assert_eq!(ended.code(), 3, "{}{}", ended.stdout, ended.stderr);
        let steps = Solution::steps(&case.result());
        let [error] = ended.errors()[..] else {
            panic!("{}", ended.stderr);
        };
        let mut named = 0;
        for (k, step) in (1..).zip(&steps) {
            let is_named = error.contains(&format!("step '{k}': "));
            assert_eq!(
                step.report["status"] == "not_converged",
                is_named,
                "{error}"
            );
            named += usize::from(is_named);
        }
        assert!(named > 1, "{error}");
    });
}

/// A run that a step's checkpoint stops goes on there with the same bits.
pub fn restarted(trials: &mut Trials) {
    let picard = ["--method", "picard", "--tolerance", "1e-4"];
    trials.on_all_ranks("steps::restarted", move |ranks| {
        let (text, mesh) = built_in("granite", 0);
        let steps =
            "[[step]]\nscale = 0.9\n[[step]]\n[[step.pressure]]\non = 'top'\nvalue = '3e6+1e5*x'";
        let case = Case::of(&model(&format!("{text}\n{steps}"), mesh), 8);
        let whole = run(&case, ranks, &picard);
        assert_eq!(whole.code(), 0, "{}{}", whole.stdout, whole.stderr);
        let expected = datasets(&case.result());
        let steps = Solution::steps(&case.result());
        let most = steps.iter().map(Solution::sweeps).max().unwrap();
        // Only the step with most sweeps gets so far.
        let stop = [
            "--max-sweeps",
            &(most - 1).to_string(),
            "--checkpoint-every",
        ]
        .map(String::from);
        let stop: Vec<&str> = stop.iter().map(String::as_str).collect();
        let every = (most - 2).to_string();
        let stopped = run(&case, ranks, &[&picard[..], &stop, &[&every]].concat());
        assert_eq!(stopped.code(), 3, "{}{}", stopped.stdout, stopped.stderr);
        let on = run(
            &case,
            1 + ranks % 4,
            &[&picard[..], &["--restart"]].concat(),
        );
        assert_eq!(on.code(), 0, "{}{}", on.stdout, on.stderr);
        assert!(!on.stdout.contains("no good checkpoint"));
        assert!(datasets(&case.result()) == expected);
        assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
    });
}
