//! Sides in space, without cells, for tests.

use std::array::from_fn;
use std::collections::HashMap;

use crate::contact_point::ContactPoint;
use crate::element::ElementKind::{self, Quad9};
use crate::element::geometry::{difference, length};
use crate::mesh::Mesh;
use crate::model::mortar::carried::carried;
use crate::model::sides::Sides;
use crate::model::surface::{Surface, SurfaceFacet};

pub type Point = [f64; 3];
/// Extent of a side along x and y.
pub type Range = [[f64; 2]; 2];

/// A mesh of sides in space, without cells.
#[derive(Default)]
pub struct Space {
    pub mesh: Mesh,
    pub sides: Vec<Vec<(ElementKind, Vec<u32>)>>,
}

impl Space {
    pub fn new() -> Self {
        let mut space = Self::default();
        space.mesh.dim = 3;
        space
    }

    /// Adds a side: the rectangle `x` × `y` in n[0] × n[1] quadrilaterals, or twice as many triangles, transformed by
    /// `map`; its normal is z before that, or −z if it is `upper`. Before, inner corners are moved by up to `uneven` of
    /// a facet.
    pub fn side(
        mut self,
        kind: ElementKind,
        [x, y]: Range,
        n: [usize; 2],
        uneven: f64,
        upper: bool,
        map: impl Fn(Point) -> Point,
    ) -> Self {
        let noise =
            |i: usize, j: usize, k: f64| (12.9 * i as f64 + 78.2 * j as f64 + 37.7 * k).sin();
        let corner = |i: usize, j: usize| -> Point {
            let inner = !i.is_multiple_of(n[0]) && !j.is_multiple_of(n[1]);
            let shift = |k: f64| if inner { uneven * noise(i, j, k) } else { 0.0 };
            let s = (i as f64 + shift(1.0)) / n[0] as f64;
            let t = (j as f64 + shift(2.0)) / n[1] as f64;
            [x[0] + s * (x[1] - x[0]), y[0] + t * (y[1] - y[0]), 0.0]
        };
        let first = self.mesh.points.len();
        let mut flat: Vec<Point> = Vec::new();
        let mut node = |p: Point| -> u32 {
            let near = |q: &Point| length(difference(*q, p)) < 1e-9;
            let place = flat.iter().position(near).unwrap_or_else(|| {
                flat.push(p);
                flat.len() - 1
            });
            (first + place) as u32
        };
        let mean = |points: &[Point]| -> Point {
            from_fn(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64)
        };
        let mut facets = Vec::new();
        for (i, j) in (0..n[0]).flat_map(|i| (0..n[1]).map(move |j| (i, j))) {
            let [a, b, c, d] =
                [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
            let cells = match (kind.corners(), (i + j) % 2) {
                (4, _) => vec![vec![a, b, c, d]],
                (_, 0) => vec![vec![a, b, c], vec![a, c, d]],
                _ => vec![vec![a, b, d], vec![b, c, d]],
            };
            for mut corners in cells {
                if upper {
                    corners.reverse();
                }
                let mut at = corners.clone();
                for (_, edge) in kind.facets() {
                    if edge.len() == 3 {
                        at.push(mean(&[corners[edge[0]], corners[edge[1]]]));
                    }
                }
                if kind == Quad9 {
                    at.push(mean(&corners));
                }
                facets.push((kind, at.into_iter().map(&mut node).collect()));
            }
        }
        self.mesh.points.extend(flat.into_iter().map(map));
        self.mesh.node_tags = (1..=self.mesh.points.len() as i64).collect();
        self.sides.push(facets);
        self
    }

    pub fn surface(&self, side: usize) -> Surface {
        let facet = |(kind, nodes): &(ElementKind, Vec<u32>)| {
            let at = nodes
                .iter()
                .map(|&n| self.mesh.points[n as usize])
                .collect();
            SurfaceFacet::new(*kind, nodes.clone(), at, None)
        };
        Surface {
            facets: self.sides[side].iter().map(facet).collect(),
        }
    }

    /// The contact points of side `a` with another.
    pub fn points(&self, a: usize, b: usize) -> Vec<ContactPoint<u32>> {
        let (a, b) = (self.surface(a), self.surface(b));
        let sides = Sides::new(&self.mesh, &a, &b, "test").unwrap();
        carried(&sides).unwrap().points
    }

    /// ∫ of the shape functions over a side, by node.
    pub fn integrals(&self, side: usize) -> HashMap<u32, f64> {
        let mut integrals = HashMap::new();
        for facet in self.surface(side).facets {
            for (xi, weight) in facet.kind.quadrature(12) {
                let area = length(facet.kind.area_vector(&facet.at, xi));
                for (&node, n) in facet.nodes.iter().zip(facet.kind.shape(xi)) {
                    *integrals.entry(node).or_default() += weight * area * n;
                }
            }
        }
        integrals
    }
}
