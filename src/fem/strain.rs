//! Large strains, for which the small-strain approximation fails.

use serde::{Deserialize, Serialize};

use super::elasticity::principal_stresses;
use super::gradients::Voigt;

/// Strain above which the small-strain approximation counts as invalid: terms of second order are a twentieth of it.
pub const LARGE: f64 = 0.05;

/// The largest mean strain of any of some cells, and the measure of those with large ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LargestStrain {
    /// max |ε_i| over its principal strains.
    pub size: f64,
    /// The middle of the cell (m).
    pub at: [f64; 3],
    /// The measure of the cells with strains above [`LARGE`] (m², m³).
    pub large: f64,
    /// The measure of all cells.
    pub whole: f64,
}

impl LargestStrain {
    /// Includes the `strain` of a cell, with this number of components, `measure`, and center `at`.
    pub fn include(
        &mut self,
        strain: &Voigt,
        components: usize,
        measure: f64,
        at: impl FnOnce() -> [f64; 3],
    ) {
        self.whole += measure;
        let tensor = tensor(strain, components);
        let squares: f64 = tensor.iter().map(|e| e * e).sum();
        let shear: f64 = tensor[3..].iter().map(|e| e * e).sum();
        // No principal strain exceeds the norm of the tensor.
        if squares + shear <= self.size.min(LARGE).powi(2) {
            return;
        }
        let size = (principal_stresses(&tensor).into_iter()).fold(0.0, |m: f64, e| m.max(e.abs()));
        if size > LARGE {
            self.large += measure;
        }
        if size > self.size {
            (self.size, self.at) = (size, at());
        }
    }

    /// Merges the data of other cells; returns true if the largest strain is theirs.
    pub fn add(&mut self, other: Self) -> bool {
        let is_larger = other.size > self.size;
        if is_larger {
            (self.size, self.at) = (other.size, other.at);
        }
        self.large += other.large;
        self.whole += other.whole;
        is_larger
    }
}

/// The strain tensor (XX, YY, ZZ, XY, YZ, XZ), with γ/2 in place of γ.
fn tensor(strain: &Voigt, components: usize) -> [f64; 6] {
    let [xx, yy, zz, yz, xz, xy] = *strain;
    match components {
        3 => [xx, yy, 0.0, 0.5 * zz, 0.0, 0.0],
        4 => [xx, yy, zz, 0.5 * yz, 0.0, 0.0],
        _ => [xx, yy, zz, 0.5 * xy, 0.5 * yz, 0.5 * xz],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_principal_strain_is_found_in_every_dimension() {
        let mut largest = LargestStrain::default();
        let mut is_now = |strain: Voigt, components, size: f64| {
            largest.include(&strain, components, 2.0, || [size, 0.0, 0.0]);
            assert!((largest.size - size).abs() < 1e-15, "{largest:?} {size}");
            assert_eq!(largest.at[0], size);
        };
        // A pure shear γ has principal strains ±γ/2; unused components don't count.
        is_now([0.0, 0.0, 0.2, 9.0, 9.0, 9.0], 3, 0.1);
        is_now([0.0, 0.0, 0.0, 0.4, 9.0, 9.0], 4, 0.2);
        is_now([0.0, 0.0, -0.25, 0.0, 0.0, 0.0], 4, 0.25);
        for (place, gamma) in [(3, 0.6), (4, 0.7), (5, 0.8)] {
            let mut strain = [0.0; 6];
            strain[place] = gamma;
            is_now(strain, 6, 0.5 * gamma);
        }
        is_now([0.04, 0.0, 0.0, 0.0, 0.0, 0.0], 6, 0.4);
        assert_eq!((largest.large, largest.whole), (12.0, 14.0));
    }
}
