//! `*ELASTIC`: the stiffness of a material, in its local axes and in those of the scene.

use nalgebra::{Matrix3, Matrix6};

use super::axes::{Axes, numbers};
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Source};
use crate::name;
use crate::scene::material::PlaneState;

/// Positions of the components 11, 22, 33, 12, 13, 23 in the scene's order xx, yy, zz, yz, xz, xy.
const PLACES: [usize; 6] = [0, 1, 2, 5, 4, 3];

/// The two indices of a component xx, yy, zz, yz, xz, xy.
const INDICES: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [1, 2], [0, 2], [0, 1]];

/// An elastic law.
#[derive(Clone, PartialEq)]
pub(super) enum Elastic {
    /// Young's modulus and Poisson's ratio.
    Isotropic(f64, f64),
    /// The matrix from strains xx, yy, zz, yz, xz, xy to stresses, with engineering shear strains.
    Anisotropic(Box<Matrix6<f64>>),
}

impl Elastic {
    /// The law of an `*ELASTIC`.
    pub(super) fn read(source: &Source, block: &Block) -> Result<Self, InputError> {
        let kind = block.parameter("TYPE").unwrap_or("ISO").to_uppercase();
        let (count, lines) = match kind.as_str() {
            "ISO" | "ISOTROPIC" => (2, 1),
            "ORTHO" | "ORTHOTROPIC" | "ENGINEERING CONSTANTS" | "ENGINEERINGCONSTANTS" => (9, 2),
            "ANISO" | "ANISOTROPIC" => (21, 3),
            _ => {
                let kind = name::shown(&kind);
                let message = format!(
                    "*ELASTIC of TYPE={kind} isn't read; expected ISO, ENGINEERING CONSTANTS, ORTHO or ANISO"
                );
                return Err(source.error(block.place, message));
            }
        };
        let mut laws = Vec::new();
        for rows in block.data.chunks(lines) {
            let mut all = Vec::new();
            for data in rows {
                all.extend(numbers(source, data, "a modulus")?);
            }
            all.truncate(count);
            if all.len() < count {
                let message = format!(
                    "{} numbers; expected {count} of *ELASTIC, TYPE={kind}",
                    all.len()
                );
                return Err(source.error(rows[0].place, message));
            }
            let law = law(&kind, &all).map_err(|reason| source.error(rows[0].place, reason))?;
            if laws.first().is_some_and(|first| *first != law) {
                let message = "stiffness depends on temperature; expected one that doesn't: that of the mean temperature";
                return Err(source.error(rows[0].place, message));
            }
            laws.push(law);
        }
        let missing = || {
            source.error(
                block.place,
                "*ELASTIC has no numbers; expected a line of them",
            )
        };
        laws.into_iter().next().ok_or_else(missing)
    }

    /// The law in the scene's axes, for a material with these local axes.
    pub(super) fn along(&self, axes: &Axes) -> Self {
        let Self::Anisotropic(own) = self else {
            return self.clone();
        };
        // σ = T σ', and the strain energy is invariant: C = T C' Tᵀ.
        let turn = Matrix6::from_fn(|row, column| {
            let ([i, j], [p, q]) = (INDICES[row], INDICES[column]);
            let product = axes[p][i] * axes[q][j];
            match p == q {
                true => product,
                false => product + axes[q][i] * axes[p][j],
            }
        });
        Self::Anisotropic(Box::new(turn * **own * turn.transpose()))
    }

    /// The keys of a material of the scene.
    pub(super) fn keys(&self, plane: Option<PlaneState>) -> Vec<(&'static str, String)> {
        let own = match self {
            Self::Isotropic(young, poisson) => {
                return vec![
                    ("young", format!("{young:?}")),
                    ("poisson", format!("{poisson:?}")),
                ];
            }
            Self::Anisotropic(own) => own,
        };
        let rows = |places: &[usize], value: &dyn Fn(usize, usize) -> f64| {
            let rows = places.iter().map(|&i| {
                let row: Vec<f64> = places.iter().map(|&j| value(i, j)).collect();
                format!("{row:?}")
            });
            format!("[{}]", rows.collect::<Vec<_>>().join(", "))
        };
        let plain = |i: usize, j: usize| own[(i, j)];
        match plane {
            None => vec![("stiffness", rows(&[0, 1, 2, 3, 4, 5], &plain))],
            Some(PlaneState::Axisymmetric) => vec![("stiffness", rows(&[0, 1, 2, 5], &plain))],
            Some(PlaneState::Strain) => vec![
                ("stiffness", rows(&[0, 1, 5], &plain)),
                (
                    "out_of_plane",
                    format!("{:?}", [0, 1, 5].map(|j| own[(2, j)])),
                ),
            ],
            Some(PlaneState::Stress) => {
                // In plane stress ε_zz follows from the in-plane strains.
                let condensed =
                    |i: usize, j: usize| own[(i, j)] - own[(i, 2)] * own[(2, j)] / own[(2, 2)];
                vec![("stiffness", rows(&[0, 1, 5], &condensed))]
            }
        }
    }

    /// A modulus, from which the unit of stresses is guessed.
    pub(super) fn modulus(&self) -> f64 {
        match self {
            Self::Isotropic(young, _) => *young,
            Self::Anisotropic(own) => own.amax(),
        }
    }
}

/// The law of 2, 9 or 21 numbers; nine are engineering constants or, for an orthotropic `kind`, stiffnesses.
fn law(kind: &str, numbers: &[f64]) -> Result<Elastic, String> {
    let stiffness = match *numbers {
        [young, _] if young <= 0.0 => {
            return Err(format!(
                "*ELASTIC: Young's modulus is {young}; expected more than 0"
            ));
        }
        [_, poisson] if poisson <= -1.0 || poisson >= 0.5 => {
            return Err(format!(
                "*ELASTIC: Poisson's ratio is {poisson}; expected more than -1 and less than 0.5"
            ));
        }
        [young, poisson] => return Ok(Elastic::Isotropic(young, poisson)),
        [a, b, c, d, e, f, g, h, i] if kind.starts_with("ORTHO") => {
            let mut all = vec![a, b, c, d, e, f];
            // Rows and columns 12, 13, 23 have only diagonal entries.
            all.extend([
                0.0, 0.0, 0.0, g, 0.0, 0.0, 0.0, 0.0, h, 0.0, 0.0, 0.0, 0.0, 0.0, i,
            ]);
            upper(&all)
        }
        [e1, e2, e3, n12, n13, n23, g12, g13, g23] => {
            engineering([e1, e2, e3], [n12, n13, n23], [g12, g13, g23])?
        }
        _ => upper(numbers),
    };
    Ok(Elastic::Anisotropic(Box::new(stiffness)))
}

/// The stiffness from Young's moduli, Poisson's ratios ν_12, ν_13, ν_23 and shear moduli G_12, G_13, G_23.
fn engineering(young: [f64; 3], ratios: [f64; 3], shear: [f64; 3]) -> Result<Matrix6<f64>, String> {
    let [n12, n13, n23] = ratios;
    let mut compliance = Matrix3::from_diagonal(&young.map(|e| 1.0 / e).into());
    for (i, j, ratio) in [(0, 1, n12), (0, 2, n13), (1, 2, n23)] {
        compliance[(i, j)] = -ratio / young[i];
        compliance[(j, i)] = -ratio / young[i];
    }
    let normal = compliance
        .try_inverse()
        .ok_or("these moduli make no stiffness; expected positive ones")?;
    let mut stiffness = Matrix6::zeros();
    stiffness
        .fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&(0.5 * (normal + normal.transpose())));
    for (place, modulus) in PLACES[3..].iter().zip(shear) {
        stiffness[(*place, *place)] = modulus;
    }
    Ok(stiffness)
}

/// The stiffness whose upper triangle is given column by column, in the order 11, 22, 33, 12, 13, 23.
fn upper(numbers: &[f64]) -> Matrix6<f64> {
    let mut stiffness = Matrix6::zeros();
    let columns = (0..6).flat_map(|column| (0..=column).map(move |row| (row, column)));
    for ((row, column), &value) in columns.zip(numbers) {
        let (row, column) = (PLACES[row], PLACES[column]);
        stiffness[(row, column)] = value;
        stiffness[(column, row)] = value;
    }
    stiffness
}
