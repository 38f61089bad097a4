//! Records of what became of random scenes and built-in ones, made with one program and compared with another's.
//!
//! `scripts/stress --record` and `--compare` run it.

pub mod compare;
mod examples;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

use clap::ValueEnum;

use crate::stability::random::{Draw, Runs};
use crate::support::stress::record::{Key, Record, Row};
use crate::support::stress::space::{draw_frictional_in_space, draw_in_space};
use crate::support::stress::trial::Interface;
use crate::support::stress::{draw, draw_frictional};

/// Runs random scenes of all kinds and writes a line on each.
#[derive(clap::Args)]
pub struct Arguments {
    /// The record to write; a folder for the results of the built-in scenes.
    file: PathBuf,
    /// Number of random scenes of every suite.
    #[arg(short = 'n', long, default_value_t = 200)]
    scenes: u64,
    /// The first of their seeds.
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// Runs these seeds alone.
    #[arg(long, value_name = "SEED", num_args = 1..)]
    only: Vec<u64>,
    /// Runs these suites alone.
    #[arg(long, value_name = "SUITE", num_args = 1..)]
    suites: Vec<Suite>,
    /// Asks for these interface solvers alone.
    #[arg(long, value_name = "OPERATOR", num_args = 1..)]
    operators: Vec<Operator>,
    /// Clusters between which the iterative one works, about.
    #[arg(long, value_name = "N", default_value_t = 8)]
    clusters: usize,
    /// Most cells along a side of a block.
    #[arg(long, default_value_t = 12)]
    cells: usize,
    /// Scenes at a time.
    #[arg(long, default_value_t = 1)]
    jobs: usize,
    /// Seconds after which a run hangs.
    #[arg(long, default_value_t = 60)]
    limit: u64,
    /// Solves all built-in scenes instead and keeps their results.
    #[arg(long)]
    examples: bool,
    /// The program under test, where it isn't the one that Cargo builds.
    #[arg(long, value_name = "PATH")]
    binary: Option<PathBuf>,
}

/// A kind of random scenes.
#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Suite {
    Plane,
    Space,
    PlaneFriction,
    SpaceFriction,
}

/// An interface solver.
#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Operator {
    /// The choice of the program itself.
    Chosen,
    Direct,
    Iterative,
}

impl Suite {
    fn draw(self) -> Draw {
        match self {
            Self::Plane => draw,
            Self::Space => draw_in_space,
            Self::PlaneFriction => draw_frictional,
            Self::SpaceFriction => draw_frictional_in_space,
        }
    }
}

/// The name of a value on the command line.
fn name(value: impl ValueEnum) -> String {
    let value = value.to_possible_value();
    value.map_or_else(String::new, |value| value.get_name().to_owned())
}

pub fn run(arguments: &Arguments) -> ExitCode {
    let binary = arguments.binary.clone();
    let binary = binary.unwrap_or_else(|| support::solver::built().to_owned());
    if arguments.examples {
        return examples::record(&binary, &arguments.file);
    }
    let seeds: Vec<u64> = match arguments.only.is_empty() {
        true => (arguments.first..arguments.first + arguments.scenes).collect(),
        false => arguments.only.clone(),
    };
    let suites = match &arguments.suites[..] {
        [] => Suite::value_variants(),
        some => some,
    };
    let operators = match &arguments.operators[..] {
        [] => &[Operator::Direct, Operator::Iterative],
        some => some,
    };
    let mut record = Record::default();
    for &suite in suites {
        for &operator in operators {
            let runs = Runs {
                binary: binary.clone(),
                cells: arguments.cells,
                jobs: arguments.jobs,
                limit: Duration::from_secs(arguments.limit),
                keep: None,
                interface: match operator {
                    Operator::Chosen => Interface::Chosen,
                    Operator::Direct => Interface::Direct,
                    Operator::Iterative => Interface::Iterative(arguments.clusters),
                },
            };
            println!("{}, {}", name(suite), name(operator));
            for ran in runs.all(suite.draw(), &seeds, false) {
                let key = Key {
                    suite: name(suite),
                    operator: name(operator),
                    seed: ran.seed,
                };
                record.rows.insert(key, Row::new(ran.friction, &ran.trial));
            }
            // Results so far are kept if the study is stopped.
            std::fs::write(&arguments.file, record.to_text()).unwrap();
        }
    }
    ExitCode::SUCCESS
}
