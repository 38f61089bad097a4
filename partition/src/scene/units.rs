//! The units of a scene's numbers, for messages and pictures.

/// The unit of length. Nothing is converted: it only determines the units printed with numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
pub enum Units {
    /// m, N and Pa.
    #[default]
    #[serde(rename = "m")]
    Metre,
    /// mm, N and MPa.
    #[serde(rename = "mm")]
    Millimetre,
}

impl Units {
    /// All units.
    pub const ALL: [Self; 2] = [Self::Metre, Self::Millimetre];

    /// The unit of lengths, which is its name in scenes and files.
    pub fn length(self) -> &'static str {
        self.pick("m", "mm")
    }

    /// The unit of forces, in the plane per thickness.
    pub fn force(self, dim: usize) -> &'static str {
        match dim {
            2 => self.pick("N/m", "N/mm"),
            _ => "N",
        }
    }

    /// The unit of moments, in the plane per thickness.
    pub fn moment(self, dim: usize) -> &'static str {
        match dim {
            2 => "N",
            _ => self.pick("N m", "N mm"),
        }
    }

    /// The unit of work, in the plane per thickness.
    pub fn work(self, dim: usize) -> &'static str {
        match dim {
            2 => self.pick("J/m", "mJ/mm"),
            _ => self.pick("J", "mJ"),
        }
    }

    /// The unit of forces per volume.
    pub fn body_force(self) -> &'static str {
        self.pick("N/m³", "N/mm³")
    }

    /// The unit of stresses.
    pub fn stress(self) -> &'static str {
        self.pick("Pa", "MPa")
    }

    fn pick(self, metre: &'static str, millimetre: &'static str) -> &'static str {
        match self {
            Self::Metre => metre,
            Self::Millimetre => millimetre,
        }
    }
}
