//! The interface problem on Γ: its numbering, S_0, and the solve at the root.

pub mod coupled;
pub mod numbering;
pub mod operator;
pub mod s_con;
