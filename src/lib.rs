//! Parallel domain decomposition for unilateral contact in linear elasticity, after J. Daněk.

pub mod certificate;
pub mod comm;
pub mod contact;
pub mod error;
pub mod fem;
pub mod interface;
pub mod output;
pub mod plan;
pub mod rigid;
pub mod run;
pub mod schur;
pub mod settings;
pub mod sweep;
