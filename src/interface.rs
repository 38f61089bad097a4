//! The interface problem S_0 U + S_CON(U) = F, (14), on Γ: its numbering, S_0, S_CON, and its solvers.

pub mod coupled;
pub mod numbering;
pub mod operator;
pub mod problem;
pub mod rigid_modes;
pub mod s_con;
pub mod solver;
