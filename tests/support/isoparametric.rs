//! Elements, independent of the program under test: shape functions from the monomials that they span, quadrature rules
//! from tables.

use contact_dd_partition::element::ElementKind::{
    self, Hexahedron8, Hexahedron20, Hexahedron27, Line2, Line3, Quad4, Quad8, Quad9, Tetrahedron4,
    Tetrahedron10, Triangle3, Triangle6,
};
use contact_dd_partition::stiffness::Stiffness;
use faer::sparse::Triplet;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use std::f64::consts::PI;

/// ∇N of a node, and around an axis N over the radius.
type Slope = ([f64; 3], f64);

/// An element at its quadrature points.
pub struct Cell {
    pub nodes: Vec<usize>,
    dim: usize,
    /// Slopes of each node and the weight times the Jacobian, around an axis times the circumference, of each point.
    points: Vec<(Vec<Slope>, f64)>,
    stiffness: DMatrix<f64>,
}

/// The midpoint of some corners.
fn middle(corners: &[[f64; 3]], of: &[usize]) -> [f64; 3] {
    [0, 1, 2].map(|k| of.iter().map(|&i| corners[i][k]).sum::<f64>() / of.len() as f64)
}

/// Reference coordinates of the nodes.
fn reference(kind: ElementKind) -> Vec<[f64; 3]> {
    let simplex = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let (corners, between): (Vec<[f64; 3]>, &[&[usize]]) = match kind {
        Line2 | Line3 => (vec![[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], &[&[0, 1]]),
        Triangle3 | Triangle6 => (simplex[..3].to_vec(), &[&[0, 1], &[1, 2], &[2, 0]]),
        Quad4 | Quad8 | Quad9 => (
            square.map(|[x, y]| [x, y, 0.0]).to_vec(),
            &[&[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 1, 2, 3]],
        ),
        Tetrahedron4 | Tetrahedron10 => (
            simplex.to_vec(),
            &[&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]],
        ),
        Hexahedron8 | Hexahedron20 | Hexahedron27 => (
            [-1.0, 1.0]
                .iter()
                .flat_map(|&z| square.map(|[x, y]| [x, y, z]))
                .collect(),
            &[
                &[0, 1],
                &[1, 2],
                &[2, 3],
                &[3, 0],
                &[4, 5],
                &[5, 6],
                &[6, 7],
                &[7, 4],
                &[0, 4],
                &[1, 5],
                &[2, 6],
                &[3, 7],
                &[0, 3, 7, 4],
                &[1, 2, 6, 5],
                &[0, 1, 5, 4],
                &[3, 2, 6, 7],
                &[0, 1, 2, 3],
                &[4, 5, 6, 7],
                &[0, 1, 2, 3, 4, 5, 6, 7],
            ],
        ),
        _ => panic!("{kind:?} is no cell"),
    };
    let others = between.iter().map(|of| middle(&corners, of));
    corners
        .iter()
        .copied()
        .chain(others)
        .take(kind.nodes())
        .collect()
}

/// Powers of ξ, η and ζ that the shape functions span.
fn powers(kind: ElementKind) -> Vec<[i32; 3]> {
    let all = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9]);
    let is_of = |powers: &[i32; 3]| {
        let sum: i32 = powers.iter().sum();
        // Serendipity elements also have factors of first degree.
        let beyond: i32 = powers.iter().filter(|&&p| p > 1).sum();
        match kind {
            Line2 | Triangle3 | Tetrahedron4 => sum <= 1,
            Triangle6 | Tetrahedron10 => sum <= 2,
            Quad4 | Hexahedron8 => beyond == 0,
            Quad8 | Hexahedron20 => beyond <= 2,
            _ => true,
        }
    };
    let is_in = |powers: &[i32; 3]| powers[kind.dim()..].iter().all(|&p| p == 0);
    all.filter(|powers| is_of(powers) && is_in(powers))
        .collect()
}

/// Σ_k V⁻¹_ki of(power k) for every node i, with V_ik = m_k(ξ_i): the value for the shape functions N = V⁻ᵀ m of a
/// linear functional given on the monomials, such as a value or a slope.
fn of_shapes(kind: ElementKind, of: &dyn Fn([i32; 3]) -> f64) -> DVector<f64> {
    let (nodes, powers) = (reference(kind), powers(kind));
    let n = nodes.len();
    let v = DMatrix::from_fn(n, n, |k, i| monomial(nodes[i], powers[k]));
    let of = DVector::from_fn(n, |k, _| of(powers[k]));
    v.lu().solve(&of).unwrap()
}

fn monomial(x: [f64; 3], powers: [i32; 3]) -> f64 {
    (0..3).map(|k| x[k].powi(powers[k])).product()
}

/// N_i.
pub fn shapes(kind: ElementKind, xi: [f64; 3]) -> Vec<f64> {
    let values = of_shapes(kind, &|powers| monomial(xi, powers));
    values.iter().copied().collect()
}

/// ∂N_i/∂ξ.
pub fn gradients(kind: ElementKind, xi: [f64; 3]) -> Vec<[f64; 3]> {
    let slopes = [0, 1, 2].map(|axis| {
        of_shapes(kind, &|mut powers| match powers[axis] {
            0 => 0.0,
            p => {
                powers[axis] -= 1;
                f64::from(p) * monomial(xi, powers)
            }
        })
    });
    (0..kind.nodes())
        .map(|i| [0, 1, 2].map(|axis| slopes[axis][i]))
        .collect()
}

/// Points and weights of the rule that defines the stiffness; for quadratic tetrahedra a rule that is as exact if their
/// edges are straight.
fn rule(kind: ElementKind, is_ring: bool) -> Vec<([f64; 3], f64)> {
    let product = |line: &[(f64, f64)]| -> Vec<([f64; 3], f64)> {
        let depth = match kind.dim() {
            2 => vec![(0.0, 1.0)],
            _ => line.to_vec(),
        };
        let pairs = line.iter().flat_map(|a| line.iter().map(move |b| (a, b)));
        pairs
            .flat_map(|(a, b)| {
                depth
                    .iter()
                    .map(move |c| ([a.0, b.0, c.0], a.1 * b.1 * c.1))
            })
            .collect()
    };
    match kind {
        Triangle3 if is_ring => {
            let (a, b) = (1.0 / 6.0, 2.0 / 3.0);
            [[a, a, 0.0], [a, b, 0.0], [b, a, 0.0]]
                .map(|at| (at, 1.0 / 6.0))
                .to_vec()
        }
        Triangle3 => vec![([1.0 / 3.0, 1.0 / 3.0, 0.0], 0.5)],
        // Dunavant, Int. J. Numer. Meth. Eng. 21 (1985), degree 4.
        Triangle6 => [
            (0.445_948_490_915_965, 0.223_381_589_678_011),
            (0.091_576_213_509_771, 0.109_951_743_655_322),
        ]
        .into_iter()
        .flat_map(|(a, w): (f64, f64)| {
            let b = 1.0 - 2.0 * a;
            [[a, a, 0.0], [a, b, 0.0], [b, a, 0.0]].map(|at| (at, 0.5 * w))
        })
        .collect(),
        Tetrahedron4 => vec![([0.25; 3], 1.0 / 6.0)],
        Tetrahedron10 => {
            let (a, b) = (0.138_196_601_125_010_5, 0.585_410_196_624_968_5);
            [[a, a, a], [b, a, a], [a, b, a], [a, a, b]]
                .map(|at| (at, 1.0 / 24.0))
                .to_vec()
        }
        Quad4 | Hexahedron8 => {
            let a = 1.0 / 3.0_f64.sqrt();
            product(&[(-a, 1.0), (a, 1.0)])
        }
        _ => {
            let a = 0.6_f64.sqrt();
            product(&[(-a, 5.0 / 9.0), (0.0, 8.0 / 9.0), (a, 5.0 / 9.0)])
        }
    }
}

/// N_i, ∂N_i/∂ξ and weights at the points of a kind's rule.
pub struct Reference(Vec<(Vec<f64>, Vec<[f64; 3]>, f64)>);

impl Reference {
    /// The reference for cells around an axis or not.
    pub fn new(kind: ElementKind, is_ring: bool) -> Self {
        let points = rule(kind, is_ring).into_iter();
        let of_point = |(xi, w)| (shapes(kind, xi), gradients(kind, xi), w);
        Self(points.map(of_point).collect())
    }
}

impl Cell {
    pub fn new(
        reference: &Reference,
        points: &[[f64; 3]],
        nodes: Vec<usize>,
        stiffness: &Stiffness,
    ) -> Self {
        let size = stiffness.size();
        let dim = if size < 6 { 2 } else { 3 };
        let at_point = |(shapes, reference, weight): &(Vec<f64>, Vec<[f64; 3]>, f64)| {
            let mut j = Matrix3::zeros();
            for (x, g) in points.iter().zip(reference) {
                j += Vector3::from(*x) * Vector3::from(*g).transpose();
            }
            if dim == 2 {
                j[(2, 2)] = 1.0;
            }
            let to_space = j.try_inverse().unwrap().transpose();
            let radius: f64 = points.iter().zip(shapes).map(|(x, n)| x[0] * n).sum();
            let around = if size == 4 { 2.0 * PI * radius } else { 1.0 };
            let slopes = reference
                .iter()
                .zip(shapes)
                .map(|(g, n)| ((to_space * Vector3::from(*g)).into(), n / radius));
            (slopes.collect(), weight * j.determinant().abs() * around)
        };
        Self {
            nodes,
            dim,
            points: reference.0.iter().map(at_point).collect(),
            stiffness: DMatrix::from_row_slice(size, size, stiffness.values()),
        }
    }

    /// The strains of a displacement of 1 along an axis, in Voigt's order, of a node with these slopes.
    fn strain(&self, ([x, y, z], hoop): Slope, axis: usize) -> DVector<f64> {
        let voigt = match axis {
            0 => [x, 0.0, 0.0, 0.0, z, y],
            1 => [0.0, y, 0.0, z, 0.0, x],
            _ => [0.0, 0.0, z, y, x, 0.0],
        };
        match self.stiffness.nrows() {
            3 => DVector::from_column_slice(&[voigt[0], voigt[1], voigt[5]]),
            4 => {
                let hoop = if axis == 0 { hoop } else { 0.0 };
                DVector::from_column_slice(&[voigt[0], voigt[1], hoop, voigt[5]])
            }
            _ => DVector::from_column_slice(&voigt),
        }
    }

    /// Σ w Gᵀ C G, G the strains of each dof.
    pub fn entries(&self) -> Vec<Triplet<usize, usize, f64>> {
        let n = self.dim * self.nodes.len();
        let mut sum = DMatrix::zeros(n, n);
        for (slopes, weight) in &self.points {
            let columns: Vec<_> = (0..n)
                .map(|i| self.strain(slopes[i / self.dim], i % self.dim))
                .collect();
            let strains = DMatrix::from_columns(&columns);
            sum += strains.transpose() * (&self.stiffness * *weight) * &strains;
        }
        let dof = |i: usize| self.dim * self.nodes[i / self.dim] + i % self.dim;
        (0..n * n)
            .map(|k| Triplet::new(dof(k / n), dof(k % n), sum[(k / n, k % n)]))
            .collect()
    }

    /// uᵀ K u.
    pub fn energy(&self, u: &[f64]) -> f64 {
        let energy = |(slopes, weight): &(Vec<Slope>, f64)| {
            let mut strain = DVector::zeros(self.stiffness.nrows());
            if self.stiffness.nrows() == 4 {
                let radial = self.nodes.iter().map(|&node| u[self.dim * node]);
                strain[2] = radial.zip(slopes).map(|(u, (_, hoop))| u * hoop).sum();
            }
            for (&node, &slope) in self.nodes.iter().zip(slopes).skip(1) {
                for axis in 0..self.dim {
                    // The slopes add up to 0: relative to the first node, a translation cancels.
                    let du = u[self.dim * node + axis] - u[self.dim * self.nodes[0] + axis];
                    strain += du * self.strain((slope.0, 0.0), axis);
                }
            }
            weight * strain.dot(&(&self.stiffness * &strain))
        };
        self.points.iter().map(energy).sum()
    }
}
