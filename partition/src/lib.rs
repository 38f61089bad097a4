//! From a scene to a problem file: everything that happens before the first MPI rank starts.
//!
//! Data flows one way:
//!
//! ```text
//! scene.toml ─ scene ─┐
//!                     ├─ model ─ decompose ─ problem ─▶ problem.h5
//! mesh.msh  ── mesh ──┘
//! ```
//!
//! [`scene`] is what a user writes, [`mesh`] what a mesher writes, [`model`] what the scene means
//! on its mesh (materials, supports, nodal forces, contact conditions `B u ≤ g`), [`decompose`]
//! splits it into subdomains so that Γ never meets Γ_c, and [`problem`] is the one definition of
//! the problem file, for its writer here and for its reader in `contact-dd-mpi`.

pub mod command_line;
pub mod decompose;
pub mod destination;
pub mod element;
pub mod error;
pub mod example;
pub mod file_kind;
mod lists;
pub mod magnitude;
pub mod manual;
pub mod mesh;
pub mod message;
pub mod model;
pub mod name;
pub mod problem;
pub mod scene;
pub mod solver;
pub mod source;
pub mod usage;
