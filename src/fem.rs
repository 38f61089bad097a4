//! Finite elements of a block: unknowns, elasticity, assembly, stresses.

pub mod assembly;
pub mod block;
pub mod dofs;
pub mod elasticity;
pub mod frame;
