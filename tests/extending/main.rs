//! What docs/extending.md says, done once: an element, a contact law and a sweep method that the
//! program doesn't have, through nothing but its public items.

#![expect(clippy::unwrap_used, reason = "a test that can't go on has failed")]

mod element;
#[path = "../../partition/tests/element/laws.rs"]
mod laws;
mod quad6;
#[path = "../support/mod.rs"]
mod support;
