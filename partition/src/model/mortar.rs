//! Conditions between sides whose nodes don't match: segment-to-segment contact, in space with polygons for
//! segments, with dual Lagrange multipliers (Wohlmuth 2000; Popp, Gitterle, Gee and Wall 2010).
//!
//! Side a carries the multipliers. Its averaged normals, interpolated along its facets, say what of
//! side b lies opposite each of its points. With the dual basis φ on what is covered, ∫ φ_j N_k =
//! δ_jk ∫ N_k, the condition of node j is
//!
//! ```text
//! n_j·(u_a(j) − Σ_k M_jk/D_jj u_b(k)) ≤ g_j,   D_jj = ∫ φ_j,   M_jk = ∫ φ_j N_k^b,   g_j = ∫ φ_j g / D_jj
//! ```
//!
//! so that its multiplier is the normal force on node j. All integrals go over the part of side a
//! that side b covers (Cichosz and Bischoff 2011), so that a uniform pressure passes whatever the
//! meshes and wherever the sides end. On a facet that is covered in part N_k are the shape functions of that part alone:
//! φ_j changes its sign, and the dual functions of the whole facet would have forces act beyond what is covered.

mod bases;
mod carried;
mod chart;
mod cover;
mod covered;
mod dual;
mod extent;
mod field;
mod foot;
mod map;
mod pairing;
mod polygons;
mod probes;
mod root;
mod rows;
mod segments;
#[cfg(test)]
mod tests;
mod weights;

pub(super) use self::foot::foot_on;
pub(super) use self::pairing::{Mortar, pair};
pub(super) use self::probes::opposite;
