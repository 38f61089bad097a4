//! Local Schur complements, (11): ordering, sparse factorization with the boundary last, condensation and recovery.
//!
//! > S = K_BB − K_BI K_II⁻¹ K_IB,   u_I = K_II⁻¹ (f_I − K_IB u_B)

mod children;
pub mod cluster_schur;
pub mod columns;
pub mod condensed;
mod coupling;
mod dissection;
pub mod factor;
pub(crate) mod front;
pub mod front_order;
mod fronts;
pub mod local;
pub mod merge;
pub mod ordering;
mod panel;
pub mod pattern;
pub mod substitution;
mod supernodes;
pub mod symmetric;
pub mod trapezoid;
