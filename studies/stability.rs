//! The stress suite: random scenes by the thousand and a table along every axis of difficulty.
//!
//! `scripts/stress` runs it and writes docs/stability.md.

mod axes;
mod document;
mod random;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use crate::support::stress::space::draw_in_space;
use crate::support::stress::trial::Verdict;
use crate::support::stress::{draw, draw_frictional};

/// Runs scenes that are hard on the solver and says what became of each.
#[derive(clap::Args)]
pub struct Arguments {
    /// Number of random scenes, without friction and with it.
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
    /// Runs scenes in space alone; their seeds count anew.
    #[arg(long, conflicts_with_all = ["markdown", "friction"])]
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

pub fn run(arguments: &Arguments) -> ExitCode {
    let binary = arguments.binary.clone();
    let binary = binary.unwrap_or_else(|| crate::support::solver::built().to_owned());
    let runs = random::Runs {
        binary,
        cells: arguments.cells,
        jobs: arguments.jobs,
        limit: Duration::from_secs(arguments.limit),
        keep: arguments.keep.clone(),
        clusters: arguments.clusters,
    };
    let told = !arguments.only.is_empty();
    let seeds = match told {
        true => arguments.only.clone(),
        false => (arguments.first..arguments.first + arguments.scenes).collect(),
    };
    let without = match arguments.friction {
        true => Vec::new(),
        false if arguments.space => Vec::new(),
        false => runs.all(draw, &seeds, told),
    };
    let in_space = match (arguments.space, &arguments.markdown) {
        (true, _) => runs.all(draw_in_space, &seeds, told),
        (false, Some(_)) => runs.all(draw_in_space, &seeds[..seeds.len() / 4], told),
        (false, None) => Vec::new(),
    };
    let alone = told || arguments.clusters.is_some() || arguments.space;
    let with = match alone && !arguments.friction {
        true => Vec::new(),
        false => runs.all(draw_frictional, &seeds, told),
    };
    if let Some(path) = &arguments.markdown {
        let rows = axes::table(&runs);
        let text = document::document(arguments.first, [&without, &in_space, &with], &rows);
        std::fs::write(path, text).unwrap();
    }
    for ran in [&without, &in_space, &with] {
        random::summary(ran);
    }
    if !with.is_empty() && !told {
        print!("{}", document::friction(arguments.first, &with));
    }
    if !in_space.is_empty() && !told {
        print!("{}", document::in_space(arguments.first, &in_space));
    }
    let mut all = without.iter().chain(&in_space).chain(&with);
    match all.all(|one| one.trial.verdict == Verdict::Right) {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}
