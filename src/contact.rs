//! Unilateral contact: approaches, the pair's small problem, S_kl and S_CON.

pub mod active_set;
pub mod approach;
pub mod pair;
pub mod s_con;
