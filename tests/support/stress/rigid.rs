//! Rigid motions of the bodies of a model, and the effect of supports and contact on them.

use contact_dd_partition::model::Model;
use nalgebra::{DMatrix, DVector};

/// Singular value, relative to the largest, below which it counts as zero.
const NOTHING: f64 = 1e-9;

/// Bodies as sets of connected nodes, with their rigid motions.
pub struct Bodies {
    dim: usize,
    /// Body of every node.
    of_node: Vec<usize>,
    /// Centre and size of every body (m).
    frames: Vec<([f64; 3], f64)>,
    points: Vec<[f64; 3]>,
}

impl Bodies {
    pub fn new(model: &Model) -> Self {
        let mesh = &model.mesh;
        let mut root: Vec<usize> = (0..mesh.points.len()).collect();
        fn find(root: &mut [usize], node: usize) -> usize {
            let mut at = node;
            while root[at] != at {
                root[at] = root[root[at]];
                at = root[at];
            }
            at
        }
        for (_, nodes) in mesh.cells.iter() {
            for pair in nodes.windows(2) {
                let (a, b) = (
                    find(&mut root, pair[0] as usize),
                    find(&mut root, pair[1] as usize),
                );
                root[a.max(b)] = a.min(b);
            }
        }
        let mut number = vec![usize::MAX; root.len()];
        let mut boxes: Vec<[[f64; 3]; 2]> = Vec::new();
        let mut of_node = Vec::with_capacity(root.len());
        for node in 0..root.len() {
            let top = find(&mut root, node);
            let p = mesh.points[node];
            if number[top] == usize::MAX {
                number[top] = boxes.len();
                boxes.push([p; 2]);
            }
            let [low, high] = &mut boxes[number[top]];
            for axis in 0..3 {
                low[axis] = low[axis].min(p[axis]);
                high[axis] = high[axis].max(p[axis]);
            }
            of_node.push(number[top]);
        }
        let frame = |[low, high]: [[f64; 3]; 2]| {
            let sizes = [0, 1, 2].map(|i| high[i] - low[i]);
            let size = sizes.into_iter().fold(0.0, f64::max);
            ([0, 1, 2].map(|i| (low[i] + high[i]) / 2.0), size)
        };
        Self {
            dim: mesh.dim,
            of_node,
            frames: boxes.into_iter().map(frame).collect(),
            points: mesh.points.clone(),
        }
    }

    /// Number of rigid motions of a body: along every axis, and rotations about its centre.
    fn modes(&self) -> usize {
        if self.dim == 2 { 3 } else { 6 }
    }

    /// Number of rigid motions.
    pub fn motions(&self) -> usize {
        self.modes() * self.frames.len()
    }

    /// The displacement of a node in each motion of its body.
    fn moves(&self, node: usize) -> Vec<[f64; 3]> {
        let [x, y, z] = self.arm(node);
        let along = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let around = [[-y, x, 0.0], [0.0, -z, y], [z, 0.0, -x]];
        let turns = if self.dim == 2 { 1 } else { 3 };
        [&along[..self.dim], &around[..turns]].concat()
    }

    /// Action of a row of coefficients, by dof, on each rigid motion.
    pub fn act(&self, row: &[(usize, f64)]) -> DVector<f64> {
        let mut sums = DVector::zeros(self.motions());
        for &(dof, c) in row {
            let (node, axis) = (dof / self.dim, dof % self.dim);
            let first = self.modes() * self.of_node[node];
            for (k, moved) in self.moves(node).iter().enumerate() {
                sums[first + k] += c * moved[axis];
            }
        }
        sums
    }

    fn arm(&self, node: usize) -> [f64; 3] {
        let (middle, size) = self.frames[self.of_node[node]];
        let p = self.points[node];
        [0, 1, 2].map(|i| (p[i] - middle[i]) / size)
    }

    /// The displacement of all nodes in the motion with these coefficients.
    pub fn displacement(&self, motion: &[f64]) -> Vec<f64> {
        (0..self.of_node.len())
            .flat_map(|node| {
                let z = &motion[self.modes() * self.of_node[node]..];
                let moves = self.moves(node);
                let sum =
                    |axis: usize| z.iter().zip(&moves).map(|(z, moved)| z * moved[axis]).sum();
                (0..self.dim).map(sum).collect::<Vec<f64>>()
            })
            .collect()
    }

    /// Orthonormal coefficients of the motions on which none of `rows` acts.
    pub fn unseen<'a>(
        &self,
        rows: impl Iterator<Item = &'a Vec<(usize, f64)>>,
    ) -> Vec<DVector<f64>> {
        let n = self.motions();
        // Rows are added to a triangular factor one by one: AᵀA would lose half of the digits.
        let mut folded = DMatrix::zeros(2 * n, n);
        let mut filled = n;
        for row in rows {
            if filled == 2 * n {
                let r = folded.clone().qr().r();
                folded.rows_mut(0, n).copy_from(&r);
                filled = n;
            }
            folded.set_row(filled, &self.act(row).transpose());
            filled += 1;
            for rest in filled..2 * n {
                folded.row_mut(rest).fill(0.0);
            }
        }
        let svd = folded.svd(false, true);
        let largest = svd.singular_values.amax();
        let Some(v_t) = svd.v_t else {
            return Vec::new();
        };
        (0..n)
            .filter(|&i| svd.singular_values[i] <= NOTHING * largest)
            .map(|i| v_t.row(i).transpose())
            .collect()
    }
}
