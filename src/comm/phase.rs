//! The current phase of this rank, for messages of failures and panics.

use std::sync::{Mutex, PoisonError};

#[cfg(debug_assertions)]
use super::on_purpose;

static PHASE: Mutex<&str> = Mutex::new("starting");

/// Sets the phase of this rank, for messages of failures and panics.
pub fn phase(name: &'static str) {
    *PHASE.lock().unwrap_or_else(PoisonError::into_inner) = name;
    #[cfg(debug_assertions)]
    on_purpose::end(name);
}

/// The phase of this rank.
pub(super) fn current_phase() -> &'static str {
    *PHASE.lock().unwrap_or_else(PoisonError::into_inner)
}
