//! The part of a facet of side a covered by side b, piece by piece, and the integrals over it.

use nalgebra::{DMatrix, DVector};

use super::super::ray_search::{FACING, Target};
use super::super::surface::Surface;
use super::bases::lift;
use super::extent::Extent;
use super::map::Map;
use crate::element::ElementKind::Triangle3;
use crate::element::geometry::dot;
use crate::element::quadrature::Quadrature;

/// Degree added to that of the shape functions' products for flat facets whose maps aren't affine: with it, facets with
/// nodes moved by a fifth of their size have errors of 1e-12.
pub(super) const EXTRA_DEGREE: usize = 6;

/// The highest degree: that of quadrilaterals of 9 nodes.
const MOST_DEGREE: usize = 8 + EXTRA_DEGREE;

/// A quadrature point of a segment.
pub(super) struct Sample {
    /// Quadrature weight times the measure (m).
    pub weight: f64,
    /// Shape functions of the facet of side a.
    pub shape: Vec<f64>,
    /// Facet of side b opposite.
    pub opposite: usize,
    /// Its shape functions at the projected point.
    pub opposite_shape: Vec<f64>,
    /// The gap along the averaged normal (m).
    pub gap: f64,
}

/// The overlap of a facet of side a with one of side b: integrals that determine those with any weight ψ = Σ c_i N_i.
pub(super) struct Overlap {
    /// Facet of side b.
    pub opposite: usize,
    /// ∫ N_i N_k, of side a and side b (m²).
    pub products: DMatrix<f64>,
    /// ∫ N_i g (m³).
    pub gaps: Vec<f64>,
}

/// The pieces of the covered part: all quadrature points in the plane, where they are few; integrals only in space,
/// where polygons have too many.
pub(super) enum Pieces {
    /// Quadrature points, segment by segment along the facet.
    Samples(Vec<Sample>),
    /// Overlaps, one for each facet of side b.
    Overlaps(Vec<Overlap>),
}

/// The part of a facet of side a that side b covers.
pub(super) struct Cover {
    /// Measure (m, in space m²).
    pub measure: f64,
    /// ∫ N_i (m, in space m²).
    pub integrals: Vec<f64>,
    /// ∫ N_i N_k (m, in space m²).
    pub mass: DMatrix<f64>,
    /// ∫ g (m², in space m³).
    pub gap: f64,
    /// The extent of the covered part on the facet.
    pub extent: Extent,
    /// The smallest gap, including ends and corners of pieces (m).
    pub least_gap: f64,
    /// The pieces.
    pub pieces: Pieces,
}

impl Cover {
    /// An empty cover of a facet of `nodes` nodes.
    pub fn new(nodes: usize) -> Self {
        Self {
            measure: 0.0,
            integrals: vec![0.0; nodes],
            mass: DMatrix::zeros(nodes, nodes),
            gap: 0.0,
            extent: Extent::new(),
            least_gap: f64::INFINITY,
            pieces: Pieces::Overlaps(Vec::new()),
        }
    }

    /// Adds a quadrature point with its weight, the shape functions `shape` of side a and the gap `gap` (m).
    pub fn add(&mut self, weight: f64, shape: &[f64], gap: f64) {
        self.measure += weight;
        self.gap += weight * gap;
        for (i, &n) in shape.iter().enumerate() {
            self.integrals[i] += weight * n;
            for (k, &m) in shape.iter().enumerate() {
                self.mass[(i, k)] += weight * n * m;
            }
        }
    }

    /// The integrals of other functions, given as rows of coefficients of the shape functions; without pieces.
    pub fn of_functions(&self, functions: &DMatrix<f64>) -> Self {
        let mut cover = Self::new(functions.nrows());
        match &self.pieces {
            // Differences of the shape functions' integrals would cancel where the part is small.
            Pieces::Samples(samples) => {
                for sample in samples {
                    let shape = functions * DVector::from_column_slice(&sample.shape);
                    cover.add(sample.weight, shape.as_slice(), sample.gap);
                }
            }
            Pieces::Overlaps(_) => {
                cover.measure = self.measure;
                cover.gap = self.gap;
                cover.integrals = lift(functions, &self.integrals);
                cover.mass = functions * &self.mass * functions.transpose();
            }
        }
        cover
    }

    /// True if nothing is covered.
    pub fn is_empty(&self) -> bool {
        match &self.pieces {
            Pieces::Samples(samples) => samples.is_empty(),
            Pieces::Overlaps(overlaps) => overlaps.is_empty(),
        }
    }
}

/// Side b, prepared for the search from side a.
pub(super) struct Opposite<'a> {
    pub surface: &'a Surface,
    /// x(η) of its facets; none in the plane.
    pub maps: Vec<Map>,
    /// Quadrature rules on triangles by their degree.
    pub rules: Vec<Quadrature>,
    pub target: Target<'a>,
    /// Largest overlap (m).
    pub behind: f64,
}

impl<'a> Opposite<'a> {
    /// Prepares side b for the search; `behind` is the largest overlap (m).
    pub fn new(surface: &'a Surface, behind: f64) -> Self {
        let in_space = surface.facets.iter().filter(|facet| facet.kind.dim() > 1);
        Self {
            surface,
            maps: in_space
                .map(|facet| Map::new(facet.kind, &facet.at))
                .collect(),
            rules: (0..=MOST_DEGREE)
                .map(|degree| Triangle3.quadrature(degree))
                .collect(),
            target: Target::new(surface),
            behind,
        }
    }

    /// True if a facet of side b faces a line along `normal`.
    pub fn faces(&self, facet: usize, normal: [f64; 3]) -> bool {
        dot(self.surface.facets[facet].normal, normal) <= -FACING
    }
}
