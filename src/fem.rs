//! Finite elements of a block: K and f of the energy ½ uᵀ K u − fᵀ u, its unknowns, its loads, its stresses.
//!
//! > uᵀ K u = a(u, u) = Σ ∫ c_ijkl e_ij(u) e_kl(u) dx,   (2)

pub mod assembly;
pub mod balance;
pub mod block;
pub mod body_frame;
pub mod contact_group;
pub mod contact_node;
pub mod contact_state;
pub mod dofs;
pub mod elasticity;
pub mod estimate;
pub mod frame;
pub mod gradients;
pub mod group_jumps;
pub mod interaction_integral;
pub mod load;
pub mod near_field;
pub mod patch;
pub mod polynomial;
pub mod prescribed;
pub mod quantity;
pub mod recovery;
pub mod resultants;
mod sites;
mod slip_directions;
pub mod springs;
pub mod strain;
pub mod stress;
pub mod stress_intensity;
pub mod tightened_bolt;
