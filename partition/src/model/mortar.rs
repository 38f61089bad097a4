//! Mortar contact between non-matching meshes: segment-to-segment, in space with polygons as segments, with dual
//! Lagrange multipliers (Wohlmuth 2000; Popp, Gitterle, Gee and Wall 2010).
//!
//! Side a, the slave side, carries the multipliers; side b is the master side. The averaged normals of side a,
//! interpolated along its facets, project each of its points onto side b. With the dual basis φ on the covered part, ∫
//! φ_j N_k = δ_jk ∫ N_k, the constraint of node j is
//!
//! ```text
//! n_j·(u_a(j) − Σ_k M_jk/D_jj u_b(k)) ≤ g_j,   D_jj = ∫ φ_j,   M_jk = ∫ φ_j N_k^b,   g_j = ∫ φ_j g / D_jj
//! ```
//!
//! so that its multiplier is the normal force on node j. All integrals extend over the part of side a that side b
//! covers (Cichosz and Bischoff 2011), so that a uniform pressure is transferred exactly for any meshes and ends of
//! sides. On a partly covered facet N_k are the shape functions of the covered part: φ_j changes its sign, and the dual
//! functions of the whole facet would apply forces beyond the covered part.

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
pub(super) use self::rows::bounded;
