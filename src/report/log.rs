//! The log of a run: text for people, or events for programs.

use std::cell::{Cell, OnceCell};
use std::collections::BTreeSet;
use std::io::stdout;
use std::time::{Duration, Instant};

use contact_dd_partition::error::OutputError;
use contact_dd_partition::message;
use contact_dd_partition::problem::Catalog;

use crate::comm::{self, Comm};
use crate::context::Listener;
use crate::error::Failure;
use crate::output::bar::Bar;
use crate::output::event::{self, Costs, Event, Finished, Step, Summary};
use crate::output::report::Report;
use crate::output::terminal;
use crate::plan::Plan;
use crate::plan::cost::CostEstimate;
use crate::report::totals::Totals;
use crate::report::{failures, reason, report};
use crate::settings::Settings;
use crate::settings::command_line::LogFormat;
use crate::sweep::SweepRecord;

/// Exit code of sweeps that don't converge.
const NOT_CONVERGED: u8 = 3;

/// Time between progress events for programs.
const PROGRESS_INTERVAL: Duration = Duration::from_secs(1);

/// Result of validating the load steps of a stage, in which the same bodies and contacts are present.
#[derive(Debug)]
pub struct Checked {
    /// Warnings of their rigid motions.
    pub warnings: Vec<String>,
    /// Estimated cost of solving them, for every rank.
    pub costs: Vec<CostEstimate>,
    /// Available memory (bytes).
    pub available: f64,
    /// Reason for the choice of the operator for contact constraints, as text.
    pub why: String,
    /// Coarse unknowns of an iterative interface solver.
    pub coarse_dofs: Option<usize>,
}

/// The log of a run, printed by the root only.
pub struct RunLog<'a> {
    comm: &'a Comm,
    settings: &'a Settings,
    format: Option<LogFormat>,
    began: Instant,
    /// Progress bar of a phase.
    bar: Bar,
    /// Time of the last printed progress event.
    last_progress: Cell<Instant>,
    /// The first load step of this run, and when it began.
    first_step: Cell<Option<(usize, Instant)>>,
    /// Error of the first event that couldn't be written. It doesn't end the run, because the results go to a file.
    write_error: OnceCell<OutputError>,
}

impl Listener for RunLog<'_> {
    fn done(&self, share: f64) {
        self.bar.done(share);
        if self.last_progress.get().elapsed() > PROGRESS_INTERVAL {
            self.last_progress.set(Instant::now());
            self.print_event(&Event::Progress {
                phase: self.bar.phase(),
                done: share,
                seconds: self.began.elapsed().as_secs_f64(),
                seconds_left: self.bar.seconds_left(),
            });
        }
    }
}

impl<'a> RunLog<'a> {
    /// The log of a run that started at `began`; silent on other ranks than the root and if `settings` are quiet.
    pub fn new(comm: &'a Comm, settings: &'a Settings, began: Instant) -> Self {
        let format = (comm.is_root() && !settings.quiet).then_some(settings.log);
        Self {
            comm,
            settings,
            format,
            began,
            bar: Bar::new(format != Some(LogFormat::Text)),
            last_progress: Cell::new(began),
            first_step: Cell::new(None),
            write_error: OnceCell::new(),
        }
    }

    /// Prints lines if the format of the log is text.
    fn print_text(&self, text: &str) {
        if self.format == Some(LogFormat::Text) {
            (self.bar).suspend(|| self.keep_error(message::print(&format!("{text}\n"))));
        }
    }

    /// Prints an event in the format of the log.
    fn print_event(&self, event: &Event<'_>) {
        match self.format {
            None => {}
            Some(LogFormat::Json) => {
                self.keep_error(message::ignoring_closed_pipe(event.write(stdout())))
            }
            Some(LogFormat::Text) => {
                if let Some(text) = terminal::text(event) {
                    self.print_text(&text);
                }
            }
        }
    }

    fn keep_error(&self, written: Result<(), OutputError>) {
        if let Err(error) = written {
            let _ = self.write_error.set(error);
        }
    }

    /// Fails if an event couldn't be written; a closed pipe is no error.
    ///
    /// # Errors
    /// The error of the first such event.
    pub fn check_written(&self) -> Result<(), Failure> {
        match self.write_error.get() {
            None => Ok(()),
            Some(error) => Err(error.clone().into()),
        }
    }

    /// Begins a phase of the run, with its number of steps if known.
    pub fn phase(&self, phase: &'static str, steps: Option<usize>) {
        comm::phase(phase);
        self.bar.begin(phase);
        self.print_event(&Event::Phase {
            phase,
            steps,
            seconds: self.began.elapsed().as_secs_f64(),
        });
    }

    /// Prints the problem, the settings, and `why` this operator for contact constraints was chosen.
    pub fn problem(&self, catalog: &Catalog, plan: &Plan, why: &str) {
        let summary = Summary {
            version: env!("CARGO_PKG_VERSION"),
            problem: self.settings.problem.display().to_string(),
            title: &catalog.title,
            dofs: catalog.dofs(),
            interface_dofs: catalog.dim * catalog.interface_nodes,
            subdomains: catalog.subdomains.len(),
            contact_pairs: plan.contact_groups(),
            contact_conditions: catalog.conditions(),
            conditions_with_friction: catalog.conditions_with_friction(),
            ranks: self.comm.size(),
            threads: usize::from(self.settings.threads),
            interface_choice: why,
        };
        self.print_event(&Event::Problem(&summary));
        if !self.settings.check {
            self.print_event(&Event::Settings {
                settings: self.settings,
                settings_from: &self.settings.from,
            });
        }
    }

    /// The result of validating every stage, and the cost of solving the one that takes most memory.
    pub fn check(&self, stages: &[Checked]) {
        self.bar.finish();
        let all = stages.iter().flat_map(|stage| &stage.warnings);
        if self.comm.is_root() {
            for warning in all.collect::<BTreeSet<_>>() {
                event::warning(self.settings.log, warning);
            }
        }
        let bytes = |stage: &&Checked| CostEstimate::sum(&stage.costs).bytes;
        let largest = stages.iter().max_by(|a, b| bytes(a).total_cmp(&bytes(b)));
        let Some(Checked {
            costs,
            available,
            why,
            coarse_dofs,
            ..
        }) = largest
        else {
            return;
        };
        let (all, most) = (CostEstimate::sum(costs), CostEstimate::largest(costs));
        self.print_event(&Event::Check(&Costs {
            memory_bytes: all.bytes,
            largest_rank_memory_bytes: most.bytes,
            available_bytes: *available,
            flops: all.flops,
            busiest_rank_flops: most.flops,
            interface_choice: why,
            coarse_dofs: *coarse_dofs,
        }));
    }

    /// Prints the start of load step `k`; nothing in a problem without load steps.
    pub fn step(&self, catalog: &Catalog, k: usize) {
        let Some(step) = catalog.steps.get(k) else {
            return;
        };
        let all = catalog.steps.len();
        let (first, began) = self.first_step.get().unwrap_or((k, Instant::now()));
        self.first_step.set(Some((first, began)));
        // The steps to come take as long as those of this run.
        let of_one = began.elapsed().as_secs_f64() / (k - first) as f64;
        let seconds_left = (k > first).then_some(of_one * (all - k) as f64);
        self.print_event(&Event::Step(&Step {
            step: k + 1,
            steps: all,
            name: &step.name,
            time: step.time,
            absent: catalog.absent_in(k),
            seconds_left,
        }));
    }

    /// Prints the header of the table of sweeps if anything is in contact.
    pub fn sweeps(&self, in_contact: bool) {
        if in_contact {
            self.print_text(terminal::SWEEP_HEADER);
        }
    }

    /// Prints a sweep.
    pub fn sweep(&self, record: &SweepRecord) {
        self.print_event(&Event::Sweep(record));
    }

    /// Makes the report, writes it with the results, and prints how the run ended. On the root.
    ///
    /// # Errors
    /// Results or log can't be written.
    pub fn finish(
        &self,
        totals: &Totals<'_>,
        write: impl FnOnce(&Report) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let report = report(totals, self.settings, self.comm);
        write(&report)?;
        self.bar.finish();
        for warning in &report.warnings {
            match self.format {
                None => event::warning(self.settings.log, warning),
                // People read them at the end of all.
                Some(_) => self.print_event(&Event::Warning { message: warning }),
            }
        }
        let failures = failures(totals);
        let exit_code = if failures.is_empty() {
            0
        } else {
            NOT_CONVERGED
        };
        self.print_event(&Event::Finished(&Finished {
            exit_code,
            result: self.settings.output.display().to_string(),
            reason: &reason(totals),
            report: &report,
            catalog: totals.catalog,
        }));
        if !failures.is_empty() {
            let why = format!("not converged: {}", failures.join("; "));
            event::error(self.settings.log, exit_code, &why);
        }
        self.check_written()
    }
}
