//! Ranks that end or stop on purpose, in a phase of the tests' choice.
//!
//! `CONTACT_DD_END="RANK KIND PHASE"` makes a rank fail, panic, be killed, or stop until it is continued,
//! when it comes to a phase. Only a build with debug assertions, which is what tests run, looks at it.

use std::sync::OnceLock;
use std::{env, thread};

use signal_hook::consts::{SIGKILL, SIGSTOP};
use signal_hook::low_level::raise;

use crate::error::Failure;

static RANK: OnceLock<usize> = OnceLock::new();

/// Makes known which rank this is.
pub fn set_rank(rank: usize) {
    RANK.get_or_init(|| rank);
}

/// Ends or stops this rank if that is to happen in `phase`.
#[expect(clippy::panic, reason = "that's the purpose")]
pub fn end(phase: &str) {
    match wish(phase).as_deref() {
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

/// The failure that this rank is to have in `phase`.
pub fn failure(phase: &str) -> Option<Failure> {
    let wish = wish(phase)?;
    (wish == "failure").then(|| Failure::ill_posed("on purpose"))
}

/// The end that this rank is to take in `phase`.
fn wish(phase: &str) -> Option<String> {
    let wish = env::var("CONTACT_DD_END").ok()?;
    let mut words = wish.splitn(3, ' ');
    let rank: usize = words.next()?.parse().ok()?;
    let kind = words.next()?;
    (RANK.get() == Some(&rank) && words.next() == Some(phase)).then(|| kind.to_owned())
}
