//! What docs/extending.md says, done once: an element, a contact law and a sweep method that the
//! program doesn't have, through nothing but its public items.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod contact_law;
mod element;
#[path = "../../partition/tests/element/laws.rs"]
mod laws;
mod layer;
mod page;
mod quad6;
mod small;
#[path = "../support/mod.rs"]
mod support;
mod sweep_method;
