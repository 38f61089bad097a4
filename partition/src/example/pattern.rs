//! Meshes of the unit square, to be mapped.

use std::collections::HashMap;

use crate::element::{ElementKind, Elements};

/// Division of the unit square before refinement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pattern {
    /// Columns and rows of rectangles, each divided along its shorter diagonal unless quadrilaterals are wanted.
    Grid(usize, usize),
    /// A row of triangles with this number of segments at the bottom, and twice as many at the top.
    Refining(usize),
    /// A row of triangles with this number of segments at the top, and twice as many at the bottom.
    Coarsening(usize),
}

impl Pattern {
    /// Number of triangles.
    pub(super) fn triangles(self) -> usize {
        match self {
            Self::Grid(columns, rows) => 2 * columns * rows,
            Self::Refining(columns) | Self::Coarsening(columns) => 3 * columns,
        }
    }
}

/// A mesh of the unit square.
#[derive(Clone, Debug, Default)]
pub(super) struct UnitSquare {
    /// Nodes.
    pub(super) points: Vec<[f64; 2]>,
    /// Triangles and quadrilaterals.
    pub(super) cells: Elements,
    /// Nodes along bottom, right, top and left, from left to right and from bottom to top.
    pub(super) sides: [Vec<u32>; 4],
}

impl UnitSquare {
    /// Divides the unit square into linear cells, with quadrilaterals from rectangles if `kind` is one; otherwise `map`
    /// determines the shorter diagonal.
    pub(super) fn new(
        pattern: Pattern,
        kind: ElementKind,
        map: &dyn Fn([f64; 2]) -> [f64; 2],
    ) -> Self {
        let mut square = Self::default();
        match pattern {
            Pattern::Grid(columns, rows) => {
                let lines: Vec<Vec<u32>> = (0..=rows)
                    .map(|row| square.line(columns, row as f64 / rows as f64))
                    .collect();
                for (j, pair) in lines.windows(2).enumerate() {
                    for i in 0..columns {
                        let corners = [pair[0][i], pair[0][i + 1], pair[1][i + 1], pair[1][i]];
                        match kind.corners() {
                            4 => square.cells.push(ElementKind::Quad4, &corners),
                            _ => square.split(corners, (i + j) % 2 == 0, map),
                        }
                    }
                }
                square.set_sides(&lines);
            }
            Pattern::Refining(columns) | Pattern::Coarsening(columns) => {
                let refining = matches!(pattern, Pattern::Refining(_));
                let (coarse, fine) = if refining { (0.0, 1.0) } else { (1.0, 0.0) };
                let coarse = square.line(columns, coarse);
                let fine = square.line(2 * columns, fine);
                for i in 0..columns {
                    let (a, b) = (coarse[i], coarse[i + 1]);
                    let (c, m, d) = (fine[2 * i], fine[2 * i + 1], fine[2 * i + 2]);
                    square.triangles([[a, b, m], [a, m, c], [b, d, m]]);
                }
                let lines = if refining {
                    [coarse, fine]
                } else {
                    [fine, coarse]
                };
                square.set_sides(&lines);
            }
        }
        square
    }

    /// Divides every linear cell into four at the midpoints of its edges.
    pub(super) fn refine(&mut self) {
        let mut middles = Middles::default();
        let coarse = std::mem::take(&mut self.cells);
        for (_, corners) in coarse.iter() {
            let on_edges = middles.of_edges(&mut self.points, corners);
            if let (&[a, b, c], &[d, e, f]) = (corners, &on_edges[..]) {
                self.triangles([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
            } else if let (&[a, b, c, d], &[e, f, g, h]) = (corners, &on_edges[..]) {
                let m = self.centre(corners);
                for quad in [[a, e, m, h], [e, b, f, m], [m, f, c, g], [h, m, g, d]] {
                    self.cells.push(ElementKind::Quad4, &quad);
                }
            }
        }
        self.add_to_sides(&mut middles);
    }

    /// Adds a node in the middle of every edge of linear cells, and one in the centre of quadrilaterals if `kind` has
    /// nine nodes.
    pub(super) fn raise(&mut self, kind: ElementKind) {
        let mut middles = Middles::default();
        let linear = std::mem::take(&mut self.cells);
        for (_, corners) in linear.iter() {
            let mut nodes = corners.to_vec();
            nodes.extend(middles.of_edges(&mut self.points, corners));
            if corners.len() == ElementKind::Triangle6.corners() {
                self.cells.push(ElementKind::Triangle6, &nodes);
                continue;
            }
            if kind == ElementKind::Quad9 {
                nodes.push(self.centre(corners));
            }
            self.cells.push(kind, &nodes);
        }
        self.add_to_sides(&mut middles);
    }

    /// Inserts the midpoints of edges into the sides.
    fn add_to_sides(&mut self, middles: &mut Middles) {
        for side in &mut self.sides {
            let mut refined = vec![side[0]];
            for pair in side.windows(2) {
                let middle = middles.between(&mut self.points, pair[0], pair[1]);
                refined.extend([middle, pair[1]]);
            }
            *side = refined;
        }
    }

    /// Appends the node in the centre of a quadrilateral.
    fn centre(&mut self, corners: &[u32]) -> u32 {
        let at = corners.iter().map(|&node| self.points[node as usize]);
        let sum = at.fold([0.0; 2], |sum, p| [sum[0] + p[0], sum[1] + p[1]]);
        self.points.push(sum.map(|x| x / corners.len() as f64));
        self.points.len() as u32 - 1
    }

    fn triangles<const N: usize>(&mut self, triangles: [[u32; 3]; N]) {
        for triangle in triangles {
            self.cells.push(ElementKind::Triangle3, &triangle);
        }
    }

    /// Appends the nodes of a horizontal line at height `t`.
    fn line(&mut self, columns: usize, t: f64) -> Vec<u32> {
        let first = self.points.len() as u32;
        self.points
            .extend((0..=columns).map(|i| [i as f64 / columns as f64, t]));
        (first..self.points.len() as u32).collect()
    }

    /// Divides a quadrilateral along its shorter diagonal; of equally long ones, `first` selects the first.
    fn split(&mut self, quad: [u32; 4], first: bool, map: &dyn Fn([f64; 2]) -> [f64; 2]) {
        const EQUAL: f64 = 1e-6;
        let [a, b, c, d] = quad;
        let length = |p: u32, q: u32| {
            let (p, q) = (map(self.points[p as usize]), map(self.points[q as usize]));
            (p[0] - q[0]).hypot(p[1] - q[1])
        };
        let (ac, bd) = (length(a, c), length(b, d));
        let along_ac = match (ac - bd).abs() < EQUAL * ac {
            true => first,
            false => ac < bd,
        };
        self.triangles(if along_ac {
            [[a, b, c], [a, c, d]]
        } else {
            [[a, b, d], [b, c, d]]
        });
    }

    fn set_sides(&mut self, lines: &[Vec<u32>]) {
        let (Some(bottom), Some(top)) = (lines.first(), lines.last()) else {
            return;
        };
        let left = lines.iter().map(|line| line[0]).collect();
        let right = lines.iter().map(|line| line[line.len() - 1]).collect();
        self.sides = [bottom.clone(), right, top.clone(), left];
    }
}

/// The middle nodes of edges.
#[derive(Default)]
struct Middles {
    nodes: HashMap<(u32, u32), u32>,
}

impl Middles {
    /// The middle node of two nodes, appended to `points` on first use.
    fn between(&mut self, points: &mut Vec<[f64; 2]>, a: u32, b: u32) -> u32 {
        *self.nodes.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let (p, q) = (points[a as usize], points[b as usize]);
            points.push([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]);
            points.len() as u32 - 1
        })
    }

    /// The middle nodes of a cell's edges, in their order.
    fn of_edges(&mut self, points: &mut Vec<[f64; 2]>, corners: &[u32]) -> Vec<u32> {
        let next = corners.iter().cycle().skip(1);
        let edges = corners.iter().zip(next);
        edges.map(|(&a, &b)| self.between(points, a, b)).collect()
    }
}
