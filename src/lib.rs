//! Parallel domain decomposition for unilateral contact in linear elasticity, after J. Daněk.
//!
//! Equation numbers are those of his *Use of MATLAB for domain decomposition method for contact problem
//! in elasticity*, symbols those of `docs/notation.md`.
//!
//! **The problem.** Elastic bodies press on each other. Discretized ([`fem`]), their displacement is
//!
//! > u = arg min ½ uᵀ K u − fᵀ u   subject to   B u ≤ g,   (1)-(3)
//!
//! with a row of B, n·(u_a − u_b) ≤ g, for each [contact point](contact_dd_partition::contact_point) of a contact
//! surface Γ_c; a is as a rule the slave side, b the master side. Rigid-body motions that neither supports nor contact
//! restrain are found before anything is factorized ([`rigid`]).
//!
//! **The decomposition.** Bodies are divided into subdomains that are bonded on the interface Γ, which includes all
//! nodes of Γ_c. T are the subdomains without contact, ϑ the pairs [k, l] in contact. Every rank [owns](plan) some of
//! them; the remaining unknown is the trace U of the displacement on Γ.
//!
//! **Schur complements.** Without contact, the interior is eliminated ([`schur::local`]),
//!
//! > S_i = K_ΓΓ − K_ΓI K_II⁻¹ K_IΓ,   i ∈ T;   (11)
//!
//! a pair has [normal jumps](contact::jumps) t = b·u as unknowns in place of some displacements
//! ([`schur::substitution`]), and one common, nonlinear Schur complement ([`contact::pair`]),
//!
//! > S_kl(U) = S_ΓΓ U + S_Γt t(U) − f_Γ,   t(U) = arg min ½ tᵀ H t − (c − S_tΓ U)ᵀ t   over   t ≤ g.   (12)
//!
//! Both are [merged](schur::merge) up a tree of subdomains, the hierarchy of the problem file, as long as that is
//! cheaper than assembling them at the root.
//!
//! **The interface problem.** With R̄_i the restriction from Γ to the boundary of subdomain i, they add up to
//!
//! > S_0 U + S_CON(U) = F,   (14)
//! >
//! > S_0 = Σ_T R̄_iᵀ S_i R̄_i,   S_CON = Σ_ϑ R̄_klᵀ S_kl R̄_kl,   F = Σ_T R̄_iᵀ f_i,   (15)
//!
//! where the load of a pair is part of its S_kl. The root assembles S_0 and F
//! ([`Interface`](interface::operator::Interface)); the ranks that own the pairs evaluate S_CON
//! ([`SCon`](interface::s_con::SCon)).
//!
//! **The start.** Contacts closed in the normal direction and free in the tangential one, t = 0, give the linear,
//! bilateral problem
//!
//! > n·(u_k − u_l) = 0 on Γ_c,   (S_0 + Σ_ϑ R̄_klᵀ S_ΓΓ R̄_kl) U^0 = F + Σ_ϑ R̄_klᵀ f_Γ,   (16)-(17)
//!
//! whose factor all methods reuse ([`bilateral_start`](interface::problem::InterfaceProblem::bilateral_start)).
//!
//! **The outer iterations, sweeps.** The paper's successive approximations,
//!
//! > S_0 U^k = F − S_CON(U^(k−1)),   (18)
//!
//! are [`picard`](sweep::picard). They converge only if the subdomains in contact are soft; [`newton`](sweep::newton)
//! and [`anderson`](sweep::anderson) converge for any stiffness ([`sweep`]).
//!
//! **The result.** Back-substitution, the [`certificate`] of the full discrete problem, and the [`output`].
//!
//! [`run`] shows all of it in one module. Only [`comm`] uses MPI; [`contact_dd_partition`] writes the problem file.

pub mod bddc;
pub mod bytes;
pub mod certificate;
pub mod comm;
pub mod condense;
pub mod contact;
pub mod context;
pub mod error;
pub mod fem;
pub mod interface;
pub mod output;
pub mod plan;
pub mod read;
pub mod recover;
pub mod report;
pub mod rigid;
pub mod run;
pub mod schur;
pub mod settings;
pub mod step;
pub mod sweep;
pub mod tree;
pub mod vector;
