//! Many contact conditions: an active-set (semismooth Newton) step fixes which of them are open, makes every
//! unknown linear with that, and eliminates again only the branches of the hierarchy above what changed.
//!
//! No matrix holds all conditions: an open normal jump is eliminated in the front where it appears, like a
//! displacement, a closed one is known there.

mod active_set;
pub mod contact;
mod front_jumps;
pub mod fronts;
mod operator;
mod problem;
pub mod slip_law;
pub mod slip_problem;
pub mod solution;
mod update;
