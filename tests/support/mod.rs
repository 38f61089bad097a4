//! What the tests of the whole program share.

#![allow(
    dead_code,
    reason = "every test binary takes what it needs and leaves the rest"
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
pub mod validation;
