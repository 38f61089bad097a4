//! The start of MPI, and the detection of launchers.

use super::*;

/// An environment with which no Open MPI starts.
const NO_MPI: (&str, &str) = ("OMPI_MCA_pml", "none-at-all");

/// Runs on `ranks` ranks, without a launcher for 0, where MPI can't be started.
fn without_mpi(case: &Case, ranks: usize, args: &[&str]) -> Ended {
    let mut command = program(ranks);
    command
        .arg(case.problem())
        .args(args)
        .env(NO_MPI.0, NO_MPI.1);
    Running::start(&mut command).wait(LIMIT)
}

/// A single rank runs without MPI, and so do commands that don't solve; several ranks fail.
pub fn only_where_needed(trials: &mut Trials) {
    trials.once("starting::a_single_rank_needs_no_mpi", || {
        let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 6);
        for ranks in [0, 1] {
            let ended = without_mpi(&case, ranks, &[]);
            assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
            assert!(ended.stdout.contains("skipped: MPI"), "{}", ended.stdout);
            assert_eq!(without_mpi(&case, ranks, &["--check"]).code(), 0);
        }
        let report = Solution::read_report(&case.result());
        if report["build"]["mpi"]
            .as_str()
            .unwrap()
            .starts_with("Open MPI")
        {
            assert_ne!(without_mpi(&case, 2, &[]).code(), 0);
        }
    });
    trials.on_all_ranks("starting::what_is_no_run_needs_no_mpi", |ranks| {
        let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 6);
        let version = without_mpi(&case, ranks, &["--version"]);
        assert_eq!(version.code(), 0, "{}", version.stderr);
        assert_eq!(version.stdout.matches("contact-dd-mpi").count(), 1);
        failed_once(
            &without_mpi(&case, ranks, &["--metod", "newton"]),
            2,
            &["--metod"],
        );
    });
}

/// Processes of a launcher unknown to this MPI never solve the problem redundantly, one by one.
pub fn foreign_launchers(trials: &mut Trials) {
    for size in [
        "OMPI_COMM_WORLD_SIZE",
        "PMI_SIZE",
        "MV2_COMM_WORLD_SIZE",
        "SLURM_STEP_NUM_TASKS",
    ] {
        trials.once(&format!("starting::foreign_launcher::{size}"), move || {
            let case = Case::of(&model(&two_block_scene(), two_blocks().mesh), 6);
            let mut command = program(0);
            command.arg(case.problem()).env(size, "3");
            let ended = Running::start(&mut command).wait(LIMIT);
            failed_once(&ended, 2, &["started 3 ranks", size, "MPI counts 1"]);
            assert_eq!(case.files(), ["problem.h5"]);
        });
    }
}
