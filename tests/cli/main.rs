//! The command line and the report, with the scripts that read reports.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod command_line;
mod records;
mod report;
mod scripts;
#[path = "../support/mod.rs"]
mod support;
mod test_script;
