//! Parallel domain decomposition for unilateral contact in linear elasticity, after J. Daněk.
//!
//! Equation numbers are those of his *Use of MATLAB for domain decomposition method for contact problem
//! in elasticity*, symbols those of `docs/notation.md`.
//!
//! **The problem.** Elastic bodies press on each other. Discretized ([`fem`]), their displacement is
//!
//! > u = arg min ½ uᵀ K u − fᵀ u   subject to   B u ≤ g,   (1)-(3)
//!
//! a row of B for each [contact point](contact_dd_partition::contact_point), n·(u_a − u_b) ≤ g, of a contact
//! surface Γ_c. Motions that neither supports nor contact hold are found before anything is factorized
//! ([`rigid`]).
//!
//! **The split.** Bodies are cut into subdomains that are bonded on Γ, to which all nodes of Γ_c belong, too. T are
//! those without contact, ϑ the pairs [k, l] in contact. Every rank [owns](plan) some of them; what is left to
//! find is the trace U of the displacement on Γ.
//!
//! **Schur complements.** Without contact the interior is eliminated ([`schur::local`]),
//!
//! > S_i = K_ΓΓ − K_ΓI K_II⁻¹ K_IΓ,   i ∈ T;   (11)
//!
//! a pair has [normal jumps](contact::jumps) t = b·u in the place of displacements ([`schur::substitution`])
//! besides, and one common, nonlinear one ([`contact::pair`]),
//!
//! > S_kl(U) = S_ΓΓ U + S_Γt t(U) − f_Γ,   t(U) = arg min ½ tᵀ H t − (c − S_tΓ U)ᵀ t   over   t ≤ g.   (12)
//!
//! Both are [merged](schur::merge) up a tree of subdomains, the hierarchy of the problem file, for as long
//! as that is cheaper than to leave them to the root.
//!
//! **The interface problem.** With R̄_i from Γ to what subdomain i has of it, they add up to
//!
//! > S_0 U + S_CON(U) = F,   (14)
//! >
//! > S_0 = Σ_T R̄_iᵀ S_i R̄_i,   S_CON = Σ_ϑ R̄_klᵀ S_kl R̄_kl,   F = Σ_T R̄_iᵀ f_i,   (15)
//!
//! where the load of a pair stands in its S_kl. S_0 and F are the root's
//! ([`Interface`](interface::operator::Interface)), S_CON is evaluated by the ranks that own the pairs
//! ([`SCon`](interface::s_con::SCon)).
//!
//! **The start.** Contacts tied in the normal direction and free along it, t = 0, give the linear,
//! bilateral problem
//!
//! > n·(u_k − u_l) = 0 on Γ_c,   (S_0 + Σ_ϑ R̄_klᵀ S_ΓΓ R̄_kl) U^0 = F + Σ_ϑ R̄_klᵀ f_Γ,   (16)-(17)
//!
//! whose factor serves all that follows ([`bilateral_start`](interface::problem::InterfaceProblem::bilateral_start)).
//!
//! **The sweeps.** The paper's successive approximations,
//!
//! > S_0 U^k = F − S_CON(U^(k−1)),   (18)
//!
//! are [`picard`](sweep::picard). They converge for soft contact subdomains only;
//! [`newton`](sweep::newton) and [`anderson`](sweep::anderson) do for any ([`sweep`]).
//!
//! **The answer.** Back-substitution, the [`certificate`] of the full discrete problem, and the [`output`].
//!
//! [`run`] is all of it on one page. Only [`comm`] knows MPI; [`contact_dd_partition`] makes the
//! problem file.

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
