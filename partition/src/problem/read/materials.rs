//! The materials.

use crate::error::InputError;
use crate::magnitude::{LARGEST, SMALLEST_STIFFNESS};
use crate::model::Material;
use crate::problem::SYMMETRY_TOLERANCE;
use crate::problem::dataset::Dataset;

/// Reads and checks all materials.
pub(super) fn read(file: &hdf5::File) -> Result<Vec<Material>, InputError> {
    let names = Dataset::column(file, "/materials/name", None)?.names()?;
    let count = names.len();
    let dataset = Dataset::open(file, "/materials/stiffness")?.shaped(Some(count), &[3, 3])?;
    let stiffness = dataset.floats(0..count)?;
    let optional = |name, width: &[usize]| match file.link_exists(name) {
        true => Dataset::open(file, name)?
            .shaped(Some(count), width)?
            .any_floats(0..count),
        false => Ok(vec![f64::NAN; count * width.iter().product::<usize>()]),
    };
    let out_of_plane = optional("/materials/out_of_plane", &[3])?;
    let poisson = optional("/materials/poisson", &[])?;
    names
        .into_iter()
        .enumerate()
        .map(|(m, name)| {
            let c = &stiffness[9 * m..9 * m + 9];
            let stiffness = [0, 3, 6].map(|at| [c[at], c[at + 1], c[at + 2]]);
            if !is_elastic(&stiffness) {
                return Err(dataset.row_error(
                    m,
                    &format!("the stiffness of \"{name}\" isn't symmetric positive definite"),
                ));
            }
            let row = &out_of_plane[3 * m..3 * m + 3];
            let out_of_plane = match row.iter().filter(|x| x.abs() <= LARGEST).count() {
                3 => Some([row[0], row[1], row[2]]),
                0 if row.iter().all(|x| x.is_nan()) => None,
                _ => {
                    return Err(InputError::new(format!(
                        "dataset /materials/out_of_plane, row {m}: expected three numbers of at most {LARGEST:e} in size, or NaN three times where they aren't known"
                    )));
                }
            };
            let poisson = match poisson[m] {
                x if x.is_nan() => None,
                x if -1.0 < x && x < 0.5 => Some(x),
                x => {
                    return Err(InputError::new(format!(
                        "dataset /materials/poisson, row {m}: {x}; expected a number above -1 and below 0.5, or NaN where it isn't known"
                    )));
                }
            };
            Ok(Material {
                name,
                stiffness,
                out_of_plane,
                poisson,
            })
        })
        .collect()
}

/// Whether a stiffness is symmetric positive definite.
fn is_elastic(stiffness: &[[f64; 3]; 3]) -> bool {
    let c = nalgebra::Matrix3::from_fn(|i, j| stiffness[i][j]);
    let symmetric = (c - c.transpose()).amax() <= SYMMETRY_TOLERANCE * c.amax();
    // Scaled first, so that no product under- or overflows.
    let scaled = c / c.amax();
    symmetric && c.amax() >= SMALLEST_STIFFNESS && nalgebra::Cholesky::new(scaled).is_some()
}
