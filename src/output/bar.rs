//! The progress bar.

use std::cell::Cell;
use std::io::{IsTerminal, Write, stderr, stdout};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// How long a log hears nothing of a run.
const SILENCE: Duration = Duration::from_secs(10);

/// How often a bar without steps moves.
const TICK: Duration = Duration::from_millis(100);

/// What a run is doing: a bar on the terminal, now and then a line in a log.
#[derive(Debug)]
pub struct Bar {
    bar: ProgressBar,
    /// When the log last heard of the run; `None` where there is no log.
    told: Option<Cell<Instant>>,
    began: Instant,
}

impl Bar {
    /// A bar that is empty; `quiet` is one that never shows.
    pub fn new(quiet: bool) -> Self {
        let now = Instant::now();
        let shown = !quiet && stderr().is_terminal();
        let bar = match shown {
            true => ProgressBar::no_length(),
            false => ProgressBar::hidden(),
        };
        let bar = Self {
            bar,
            told: (!quiet && !shown).then(|| Cell::new(now)),
            began: now,
        };
        // Before the first phase there is nothing to show.
        bar.look("");
        bar
    }

    fn look(&self, template: &str) {
        // The templates are constant; were one wrong, the default bar would do.
        if let Ok(style) = ProgressStyle::with_template(template) {
            self.bar.set_style(style.progress_chars("=> "));
        }
    }

    /// Begins a phase, of so many steps where that is known.
    pub fn begin(&self, phase: &'static str, steps: Option<usize>) {
        self.tell(|| phase.to_owned());
        self.look(match steps {
            Some(_) => "{msg} [{bar:32}] {pos}/{len} {elapsed}",
            None => "{msg} {spinner} {elapsed}",
        });
        self.bar.reset();
        self.bar.set_message(phase);
        match steps {
            Some(steps) => self.bar.set_length(steps as u64),
            None => self.bar.unset_length(),
        }
        if !self.bar.is_hidden() {
            self.bar.enable_steady_tick(TICK);
        }
    }

    /// One step more is done.
    pub fn advance(&self) {
        self.bar.inc(1);
        self.tell(|| {
            let (done, all) = (self.bar.position(), self.bar.length().unwrap_or(0));
            format!("{}, {done} of {all}", self.bar.message())
        });
    }

    /// Tells the log, unless it has heard of the run just now.
    fn tell(&self, doing: impl FnOnce() -> String) {
        let Some(told) = &self.told else { return };
        if told.get().elapsed() > SILENCE {
            told.set(Instant::now());
            let seconds = self.began.elapsed().as_secs_f64();
            // A closed pipe is no reason to stop a run that writes its results to a file.
            let _ = writeln!(stdout(), "  after {seconds:.0} s: {}", doing());
        }
    }

    /// Prints while the bar is out of the way.
    pub fn aside(&self, print: impl FnOnce()) {
        self.bar.suspend(print);
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.finish();
    }
}
