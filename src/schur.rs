//! Local Schur complements: ordering, sparse factorization with the boundary last, condensation and
//! recovery.

mod columns;
pub mod condensed;
mod dissection;
pub mod factor;
mod front;
mod fronts;
mod graph;
pub mod local;
pub mod merge;
pub mod ordering;
mod panel;
mod partial;
pub mod pattern;
pub mod repeats;
mod supernodes;
pub mod trace;
