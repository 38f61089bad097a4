//! Triangulations of the unit square, to be mapped.

use std::collections::HashMap;

/// How the unit square is triangulated before it is refined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pattern {
    /// Columns and rows of rectangles, each cut along its shorter diagonal.
    Grid(usize, usize),
    /// One row whose top has twice as many segments as its bottom, which has so many.
    Refining(usize),
    /// One row whose bottom has twice as many segments as its top, which has so many.
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

/// A triangulation of the unit square.
#[derive(Clone, Debug, Default)]
pub(super) struct UnitSquare {
    /// Nodes.
    pub(super) points: Vec<[f64; 2]>,
    /// Triangles.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Nodes along bottom, right, top and left, from left to right and from bottom to top.
    pub(super) sides: [Vec<u32>; 4],
}

impl UnitSquare {
    /// Triangulates the unit square; `map` tells which diagonal is the shorter one.
    pub(super) fn new(pattern: Pattern, map: &dyn Fn([f64; 2]) -> [f64; 2]) -> Self {
        let mut square = Self::default();
        match pattern {
            Pattern::Grid(columns, rows) => {
                let lines: Vec<Vec<u32>> = (0..=rows)
                    .map(|row| square.line(columns, row as f64 / rows as f64))
                    .collect();
                for (j, pair) in lines.windows(2).enumerate() {
                    for i in 0..columns {
                        let corners = [pair[0][i], pair[0][i + 1], pair[1][i + 1], pair[1][i]];
                        square.split(corners, (i + j) % 2 == 0, map);
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
                    square.triangles.extend([[a, b, m], [a, m, c], [b, d, m]]);
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

    /// Cuts every triangle into four by the midpoints of its edges.
    pub(super) fn refine(&mut self) {
        let mut midpoints: HashMap<(u32, u32), u32> = HashMap::new();
        let points = &mut self.points;
        let mut midpoint = |a: u32, b: u32| {
            *midpoints.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let (p, q) = (points[a as usize], points[b as usize]);
                points.push([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]);
                points.len() as u32 - 1
            })
        };
        let mut finer = Vec::with_capacity(4 * self.triangles.len());
        for &[a, b, c] in &self.triangles {
            let (d, e, f) = (midpoint(a, b), midpoint(b, c), midpoint(c, a));
            finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        for side in &mut self.sides {
            let mut refined = vec![side[0]];
            for pair in side.windows(2) {
                refined.extend([midpoint(pair[0], pair[1]), pair[1]]);
            }
            *side = refined;
        }
        self.triangles = finer;
    }

    /// Appends the nodes of a horizontal line at height `t`.
    fn line(&mut self, columns: usize, t: f64) -> Vec<u32> {
        let first = self.points.len() as u32;
        self.points
            .extend((0..=columns).map(|i| [i as f64 / columns as f64, t]));
        (first..self.points.len() as u32).collect()
    }

    /// Cuts a quadrilateral along its shorter diagonal, along the first one or the other where
    /// both are equally long.
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
        self.triangles.extend(if along_ac {
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
