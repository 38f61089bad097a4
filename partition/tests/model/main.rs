//! What a scene means on its mesh.

#![expect(
    clippy::unwrap_used,
    reason = "what the tests share may panic as they do"
)]

mod blocks;
mod bodies;
#[path = "../../../tests/support/close.rs"]
mod close;
mod contact;
mod corner;
mod doubts;
mod invariance;
mod loads;
mod mortar;
mod mortar_discs;
mod obstacle;
mod quadratic;
mod steps;
mod supports;
