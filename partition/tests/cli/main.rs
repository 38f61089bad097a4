//! The program as a user starts it.

#![expect(clippy::unwrap_used, reason = "a test that can't go on has failed")]

mod decks;
mod full_disk;
mod info;
#[path = "../../../tests/support/mounted.rs"]
mod mounted;
mod outputs;
mod program;
mod refusals;
#[path = "../library/says.rs"]
mod says;
#[path = "../library/table.rs"]
mod table;
