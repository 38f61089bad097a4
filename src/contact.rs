//! Unilateral contact: gap variables, the pair's small problem, and S_kl.

pub mod active_set;
pub mod gap;
pub mod pair;
pub mod s_con;
