//! Materials as a scene gives them.

use nalgebra::Matrix3;
use serde::Deserialize;

use super::number::Constant;
use crate::magnitude::SMALLEST_STIFFNESS;

/// How a material answers to strain.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "MaterialKeys")]
pub enum Elasticity {
    /// The same in all directions.
    Isotropic {
        /// Young's modulus (Pa).
        young: f64,
        /// Poisson's ratio.
        poisson: f64,
    },
    /// Any stiffness in the plane.
    Anisotropic {
        /// C: (ε_xx, ε_yy, γ_xy) to (σ_xx, σ_yy, σ_xy), symmetric positive definite (Pa).
        stiffness: [[f64; 3]; 3],
        /// (ε_xx, ε_yy, γ_xy) to σ_zz in plane strain (Pa).
        out_of_plane: Option<[f64; 3]>,
    },
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of young and poisson, or of stiffness"
)]
struct MaterialKeys {
    young: Option<Young>,
    poisson: Option<Poisson>,
    stiffness: Option<Stiffness>,
    out_of_plane: Option<[Constant; 3]>,
}

impl TryFrom<MaterialKeys> for Elasticity {
    type Error = &'static str;

    fn try_from(keys: MaterialKeys) -> Result<Self, Self::Error> {
        match (keys.young, keys.poisson, keys.stiffness) {
            (Some(young), Some(poisson), None) => {
                if keys.out_of_plane.is_some() {
                    return Err("'out_of_plane' belongs to 'stiffness'; \
                                it follows from 'young' and 'poisson'");
                }
                Ok(Self::Isotropic {
                    young: young.0,
                    poisson: poisson.0,
                })
            }
            (None, None, Some(stiffness)) => Ok(Self::Anisotropic {
                stiffness: stiffness.0,
                out_of_plane: keys.out_of_plane.map(|row| row.map(|c| c.0)),
            }),
            (Some(_), None, None) => Err("the key 'poisson' is missing"),
            (None, Some(_), None) => Err("the key 'young' is missing"),
            (None, None, None) => {
                Err("keys are missing: a material has 'young' and 'poisson', or 'stiffness'")
            }
            _ => Err("a material has either 'young' and 'poisson', or 'stiffness'"),
        }
    }
}

#[derive(Deserialize)]
#[serde(try_from = "Constant")]
struct Young(f64);

impl TryFrom<Constant> for Young {
    type Error = String;

    fn try_from(Constant(value): Constant) -> Result<Self, String> {
        if value >= SMALLEST_STIFFNESS {
            Ok(Self(value))
        } else {
            Err(format!(
                "Young's modulus is {value}; expected more than 0 (at least {SMALLEST_STIFFNESS:e})"
            ))
        }
    }
}

#[derive(Deserialize)]
#[serde(try_from = "Constant")]
struct Poisson(f64);

impl TryFrom<Constant> for Poisson {
    type Error = String;

    fn try_from(Constant(value): Constant) -> Result<Self, String> {
        if -1.0 < value && value < 0.5 {
            Ok(Self(value))
        } else {
            Err(format!(
                "Poisson's ratio is {value}; expected more than -1 and less than 0.5"
            ))
        }
    }
}

#[derive(Deserialize)]
#[serde(try_from = "[[Constant; 3]; 3]")]
struct Stiffness([[f64; 3]; 3]);

impl TryFrom<[[Constant; 3]; 3]> for Stiffness {
    type Error = String;

    fn try_from(rows: [[Constant; 3]; 3]) -> Result<Self, String> {
        let given = Matrix3::from(rows.map(|row| row.map(|c| c.0))).transpose();
        let slack = 1e-9 * given.amax();
        for i in 0..3 {
            for j in 0..i {
                if (given[(i, j)] - given[(j, i)]).abs() > slack {
                    return Err(format!(
                        "the stiffness isn't symmetric: row {}, column {} is {}, its mirror image is {}",
                        i + 1,
                        j + 1,
                        given[(i, j)],
                        given[(j, i)]
                    ));
                }
            }
        }
        let symmetric = 0.5 * (given + given.transpose());
        // Scaled first, so that no product under- or overflows.
        let scale = symmetric.amax();
        let eigenvalues = (symmetric / scale).symmetric_eigenvalues() * scale;
        let (least, largest) = (eigenvalues.min(), eigenvalues.max());
        if least > 1e-15 * largest && scale >= SMALLEST_STIFFNESS {
            Ok(Self(symmetric.into()))
        } else {
            Err(format!(
                "the stiffness isn't positive definite: its eigenvalues reach from {least:.3e} to {largest:.3e}"
            ))
        }
    }
}
