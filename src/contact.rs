//! Unilateral contact: approaches, the pair's small problem, S_kl and S_CON.

pub mod active_set;
pub mod approach;
pub mod dependent;
pub mod dual;
pub mod interior_point;
pub mod law;
pub mod limits;
pub mod open_factor;
pub mod pair;
