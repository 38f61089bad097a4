//! The library's own interface, without runs of the program.

#![expect(clippy::unwrap_used, reason = "a test that can't go on has failed")]

extern crate contact_dd_trials as support;

mod architecture;
mod result_file;
