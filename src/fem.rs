//! Finite elements of a block: unknowns, elasticity, assembly, balance, stresses.

pub mod assembly;
pub mod balance;
pub mod block;
pub mod condition;
pub mod dofs;
pub mod elasticity;
pub mod frame;
pub mod stress;
