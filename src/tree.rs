//! Direct solver for many contact constraints: an active-set (semismooth Newton) iteration fixes the open ones, which
//! makes every unknown linear, and refactorizes only the branches of the hierarchy above the constraints that changed.
//!
//! No matrix holds all constraints: an open normal jump is eliminated in the front where it appears, like a
//! displacement; a closed one has its known value there.

mod active_set;
pub mod contact;
mod front_jumps;
pub mod fronts;
mod operator;
mod problem;
pub mod slip_problem;
pub mod solution;
mod update;
