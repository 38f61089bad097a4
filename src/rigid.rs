//! Rigid motions: those that neither supports nor contact hold, those by which bodies come to rest,
//! and those that are free once contacts have opened.
//!
//! Found from geometry alone, before anything is factorized, because a Cholesky factorization
//! passes a free motion at a pivot of round-off. With R the rigid motions that the supports
//! leave, a motion z is free if B R z = 0, and held by contact if B R z ≤ 0 doesn't allow it; the
//! load balances if contact forces λ ≥ 0 with (B R)ᵀ λ = Rᵀ f exist. B R has no energy and (B R)ᵀ c
//! is Rᵀ f in every contact problem: what round-off makes of both is taken out.
//!
//! With friction B has tangential rows, too. No motion is free that these hold, and their forces help to balance the
//! load within the law's bounds. That such forces exist is necessary: by which of them elastic bodies come to rest
//! depends on their path, and a load that needs others is found by the solver not to converge.

pub mod analysis;
mod bodies;
pub mod body_analysis;
pub mod closing_motion;
mod cluster_modes;
mod columns;
mod description;
pub mod forces;
pub mod free_motion;
mod friction_limit;
pub mod infeasible_nodes;
mod kinematics;
mod many_bodies;
pub mod nonnegative;
mod null_space;
pub mod projection;
mod proof;
pub mod released_modes;
mod rows;
pub mod scene;
#[cfg(test)]
mod squares;
mod ties;
mod unheld_motions;
