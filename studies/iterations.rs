//! Iterations of the interface solver between more and more clusters.
//!
//! `scripts/iterations` runs it and writes docs/iterations.md.

use std::path::PathBuf;
use std::process::ExitCode;

use contact_dd_partition::model::Model;
use serde_json::Value;

use crate::support::process::Running;
use crate::support::scenes::{built_in_model, checkerboard, columns};
use crate::support::solution::Solution;
use crate::support::solver::{Case, problem, program};

/// Iterations that no linear problem takes more of: 40 to 1e-10 of the solution, and so many more to 1e-14.
const MOST: usize = 40 * 14 / 10;
/// The same of a contact problem, over those of one linear solve with its contacts closed.
const MOST_IN_ALL: f64 = 4.0;

/// Counts the iterations of the interface solver between more and more clusters.
#[derive(clap::Args)]
pub struct Arguments {
    /// Levels of clusters: 16, 64, 256, in space 8, 64, 512.
    #[arg(long, value_name = "N", default_value_t = 3)]
    levels: u32,
    /// Writes the results as markdown.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
}

/// A scene that grows with the number of clusters: its name and its mesh, of cells twice as fine at every level.
type Scene = (&'static str, fn(u32) -> Model);

const LINEAR: [Scene; 4] = [
    ("plate", |level| {
        checkerboard([1e9, 1e9], 0.3, 1, 12 << level)
    }),
    ("contrast 1e6 in squares that no cluster follows", |level| {
        checkerboard([1e9, 1e3], 0.3, 1, 12 << level)
    }),
    ("slender, 10 : 1", |level| {
        checkerboard([1e9, 1e9], 0.3, 10, 4 << level)
    }),
    ("Poisson's ratio 0.4999", |level| {
        checkerboard([1e9, 1e9], 0.4999, 1, 12 << level)
    }),
];

const IN_SPACE: [Scene; 3] = [
    ("columns in space", |level| {
        columns([1e9, 1e9], 0.3, 2 << level, 14 << level)
    }),
    ("columns in space, contrast 1e6", |level| {
        columns([1e9, 1e3], 0.3, 2 << level, 14 << level)
    }),
    ("columns in space, Poisson's ratio 0.4999", |level| {
        columns([1e9, 1e9], 0.4999, 2 << level, 14 << level)
    }),
];

const CONTACT: [Scene; 2] = [
    ("`granite`", |level| built_in_model("granite", 1 + level)),
    ("`stack`, held by contact alone", |level| {
        built_in_model("stack", 2 + level)
    }),
];

/// Cost of a run.
struct Taken {
    dofs: u64,
    clusters: usize,
    coarse: u64,
    /// Of the start and of every sweep.
    iterations: Vec<usize>,
    conditions: u64,
}

pub fn run(arguments: &Arguments) -> ExitCode {
    let rows = |scenes: &[Scene], clusters: fn(u32) -> usize| -> Vec<(&str, Taken)> {
        let levels = 0..arguments.levels;
        let all = scenes
            .iter()
            .flat_map(|&scene| levels.clone().map(move |level| (scene, level)));
        all.map(|((name, model), level)| {
            let taken = taken(&model(level), clusters(level));
            println!(
                "{name}: {} clusters, {:?}",
                taken.clusters, taken.iterations
            );
            (name, taken)
        })
        .collect()
    };
    let in_plane = |level| 16usize << (2 * level);
    let mut linear = rows(&LINEAR, in_plane);
    linear.extend(rows(&IN_SPACE, |level| 8 << (3 * level)));
    let contact = rows(&CONTACT, in_plane);
    let text = document(&linear, &contact);
    match &arguments.markdown {
        Some(path) => std::fs::write(path, text).unwrap(),
        None => print!("{text}"),
    }
    let few = linear.iter().all(|(_, taken)| taken.iterations[0] <= MOST);
    let few_in_all = contact
        .iter()
        .all(|(_, taken)| taken.in_all() <= MOST_IN_ALL);
    match few && few_in_all {
        true => ExitCode::SUCCESS,
        false => ExitCode::FAILURE,
    }
}

/// Solves a model between so many clusters, about.
fn taken(model: &Model, clusters: usize) -> Taken {
    let mut problem = problem(model, Some(2 * clusters));
    problem.catalog.choose_clusters(Some(clusters));
    let clusters = problem.catalog.hierarchy.clusters.len();
    let case = Case::new(&problem);
    let mut command = program(0);
    command
        .arg(case.problem())
        .args(["--interface", "iterative", "--no-stress"]);
    let ended = Running::start(&mut command).wait(std::time::Duration::from_secs(600));
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    let report = Solution::read_report(&case.result());
    let number = |key: &str| report[key].as_u64().unwrap();
    let counts = report["interface_iterations"].as_array().unwrap().iter();
    Taken {
        dofs: number("dofs"),
        clusters,
        coarse: number("coarse_dofs"),
        iterations: counts
            .filter_map(Value::as_u64)
            .map(|n| n as usize)
            .collect(),
        conditions: number("contact_conditions"),
    }
}

impl Taken {
    /// All iterations over those of one solve to the same accuracy: the last sweep's, where the active set stays.
    fn in_all(&self) -> f64 {
        let last = self.iterations.last().copied().unwrap_or(1).max(1);
        self.iterations.iter().sum::<usize>() as f64 / last as f64
    }
}

fn document(linear: &[(&str, Taken)], contact: &[(&str, Taken)]) -> String {
    let iterations = linear.iter().map(|(_, taken)| taken.iterations[0]);
    let most = iterations.max().unwrap_or(0);
    let in_all = contact.iter().map(|(_, taken)| taken.in_all());
    let in_all = in_all.fold(0.0, f64::max);
    let met = |is_met: bool| if is_met { "yes" } else { "no" };
    let mut text = format!(
        "# Iterations between clusters\n\n\
         `scripts/iterations` counts the iterations of `--interface iterative` on scenes whose mesh and number of \
         clusters\ngrow together, and writes this page. Clusters are subtrees of the hierarchy, cut like subdomains; \
         nodes inside the\nplates are moved at random. An iteration ends where the error in the energy norm is about \
         1e-14 of the solution.\n\n{}.\n\n## In short\n\n\
         | | most | target | met |\n|---|--:|--:|--:|\n\
         | iterations of a linear problem | {most} | {MOST} | {} |\n\
         | iterations of all active sets over those of the last | {in_all:.1} | {MOST_IN_ALL:.1} | {} |\n\n\
         The sections that follow are for developers of the solver.\n\n## Without contact\n\n\
         | scene | dofs | clusters | coarse dofs | iterations |\n|---|--:|--:|--:|--:|\n",
        crate::measured(),
        met(most <= MOST),
        met(in_all <= MOST_IN_ALL),
    );
    for (name, taken) in linear {
        let Taken {
            dofs,
            clusters,
            coarse,
            iterations,
            ..
        } = taken;
        text += &format!(
            "| {name} | {dofs} | {clusters} | {coarse} | {} |\n",
            iterations[0]
        );
    }
    text += "\n## With contact\n\nEach sweep fixes an active set. Its iterations begin at the solution of the sweep \
             before and end where they are a\nhundredth of what was wrong with the active set; the last ones go as far \
             as those above.\n\n\
             | scene | dofs | conditions | clusters | coarse dofs | sweeps | iterations of start and sweeps | in all over the last |\n\
             |---|--:|--:|--:|--:|--:|---|--:|\n";
    for (name, taken) in contact {
        let Taken {
            dofs,
            clusters,
            coarse,
            iterations,
            conditions,
        } = taken;
        let each: Vec<String> = iterations.iter().map(usize::to_string).collect();
        text += &format!(
            "| {name} | {dofs} | {conditions} | {clusters} | {coarse} | {} | {} | {:.1} |\n",
            iterations.len() - 1,
            each.join(", "),
            taken.in_all()
        );
    }
    text
}
