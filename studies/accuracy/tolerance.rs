//! Influence of the sweeps' tolerance on the error, by every method.

use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::problem::Problem;
use hdf5::File;
use serde::{Deserialize, Serialize};

use super::series::Series;
use crate::support::solution::Solution;
use crate::support::solver::Case;
use crate::support::validation::Posed;

/// `--method`.
pub const METHODS: [&str; 3] = ["newton", "anderson", "picard"];
/// `--tolerance`.
pub const TOLERANCES: [f64; 7] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14];
/// Enough for there to be an interface on every mesh.
const SUBDOMAINS: usize = 8;
/// More than `anderson` needs.
const MANY: &str = "2000";

/// A mesh on which tolerances were tried. Errors are those in the norm of the energy.
#[derive(Deserialize, Serialize)]
pub struct Tried {
    pub scene: String,
    pub element: String,
    pub mesh: String,
    pub dofs: usize,
    /// The limit of no tolerance: `newton` to the smallest tolerance.
    pub error: f64,
    pub asked: Vec<Asked>,
    pub stopped: Vec<Stopped>,
}

/// A run as a user asks for it.
#[derive(Deserialize, Serialize)]
pub struct Asked {
    pub method: String,
    pub tolerance: f64,
    pub converged: bool,
    pub sweeps: u64,
    /// Of the sweeps and of the whole run.
    pub seconds: [f64; 2],
    pub error: f64,
}

/// A run that stopped in the middle, without the refinement that follows sweeps that converge.
#[derive(Deserialize, Serialize)]
pub struct Stopped {
    pub residual: f64,
    pub error: f64,
}

impl Tried {
    /// Difference of an error from that of the mesh alone, over it.
    pub fn shift(&self, error: f64) -> f64 {
        (error / self.error - 1.0).abs()
    }

    /// The run that was asked for so.
    pub fn run(&self, method: &str, tolerance: f64) -> Option<&Asked> {
        (self.asked.iter()).find(|run| run.method == method && run.tolerance == tolerance)
    }

    /// The largest residual from which on no error is further away than `shift`, by straight lines
    /// between logarithms.
    pub fn enough(&self, shift: f64) -> f64 {
        let is_far = |end: &Stopped| self.shift(end.error) > shift;
        let Some(far) = self.stopped.iter().rposition(is_far) else {
            return self.stopped.first().map_or(0.0, |end| end.residual);
        };
        let Some(near) = self.stopped.get(far + 1) else {
            return 0.0;
        };
        let far = &self.stopped[far];
        // A shift of zero has no logarithm.
        let [larger, smaller] = [far, near].map(|end| self.shift(end.error).max(f64::EPSILON));
        let way = (larger / shift).ln() / (larger / smaller).ln();
        far.residual * (near.residual / far.residual).powf(way)
    }
}

/// Tries everything on the meshes of a series that have `dofs` at most.
pub fn measure(series: &Series, dofs: usize) -> Vec<Tried> {
    (0..series.levels)
        .map(series.pose.as_ref())
        .filter(|posed| posed.dofs() <= dofs)
        .filter_map(|posed| one(series, &posed))
        .collect()
}

fn one(series: &Series, posed: &Posed) -> Option<Tried> {
    // The coarsest meshes can't be cut into so many.
    let decomposition = Decomposition::new(&posed.model, Some(SUBDOMAINS)).ok()?;
    let case = Case::new(&Problem::new(&posed.model, &decomposition).unwrap());
    let mut asked = Vec::new();
    for method in METHODS {
        for tolerance in TOLERANCES {
            asked.push(ask(&case, posed, method, tolerance));
        }
    }
    let best = asked.iter().rfind(|run| run.method == METHODS[0]).unwrap();
    assert!(best.converged, "{}, {} dofs", series.name(), posed.dofs());
    let tried = Tried {
        scene: series.scene.into(),
        element: series.element.into(),
        mesh: series.mesh.into(),
        dofs: posed.dofs(),
        error: best.error,
        stopped: stopped(&case, posed),
        asked,
    };
    println!(
        "{}, {}, {} dofs: tolerances tried",
        tried.scene,
        series.name(),
        tried.dofs
    );
    Some(tried)
}

fn ask(case: &Case, posed: &Posed, method: &str, tolerance: f64) -> Asked {
    let text = format!("{tolerance:e}");
    let ended = case.run(&["--quiet", "--method", method, "--tolerance", &text]);
    assert!([0, 3].contains(&ended.code()), "{}", ended.stderr);
    let solution = Solution::read(&case.result());
    let seconds = |phase: &str| solution.report["seconds"][phase].as_f64().unwrap();
    Asked {
        method: method.into(),
        tolerance,
        converged: ended.code() == 0,
        sweeps: solution.sweeps(),
        seconds: [seconds("sweeps"), seconds("total")],
        error: posed.exact.energy_error(&posed.model, &solution),
    }
}

/// Answers of `anderson`, stopped where its residual falls below every power of ten and no contact
/// changes, as where it converges to that tolerance.
fn stopped(case: &Case, posed: &Posed) -> Vec<Stopped> {
    let anderson = ["--quiet", "--method", "anderson", "--max-sweeps"];
    case.run(&[&anderson[..], &[MANY, "--tolerance", "1e-14"]].concat());
    let file = File::open(case.result()).unwrap();
    let residuals = file.dataset("convergence/residual").unwrap();
    let residuals = residuals.read_raw::<f64>().unwrap();
    let active = file.dataset("convergence/active").unwrap();
    let active = active.read_raw::<i64>().unwrap();
    drop(file);
    let settled = |k: &usize| active[*k] == active[k - 1];
    let mut ends: Vec<usize> = (2..15)
        .filter_map(|digits| {
            let limit = 10f64.powi(-digits);
            (1..residuals.len())
                .filter(settled)
                .find(|&k| residuals[k] <= limit)
        })
        .collect();
    ends.dedup();
    ends.into_iter()
        .map(|k| {
            // A tolerance that nothing reaches.
            let limits = [&k.to_string(), "--tolerance", "1e-300"];
            let ended = case.run(&[&anderson[..], &limits].concat());
            assert!([0, 3].contains(&ended.code()), "{}", ended.stderr);
            let solution = Solution::read(&case.result());
            Stopped {
                residual: residuals[k],
                error: posed.exact.energy_error(&posed.model, &solution),
            }
        })
        .collect()
}
