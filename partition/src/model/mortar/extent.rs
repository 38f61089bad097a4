//! Extent of the covered part of a facet.

use nalgebra::DMatrix;

use super::map::Xi;
use crate::element::ElementKind;
use crate::element::definition::Domain;

/// Distance from the end of a reference facet that is round-off.
const ROUND_OFF: f64 = 1e-9;

/// The smallest extent: on a smaller part the functions are differences of shape functions that cancel.
const LEAST: f64 = 1e-2;

/// The smallest part of a reference facet, of the same shape, that contains the covered part: an interval, a rectangle
/// along the axes, or a triangle of the same angles.
pub(super) struct Extent {
    low: Xi,
    high: Xi,
    /// The largest ξ + η.
    sum: f64,
}

impl Extent {
    /// The extent of an empty cover.
    pub fn new() -> Self {
        Self {
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
            sum: f64::NEG_INFINITY,
        }
    }

    /// Enlarges the extent to include a point.
    pub fn include(&mut self, xi: Xi) {
        for (k, &x) in xi.iter().enumerate() {
            self.low[k] = self.low[k].min(x);
            self.high[k] = self.high[k].max(x);
        }
        self.sum = self.sum.max(xi[0] + xi[1]);
    }

    /// The shape functions of this part as a facet itself, N̂_i(ξ) = Σ_k T_ik N_k(ξ), as rows of T; `None` where the
    /// part is the whole facet.
    ///
    /// The shape functions of all kinds of facets span spaces that are invariant under translation and scaling along
    /// the axes, so that T_ik = N̂_i(ξ_k) at the nodes ξ_k.
    pub fn functions(&self, kind: ElementKind) -> Option<DMatrix<f64>> {
        let to_part = match kind.domain() {
            Domain::Triangle => self.in_triangle()?,
            domain => self.in_box(domain.dim())?,
        };
        let nodes = kind.node_coordinates();
        let columns: Vec<Vec<f64>> = (nodes.iter())
            .map(|&[s, t, _]| {
                let [s, t] = to_part([s, t]);
                kind.shape([s, t, 0.0])
            })
            .collect();
        Some(DMatrix::from_fn(nodes.len(), nodes.len(), |i, k| {
            columns[k][i]
        }))
    }

    /// The map of an interval or a rectangle onto the whole facet.
    fn in_box(&self, dim: usize) -> Option<Box<dyn Fn(Xi) -> Xi>> {
        let (mut low, mut high) = ([-1.0; 2], [1.0; 2]);
        for k in 0..dim {
            let missing = (2.0 * LEAST - (self.high[k] - self.low[k])).max(0.0);
            let ends = [self.low[k] - 0.5 * missing, self.high[k] + 0.5 * missing];
            low[k] = if ends[0] < -1.0 + ROUND_OFF {
                -1.0
            } else {
                ends[0]
            };
            high[k] = if ends[1] > 1.0 - ROUND_OFF {
                1.0
            } else {
                ends[1]
            };
        }
        if low == [-1.0; 2] && high == [1.0; 2] {
            return None;
        }
        Some(Box::new(move |xi| {
            [0, 1].map(|k| (2.0 * xi[k] - low[k] - high[k]) / (high[k] - low[k]))
        }))
    }

    /// The map of a triangle onto the whole facet.
    fn in_triangle(&self) -> Option<Box<dyn Fn(Xi) -> Xi>> {
        let missing = (LEAST - (self.sum - self.low[0] - self.low[1])).max(0.0) / 3.0;
        let at_end = |x: f64| if x < ROUND_OFF { 0.0 } else { x };
        let low = self.low.map(|x| at_end(x - missing));
        let size = 1.0 - at_end(1.0 - self.sum - missing) - low[0] - low[1];
        if low == [0.0; 2] && size == 1.0 {
            return None;
        }
        Some(Box::new(move |xi| [0, 1].map(|k| (xi[k] - low[k]) / size)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::ElementKind::{Line2, Line3, Quad4, Quad8, Quad9, Triangle3, Triangle6};

    #[test]
    fn its_functions_are_those_of_a_facet_that_is_the_part_alone() {
        let part = [[0.1, 0.2], [0.5, 0.2], [0.1, 0.6]];
        for kind in [Line2, Line3, Triangle3, Triangle6, Quad4, Quad8, Quad9] {
            let mut extent = Extent::new();
            for xi in part {
                extent.include(xi);
            }
            let functions = extent.functions(kind).unwrap();
            let nodes = kind.node_coordinates();
            for (k, &node) in nodes.iter().enumerate() {
                // The node of the part, by a map of the whole facet onto it.
                let at = match kind.domain() {
                    Domain::Triangle => [0, 1].map(|axis| part[0][axis] + 0.4 * node[axis]),
                    _ => [0, 1].map(|axis| part[0][axis] + 0.2 * (1.0 + node[axis])),
                };
                let at = if kind.dim() == 1 { [at[0], 0.0] } else { at };
                let shape = kind.shape([at[0], at[1], 0.0]);
                for i in 0..nodes.len() {
                    let row = functions.row(i);
                    let found: f64 = row.iter().zip(&shape).map(|(t, n)| t * n).sum();
                    let expected = if i == k { 1.0 } else { 0.0 };
                    assert!((found - expected).abs() < 1e-13, "{kind:?}");
                }
            }
        }
    }

    #[test]
    fn the_whole_has_the_functions_that_there_are() {
        for kind in [Line3, Quad8, Triangle6] {
            let mut extent = Extent::new();
            for node in &kind.node_coordinates()[..kind.corners()] {
                extent.include([node[0] * (1.0 - 1e-12), node[1]]);
            }
            assert!(extent.functions(kind).is_none());
        }
    }

    #[test]
    fn a_point_is_spread_out() {
        for kind in [Line2, Quad4, Triangle3] {
            let mut extent = Extent::new();
            extent.include([0.3, 0.3]);
            let functions = extent.functions(kind).unwrap();
            assert!(functions.iter().all(|t| t.abs() < 1e5), "{kind:?}");
        }
    }
}
