//! Contact of sides whose nodes don't match.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod invariance;
mod patch;
mod round;
mod sorts;
#[path = "../support/mod.rs"]
mod support;
mod system;
