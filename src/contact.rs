//! Unilateral contact: S_kl of a pair, (12), with its contact problem condensed onto normal jumps.
//!
//! > S_kl(U) = S_ΓΓ U + S_Γt t(U) − f_Γ,   t(U) = arg min ½ tᵀ H t − (c − S_tΓ U)ᵀ t   over   t ≤ g

pub mod active_equalities;
pub mod active_set;
pub mod condensed_contact;
pub mod conditions;
pub mod dependence;
pub mod dependent;
pub mod dual;
pub mod friction;
pub mod independent_limits;
pub mod interior_point;
pub mod jumps;
pub mod law;
pub mod laws;
pub mod limits;
pub mod newton;
pub mod open_factor;
pub mod pair;
pub mod patch;
mod prescribed_slip;
pub mod projection;
pub mod shared_jump;
pub mod sharing;
pub mod slip_law;
pub mod status;
pub mod tangent;
