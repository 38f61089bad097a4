//! The progress bar.

use std::cell::Cell;
use std::io::{IsTerminal, Write, stderr, stdout};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Time without output after which a line of progress is added to a log.
const LOG_INTERVAL: Duration = Duration::from_secs(10);

/// Interval at which the bar is redrawn without progress.
const TICK: Duration = Duration::from_millis(100);

/// Resolution of the bar.
const STEPS: u64 = 1000;

/// Progress of a run: a bar on the terminal, occasional lines in a log.
#[derive(Debug)]
pub struct Bar {
    bar: ProgressBar,
    phase: Cell<&'static str>,
    part: Cell<Part>,
    /// Time of the last line in the log; `None` without one.
    last_line: Option<Cell<Instant>>,
    began: Instant,
}

/// A part of a phase with known progress, such as a linear system.
#[derive(Clone, Copy, Debug)]
struct Part {
    began: Instant,
    share: f64,
}

impl Part {
    fn new() -> Self {
        Self {
            began: Instant::now(),
            share: 0.0,
        }
    }

    /// Estimated time of the rest of the part at the present rate (s); `None` if too little is done for an estimate.
    fn seconds_left(self, elapsed: Duration) -> Option<f64> {
        let left = elapsed.as_secs_f64() * (1.0 - self.share) / self.share;
        (self.share > 0.02 && elapsed > 10 * TICK).then_some(left)
    }
}

impl Bar {
    /// An empty bar; if `quiet`, it is never shown.
    pub fn new(quiet: bool) -> Self {
        let now = Instant::now();
        let shown = !quiet && stderr().is_terminal();
        let bar = match shown {
            true => ProgressBar::no_length(),
            false => ProgressBar::hidden(),
        };
        let bar = Self {
            bar,
            phase: Cell::new(""),
            part: Cell::new(Part::new()),
            last_line: (!quiet && !shown).then(|| Cell::new(now)),
            began: now,
        };
        // Nothing is shown before the first phase.
        bar.set_template("");
        bar
    }

    fn set_template(&self, template: &str) {
        // The templates are constants; with a wrong one, the default bar would be used.
        if let Ok(style) = ProgressStyle::with_template(template) {
            self.bar.set_style(style.progress_chars("=> "));
        }
    }

    /// Begins a phase.
    pub fn begin(&self, phase: &'static str) {
        self.phase.set(phase);
        self.part.set(Part::new());
        self.log_progress(|| phase.to_owned());
        self.set_template("{msg} {spinner} {elapsed}");
        self.bar.reset();
        self.bar.set_message(phase);
        self.bar.unset_length();
        if !self.bar.is_hidden() {
            self.bar.enable_steady_tick(TICK);
        }
    }

    /// Reports the `share` done of the phase, or of a part of it; 0 begins another part.
    pub fn done(&self, share: f64) {
        let mut part = self.part.get();
        if share == 0.0 {
            part = Part::new();
            self.set_template("{msg} [{bar:32}] {percent} %{prefix}, {elapsed} so far");
            self.bar.set_length(STEPS);
        }
        part.share = share;
        self.part.set(part);
        let left = || {
            let seconds = self.seconds_left();
            seconds.map_or(String::new(), |s| format!(", {}", in_words(s)))
        };
        if !self.bar.is_hidden() {
            self.bar.set_position((share * STEPS as f64) as u64);
            self.bar.set_prefix(left());
        }
        self.log_progress(|| format!("{}, {:.0} %{}", self.phase.get(), 100.0 * share, left()));
    }

    /// The phase of the run.
    pub fn phase(&self) -> &'static str {
        self.phase.get()
    }

    /// Estimated time of the rest of the part at the present rate (s), if there is an estimate.
    pub fn seconds_left(&self) -> Option<f64> {
        let part = self.part.get();
        part.seconds_left(part.began.elapsed())
    }

    /// Writes a line to the log, unless it has had one recently.
    fn log_progress(&self, doing: impl FnOnce() -> String) {
        let Some(last_line) = &self.last_line else {
            return;
        };
        if last_line.get().elapsed() > LOG_INTERVAL {
            last_line.set(Instant::now());
            let seconds = self.began.elapsed().as_secs_f64();
            // A closed pipe must not stop a run that writes its results to a file.
            let _ = writeln!(stdout(), "  after {seconds:.0} s: {}", doing());
        }
    }

    /// Prints with the bar temporarily removed.
    pub fn suspend(&self, print: impl FnOnce()) {
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

/// Remaining time as text.
pub fn in_words(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("about {s:.0} s left"),
        s if s < 6000.0 => format!("about {:.0} min left", s / 60.0),
        s => format!("about {:.0} h left", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_takes_as_long_as_what_is_done() {
        let part = Part {
            share: 0.25,
            ..Part::new()
        };
        let left = part.seconds_left(Duration::from_secs(40));
        assert_eq!(left, Some(120.0));
        assert_eq!(part.seconds_left(Duration::from_millis(1)), None);
        assert_eq!(Part::new().seconds_left(Duration::from_secs(40)), None);
        let words = [40.0, 120.0, 7200.0].map(in_words);
        assert_eq!(
            words,
            ["about 40 s left", "about 2 min left", "about 2 h left"]
        );
    }
}
