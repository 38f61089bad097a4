//! Materials and the plane state in a scene.

use std::f64::consts::PI;

use nalgebra::DMatrix;
use serde::Deserialize;
use serde::de::{Deserializer, Error};

use super::number::Constant;
use super::place;
use crate::magnitude::SMALLEST_STIFFNESS;
use crate::stiffness::Stiffness;

/// Law of a material.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "MaterialKeys")]
pub enum Elasticity {
    /// An isotropic material.
    Isotropic {
        /// Young's modulus (Pa).
        young: f64,
        /// Poisson's ratio.
        poisson: f64,
    },
    /// A material with any stiffness.
    Anisotropic {
        /// C: (ε_xx, ε_yy, γ_xy) to (σ_xx, σ_yy, σ_xy), around an axis in the order xx, yy, zz, xy, in space xx, yy,
        /// zz, yz, xz, xy; symmetric positive definite (Pa).
        stiffness: Stiffness,
        /// (ε_xx, ε_yy, γ_xy) to σ_zz in plane strain (Pa).
        out_of_plane: Option<[f64; 3]>,
    },
}

/// Plane state of a two-dimensional scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PlaneState {
    /// ε_zz = 0.
    Strain,
    /// σ_zz = 0.
    Stress,
    /// Axial symmetry about the axis x = 0: x is the radius, zz the hoop direction.
    Axisymmetric,
}

impl PlaneState {
    /// All plane states.
    pub const ALL: [Self; 3] = [Self::Strain, Self::Stress, Self::Axisymmetric];

    /// Name in scenes and problem files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Strain => "strain",
            Self::Stress => "stress",
            Self::Axisymmetric => "axisymmetric",
        }
    }

    /// The number of components of a strain: xx, yy, xy, around an axis xx, yy, zz, xy; in space, which has no plane
    /// state, xx, yy, zz, yz, xz, xy.
    pub fn components(plane: Option<Self>) -> usize {
        match plane {
            Some(Self::Strain | Self::Stress) => 3,
            Some(Self::Axisymmetric) => 4,
            None => 6,
        }
    }

    /// Extent out of the plane per unit of length or area at `x`: one metre of thickness, or 2πx around the axis; 1 in
    /// space.
    pub fn thickness(plane: Option<Self>, x: [f64; 3]) -> f64 {
        match plane {
            Some(Self::Axisymmetric) => 2.0 * PI * x[0],
            _ => 1.0,
        }
    }
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of young and poisson, or of stiffness"
)]
struct MaterialKeys {
    #[serde(default, deserialize_with = "young")]
    young: Option<f64>,
    #[serde(default, deserialize_with = "poisson")]
    poisson: Option<f64>,
    #[serde(default, deserialize_with = "stiffness")]
    stiffness: Option<Stiffness>,
    #[serde(default, deserialize_with = "place::exactly")]
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
                Ok(Self::Isotropic { young, poisson })
            }
            (None, None, Some(stiffness)) => Ok(Self::Anisotropic {
                stiffness,
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

fn young<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    let expected = format!("more than 0 (at least {SMALLEST_STIFFNESS:e})");
    let holds = |value| value >= SMALLEST_STIFFNESS;
    Constant::checked(deserializer, holds, "Young's modulus", &expected).map(Some)
}

fn poisson<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    let expected = "more than -1 and less than 0.5";
    let holds = |value| -1.0 < value && value < 0.5;
    Constant::checked(deserializer, holds, "Poisson's ratio", expected).map(Some)
}

/// The symmetric part of a matrix, which has to be symmetric and positive definite.
fn stiffness<'de, D>(deserializer: D) -> Result<Option<Stiffness>, D::Error>
where
    D: Deserializer<'de>,
{
    let rows = Vec::<Vec<Constant>>::deserialize(deserializer)?;
    let size = rows.len();
    if !matches!(size, 3 | 4 | 6) || rows.iter().any(|row| row.len() != size) {
        return Err(D::Error::custom(
            "expected 3 rows of 3 numbers in the plane, 4 of 4 around an axis, or 6 of 6 in space",
        ));
    }
    let given = DMatrix::from_fn(size, size, |i, j| rows[i][j].0);
    let slack = 1e-9 * given.amax();
    for (i, j) in (0..size).flat_map(|i| (0..i).map(move |j| (i, j))) {
        let (below, above) = (given[(i, j)], given[(j, i)]);
        if (below - above).abs() > slack {
            return Err(D::Error::custom(format!(
                "the stiffness isn't symmetric: row {}, column {} is {below}, its mirror image is {above}",
                i + 1,
                j + 1
            )));
        }
    }
    let symmetric = 0.5 * (&given + given.transpose());
    // Scaled first, so that no product overflows or underflows.
    let scale = symmetric.amax();
    let eigenvalues = (&symmetric / scale).symmetric_eigenvalues() * scale;
    let (least, largest) = (eigenvalues.min(), eigenvalues.max());
    match least > 1e-15 * largest && scale >= SMALLEST_STIFFNESS {
        true => Ok(Some(Stiffness::new(size, symmetric.as_slice()))),
        false => Err(D::Error::custom(format!(
            "the stiffness isn't positive definite: its eigenvalues reach from {least:.3e} to {largest:.3e}"
        ))),
    }
}
