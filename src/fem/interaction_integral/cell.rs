//! Nodes, cells and quadrature points of a crack tip's disc, in the frame of the tip.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::element::quadrature::TabulatedPoint;
use nalgebra::Vector3;

use crate::fem::gradients::{MAX_PLANE_NODES, PointGradients};
use crate::fem::near_field::Gradient;

/// Radii of the evaluated discs, over that of the tip; the exact integral doesn't depend on the radius.
pub(super) const RADII: [f64; 3] = [1.0, 0.75, 0.5];
/// Degree of the quadrature of near fields.
pub(super) const DEGREE: usize = 6;
/// Size of a cell over its distance from the tip up to which a lower degree integrates near fields to 2e-6, and that
/// degree for linear and for other displacements.
const FAR: [(f64, [usize; 2]); 2] = [(0.04, [2, 4]), (0.12, [4, 5])];

/// W for both modes.
pub(super) type Work = [[f64; 2]; 2];

/// A node in the frame of the tip: its position (m), and q and W for every radius.
pub(super) struct LocalNode {
    pub place: [f64; 2],
    pub q: [f64; RADII.len()],
    pub work: [Work; RADII.len()],
}

/// A cell in the frame of the tip.
pub(super) struct LocalCell<'n> {
    pub kind: ElementKind,
    /// True if it has incompatible modes.
    pub has_modes: bool,
    /// The numbers of its nodes in the block.
    pub numbers: Vec<usize>,
    pub nodes: Vec<&'n LocalNode>,
    pub points: Vec<[f64; 3]>,
    /// Initial stress at its nodes (Pa); empty where there is none.
    pub initial: Vec<Vector3<f64>>,
}

/// M of a cell: the coefficients of u, by nodes and then by incompatible modes, in the frame of the tip, and the
/// constant part.
#[derive(Default)]
pub(super) struct OfCell {
    pub slopes: Vec<[f64; 2]>,
    pub constant: f64,
}

impl LocalNode {
    /// True if it lies in the largest disc.
    pub fn is_near(&self) -> bool {
        self.q[0] > 0.0
    }
}

impl OfCell {
    /// Resets the integral to zero, for a cell with this number of nodes and modes.
    pub fn clear(&mut self, places: usize) {
        self.slopes.clear();
        self.slopes.resize(places, [0.0; 2]);
        self.constant = 0.0;
    }
}

impl LocalCell<'_> {
    /// True if the near fields don't contribute to its integrals over the first `radii` discs, because q is constant on
    /// the cell in each.
    pub fn is_flat(&self, radii: usize) -> bool {
        let is_flat = |pair: &[&LocalNode]| pair[0].q[..radii] == pair[1].q[..radii];
        self.initial.is_empty() && self.nodes.windows(2).all(is_flat)
    }

    /// Degree of the quadrature of near fields, which vary less over cells farther from the tip.
    pub fn degree(&self) -> usize {
        let distance = |of: &[f64; 3]| of[0].hypot(of[1]);
        let nearest = self
            .points
            .iter()
            .map(distance)
            .fold(f64::INFINITY, f64::min);
        let size = (self.points.iter())
            .map(|of| (of[0] - self.points[0][0]).hypot(of[1] - self.points[0][1]))
            .fold(0.0, f64::max);
        let is_linear = self.nodes.len() == 3;
        let far = FAR.iter().find(|(ratio, _)| size <= ratio * nearest);
        far.map_or(
            DEGREE,
            |(_, [linear, other])| if is_linear { *linear } else { *other },
        )
    }
}

/// A quadrature point of a cell.
pub(super) struct LocalPoint {
    pub at: PointGradients<2, 3, MAX_PLANE_NODES>,
    /// σ⁰ (Pa), (xx, yy, xy).
    pub initial: Vector3<f64>,
    /// σ⁰,₁ (Pa/m).
    pub initial_slope: Vector3<f64>,
}

impl LocalPoint {
    pub fn new(cell: &LocalCell<'_>, reference: &TabulatedPoint) -> Self {
        let mut at = PointGradients::new(reference, &cell.points);
        if cell.has_modes {
            at = at.with_modes(reference, &cell.points);
        }
        let (mut initial, mut initial_slope) = (Vector3::zeros(), Vector3::zeros());
        for ((stress, n), g) in cell.initial.iter().zip(&reference.shape).zip(&at.gradients) {
            initial += *n * stress;
            initial_slope += g[0] * stress;
        }
        Self {
            at,
            initial,
            initial_slope,
        }
    }

    /// Adds `multiple` times the linear form Σ factor_ij u_i,j at the point.
    pub fn add(&self, multiple: f64, factor: &Gradient, found: &mut OfCell) {
        let weight = multiple * self.at.weight;
        for (slope, g) in found.slopes.iter_mut().zip(&self.at.gradients) {
            for (slope, row) in slope.iter_mut().zip(factor) {
                *slope += weight * (row[0] * g[0] + row[1] * g[1]);
            }
        }
    }
}
