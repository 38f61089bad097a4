//! Deliberate failures of ranks in a given phase, for tests.
//!
//! `CONTACT_DD_END="RANK KIND PHASE"` makes a rank fail, panic, be killed, or stop until it is continued, when it
//! enters a phase. Only builds with debug assertions, which tests use, evaluate it.

use std::sync::OnceLock;
use std::{env, thread};

use signal_hook::consts::{SIGKILL, SIGSTOP};
use signal_hook::low_level::raise;

use crate::error::Failure;

static RANK: OnceLock<usize> = OnceLock::new();

/// Sets the number of this rank.
pub fn set_rank(rank: usize) {
    RANK.get_or_init(|| rank);
}

/// Ends or stops this rank if the variable requests it in `phase`.
#[expect(clippy::panic, reason = "that's the purpose")]
pub fn end(phase: &str) {
    match requested(phase).as_deref() {
        Some("panic") => panic!("on purpose"),
        Some("kill") => {
            let _ = raise(SIGKILL);
            thread::park();
        }
        Some("stop") => {
            let _ = raise(SIGSTOP);
        }
        _ => {}
    }
}

/// The failure that the variable requests on this rank in `phase`.
pub fn failure(phase: &str) -> Option<Failure> {
    let request = requested(phase)?;
    (request == "failure").then(|| Failure::ill_posed("on purpose"))
}

/// The kind of end that the variable requests on this rank in `phase`.
fn requested(phase: &str) -> Option<String> {
    let request = env::var("CONTACT_DD_END").ok()?;
    let mut words = request.splitn(3, ' ');
    let rank: usize = words.next()?.parse().ok()?;
    let kind = words.next()?;
    (RANK.get() == Some(&rank) && words.next() == Some(phase)).then(|| kind.to_owned())
}
