//! Rigid-body motions: those restrained by neither supports nor contact, closing motions, by which bodies come into
//! contact, and those that become free once contacts have opened.
//!
//! They are found from geometry alone, before anything is factorized, because a Cholesky factorization may pass a free
//! motion with a pivot of round-off. Let the columns of R be the rigid motions that the supports leave. A motion z is
//! free if B R z = 0, and contact resists it if it violates B R z ≤ 0; the load is balanced if contact forces λ ≥ 0
//! with (B R)ᵀ λ = Rᵀ f exist. In every contact problem with stiffness H and load c on the normal jumps, H B R = 0 and
//! (B R)ᵀ c = Rᵀ f hold: round-off that violates either is removed.
//!
//! With friction B has tangential rows, too. They restrain motions, and their forces contribute to the balance of the
//! load within the bounds of the friction law. Existence of such forces is necessary only: the forces under which
//! elastic bodies come to rest depend on the load path, and if these don't balance the load, the solver doesn't
//! converge.

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
