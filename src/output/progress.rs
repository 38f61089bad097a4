//! The progress bar.

use std::io::{IsTerminal, stderr};

use indicatif::{ProgressBar, ProgressStyle};

/// A bar on the terminal; in a batch log there is none.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar for the factorization of `subdomains` subdomains, `quiet` without one.
    pub fn factorization(subdomains: usize, quiet: bool) -> Self {
        if quiet || !stderr().is_terminal() {
            return Self {
                bar: ProgressBar::hidden(),
            };
        }
        let bar = ProgressBar::new(subdomains as u64);
        // The template is constant; were it wrong, the default bar would do.
        if let Ok(style) =
            ProgressStyle::with_template("factorize [{bar:32}] {pos}/{len} subdomains {elapsed}")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        Self { bar }
    }

    /// One subdomain more is done.
    pub fn advance(&self) {
        self.bar.inc(1);
    }

    /// Removes the bar.
    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}
