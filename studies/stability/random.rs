//! Random scenes, one after the other or several at a time.

use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use crate::support::stress::Drawn;
use crate::support::stress::friction::Law;
use crate::support::stress::trial::{Interface, Trial, Verdict};

/// Makes the scene of a seed, with blocks of so many cells.
pub type Draw = fn(u64, usize) -> Drawn;

/// Settings of the runs.
pub struct Runs {
    pub binary: PathBuf,
    pub cells: usize,
    pub jobs: usize,
    pub limit: Duration,
    pub keep: Option<PathBuf>,
    /// The interface solver that is asked for.
    pub interface: Interface,
}

/// A scene that was run; of its model nothing is kept.
pub struct Ran {
    pub seed: u64,
    pub family: &'static str,
    /// The name of its cells.
    pub cells: &'static str,
    /// Whether its solution was chosen first.
    pub manufactured: bool,
    /// On how many ranks it ran besides, 0 for none.
    pub ranks: usize,
    /// Its laws of friction, if it has any.
    pub friction: Option<Law>,
    /// Number of load steps, 0 where it has none.
    pub steps: usize,
    pub trial: Trial,
    pub seconds: f64,
}

impl Runs {
    /// Runs the scenes that are drawn with `seeds`; tells each, or those only that aren't right.
    pub fn all(&self, draw: Draw, seeds: &[u64], told: bool) -> Vec<Ran> {
        let next = AtomicUsize::new(0);
        let ran = Mutex::new(Vec::new());
        std::thread::scope(|scope| {
            for _ in 0..self.jobs {
                scope.spawn(|| {
                    while let Some(&seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed)) {
                        if let Some(one) = self.one(draw, seed, told) {
                            ran.lock().unwrap().push(one);
                        }
                    }
                });
            }
        });
        let mut ran = ran.into_inner().unwrap();
        ran.sort_by_key(|one| one.seed);
        ran
    }

    /// None where what was drawn is no scene: moving nodes may fold a cell.
    fn one(&self, draw: Draw, seed: u64, told: bool) -> Option<Ran> {
        let began = Instant::now();
        let Ok(drawn) = std::panic::catch_unwind(|| draw(seed, self.cells)) else {
            println!("{seed:>6} can't be");
            return None;
        };
        let trial = Trial::with(
            &drawn,
            &self.binary,
            self.limit,
            self.keep.as_deref(),
            self.interface,
        );
        let ran = Ran::new(&drawn, trial, began);
        if told || ran.trial.verdict != Verdict::Right || ran.is_short() {
            println!("{}", ran.line());
        }
        if told {
            print_details(&drawn, &ran);
        }
        Some(ran)
    }
}

fn print_details(drawn: &Drawn, ran: &Ran) {
    println!("{}", drawn.described());
    if let Some(report) = &ran.trial.report {
        println!("{report:#}");
    }
    println!("{:#?}", ran.trial.findings);
}

impl Ran {
    pub fn new(drawn: &Drawn, trial: Trial, began: Instant) -> Self {
        Self {
            seed: drawn.seed,
            family: drawn.family,
            cells: drawn.cells,
            manufactured: drawn.manufactured,
            ranks: drawn.ranks,
            friction: drawn.friction,
            steps: drawn.model.steps.len(),
            trial,
            seconds: began.elapsed().as_secs_f64(),
        }
    }

    /// Whether it misses a target of every scene though it is right.
    pub fn is_short(&self) -> bool {
        let over = |keys: &[&str], limit: f64| {
            let value = self.trial.reported(keys);
            value.is_some_and(|value| value > limit)
        };
        (self.steps == 0 && over(&["sweeps"], 12.0))
            || over(&["certificate", "equilibrium"], 1e-14)
            || over(&["certificate", "penetration"], 1e-14)
            || over(&["certificate", "tension"], 1e-12)
    }

    /// All in one line.
    pub fn line(&self) -> String {
        let trial = &self.trial;
        let mut line = format!(
            "{:>6} {:<17} {:<26} {:<13} {:>6} dofs {:>4} conditions {:>3} subdomains {:>5.2} s",
            self.seed,
            self.family,
            self.cells,
            trial.verdict.name(),
            trial.dofs,
            trial.conditions,
            trial.subdomains,
            self.seconds
        );
        if let Some(sweeps) = trial.reported(&["sweeps"]) {
            line += &format!("  sweeps {sweeps}");
        }
        for key in ["equilibrium", "penetration", "tension"] {
            if let Some(value) = trial.reported(&["certificate", key]) {
                line += &format!("  {key} {value:.1e}");
            }
        }
        if let Some(law) = self.friction {
            line += &format!("  {law:.2?}, {} load steps", self.steps);
            if let Some(steps) = trial.newton_steps() {
                line += &format!(" of {steps} steps at most");
            }
        }
        if let Some(findings) = &trial.findings {
            line += &format!(
                "  difference {:.1e} ({:.1e}) signs {:.1e}",
                findings.difference.unwrap_or(f64::NAN),
                findings.disturbance.unwrap_or(f64::NAN),
                findings.reference_signs.unwrap_or(f64::NAN)
            );
        }
        if !trial.reason.is_empty() {
            line += &format!("  {}", trial.reason.trim());
        }
        line
    }
}

/// Prints how many there are of each verdict.
pub fn summary(ran: &[Ran]) {
    if ran.is_empty() {
        return;
    }
    for verdict in Verdict::ALL {
        let count = (ran.iter())
            .filter(|one| one.trial.verdict == verdict)
            .count();
        println!("{:<14} {count}", verdict.name());
    }
    println!(
        "short          {}",
        ran.iter().filter(|one| one.is_short()).count()
    );
    println!(
        "seconds        {:.0}",
        ran.iter().map(|one| one.seconds).sum::<f64>()
    );
}
