//! What the tests of the whole program share.

#![allow(
    dead_code,
    reason = "every test binary takes what it needs and leaves the rest"
)]

pub mod blocks;
pub mod monolithic;
pub mod process;
pub mod random;
pub mod scenes;
pub mod solution;
pub mod solver;
