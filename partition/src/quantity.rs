//! Quantities of interest, and the parameters of their derivatives.

/// A quantity of interest.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Name.
    pub name: String,
    /// Kind.
    pub kind: QuantityKind,
    /// The unit vector of a force, or in space the axis of a moment; zero for the sum of the normal forces, and for
    /// other kinds.
    pub direction: [f64; 3],
    /// The reference point of a moment (m); zero for other kinds.
    pub point: [f64; 3],
    /// The smoothing length of a largest pressure (m); 0 for the pressure of a point. For the forces of a contact the
    /// area of the nodes that both of its sides share (m, in space m²).
    pub length: f64,
    /// The constant part in every load step, a single one without steps: the contribution of initial stress to an
    /// average stress.
    pub constants: Vec<f64>,
    /// The indices of its objects, by its kind.
    pub of: Vec<u32>,
    /// Tag of its node; −1 for quantities without a node.
    pub node: i64,
}

/// Kind of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuantityKind {
    /// Displacement of a node along a direction: its weights times displacements.
    Displacement,
    /// Average of a component of the stress over a body, of these materials: its weights times displacements, and the
    /// constant.
    MeanStress,
    /// Force of these supports or springs on the bodies.
    Reaction,
    /// Force on side a of a contact, or with zero direction the sum of its normal forces.
    ContactForce,
    /// The sum of the normal forces of a contact over the area of all its points.
    MeanPressure,
    /// The largest pressure of a contact, of a point or smoothed.
    LargestPressure,
    /// The remaining gap at a point of a contact: the indices of both.
    Opening,
    /// The elastic energy ½ uᵀ K u of all bodies.
    Energy,
    /// K_I of a crack tip.
    OpeningIntensity,
    /// K_II of a crack tip.
    SlidingIntensity,
    /// J of a crack tip.
    EnergyReleaseRate,
    /// Moment of the forces on side a of a contact about an axis.
    ContactMoment,
}

impl QuantityKind {
    /// All kinds, in the order of their numbers in the problem file.
    pub const ALL: [Self; 12] = [
        Self::Displacement,
        Self::MeanStress,
        Self::Reaction,
        Self::ContactForce,
        Self::MeanPressure,
        Self::LargestPressure,
        Self::Opening,
        Self::Energy,
        Self::OpeningIntensity,
        Self::SlidingIntensity,
        Self::EnergyReleaseRate,
        Self::ContactMoment,
    ];

    /// True of the forces of a contact, added up.
    pub fn adds_forces(self) -> bool {
        matches!(
            self,
            Self::ContactForce | Self::ContactMoment | Self::MeanPressure
        )
    }

    /// The word in scenes and reports.
    pub fn word(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::MeanStress => "mean_stress",
            Self::Reaction => "reaction",
            Self::ContactForce => "contact_force",
            Self::MeanPressure => "mean_pressure",
            Self::LargestPressure => "largest_pressure",
            Self::Opening => "opening",
            Self::Energy => "energy",
            Self::OpeningIntensity => "k_i",
            Self::SlidingIntensity => "k_ii",
            Self::EnergyReleaseRate => "energy_release_rate",
            Self::ContactMoment => "contact_moment",
        }
    }
}

/// A parameter of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name.
    pub name: String,
    /// Kind.
    pub kind: ParameterKind,
    /// The value; NaN if it varies in space.
    pub value: f64,
    /// The indices of its objects, by its kind.
    pub of: Vec<u32>,
}

/// Kind of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// The factor of a load, with the value 1.
    Load,
    /// The stiffness of these materials: Young's modulus, or a factor.
    Stiffness,
    /// Increment of the gap of a contact (m).
    Gap,
    /// Increment of the displacements prescribed by a boundary condition along an axis: the indices of both (m).
    Displacement,
    /// Coefficient of friction of a contact.
    Friction,
}

impl ParameterKind {
    /// All kinds, in the order of their numbers in the problem file.
    pub const ALL: [Self; 5] = [
        Self::Load,
        Self::Stiffness,
        Self::Gap,
        Self::Displacement,
        Self::Friction,
    ];

    /// The word in reports.
    pub fn word(self) -> &'static str {
        match self {
            Self::Load => "load",
            Self::Stiffness => "stiffness",
            Self::Gap => "gap",
            Self::Displacement => "displacement",
            Self::Friction => "friction",
        }
    }
}

/// Contributions of nodes to quantities and loads: nodes of the mesh, or of a subdomain, whose contributions add up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodalShares {
    /// Weights of displacements in quantities.
    pub weights: Vec<NodeWeight>,
    /// Nodal forces of loads.
    pub forces: Vec<LoadForce>,
}

/// The weight of a node's displacement in a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeWeight {
    /// Number of the quantity.
    pub quantity: u32,
    /// Node.
    pub node: u32,
    /// A coefficient for each component.
    pub value: [f64; 3],
}

/// The nodal force of a load that is a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadForce {
    /// Number of the parameter.
    pub parameter: u32,
    /// Node.
    pub node: u32,
    /// The force in every load step, a single one without steps (N per metre of thickness).
    pub forces: Vec<[f64; 3]>,
}

/// Quantities, parameters, and the contributions of nodes of the mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Goals {
    /// Quantities.
    pub quantities: Vec<Quantity>,
    /// Parameters; none without quantities.
    pub parameters: Vec<Parameter>,
    /// The contributions of nodes.
    pub shares: NodalShares,
}
