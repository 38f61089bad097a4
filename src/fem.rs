//! Finite elements of a block: unknowns, elasticity, assembly, loads, balance, stresses.

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
pub mod load;
pub mod node_frames;
pub mod patch;
pub mod recovery;
mod sites;
pub mod stress;
