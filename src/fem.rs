//! Finite elements of a block: unknowns, elasticity, assembly, balance, stresses.

pub mod assembly;
pub mod balance;
pub mod block;
mod bounds;
pub mod condition;
pub mod dofs;
pub mod elasticity;
mod elimination;
pub mod estimate;
pub mod frame;
pub mod node_frames;
pub mod owned;
pub mod patch;
pub mod recovery;
mod sites;
pub mod stress;
