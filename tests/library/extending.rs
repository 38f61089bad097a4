//! What docs/extending.md says, done once: an element, a contact law and a sweep method that the
//! program doesn't have, through nothing but its public items.

mod contact_law;
mod element;
#[path = "../../partition/tests/library/element/laws.rs"]
mod laws;
mod layer;
mod page;
mod quad6;
mod small;
mod sweep_method;
