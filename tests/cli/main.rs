//! The command line, the report, and the scripts that read reports.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

extern crate contact_dd_trials as support;

mod command_line;
mod records;
mod report;
mod scripts;
mod test_script;
