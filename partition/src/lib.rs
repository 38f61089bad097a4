//! From a scene to a problem file: everything that happens before the first MPI rank starts.
//!
//! Data flow in one direction:
//!
//! ```text
//! scene.toml ─ scene ─┐
//!                     ├─ model ─ decompose ─ problem ─▶ problem.h5
//! mesh.msh  ── mesh ──┘
//! ```
//!
//! **The scene** is the user's input ([`scene`]), the **mesh** that of a mesher ([`mesh`]), with cells over which u(ξ)
//! = Σ N_i(ξ) u_i ([`element`]). [`example`] has some of both.
//!
//! **The model** is the scene on its mesh ([`model`]): bodies and their materials σ = C ε, the supports of Γ_u and Γ_o,
//! the nodal forces of Γ_τ, and for every contact of Γ_c
//!
//! > n·(u_a − u_b) ≤ g,   together   B u ≤ g,
//!
//! the set K over which (1) minimizes.
//!
//! Node pairs, dual mortar weights and rigid obstacles each produce such rows, and the later stages don't distinguish
//! them.
//!
//! **The partition** ([`decompose`]) cuts bodies into subdomains Ω^i that meet on
//!
//! > Γ = ∪ ∂Ω^i ∩ ∂Ω^j,   Γ ∩ Γ_c = ∅ except for the tips of cracks,
//!
//! by METIS on a graph whose vertices are the indivisible parts. Subdomains in contact are the pairs ϑ, the others T.
//! It also builds the [`hierarchy`] along which Schur complements are merged, rated by estimated [`flops`]. Only this
//! part, behind the feature `metis`, needs METIS.
//!
//! **The problem file** ([`problem`]) is defined once, for its writer here and for its reader in `contact-dd-mpi`. It
//! gets its name when it is complete ([`destination`]).

pub mod allocator;
pub mod command_line;
pub mod contact_point;
pub mod crack_tip;
pub mod deck;
#[cfg(feature = "metis")]
pub mod decompose;
pub mod destination;
pub mod disjoint_sets;
pub mod element;
pub mod error;
pub mod example;
pub mod explanation;
pub mod flops;
pub mod hierarchy;
pub mod id;
#[cfg(feature = "metis")]
pub mod info;
#[cfg_attr(
    not(feature = "metis"),
    allow(dead_code, reason = "the partitioner uses more of it than a reader")
)]
mod lists;
pub mod magnitude;
pub mod manual;
pub mod mesh;
pub mod message;
pub mod mismatch;
pub mod model;
pub mod name;
pub mod numbered;
pub mod problem;
pub mod quantity;
pub mod scene;
pub mod solver;
pub mod source;
pub mod stiffness;
