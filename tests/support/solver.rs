//! The program under test, started like by a user.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::Duration;

use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::model::Model;
use contact_dd_partition::problem::Problem;
use tempfile::TempDir;

use super::process::{Ended, Running};
use super::solution::{Solution, datasets, difference};

/// Time limit well above any of these runs, even on a busy machine.
pub const LIMIT: Duration = Duration::from_secs(300);

/// A folder with a problem file.
pub struct Case {
    folder: TempDir,
}

impl Case {
    pub fn new(problem: &Problem) -> Self {
        let case = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        problem.write(&case.problem()).unwrap();
        case
    }

    /// The problem of a model in `count` subdomains.
    #[track_caller]
    pub fn of(model: &Model, count: usize) -> Self {
        Self::new(&problem(model, Some(count)))
    }

    /// The problem of a model in `count` subdomains and about `clusters` clusters.
    #[track_caller]
    pub fn in_clusters(model: &Model, count: usize, clusters: usize) -> Self {
        let mut problem = problem(model, Some(count));
        problem.catalog.choose_clusters(Some(clusters));
        Self::new(&problem)
    }

    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub fn problem(&self) -> PathBuf {
        self.folder.path().join("problem.h5")
    }

    pub fn result(&self) -> PathBuf {
        self.folder.path().join("problem.vtkhdf")
    }

    /// The names of all files in the folder, sorted.
    pub fn files(&self) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.folder())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// Runs without a launcher, with the problem and `args`.
    pub fn run(&self, args: &[&str]) -> Ended {
        self.run_on(0, args)
    }

    /// Runs on `ranks` ranks; 0 means without a launcher.
    pub fn run_on(&self, ranks: usize, args: &[&str]) -> Ended {
        Running::start(program(ranks).arg(self.problem()).args(args)).wait(LIMIT)
    }

    /// Runs without a launcher and reads the result, which has to fulfil its certificate.
    #[track_caller]
    pub fn solve(&self, args: &[&str]) -> Solution {
        let ended = self.run(args);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        let solution = Solution::read(&self.result());
        solution.check_certificate();
        solution
    }

    /// Fails unless the existing result has the same bits on 2 to 4 ranks, and likewise the iterative solver's, which
    /// agrees with it up to a `tolerance`.
    #[track_caller]
    pub fn is_the_same_on_all_ranks_and_by_iteration(&self, tolerance: f64) {
        let direct = self.folder().join("direct.vtkhdf");
        std::fs::rename(self.result(), &direct).unwrap();
        self.has_the_bits_of(&direct, &[]);
        let iterative = ["--interface", "iterative"];
        let ended = self.run(&iterative);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        let (apart, at) = difference(&direct, &self.result());
        assert!(apart < tolerance, "{apart:e} in {at}");
        let alone = self.folder().join("iterative.vtkhdf");
        std::fs::rename(self.result(), &alone).unwrap();
        self.has_the_bits_of(&alone, &iterative);
    }

    /// Fails unless runs on 2 to 4 ranks have the bits of a result.
    #[track_caller]
    fn has_the_bits_of(&self, result: &Path, args: &[&str]) {
        let expected = datasets(result);
        for ranks in [2, 3, 4] {
            let ended = self.run_on(ranks, args);
            assert_eq!(ended.code(), 0, "{}", ended.stderr);
            assert!(
                datasets(&self.result()) == expected,
                "{ranks} ranks {args:?}"
            );
        }
    }
}

/// Solves all increments of a model in `count` subdomains; each has to fulfil its certificate.
#[track_caller]
pub fn solve_steps(model: &Model, count: usize) -> Vec<Solution> {
    let case = Case::of(model, count);
    let ended = case.run(&[]);
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    let all = Solution::increments(&case.result(), !model.steps.is_empty());
    all.iter().for_each(Solution::check_certificate);
    all
}

/// A model cut into `count` subdomains.
#[track_caller]
pub fn problem(model: &Model, count: Option<usize>) -> Problem {
    let decomposition = Decomposition::new(model, count).unwrap_or_else(|e| panic!("{e}"));
    Problem::new(model, &decomposition).unwrap_or_else(|e| panic!("{e}"))
}

/// Solves a model in `count` subdomains with `newton`.
#[track_caller]
pub fn solve(model: &Model, count: usize) -> Solution {
    Case::of(model, count).solve(&[])
}

/// The program under test, built by Cargo.
pub fn built() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        // Cargo puts tests and studies into a folder below that of the programs under test.
        let own = env::current_exe().unwrap();
        let folder = own.parent().and_then(Path::parent).unwrap();
        let built = folder.join("contact-dd-mpi");
        assert!(built.is_file(), "{} is missing", built.display());
        built
    })
}

/// The command that starts the program on `ranks` ranks; without the launcher for 0.
pub fn program(ranks: usize) -> Command {
    launched(built(), ranks)
}

/// The command that starts `binary` on `ranks` ranks; without the launcher for 0.
pub fn launched(binary: &Path, ranks: usize) -> Command {
    let mut command = match ranks {
        0 => Command::new(binary),
        _ => {
            let launcher = env::var("MPIEXEC").unwrap_or_else(|_| "mpirun".into());
            let mut words = launcher.split_whitespace();
            let mut command = Command::new(words.next().unwrap_or("mpirun"));
            command.args(words).args(["-n", &ranks.to_string()]);
            command.arg(binary);
            command
        }
    };
    command
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_rmaps_base_oversubscribe", "1")
        .env("OMPI_MCA_pml", "ob1")
        .env("OMPI_MCA_hwloc_base_binding_policy", "none");
    command
}
