//! Runs that end without a solution: in the same manner on every rank.

use super::*;

/// A loaded rigid-body motion without resistance ends with 4 and the name of the body.
pub fn no_equilibrium(trials: &mut Trials) {
    let lifted = "[[traction]]\non = 'upper top'\nvalue = [0.0, 1e6]\n";
    let pushed = "[[traction]]\non = 'upper top'\nvalue = [1e5, -1e6]\n";
    let toppled = "[[pressure]]\non = 'upper top'\nvalue = '1e6*(0.6-x)'\n[[traction]]\non = 'upper top'\nvalue = [0.0, -5e5]\n";
    let scenes = [
        ("lifted", format!("{BODIES}{SUPPORTS}{JOINT}{lifted}")),
        (
            "pushed_aside",
            format!("{BODIES}{}{JOINT}{pushed}", lower_support()),
        ),
        (
            "toppled",
            format!("{BODIES}{}{JOINT}{toppled}", lower_support()),
        ),
        (
            "not_touched_at_all",
            format!("{BODIES}{}{lifted}", lower_support()),
        ),
    ];
    for (name, scene) in scenes {
        trials.on_all_ranks(&format!("no_equilibrium::{name}"), move |ranks| {
            let case = Case::of(&model(&scene, two_blocks().mesh), 6);
            failed_once(&case.run_on(ranks, &[]), 4, &["upper"]);
            assert_eq!(case.files(), ["problem.h5"]);
        });
    }
}

/// The upper block is held only by contact.
fn lower_support() -> &'static str {
    SUPPORTS
        .split("[[displacement]]\non = 'upper left'")
        .next()
        .unwrap_or_default()
}

/// Results without convergence are written and marked; the message suggests a remedy.
pub fn not_converged(trials: &mut Trials) {
    let methods: [(&str, &[&str]); 3] = [
        (
            "literal_picard",
            &["--method", "picard", "--relaxation", "1"],
        ),
        (
            "few_picard_sweeps",
            &["--method", "picard", "--max-sweeps", "2"],
        ),
        ("no_newton_sweep", &["--max-sweeps", "0"]),
    ];
    for (name, args) in methods {
        trials.on_all_ranks(&format!("not_converged::{name}"), move |ranks| {
            let case = Case::of(&built_in_model("granite", 0), 8);
            let words: &[&str] = match args.contains(&"picard") {
                true => &["not converged", "--method newton"],
                false => &["not converged"],
            };
            failed_once(&case.run_on(ranks, args), 3, words);
            assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
            let report = Solution::read(&case.result()).report;
            assert_eq!(report["status"], "not_converged");
            // The lack of convergence isn't blamed on the scene.
            assert!(!report["warnings"].to_string().contains("badly conditioned"));
        });
    }
}
