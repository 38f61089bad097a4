//! The parts of a model: materials, supports and contacts.

use crate::contact_point::{ContactPoint, Probe};
use crate::stiffness::Stiffness;

/// A linear elastic material, σ = C ε in Voigt's order (xx, yy, xy in the plane; xx, yy, zz, xy around an axis; xx, yy,
/// zz, yz, xz, xy in space).
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the scene.
    pub name: String,
    /// C, symmetric positive definite, for the scene's plane state (Pa).
    pub stiffness: Stiffness,
    /// Row of σ_zz for (ε_xx, ε_yy, γ_xy) (Pa); `None` where the user didn't give it, around an axis and in space.
    pub out_of_plane: Option<[f64; 3]>,
    /// Poisson's ratio of an isotropic material.
    pub poisson: Option<f64>,
    /// The integration of its cells' stiffness.
    pub formulation: Formulation,
}

/// The integration of the stiffness of cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Formulation {
    /// Full integration.
    #[default]
    Full,
    /// 4-node quadrilaterals and 8-node hexahedra with incompatible modes, which represent bending.
    IncompatibleModes,
    /// 8-node quadrilaterals and 20-node hexahedra, integrated at two points in each direction.
    Reduced,
}

impl Formulation {
    /// The formulation in plain words, as a suffix to the name of a material.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Full => "",
            Self::IncompatibleModes => " with incompatible modes",
            Self::Reduced => " with reduced integration",
        }
    }
}

/// One support row: u(node)·direction = value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support {
    /// Node.
    pub node: u32,
    /// Unit vector. The rows of one node are orthonormal.
    pub direction: [f64; 3],
    /// Prescribed displacement along it (m).
    pub value: f64,
    /// Index in [`Model::support_names`](super::Model::support_names) of the boundary condition that prescribes it: of
    /// several the first.
    pub condition: u32,
}

/// A contact of the scene with its points.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Name in the scene.
    pub name: String,
    /// Points over the nodes of the mesh, along the side whose nodes carry them.
    pub points: Vec<ContactPoint<u32>>,
    /// Points at which the side without constraints is checked for penetration; none for matching nodes.
    pub probes: Vec<Probe<u32>>,
    /// Points without constraints, as supports prescribe their normal jumps.
    pub prescribed: Vec<ContactPoint<u32>>,
}
