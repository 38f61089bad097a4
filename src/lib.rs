//! Parallel domain decomposition for unilateral contact in linear elasticity, after J. Daněk.
//!
//! Several elastic bodies press on each other. Their displacement minimizes ½ uᵀK u − fᵀu subject to
//! B u ≤ g. Cut into subdomains that are bonded on Γ, the problem is one for the trace U on Γ alone,
//!
//! > S_0 U + S_CON(U) = F,   (14)
//!
//! with S_0 the sum of the Schur complements of the subdomains without contact, (11), and S_CON the
//! sum of the common, nonlinear ones of the pairs in contact, (12). Equation numbers are those of
//! J. Daněk, *Use of MATLAB for domain decomposition method for contact problem in elasticity*.
//!
//! [`run`] is the whole solve on one page: every rank reads its own blocks ([`plan`], [`fem`]),
//! looks for rigid motions that nothing holds ([`rigid`]), condenses them ([`schur`], [`contact`]) and
//! merges what belongs together up a tree of subdomains, the hierarchy of the problem file; the root
//! assembles and solves what is left of Γ ([`interface`], [`sweep`]); the solution is checked against
//! the full discrete problem ([`certificate`]) and written ([`output`]). A run that a signal stops leaves
//! a [`checkpoint`]. Only [`comm`] knows MPI.

pub mod certificate;
pub mod checkpoint;
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
