//! The materials.

use super::contents::Contents;
use super::slice::Slice;
use crate::error::InputError;
use crate::model::{Formulation, Material, PlaneState};
use crate::problem::schema::FORMULATIONS;
use crate::stiffness::Stiffness;

/// Reads and checks all materials.
pub(super) fn read(
    contents: &Contents,
    plane: Option<PlaneState>,
) -> Result<Vec<Material>, InputError> {
    let names = contents.strings("/materials/name")?;
    let rows = 0..names.len();
    let stiffnesses = contents.numbers("/materials/stiffness", rows.clone())?;
    let optional = |path: &str| {
        let found = contents
            .has(path)
            .then(|| contents.numbers(path, rows.clone()));
        found.transpose()
    };
    let planes = optional("/materials/out_of_plane")?;
    let ratios = optional("/materials/poisson")?;
    let mut formulations = vec![Formulation::Full; names.len()];
    for (formulation, path) in FORMULATIONS {
        let have = contents.integers(path, rows.clone())?;
        let of_materials = formulations.iter_mut().zip(have.all());
        (of_materials.filter(|(_, have)| **have == 1)).for_each(|(of, _)| *of = formulation);
    }
    names
        .into_iter()
        .enumerate()
        .map(|(m, name)| {
            let stiffness = Stiffness::new(PlaneState::components(plane), stiffnesses.of(m..m + 1));
            if !stiffness.is_elastic() {
                let what = format!("the stiffness of \"{name}\" isn't symmetric positive definite");
                return Err(stiffnesses.error(m, &what));
            }
            let out_of_plane = planes.as_ref().map(|planes| out_of_plane(planes, m));
            let poisson = ratios.as_ref().map(|ratios| poisson(ratios, m));
            Ok(Material {
                name,
                stiffness,
                out_of_plane: out_of_plane.transpose()?.flatten(),
                poisson: poisson.transpose()?.flatten(),
                formulation: formulations[m],
            })
        })
        .collect()
}

/// The row of C for σ_zz, if known.
fn out_of_plane(planes: &Slice<f64>, m: usize) -> Result<Option<[f64; 3]>, InputError> {
    match *planes.of(m..m + 1) {
        [x, y, z] if x.is_nan() && y.is_nan() && z.is_nan() => Ok(None),
        [x, y, z] if !(x.is_nan() || y.is_nan() || z.is_nan()) => Ok(Some([x, y, z])),
        _ => Err(planes.error(
            m,
            "expected numbers, or NaN for all where they aren't known",
        )),
    }
}

/// Poisson's ratio, if known.
fn poisson(ratios: &Slice<f64>, m: usize) -> Result<Option<f64>, InputError> {
    match ratios.of(m..m + 1)[0] {
        ratio if ratio.is_nan() => Ok(None),
        ratio if -1.0 < ratio && ratio < 0.5 => Ok(Some(ratio)),
        ratio => {
            let what = format!(
                "{ratio}; expected a number above -1 and below 0.5, or NaN where it isn't known"
            );
            Err(ratios.error(m, &what))
        }
    }
}
