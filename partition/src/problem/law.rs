//! Laws of friction in the datasets `law`, `friction` and `shear_bound` of `/contact`.

use crate::contact_point::Law;

/// A row of these datasets.
pub(super) struct LawRow {
    /// 0 without friction, 1 Tresca friction, 2 Coulomb friction, 3 a tie.
    pub law: i64,
    /// Coefficient of friction.
    pub friction: f64,
    /// Tresca bound or cohesion (Pa).
    pub shear_bound: f64,
}

impl From<Law> for LawRow {
    fn from(law: Law) -> Self {
        let (law, friction, shear_bound) = match law {
            Law::Frictionless => (0, 0.0, 0.0),
            Law::Given { bound } => (1, 0.0, bound),
            Law::Coulomb {
                coefficient,
                cohesion,
            } => (2, coefficient, cohesion),
            Law::Tied => (3, 0.0, 0.0),
        };
        Self {
            law,
            friction,
            shear_bound,
        }
    }
}

impl LawRow {
    /// The law of a row whose single values are valid.
    ///
    /// # Errors
    /// A value that contradicts the law: the dataset, and the expectation.
    pub fn law(&self) -> Result<Law, (&'static str, String)> {
        let &Self {
            law,
            friction,
            shear_bound,
        } = self;
        let zero = |dataset, value: f64| match value == 0.0 {
            true => Ok(()),
            false => Err((
                dataset,
                format!("{value} at a point of law {law}; expected 0"),
            )),
        };
        match law {
            0 | 3 => {
                zero("/contact/friction", friction)?;
                zero("/contact/shear_bound", shear_bound)?;
                Ok(match law {
                    0 => Law::Frictionless,
                    _ => Law::Tied,
                })
            }
            1 => {
                zero("/contact/friction", friction)?;
                Ok(Law::given(shear_bound))
            }
            _ => Ok(Law::coulomb(friction, shear_bound)),
        }
    }
}
