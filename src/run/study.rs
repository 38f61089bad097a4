//! A study: quantities of many cases with the factors of one run.

use std::cell::Cell;
use std::path::Path;
use std::time::Instant;

use contact_dd_partition::destination::write_bytes;
use contact_dd_partition::quantity::Parameter;
use serde::Serialize;

use crate::comm::ranks::RankSeconds;
use crate::context::{Context, Listener, LoadPoint};
use crate::error::{Failure, FailureKind};
use crate::report::log::RunLog;
use crate::run::cases::{Cases, Varied};
use crate::run::increment::{Increment, Increments};
use crate::run::operators::Operators;
use crate::run::stage::Stages;
use crate::settings::Settings;
use crate::step::state::{StepState, analyse, stop_if_asked};

/// The table of a study.
#[derive(Serialize)]
struct Table<'a> {
    parameters: &'a [String],
    quantities: Vec<Named<'a>>,
    cases: Vec<Case>,
}

/// A quantity in it.
#[derive(Serialize)]
struct Named<'a> {
    name: &'a str,
    kind: &'a str,
}

/// A row of the table.
#[derive(Serialize)]
struct Case {
    /// The values of the parameters.
    values: Vec<f64>,
    /// "converged", "not_converged" or "ill_posed".
    status: &'static str,
    /// Reason why it is ill-posed, as text.
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<String>,
    /// The values of the quantities; empty if it is ill-posed.
    quantities: Vec<f64>,
}

impl Stages<'_> {
    /// Solves the cases of a study and writes the table of their quantities; returns true if all converged. Collective.
    ///
    /// # Errors
    /// Errors of the whole run, except that a case may be ill-posed; a problem with load steps, which a study can't
    /// have.
    pub fn study(&self, path: &Path) -> Result<bool, Failure> {
        let catalog = self.file.catalog();
        let read = || match (catalog.steps.is_empty(), catalog.quantities.is_empty()) {
            (false, _) => Err(Failure::input(
                "--study: the problem has load steps; a study is of a problem without",
            )),
            (_, true) => Err(Failure::input(
                "--study: the problem has no quantities; expected [[quantity]] in its scene",
            )),
            _ => Cases::read(path, catalog),
        };
        let mut asked = self
            .comm
            .agree(self.comm.is_root().then(read).transpose())?;
        self.comm.broadcast(&mut asked);
        let asked = asked.unwrap_or_default();
        let parameters = self.comm.agree(asked.of(catalog).map_err(Failure::input))?;
        let cases = self.solve_cases(&asked, &parameters)?;
        let all_converged = cases.iter().all(|case| case.status == "converged");
        let quantities = catalog.quantities.iter().map(|of| Named {
            name: &of.name,
            kind: of.kind.word(),
        });
        let table = Table {
            parameters: &asked.parameters,
            quantities: quantities.collect(),
            cases,
        };
        let write = || {
            let written = write_bytes(&self.settings.output, |file| {
                serde_json::to_writer(file, &table).map_err(std::io::Error::from)
            });
            written.map_err(Failure::from)
        };
        (self.comm).agree(self.comm.is_root().then(write).transpose())?;
        self.comm.agree(self.log.check_written())?;
        Ok(self.comm.decide(all_converged))
    }

    /// Solves all cases with the same factors. Collective.
    fn solve_cases(&self, asked: &Cases, parameters: &[&Parameter]) -> Result<Vec<Case>, Failure> {
        let settings = &Settings {
            no_stress: true,
            quiet: true,
            ..self.settings.clone()
        };
        let stage = &self.file.catalog().stage(0..1, &[]);
        let parts = self.parts(stage, None, true)?;
        let context = self.context(stage, &parts);
        let load_point = LoadPoint::end_of(0);
        let analysis = analyse(&context, load_point, &[])?;
        let loads = StepState::default().loads(&context, load_point, &analysis);
        let seconds = &mut RankSeconds::default();
        let mut operators = Operators::new(context, self.log, &loads, &analysis, seconds)?;
        let count = asked.cases.len();
        self.log.phase("solving the cases", Some(count));
        let log = &RunLog::new(self.comm, settings, Instant::now());
        let mut cases = Vec::new();
        for (number, values) in asked.cases.iter().enumerate() {
            stop_if_asked(&context, settings, 0)?;
            let varied = Varied::new(&context, parameters, values);
            let context = Context {
                listener: log,
                ..varied.context(context)
            };
            let analysis = analyse(&context, load_point, &[]);
            let begun = analysis.and_then(|analysis| {
                let loads = StepState::default().loads(&context, load_point, &analysis);
                operators.begin_anew(&context, &loads)?;
                Ok(analysis)
            });
            let increments = Increments {
                context,
                settings,
                log,
                operators: &operators,
                is_relieved: false,
                has_derivatives: false,
                linear_solves: &Cell::default(),
            };
            let solved = begun.and_then(|analysis| {
                increments.step(0, (&[], &analysis), StepState::default(), seconds)
            });
            let solved = solved.map_err(|mut failure| {
                failure.message = format!("case {}: {}", number + 1, failure.message);
                failure
            });
            cases.push(row(&increments, values, solved)?);
            self.log.done((number + 1) as f64 / count as f64);
        }
        Ok(cases)
    }
}

/// The row of a case. Collective.
///
/// # Errors
/// An error other than an ill-posed case.
fn row(
    increments: &Increments<'_>,
    values: &[f64],
    solved: Result<Increment, Failure>,
) -> Result<Case, Failure> {
    let values = values.to_vec();
    let solved = match solved {
        Ok(solved) => solved,
        Err(failure) if failure.kind == FailureKind::IllPosed => {
            return Ok(Case {
                values,
                status: "ill_posed",
                why: Some(failure.message),
                quantities: Vec::new(),
            });
        }
        Err(failure) => return Err(failure),
    };
    let status = match increments.is_converged(&solved) {
        true => "converged",
        false => "not_converged",
    };
    let quantities = &solved.solution.quantities.values;
    Ok(Case {
        values,
        status,
        why: None,
        quantities: quantities.iter().map(|of| of.value).collect(),
    })
}
