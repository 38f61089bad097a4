//! contact-dd-mpi.

pub mod comm;
pub mod contact;
pub mod error;
pub mod fem;
pub mod interface;
pub mod schur;
pub mod sweep;
