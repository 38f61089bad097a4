//! Plane strain and plane stress.

/// Which plane state a two-dimensional scene is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PlaneState {
    /// ε_zz = 0.
    Strain,
    /// σ_zz = 0.
    Stress,
}

impl PlaneState {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Strain, Self::Stress];

    /// Its name in scenes and problem files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Strain => "strain",
            Self::Stress => "stress",
        }
    }
}
