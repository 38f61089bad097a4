//! Planning: the tree along which Schur complements are merged, the cost of its nodes, the clusters of an iterative
//! interface solver, and the choice of the fastest interface solver.
//!
//! All of it follows from the problem file, so that merges are the same on any number of ranks.

pub mod choice;
mod clusters;
pub mod cost;
mod interface;
pub mod tree;
pub mod work;
