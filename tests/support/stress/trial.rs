//! A run of the program on a scene, and the verdict.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use contact_dd_partition::model::Model;
use contact_dd_partition::problem::Problem;
use serde_json::Value;

use super::super::assembled::Assembled;
use super::super::process::{Ended, Running};
use super::super::scenes::at_step;
use super::super::solution::{Solution, datasets};
use super::super::solver::{Case, launched};
use super::judge::Findings;
use super::{Balance, Drawn, decomposed};

/// Most dofs for which a reference is computed.
const REFERENCE: usize = 100_000;

/// The verdict on a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// The solution, or the message of its absence in a scene without equilibrium.
    Right,
    /// An answer reported as converged that isn't the solution.
    Wrong,
    /// Different bits on several ranks.
    Differs,
    /// A refusal although an equilibrium exists.
    Refused,
    /// A solution of a scene without equilibrium.
    Missed,
    NotConverged,
    Hung,
    Crashed,
    /// A scene that isn't as built: its equilibrium is a matter of round-off.
    Unclear,
}

impl Verdict {
    pub const ALL: [Self; 9] = [
        Self::Right,
        Self::Wrong,
        Self::Differs,
        Self::Refused,
        Self::Missed,
        Self::NotConverged,
        Self::Hung,
        Self::Crashed,
        Self::Unclear,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Wrong => "wrong",
            Self::Differs => "differs",
            Self::Refused => "refused",
            Self::Missed => "missed",
            Self::NotConverged => "not converged",
            Self::Hung => "hung",
            Self::Crashed => "crashed",
            Self::Unclear => "unclear",
        }
    }
}

/// A scene with its verdict.
pub struct Trial {
    pub verdict: Verdict,
    /// The reason for the verdict as text; empty if the answer is right.
    pub reason: String,
    /// True if an equilibrium exists; `None` if that depends on round-off, so that both a solution and the message that
    /// none exists are right, or on the strength of friction.
    pub equilibrium: Option<bool>,
    /// True if rigid bodies are held by friction, which may not suffice for elastic ones.
    pub by_friction: bool,
    /// True if a load step was divided because it didn't converge as a whole.
    pub in_parts: bool,
    /// The program's exit code, and the time it took (s).
    pub exit: Option<i32>,
    pub seconds: f64,
    /// The message of a failure.
    pub message: String,
    pub dofs: usize,
    pub conditions: usize,
    pub subdomains: usize,
    /// The judge's findings, if there is a result.
    pub findings: Option<Findings>,
    /// The program's own report.
    pub report: Option<Value>,
}

/// The scene with the loads of a step.
struct Loaded {
    model: Model,
    assembled: Assembled,
}

impl Loaded {
    fn new(model: Model) -> Self {
        Self {
            assembled: Assembled::new(&model),
            model,
        }
    }
}

/// A scene with the loads of all its steps.
fn steps(model: &Model) -> Vec<Loaded> {
    match model.steps.len() {
        0 => vec![Loaded::new(model.clone())],
        count => (0..count).map(|k| Loaded::new(at_step(model, k))).collect(),
    }
}

/// Equilibrium of all steps of a scene without friction, and with its own friction.
fn balances(drawn: &Drawn, steps: &[Loaded]) -> [Balance; 2] {
    let without = |step: &Loaded| Balance::without_friction(&step.model, &step.assembled);
    let held = least(steps.iter().map(without));
    let with = |step: &Loaded| Balance::new(&step.model, &step.assembled);
    match (held, drawn.friction) {
        // Scenes that hold without friction hold with it.
        (Balance::Holds, _) | (_, None) => [held; 2],
        _ => [held, least(steps.iter().map(with))],
    }
}

/// True if some step certainly has no equilibrium.
pub fn has_no_equilibrium(drawn: &Drawn) -> bool {
    balances(drawn, &steps(&drawn.model))[1] == Balance::Fails
}

/// The worst balance of all.
fn least(balances: impl Iterator<Item = Balance>) -> Balance {
    let rank = |balance: &Balance| match balance {
        Balance::Holds => 0,
        Balance::Unclear => 1,
        Balance::Fails => 2,
    };
    balances.max_by_key(rank).unwrap_or(Balance::Holds)
}

/// The requested interface solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// The program's choice.
    Chosen,
    Direct,
    /// The iterative solver between about this many clusters.
    Iterative(usize),
}

impl Interface {
    fn options(self) -> &'static [&'static str] {
        match self {
            Self::Chosen => &[],
            Self::Direct => &["--interface", "direct"],
            Self::Iterative(_) => &["--interface", "iterative"],
        }
    }
}

impl Trial {
    /// Runs `binary` on a scene, at most for `limit`; copies the problem file to `keep`, if given.
    pub fn of(drawn: &Drawn, binary: &Path, limit: Duration, keep: Option<&Path>) -> Self {
        Self::with(drawn, binary, limit, keep, Interface::Chosen)
    }

    /// Runs `binary` likewise, with an `interface` solver.
    pub fn with(
        drawn: &Drawn,
        binary: &Path,
        limit: Duration,
        keep: Option<&Path>,
        interface: Interface,
    ) -> Self {
        let args = interface.options();
        let model = &drawn.model;
        let mut trial = Self {
            verdict: Verdict::Right,
            reason: String::new(),
            equilibrium: drawn.equilibrium,
            by_friction: false,
            in_parts: false,
            exit: None,
            seconds: 0.0,
            message: String::new(),
            dofs: model.mesh.dim * model.mesh.points.len(),
            conditions: model.contacts.iter().map(|c| c.points.len()).sum(),
            subdomains: 0,
            findings: None,
            report: None,
        };
        let steps = steps(model);
        let [held, balance] = balances(drawn, &steps);
        trial.equilibrium = match (balance, drawn.equilibrium) {
            (Balance::Holds, None) if held != Balance::Holds => {
                trial.by_friction = true;
                drawn.determined.then_some(true)
            }
            (Balance::Holds, None | Some(true)) => Some(true),
            (Balance::Fails, None | Some(false)) => Some(false),
            (Balance::Unclear, None) => None,
            (_, built) => {
                trial.ends(Verdict::Unclear, format!("{balance:?}, built: {built:?}"));
                return trial;
            }
        };
        let problem = decomposed(model, drawn.subdomains).and_then(|decomposition| {
            trial.subdomains = decomposition.count;
            Problem::new(model, &decomposition).map_err(|error| error.to_string())
        });
        let case = match problem {
            Ok(mut problem) => {
                if let Interface::Iterative(clusters) = interface {
                    problem.catalog.choose_clusters(Some(clusters));
                }
                Case::new(&problem)
            }
            Err(message) => {
                trial.ends(Verdict::Refused, message);
                return trial;
            }
        };
        if let Some(folder) = keep {
            std::fs::copy(case.problem(), folder.join(format!("{}.h5", drawn.seed))).unwrap();
            std::fs::write(
                folder.join(format!("{}.toml", drawn.seed)),
                drawn.described(),
            )
            .unwrap();
        }
        let ended = Running::start(launched(binary, 0).arg(case.problem()).args(args)).wait(limit);
        trial.exit = ended.status.and_then(|status| status.code());
        trial.seconds = ended.took.as_secs_f64();
        trial.message = ended.errors().join(" ");
        trial.judge(drawn, &steps, &case, &ended);
        if drawn.ranks > 0 && trial.verdict == Verdict::Right {
            let mut command = launched(binary, drawn.ranks);
            trial.again(drawn.ranks, command.args(args), limit, &case, &ended);
        }
        trial
    }

    fn ends(&mut self, verdict: Verdict, reason: impl Into<String>) {
        self.verdict = verdict;
        self.reason = reason.into();
    }

    fn judge(&mut self, drawn: &Drawn, steps: &[Loaded], case: &Case, ended: &Ended) {
        let has_steps = !drawn.model.steps.is_empty();
        let Some(status) = ended.status else {
            return self.ends(Verdict::Hung, format!("after {:.0?}", ended.took));
        };
        let message = self.message.clone();
        match (status.code(), self.equilibrium) {
            (Some(4), None) if self.by_friction => {
                return self.ends(Verdict::Unclear, message);
            }
            (Some(4), Some(false) | None) => return,
            (Some(2 | 4), _) => return self.ends(Verdict::Refused, message),
            (Some(0 | 3), _) => {}
            _ => return self.ends(Verdict::Crashed, format!("{status} {}", ended.stderr)),
        }
        self.report = Some(Solution::read_report(&case.result()));
        if self.equilibrium == Some(false) {
            return self.ends(Verdict::Missed, message);
        }
        let mut faults = Vec::new();
        let solutions = Solution::increments(&case.result(), has_steps);
        for (k, solution) in solutions.iter().enumerate() {
            let Loaded { model, assembled } = &steps[k];
            let reference = self.dofs <= REFERENCE;
            let before = k.checked_sub(1).map(|k| &solutions[k]);
            let mut findings = Findings::after(before, model, assembled, solution, reference);
            if self.is_in_parts(drawn.model.steps.get(k).map(|step| step.name.as_str())) {
                self.in_parts = true;
                findings = findings.in_parts();
            }
            let at = if has_steps {
                format!("step {}: ", k + 1)
            } else {
                String::new()
            };
            faults.extend(
                findings
                    .faults()
                    .into_iter()
                    .map(|fault| at.clone() + &fault),
            );
            self.findings = Some(self.findings.map_or(findings, |before| before.or(findings)));
        }
        if status.code() == Some(0) && solutions.len() < steps.len() {
            faults.push(format!("{} of {} steps", solutions.len(), steps.len()));
        }
        if status.code() == Some(3) {
            self.ends(Verdict::NotConverged, faults.join(", "));
        } else if !faults.is_empty() {
            self.ends(Verdict::Wrong, faults.join(", "));
        }
    }

    /// Runs the scene on `ranks` ranks, which must give the same exit code and bits.
    fn again(
        &mut self,
        ranks: usize,
        command: &mut Command,
        limit: Duration,
        case: &Case,
        first: &Ended,
    ) {
        let result = case.folder().join("again.vtkhdf");
        command.arg(case.problem()).arg("-o").arg(&result);
        let ended = Running::start(command).wait(limit);
        let code = |ended: &Ended| ended.status.and_then(|status| status.code());
        if ended.status.is_none() {
            return self.ends(Verdict::Hung, format!("on {ranks} ranks"));
        }
        if code(&ended) != code(first) {
            let reason = format!("{:?} on {ranks} ranks: {}", code(&ended), ended.stderr);
            return self.ends(Verdict::Differs, reason);
        }
        if code(first) == Some(0) {
            let (a, b) = (datasets(&case.result()), datasets(&result));
            if let Some((name, _)) = a.iter().find(|(name, values)| b.get(*name) != Some(values)) {
                self.ends(Verdict::Differs, format!("{name} on {ranks} ranks"));
            }
        }
    }

    /// A number of the program's report.
    pub fn reported(&self, keys: &[&str]) -> Option<f64> {
        let report = self.report.as_ref()?;
        keys.iter()
            .try_fold(report, |at, key| at.get(key))?
            .as_f64()
    }

    /// The largest number of steps of Newton's method in an increment.
    pub fn newton_steps(&self) -> Option<f64> {
        let report = self.report.as_ref()?;
        let of = |entry: &Value| entry.get("active_set_iterations")?.as_f64();
        match report.get("steps").and_then(Value::as_array) {
            Some(steps) => steps.iter().filter_map(of).reduce(f64::max),
            None => of(report),
        }
    }

    /// True if the report warns that the step with this name, or the only one, was made in parts.
    fn is_in_parts(&self, step: Option<&str>) -> bool {
        let name = step.map_or(String::new(), |name| format!("step '{name}': "));
        let warnings = self.listed("warnings").unwrap_or_default();
        let mut warnings = warnings
            .iter()
            .map(|words| words.strip_prefix(&name).unwrap_or(words));
        warnings.any(|words| {
            words.starts_with("a load step") && words.contains("didn't converge at once")
        })
    }

    /// The strings of a list in the program's report.
    pub fn listed(&self, key: &str) -> Option<Vec<&str>> {
        let words = self.report.as_ref()?.get(key)?.as_array()?;
        Some(words.iter().filter_map(Value::as_str).collect())
    }
}
