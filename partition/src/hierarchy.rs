//! Planning: the tree along which Schur complements are merged, what its nodes cost, the clusters between which an
//! iterative interface solver works, and which interface solver takes less time.
//!
//! All of it follows from the problem file, so that merges are the same on any number of ranks.

pub mod choice;
mod clusters;
pub mod cost;
mod interface;
pub mod tree;
pub mod work;
