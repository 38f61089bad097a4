//! Ranks that fail, panic or are killed deliberately, in every phase of a run.

use super::*;

/// Kinds of a rank's end, as in `CONTACT_DD_END`.
const KINDS: [&str; 3] = ["failure", "panic", "kill"];

/// Phases without error returns, in which a rank can only end suddenly.
const WITHOUT_FAILURES: [&str; 3] = ["starting", "sweeping", "recovering"];

/// The phase in which only load steps after the first return errors.
const OF_LATER_STEPS: &str = "condensing the load";

/// The end of one rank, in any phase, ends all ranks; no process is left and the older result is unchanged. A message
/// names rank and phase, unless the rank was killed: then the launcher reports it.
pub fn sudden_ends(trials: &mut Trials) {
    // An optimized program has no artificial ends.
    if cfg!(not(debug_assertions)) {
        return;
    }
    for phase in phases() {
        for kind in KINDS {
            if kind == "failure" && WITHOUT_FAILURES.contains(&phase) {
                continue;
            }
            // The panic of a single rank, which runs without MPI, has the same effect.
            let has_case = |&ranks: &usize| ranks > 1 || kind == "panic";
            for ranks in RANKS.into_iter().filter(has_case) {
                let name = format!("sudden_end::{kind}_while_{phase}::on_{ranks}_ranks");
                trials.once(&name.replace(' ', "_"), move || {
                    let model = match phase == OF_LATER_STEPS {
                        true => steps::two_blocks_in_steps(),
                        false => model(&two_block_scene(), two_blocks().mesh),
                    };
                    let case = Case::of(&model, 9);
                    fs::write(case.result(), "the result of yesterday").unwrap();
                    for rank in [0, ranks - 1] {
                        sudden_end(&case, [rank, ranks], kind, phase);
                    }
                    // A killed rank can't remove its files.
                    if kind == "failure" {
                        assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
                    }
                });
            }
        }
    }
}

/// A rank that fails while a fixed active set is solved, for many contact constraints: all ranks try once more with
/// springs, and end.
pub fn in_an_active_set_step(trials: &mut Trials) {
    if cfg!(not(debug_assertions)) {
        return;
    }
    for ranks in [2, 3] {
        let name =
            format!("sudden_end::failure_while_an_active_set_has_active_set::on_{ranks}_ranks");
        trials.once(&name, move || {
            let case = Case::of(&built_in_model("wall", 1), 33);
            fs::write(case.result(), "the result of yesterday").unwrap();
            sudden_end(&case, [ranks - 1, ranks], "failure", "sweeping");
        });
    }
}

/// All phases of a run, by their names in its source.
fn phases() -> impl Iterator<Item = &'static str> {
    let run = include_str!("../../src/run.rs").split("phase(\"").skip(1);
    let named = run.filter_map(|call| call.split('"').next());
    ["starting"].into_iter().chain(named)
}

#[track_caller]
fn sudden_end(case: &Case, [rank, ranks]: [usize; 2], kind: &str, phase: &str) {
    let mut command = program(ranks);
    command
        .arg(case.problem())
        .env("CONTACT_DD_END", format!("{rank} {kind} {phase}"));
    let ended = Running::start(&mut command).wait(LIMIT);
    let printed = format!("rank {rank}\n{}{}", ended.stdout, ended.stderr);
    match kind {
        "failure" => assert_eq!(ended.code(), 4, "{printed}"),
        "panic" => assert_eq!(ended.code(), 1, "{printed}"),
        _ => assert_ne!(ended.code(), 0, "{printed}"),
    }
    ended.leaves_no_process(LIMIT);
    if kind != "kill" {
        let [error] = ended.errors()[..] else {
            panic!("expected one message\n{printed}");
        };
        let place = format!("rank {rank} of {ranks}");
        assert!(error.contains(&place), "{error}");
        assert!(error.contains(phase), "{error}\nlacks '{phase}'");
    }
    let result = fs::read_to_string(case.result()).unwrap();
    assert_eq!(result, "the result of yesterday");
    let visible = case
        .files()
        .into_iter()
        .filter(|name| !name.starts_with('.'));
    assert_eq!(visible.count(), 2);
}
