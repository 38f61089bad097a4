//! The functions on a facet to which multipliers are dual.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::super::blend::{Blending, of_corners};
use super::super::surface::SurfaceFacet;
use crate::element::ElementKind;

/// The kind of a facet, and its corner on the axis.
pub(super) type Kind = (ElementKind, Option<usize>);

/// Bases of functions on the facets of a kind, as rows of coefficients of the shape functions. The functions of each
/// basis sum to 1, and so do their duals.
pub(super) struct Bases {
    /// Bases from one function for each node down to one for each corner, which stay independent on a smaller part of
    /// the facet.
    pub levels: Vec<DMatrix<f64>>,
    /// ∫ of the nodes' functions over a whole facet, relative to its measure.
    pub shares: Vec<f64>,
}

impl Bases {
    /// The bases of every kind of facets.
    pub fn new<'a>(facets: impl Iterator<Item = &'a SurfaceFacet>) -> BTreeMap<Kind, Self> {
        let mut bases = BTreeMap::new();
        for facet in facets {
            let kind = Self::kind(facet);
            (bases.entry(kind)).or_insert_with(|| Self::of(kind));
        }
        bases
    }

    /// The key of a facet's bases.
    pub fn kind(facet: &SurfaceFacet) -> Kind {
        (facet.kind, facet.corner_on_axis())
    }

    fn of((kind, on_axis): Kind) -> Self {
        let nodes = kind.nodes();
        let each = Blending::new(kind, on_axis).positive();
        let mut integrals = vec![0.0; nodes];
        for (xi, weight) in kind.quadrature(4) {
            let values = kind.shape(xi);
            (integrals.iter_mut().zip(values)).for_each(|(sum, n)| *sum += weight * n);
        }
        let whole = kind.domain().measure();
        let shares = lift(&each, &integrals);
        let shares = shares.into_iter().map(|integral| integral / whole);
        let shares = shares.collect();
        let mut levels = vec![each];
        if kind.dim() > 1 && !kind.is_linear() {
            levels.push(of_corners(kind));
        }
        Self { levels, shares }
    }
}

/// The integrals of a basis from those of the shape functions.
pub(super) fn lift(basis: &DMatrix<f64>, integrals: &[f64]) -> Vec<f64> {
    let row = |i: usize| {
        integrals
            .iter()
            .enumerate()
            .map(move |(k, n)| basis[(i, k)] * n)
    };
    (0..basis.nrows()).map(|i| row(i).sum()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::ElementKind::{Line2, Line3, Quad4, Quad8, Quad9, Triangle3, Triangle6};

    #[test]
    fn functions_sum_to_one_and_have_positive_integrals() {
        for kind in [Line2, Line3, Triangle3, Triangle6, Quad4, Quad8, Quad9] {
            let bases = Bases::of((kind, None));
            assert!(bases.shares.iter().all(|&share| share > 0.02), "{kind:?}");
            assert!((bases.shares.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            for basis in &bases.levels {
                for column in basis.column_iter() {
                    assert!((column.sum() - 1.0).abs() < 1e-15, "{kind:?}");
                }
            }
        }
    }

    #[test]
    fn corners_of_quadratic_facets_have_the_functions_of_linear_ones() {
        for (kind, linear) in [(Triangle6, Triangle3), (Quad8, Quad4), (Quad9, Quad4)] {
            let bases = Bases::of((kind, None));
            for (xi, _) in kind.quadrature(3) {
                let found = lift(&bases.levels[1], &kind.shape(xi));
                for (found, expected) in found.iter().zip(linear.shape(xi)) {
                    assert!((found - expected).abs() < 1e-14, "{kind:?}");
                }
            }
        }
    }
}
