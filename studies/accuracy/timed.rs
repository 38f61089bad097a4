//! Run time and error of every mesh, by the default method and tolerance.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::series::Series;
use crate::support::solution::Solution;
use crate::support::solver::{Case, problem};

/// Numbers of ranks; 0 is one rank without a launcher.
const RANKS: [usize; 2] = [0, 2];

/// Results on one mesh.
#[derive(Deserialize, Serialize)]
pub struct Timed {
    pub scene: String,
    pub element: String,
    pub mesh: String,
    pub is_quadratic: bool,
    pub dofs: usize,
    pub subdomains: u64,
    pub sweeps: u64,
    /// Energy, pressure, extent of the contact.
    pub errors: [f64; 3],
    /// Medians of the report's phases and of their total on 1 and on 2 ranks (s).
    pub seconds: [BTreeMap<String, f64>; 2],
}

impl Timed {
    /// The whole run on 1 or on 2 ranks (s).
    pub fn total(&self, ranks: usize) -> f64 {
        self.seconds[ranks - 1]["total"]
    }

    /// From `assemble` to `recover` on one rank (s).
    pub fn solve(&self) -> f64 {
        let phases = ["assemble", "factorize", "interface", "sweeps", "recover"];
        phases.iter().map(|phase| self.seconds[0][*phase]).sum()
    }
}

/// Runs the meshes of a series, each `repeat` times.
pub fn measure(series: &Series, repeat: usize) -> Vec<Timed> {
    (0..series.levels)
        .map(|level| one(series, level, repeat))
        .collect()
}

fn one(series: &Series, level: usize, repeat: usize) -> Timed {
    let posed = (series.pose)(level);
    let case = Case::new(&problem(&posed.model, None));
    let seconds = RANKS.map(|ranks| {
        let reports: Vec<Value> = (0..repeat).map(|_| report(&case, ranks)).collect();
        medians(&reports)
    });
    let solution = Solution::read(&case.result());
    let count = |name: &str| solution.report[name].as_u64().unwrap();
    let errors = posed.errors(&solution);
    let timed = Timed {
        scene: series.scene.into(),
        element: series.element.into(),
        mesh: series.mesh.into(),
        is_quadratic: series.is_quadratic,
        dofs: posed.dofs(),
        subdomains: count("subdomains"),
        sweeps: count("sweeps"),
        errors: [0, 1, 2].map(|i| errors[i].value),
        seconds,
    };
    println!(
        "{}, {}, {} dofs: energy {:.1e}, {:.1} ms on 1 rank, {:.1} ms on 2",
        timed.scene,
        series.name(),
        timed.dofs,
        timed.errors[0],
        1e3 * timed.total(1),
        1e3 * timed.total(2),
    );
    timed
}

fn report(case: &Case, ranks: usize) -> Value {
    let path = case.folder().join("report.json");
    let ended = case.run_on(ranks, &["--quiet", "--report", path.to_str().unwrap()]);
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

fn medians(reports: &[Value]) -> BTreeMap<String, f64> {
    let phases = reports[0]["seconds"].as_object().unwrap().keys();
    let median = |phase: &String| {
        let values = reports.iter().map(|report| &report["seconds"][phase]);
        let mut values: Vec<f64> = values.map(|value| value.as_f64().unwrap()).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    phases.map(|phase| (phase.clone(), median(phase))).collect()
}
