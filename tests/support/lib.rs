//! Trials of the whole program, shared by tests and studies: random scenes, exact solutions, independent solves and the
//! judges that compare.

#![allow(
    missing_docs,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::new_without_default,
    clippy::panic,
    reason = "a trial that can't go on has failed"
)]

pub mod assembled;
pub mod blocks;
pub mod close;
pub mod comparison;
pub mod energy;
pub mod extruded;
pub mod isoparametric;
pub mod monolithic;
pub mod mounted;
pub mod process;
pub mod punches;
pub mod random;
pub mod round;
pub mod scenes;
pub mod solids;
pub mod solution;
pub mod solver;
pub mod sorts;
pub mod sparse_system;
pub mod statics;
pub mod stress;
pub mod twofold;
pub mod uneven;
pub mod uniform;
pub mod validation;
