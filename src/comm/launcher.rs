//! Environment variables of MPI launchers: whether a process is one of several ranks, and which.

use std::env;

use crate::error::Failure;

/// The variables in which MPI launchers state the number of ranks.
const SIZES: [&str; 3] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE"];

/// Number of processes of srun: its tasks, or the daemons of an `mpirun` that srun starts.
const SRUN_SIZE: &str = "SLURM_STEP_NUM_TASKS";

/// The variables in which launchers state the rank of a process; some state no size, PMIx only on request.
const RANKS: [&str; 8] = [
    "OMPI_COMM_WORLD_RANK",
    "PMI_RANK",
    "PMIX_RANK",
    "MV2_COMM_WORLD_RANK",
    "PALS_RANKID",
    "ALPS_APP_PE",
    "JSM_NAMESPACE_RANK",
    "FLUX_TASK_RANK",
];

/// Number of a process among the tasks of srun; 0 also in the script of a batch job.
const SRUN_RANK: &str = "SLURM_PROCID";

/// The value of an environment variable.
fn variable(name: &str) -> Option<String> {
    env::var(name).ok()
}

/// True if an MPI launcher started this process, even as the only rank.
pub fn is_launched() -> bool {
    let mut names = SIZES.iter().chain(&RANKS);
    names.any(|name| variable(name).is_some())
}

/// True if this process is the first one of its launcher, or has no launcher.
pub fn is_first() -> bool {
    is_first_by(variable)
}

fn is_first_by(variable: impl Fn(&str) -> Option<String>) -> bool {
    let mut names = RANKS.into_iter().chain([SRUN_RANK]);
    names.find_map(variable).is_none_or(|rank| rank == "0")
}

/// True if this process may be one of several ranks; only MPI can tell for certain.
pub(super) fn is_one_of_several() -> bool {
    is_one_of_several_by(variable)
}

fn is_one_of_several_by(variable: impl Fn(&str) -> Option<String>) -> bool {
    let mut sizes = SIZES
        .into_iter()
        .chain([SRUN_SIZE])
        .filter_map(&variable)
        .peekable();
    match sizes.peek() {
        Some(_) => sizes.any(|size| size != "1"),
        None => RANKS.into_iter().any(|name| variable(name).is_some()),
    }
}

/// Checks that the launcher's number of ranks is MPI's.
///
/// # Errors
/// The launcher belongs to another MPI than the program, and has started n programs of one rank each.
pub(super) fn check(size: usize) -> Result<(), Failure> {
    match launched(|name| variable(name)?.parse().ok()) {
        Some((name, launched)) if launched != size => Err(Failure::input(format!(
            "the launcher started {launched} ranks ({name}), but MPI counts {size}: {}",
            match name {
                SRUN_SIZE =>
                    "srun doesn't know how this MPI's ranks find each other; expected \
                     srun --mpi=pmix with OpenMPI, --mpi=pmi2 with MPICH, or mpirun",
                _ => "mpirun belongs to another MPI than the one this program was built with",
            }
        ))),
        _ => Ok(()),
    }
}

/// The number of ranks that the launcher started, and the variable that holds it.
fn launched(number: impl Fn(&str) -> Option<usize>) -> Option<(&'static str, usize)> {
    (SIZES.into_iter().chain([SRUN_SIZE])).find_map(|name| Some((name, number(name)?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An environment with the `given` variables.
    fn of<'a>(given: &'a [(&str, &str)]) -> impl Fn(&str) -> Option<String> + 'a {
        |name| {
            let (_, value) = given.iter().find(|(n, _)| *n == name)?;
            Some((*value).to_owned())
        }
    }

    #[test]
    fn srun_is_believed_where_no_launcher_of_mpi_counts() {
        let launched = |given: &[(&str, &str)]| launched(|name| of(given)(name)?.parse().ok());
        assert_eq!(launched(&[]), None);
        assert_eq!(launched(&[(SRUN_SIZE, "4")]), Some((SRUN_SIZE, 4)));
        let daemons_of_two_nodes = [(SRUN_SIZE, "2"), ("PMI_SIZE", "16")];
        assert_eq!(launched(&daemons_of_two_nodes), Some(("PMI_SIZE", 16)));
    }

    #[test]
    fn only_who_is_certainly_alone_is_taken_to_be() {
        let alone: [&[(&str, &str)]; 5] = [
            &[],
            &[
                ("OMPI_COMM_WORLD_SIZE", "1"),
                ("OMPI_COMM_WORLD_RANK", "0"),
                ("PMIX_RANK", "0"),
            ],
            &[("PMI_SIZE", "1"), ("PMI_RANK", "0")],
            // One task of srun, with PMIx or without; the script of a batch job.
            &[(SRUN_SIZE, "1"), ("PMIX_RANK", "0")],
            &[(SRUN_RANK, "0"), ("SLURM_NTASKS", "16")],
        ];
        for given in alone {
            assert!(!is_one_of_several_by(of(given)), "{given:?}");
            assert!(is_first_by(of(given)), "{given:?}");
        }
        let several: [&[(&str, &str)]; 6] = [
            &[("OMPI_COMM_WORLD_SIZE", "2"), ("OMPI_COMM_WORLD_RANK", "1")],
            &[("PMI_SIZE", "many"), ("PMI_RANK", "1")],
            // One launcher within another, in either order.
            &[
                ("OMPI_COMM_WORLD_SIZE", "1"),
                ("PMI_SIZE", "4"),
                ("PMI_RANK", "1"),
            ],
            &[
                ("OMPI_COMM_WORLD_SIZE", "16"),
                (SRUN_SIZE, "1"),
                ("PMIX_RANK", "1"),
            ],
            &[(SRUN_SIZE, "4"), (SRUN_RANK, "1")],
            // No size is stated.
            &[("PMIX_RANK", "1")],
        ];
        for given in several {
            assert!(is_one_of_several_by(of(given)), "{given:?}");
            assert!(!is_first_by(of(given)), "{given:?}");
        }
    }
}
