//! The report of a run, in JSON.

use std::fs;
use std::path::{Path, PathBuf};

use contact_dd_partition::destination::{Destination, failure};
use contact_dd_partition::error::OutputError;
use schemars::JsonSchema;
use serde::Serialize;

use crate::certificate::Certificate;
use crate::certificate::energy::EnergyBalance;
use crate::comm::ranks::{PhaseSeconds, RankReport};
use crate::fem::resultants::{Friction, Resultants};
use crate::settings::command_line::InterfaceMethod;
use crate::settings::{Origins, Settings};

/// Status in which a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The tolerance is met and the active set has settled.
    Converged,
    /// The tolerance isn't met, or contacts still change; the results are written nevertheless.
    NotConverged,
}

/// Operator with which contact constraints are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ContactOperator {
    /// A dense matrix of the constraints, of all or of each group.
    Dense,
    /// The fronts of the hierarchy, refactorized for every active set.
    Tree,
    /// Fronts within clusters, and iterations preconditioned by BDDC between the clusters.
    Bddc,
}

/// Discretization error of the stress, after Zienkiewicz and Zhu, in the energy norm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
pub struct ErrorEstimate {
    /// ‖σ* − σ_h‖ / ‖σ‖, with σ* the recovered stress and ‖σ‖² = ‖σ_h‖² + ‖σ* − σ_h‖².
    pub relative: f64,
    /// ‖σ* − σ_h‖ (√N, per metre of thickness in the plane).
    pub error: f64,
    /// ‖σ_h‖, the root of twice the strain energy (the same unit).
    pub energy_norm: f64,
}

/// A load step, also one whose sweeps ended without converging.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct StepReport {
    /// The name.
    pub name: String,
    /// The time on the load path.
    pub time: f64,
    /// Names of the inactive bodies and contacts; contacts of inactive bodies may be omitted.
    pub absent: Vec<String>,
    /// Status in which its sweeps ended.
    pub status: Status,
    /// Number of sweeps after the start.
    pub sweeps: usize,
    /// Number of linear systems solved within contact problems.
    pub active_set_iterations: usize,
    /// Number of linear problems solved for contact constraints: those within contact problems, or with fixed active
    /// sets one for every load; abandoned attempts included.
    pub linear_solves: usize,
    /// Relative residual of the interface problem at the end.
    pub interface_residual: f64,
    /// Iterations of the interface solver in the start and in every sweep; empty where it is direct.
    pub interface_iterations: Vec<usize>,
    /// Number of closed contact constraints.
    pub active_contacts: usize,
    /// Checks of its solution.
    pub certificate: Certificate,
    /// Estimate of the condition number; `null` where none is possible.
    pub condition_number: Option<f64>,
    /// Estimate of the mesh's error; `null` where stresses are left out.
    pub error_estimate: Option<ErrorEstimate>,
    /// Resultants of contacts and supports.
    #[serde(flatten)]
    pub resultants: Resultants,
    /// State and work of friction in it, in all contacts; `null` where there is none.
    pub friction: Option<FrictionOfStep>,
}

/// State and work of friction in a load step, in all contacts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FrictionOfStep {
    /// The state and work.
    #[serde(flatten)]
    pub friction: Friction,
    /// Balance of energy.
    pub energy: EnergyBalance,
    /// True if friction is at its limit: a body is held by friction alone, which is fully mobilized, so that its
    /// position isn't unique; a warning names the motion.
    pub at_limit: bool,
    /// Number of increments of the load step, of several load steps the largest; slip and status are those of the last
    /// one.
    pub increments: usize,
    /// True if `--second-start` found another solution; `null` without it.
    pub other_solution: Option<bool>,
}

/// The report. A number that isn't finite is `null` in its JSON.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Report {
    /// Status in which the run ended.
    pub status: Status,
    /// `newton`, `anderson` or `picard`.
    pub method: String,
    /// Number of sweeps after the bilateral start.
    pub sweeps: usize,
    /// Number of linear systems solved within contact problems.
    pub active_set_iterations: usize,
    /// Number of linear problems solved for contact constraints: those within contact problems, or with fixed active
    /// sets one for every load; abandoned attempts included.
    pub linear_solves: usize,
    /// Fallback methods that were used, as text.
    pub fallbacks: Vec<String>,
    /// Relative residual of the interface problem at the end.
    pub interface_residual: f64,
    /// Solver of the linear interface problem: `direct` or `iterative`.
    pub interface_solver: InterfaceMethod,
    /// Reason for that choice, as text.
    pub interface_choice: String,
    /// Operator with which contact constraints were solved.
    pub contact_operator: ContactOperator,
    /// Iterations of the interface solver in the start and in every sweep, load step after load step; empty where it is
    /// direct.
    pub interface_iterations: Vec<usize>,
    /// Unknowns of the coarse problem of the iterative interface solver; 0 where it is direct.
    pub coarse_dofs: usize,
    /// Number of degrees of freedom.
    pub dofs: usize,
    /// Number of degrees of freedom on Γ.
    pub interface_dofs: usize,
    /// Number of contact constraints.
    pub contact_conditions: usize,
    /// Number of closed contact constraints.
    pub active_contacts: usize,
    /// Number of subdomains.
    pub subdomains: usize,
    /// Number of pairs, or groups, in contact.
    pub contact_pairs: usize,
    /// Number of ranks.
    pub ranks: usize,
    /// Number of hosts that the ranks ran on.
    pub hosts: usize,
    /// Number of threads of each rank.
    pub threads: usize,
    /// Checks of the solution.
    pub certificate: Certificate,
    /// Estimate of the condition number of the stiffness, scaled to a unit diagonal, with the
    /// contact status of the solution; `null` where none is possible.
    pub condition_number: Option<f64>,
    /// Time of each phase, that of the slowest rank.
    pub seconds: PhaseSeconds,
    /// Work of each rank.
    pub per_rank: Vec<RankReport>,
    /// Sum of the ranks' peak resident memory (bytes).
    pub peak_memory_bytes: u64,
    /// Estimate of the mesh's error; `null` where stresses are left out.
    pub error_estimate: Option<ErrorEstimate>,
    /// Resultants of contacts and supports.
    #[serde(flatten)]
    pub resultants: Resultants,
    /// State and work of friction in all contacts; `null` where there is none.
    pub friction: Option<FrictionOfStep>,
    /// The load steps; empty for a problem without. In the fields above, sweeps, inner steps and work of friction are
    /// sums over all load steps, residual, certificate and condition number those of the worst, the others those of the
    /// last.
    pub steps: Vec<StepReport>,
    /// Parts of a run that the scene didn't need, as text.
    pub skipped: Vec<String>,
    /// Warnings, as text.
    pub warnings: Vec<String>,
    /// The settings; `null` if the method decides.
    pub settings: Settings,
    /// Origin of each setting.
    pub settings_from: Origins,
    /// Version of the program.
    pub version: String,
    /// The build.
    pub build: Build,
}

impl Report {
    /// The report as JSON.
    pub fn to_json(&self) -> String {
        // The report contains nothing that JSON can't represent.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

/// The build of this program.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Build {
    /// Commit of its source, with `-dirty` appended if files were changed; `null` in a debug build
    /// and outside a repository.
    pub commit: Option<String>,
    /// `release` or `debug`.
    pub profile: String,
    /// The compiler.
    pub compiler: String,
    /// Target of the compilation.
    pub target: String,
    /// The MPI library.
    pub mpi: String,
    /// The version of the HDF5 library.
    pub hdf5: String,
}

impl Build {
    /// The build of this program, with `mpi` for the MPI library.
    pub fn of_this_program(mpi: String) -> Self {
        let (major, minor, release) = hdf5::library_version();
        Self {
            commit: option_env!("BUILD_COMMIT").map(str::to_owned),
            profile: env!("BUILD_PROFILE").into(),
            compiler: env!("BUILD_COMPILER").into(),
            target: env!("BUILD_TARGET").into(),
            mpi,
            hdf5: format!("{major}.{minor}.{release}"),
        }
    }
}

/// Destination of a report.
#[derive(Debug)]
pub enum ReportFile {
    /// A file, under a temporary name until it is complete.
    File(Destination),
    /// A target that isn't a regular file, such as a terminal or a pipe.
    Stream(PathBuf),
}

impl ReportFile {
    /// Creates the temporary file.
    ///
    /// # Errors
    /// The file can't be created: a missing folder, no permission, the name of a folder.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let stream = fs::metadata(path).is_ok_and(|at| !at.is_file() && !at.is_dir());
        Ok(match stream {
            true => Self::Stream(path.to_path_buf()),
            false => Self::File(Destination::new(path)?),
        })
    }

    /// Writes the report as one or several lines of JSON, and gives the file its final name.
    ///
    /// # Errors
    /// The file can't be written.
    pub fn write(self, json: &str) -> Result<(), OutputError> {
        let text = format!("{json}\n");
        match self {
            Self::File(destination) => {
                fs::write(destination.temporary(), text)
                    .map_err(|error| destination.failure(error))?;
                destination.commit()
            }
            Self::Stream(path) => fs::write(&path, text).map_err(|error| failure(&path, error)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_not_finite_are_null() {
        let certificate = Certificate {
            equilibrium: f64::NAN,
            tension: f64::INFINITY,
            ..Certificate::default()
        };
        let value = serde_json::to_value(certificate).unwrap();
        assert!(value["equilibrium"].is_null() && value["tension"].is_null());
        assert_eq!(value["penetration"], 0.0);
    }

    #[test]
    fn reports_go_to_files_and_streams_but_not_to_folders() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.json");
        let write = |path: &Path| ReportFile::create(path)?.write("{}");
        write(&path).unwrap();
        assert_eq!(fs::read_to_string(path).unwrap(), "{}\n");
        write(Path::new("/dev/null")).unwrap();
        let error = write(folder.path()).unwrap_err().to_string();
        assert!(error.contains("isn't a file"), "{error}");
    }
}
