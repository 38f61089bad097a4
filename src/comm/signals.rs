//! Signals that request the end of a run.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1};
use signal_hook::flag;

static ASKED: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// True if this rank was asked to stop: by SIGTERM, SIGINT, or SIGUSR1, which Slurm can be told to send before the time
/// limit.
pub fn is_asked_to_stop() -> bool {
    let asked = ASKED.get();
    asked.is_some_and(|asked| asked.load(Ordering::Relaxed))
}

/// Installs the signal handlers; the same signal a second time ends the process by default.
pub(super) fn listen() -> io::Result<()> {
    let asked = ASKED.get_or_init(Arc::default);
    for signal in [SIGTERM, SIGINT, SIGUSR1] {
        // SIGUSR1 of a batch system is followed by its SIGTERM, which mustn't count as the second signal.
        let came = Arc::new(AtomicBool::new(false));
        flag::register_conditional_default(signal, Arc::clone(&came))?;
        flag::register(signal, came)?;
        flag::register(signal, Arc::clone(asked))?;
    }
    Ok(())
}
