//! Run time against error, over elements, meshes, methods and tolerances.
//!
//! `scripts/accuracy` runs it and writes docs/accuracy.md.

mod conclusions;
mod document;
mod reached;
mod series;
mod timed;
mod tolerance;

use std::path::PathBuf;
use std::process::ExitCode;

use serde::{Deserialize, Serialize};

use conclusions::{Conclusions, default_tolerance};
use series::Series;
use timed::Timed;
use tolerance::Tried;

/// Measures run time against error on finer and finer meshes.
#[derive(clap::Args)]
pub struct Arguments {
    /// Runs of each mesh and number of ranks; times are their medians [default: 5, or 1 if quick].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    repeat: Option<u16>,
    /// Runs every mesh once, and tries tolerances on the smallest meshes alone.
    #[arg(long, conflicts_with = "markdown")]
    quick: bool,
    /// Takes the measurements of this file, which `--json` wrote, in place of new ones.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["quick", "repeat", "json"])]
    from: Option<PathBuf>,
    /// Writes all measurements as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Writes the results as markdown.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
}

/// All that was measured.
#[derive(Deserialize, Serialize)]
struct Measurements {
    machine: String,
    repetitions: usize,
    default_tolerance: f64,
    timed: Vec<Timed>,
    tried: Vec<Tried>,
}

impl Measurements {
    /// Measures run times `repeat` times and tries tolerances on meshes of that many `dofs` at most.
    fn new(series: &[Series], repeat: usize, dofs: usize) -> Self {
        Self {
            machine: machine(),
            repetitions: repeat,
            default_tolerance: default_tolerance(),
            timed: (series.iter())
                .flat_map(|series| timed::measure(series, repeat))
                .collect(),
            tried: (series.iter())
                .flat_map(|series| tolerance::measure(series, dofs))
                .collect(),
        }
    }
}

pub fn run(arguments: &Arguments) -> ExitCode {
    let (dofs, usual) = match arguments.quick {
        true => (700, 1),
        false => (9_000, 5),
    };
    let series = series::all();
    let measurements = match &arguments.from {
        Some(path) => serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap(),
        None => Measurements::new(&series, arguments.repeat.map_or(usual, usize::from), dofs),
    };
    if let Some(path) = &arguments.json {
        std::fs::write(path, serde_json::to_vec_pretty(&measurements).unwrap()).unwrap();
    }
    let conclusions = Conclusions::new(&series, &measurements);
    let faults = conclusions.faults();
    print!("\n{}", conclusions.text());
    faults
        .iter()
        .for_each(|fault| println!("not kept: {fault}"));
    if let Some(path) = &arguments.markdown {
        let text = document::document(&measurements, &conclusions, &faults);
        std::fs::write(path, text).unwrap();
    }
    match faults.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}

/// Processor, cores and load of this machine, in words.
fn machine() -> String {
    let processor = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model =
        (processor.lines()).find_map(|line| line.strip_prefix("model name")?.split(": ").nth(1));
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    format!(
        "{}, {} cores, load {} at the start",
        model.unwrap_or("unknown processor"),
        std::thread::available_parallelism().map_or(1, usize::from),
        load.split(' ').next().unwrap_or_default(),
    )
}
