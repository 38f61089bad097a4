//! Parallel domain decomposition for unilateral contact in linear elasticity, after J. Daněk.

pub mod comm;
pub mod contact;
pub mod error;
pub mod fem;
pub mod interface;
pub mod output;
pub mod schur;
pub mod sweep;
