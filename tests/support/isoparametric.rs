//! Elements without any code of the program under test: shape functions from the monomials that
//! they span, rules of quadrature from tables.

use contact_dd_partition::element::ElementKind::{self, Quad4, Quad8, Quad9, Triangle3, Triangle6};
use faer::sparse::Triplet;
use nalgebra::{DMatrix, DVector};

/// An element at its quadrature points.
pub struct Cell {
    pub nodes: Vec<usize>,
    /// ∇N of each node and the weight times the Jacobian, of each point.
    points: Vec<(Vec<[f64; 2]>, f64)>,
    stiffness: [[f64; 3]; 3],
}

/// Reference coordinates of all nodes that a cell of three or four corners may have.
fn reference(kind: ElementKind) -> Vec<[f64; 2]> {
    let triangle = [
        [0.0, 0.0],
        [1.0, 0.0],
        [0.0, 1.0],
        [0.5, 0.0],
        [0.5, 0.5],
        [0.0, 0.5],
    ];
    let square = [
        [-1.0, -1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [0.0, -1.0],
        [1.0, 0.0],
        [0.0, 1.0],
        [-1.0, 0.0],
        [0.0, 0.0],
    ];
    match kind {
        Triangle3 => triangle[..3].to_vec(),
        Triangle6 => triangle.to_vec(),
        Quad4 => square[..4].to_vec(),
        Quad8 => square[..8].to_vec(),
        Quad9 => square.to_vec(),
        _ => panic!("{kind:?} is no cell"),
    }
}

/// Powers of ξ and η that the shape functions span.
fn powers(kind: ElementKind) -> &'static [[i32; 2]] {
    match kind {
        Triangle3 => &[[0, 0], [1, 0], [0, 1]],
        Triangle6 => &[[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2]],
        Quad4 => &[[0, 0], [1, 0], [0, 1], [1, 1]],
        Quad8 => &[
            [0, 0],
            [1, 0],
            [0, 1],
            [2, 0],
            [1, 1],
            [0, 2],
            [2, 1],
            [1, 2],
        ],
        _ => &[
            [0, 0],
            [1, 0],
            [0, 1],
            [2, 0],
            [1, 1],
            [0, 2],
            [2, 1],
            [1, 2],
            [2, 2],
        ],
    }
}

/// Σ_k V⁻¹_ki of(power k) for every node i, with V_ik = m_k(ξ_i): what a linear function of the
/// monomials, such as a value or a slope, is of the shape functions N = V⁻ᵀ m.
fn of_shapes(kind: ElementKind, of: &dyn Fn([i32; 2]) -> f64) -> DVector<f64> {
    let (nodes, powers) = (reference(kind), powers(kind));
    let n = nodes.len();
    let v = DMatrix::from_fn(n, n, |k, i| {
        nodes[i][0].powi(powers[k][0]) * nodes[i][1].powi(powers[k][1])
    });
    let of = DVector::from_fn(n, |k, _| of(powers[k]));
    v.lu().solve(&of).unwrap()
}

/// N_i.
pub fn shapes(kind: ElementKind, [s, t]: [f64; 2]) -> Vec<f64> {
    let values = of_shapes(kind, &|[p, q]| s.powi(p) * t.powi(q));
    values.iter().copied().collect()
}

/// ∂N_i/∂ξ.
pub fn gradients(kind: ElementKind, [s, t]: [f64; 2]) -> Vec<[f64; 2]> {
    let slope = |x: f64, p: i32| {
        if p == 0 {
            0.0
        } else {
            f64::from(p) * x.powi(p - 1)
        }
    };
    let x = of_shapes(kind, &|[p, q]| slope(s, p) * t.powi(q));
    let y = of_shapes(kind, &|[p, q]| s.powi(p) * slope(t, q));
    x.iter().zip(&y).map(|(&x, &y)| [x, y]).collect()
}

/// Points and weights of the rule by which the stiffness is defined.
fn rule(kind: ElementKind) -> Vec<([f64; 2], f64)> {
    let product = |line: &[(f64, f64)]| {
        let pairs = line.iter().flat_map(|a| line.iter().map(move |b| (a, b)));
        pairs.map(|(a, b)| ([a.0, b.0], a.1 * b.1)).collect()
    };
    match kind {
        Triangle3 => vec![([1.0 / 3.0; 2], 0.5)],
        // Dunavant, Int. J. Numer. Meth. Eng. 21 (1985), degree 4.
        Triangle6 => [
            (0.445_948_490_915_965, 0.223_381_589_678_011),
            (0.091_576_213_509_771, 0.109_951_743_655_322),
        ]
        .into_iter()
        .flat_map(|(a, w): (f64, f64)| {
            let b = 1.0 - 2.0 * a;
            [[a, a], [a, b], [b, a]].map(|at| (at, 0.5 * w))
        })
        .collect(),
        Quad4 => {
            let a = 1.0 / 3.0_f64.sqrt();
            product(&[(-a, 1.0), (a, 1.0)])
        }
        _ => {
            let a = 0.6_f64.sqrt();
            product(&[(-a, 5.0 / 9.0), (0.0, 8.0 / 9.0), (a, 5.0 / 9.0)])
        }
    }
}

/// ∂N_i/∂ξ and weights at the points of a kind's rule.
pub struct Reference(Vec<(Vec<[f64; 2]>, f64)>);

impl Reference {
    pub fn new(kind: ElementKind) -> Self {
        let points = rule(kind).into_iter();
        Self(points.map(|(xi, w)| (gradients(kind, xi), w)).collect())
    }
}

impl Cell {
    pub fn new(
        reference: &Reference,
        points: &[[f64; 3]],
        nodes: Vec<usize>,
        stiffness: [[f64; 3]; 3],
    ) -> Self {
        let at_point = |(reference, weight): &(Vec<[f64; 2]>, f64)| {
            let mut j = [[0.0; 2]; 2];
            for (x, g) in points.iter().zip(reference) {
                for k in 0..4 {
                    j[k / 2][k % 2] += x[k / 2] * g[k % 2];
                }
            }
            let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
            let slopes = reference.iter().map(|[s, t]| {
                [
                    (j[1][1] * s - j[1][0] * t) / det,
                    (j[0][0] * t - j[0][1] * s) / det,
                ]
            });
            (slopes.collect(), weight * det.abs())
        };
        Self {
            nodes,
            points: reference.0.iter().map(at_point).collect(),
            stiffness,
        }
    }

    /// aᵀ C b.
    fn product(&self, a: [f64; 3], b: [f64; 3]) -> f64 {
        let c = &self.stiffness;
        (0..9).map(|k| a[k / 3] * c[k / 3][k % 3] * b[k % 3]).sum()
    }

    /// Σ w Gᵀ C G, G the strains (ε_xx, ε_yy, γ_xy) of each dof.
    pub fn entries(&self) -> Vec<Triplet<usize, usize, f64>> {
        let n = 2 * self.nodes.len();
        let strain = |slopes: &[[f64; 2]], i: usize| match (i % 2, slopes[i / 2]) {
            (0, [x, y]) => [x, 0.0, y],
            (_, [x, y]) => [0.0, y, x],
        };
        let dof = |i: usize| 2 * self.nodes[i / 2] + i % 2;
        let value = |i: usize, j: usize| {
            let terms = self.points.iter().map(|(slopes, weight)| {
                weight * self.product(strain(slopes, i), strain(slopes, j))
            });
            terms.sum()
        };
        (0..n * n)
            .map(|k| Triplet::new(dof(k / n), dof(k % n), value(k / n, k % n)))
            .collect()
    }

    /// uᵀ K u.
    pub fn energy(&self, u: &[f64]) -> f64 {
        let energy = |(slopes, weight): &(Vec<[f64; 2]>, f64)| {
            let mut strain = [0.0; 3];
            for (node, [x, y]) in self.nodes.iter().zip(slopes).skip(1) {
                // The slopes add up to 0: against the first node, a translation drops out.
                let [du, dv] = [0, 1].map(|axis| u[2 * node + axis] - u[2 * self.nodes[0] + axis]);
                strain[0] += x * du;
                strain[1] += y * dv;
                strain[2] += y * du + x * dv;
            }
            weight * self.product(strain, strain)
        };
        self.points.iter().map(energy).sum()
    }
}
