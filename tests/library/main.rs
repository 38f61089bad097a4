//! The library's own interface, without runs of the program.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod architecture;
mod result_file;
#[path = "../support/mod.rs"]
mod support;
