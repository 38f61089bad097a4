//! The stress suite: random scenes by the thousand and a table along every axis of difficulty.
//!
//! `scripts/stress` runs it and writes docs/stability.md.

mod axes;
mod document;
pub mod random;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use self::random::{Draw, Ran};
use crate::support::stress::space::{draw_frictional_in_space, draw_in_space};
use crate::support::stress::trial::{Interface, Verdict};
use crate::support::stress::{draw, draw_frictional};

/// Runs scenes that are hard on the solver and says what became of each.
#[derive(clap::Args)]
pub struct Arguments {
    /// Number of random scenes in the plane, without friction and with it, of half as many in space.
    #[arg(short = 'n', long, default_value_t = 1008)]
    scenes: u64,
    /// The first of their seeds.
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// Runs the scenes of these seeds alone and tells all of them.
    #[arg(long, value_name = "SEED", num_args = 1.., conflicts_with = "markdown")]
    only: Vec<u64>,
    /// Copies problem and scene files of `--only` into this folder.
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,
    /// Runs scenes with friction alone; their seeds count anew.
    #[arg(long, conflicts_with = "markdown")]
    friction: bool,
    /// Runs scenes in space alone; their seeds count anew, without friction and with it.
    #[arg(long, conflicts_with = "markdown")]
    space: bool,
    /// Solves with the iterative interface solver between so many clusters, about, scenes without friction if no others
    /// are asked for.
    #[arg(long, value_name = "N", conflicts_with = "markdown")]
    clusters: Option<usize>,
    /// Most cells along a side of a block.
    #[arg(long, default_value_t = 12)]
    cells: usize,
    /// Scenes at a time.
    #[arg(long, default_value_t = 1)]
    jobs: usize,
    /// Seconds after which a run hangs.
    #[arg(long, default_value_t = 60)]
    limit: u64,
    /// The program under test, where it isn't the one that Cargo builds.
    #[arg(long, value_name = "PATH")]
    binary: Option<PathBuf>,
    /// Writes the results as markdown.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
}

/// Runs of each kind.
struct Kinds {
    plain: Vec<Ran>,
    in_space: Vec<Ran>,
    with_friction: Vec<Ran>,
    in_space_with_friction: Vec<Ran>,
}

pub fn run(arguments: &Arguments) -> ExitCode {
    let binary = arguments.binary.clone();
    let binary = binary.unwrap_or_else(|| support::solver::built().to_owned());
    let runs = random::Runs {
        binary,
        cells: arguments.cells,
        jobs: arguments.jobs,
        limit: Duration::from_secs(arguments.limit),
        keep: arguments.keep.clone(),
        interface: (arguments.clusters).map_or(Interface::Chosen, Interface::Iterative),
    };
    let told = !arguments.only.is_empty();
    let seeds = match told {
        true => arguments.only.clone(),
        false => (arguments.first..arguments.first + arguments.scenes).collect(),
    };
    let one_kind = told || arguments.clusters.is_some() || arguments.space || arguments.friction;
    let some = |draw: Draw, space: bool, friction: bool| {
        // Scenes in space cost more.
        let count = match one_kind || !space {
            true => seeds.len(),
            false => seeds.len().div_ceil(2),
        };
        match !one_kind || (space, friction) == (arguments.space, arguments.friction) {
            true => runs.all(draw, &seeds[..count], told),
            false => Vec::new(),
        }
    };
    let ran = Kinds {
        plain: some(draw, false, false),
        in_space: some(draw_in_space, true, false),
        with_friction: some(draw_frictional, false, true),
        in_space_with_friction: some(draw_frictional_in_space, true, true),
    };
    if let Some(path) = &arguments.markdown {
        let rows = axes::table(&runs);
        let text = document::document(arguments.first, &ran, &rows);
        std::fs::write(path, text).unwrap();
    }
    let Kinds {
        plain,
        in_space,
        with_friction,
        in_space_with_friction,
    } = &ran;
    let all = [plain, in_space, with_friction, in_space_with_friction];
    for ran in all {
        random::summary(ran);
    }
    if !told {
        print!("{}", document::chapters(arguments.first, &ran));
    }
    let mut all = all.into_iter().flatten();
    match all.all(|one| one.trial.verdict == Verdict::Right) {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}
