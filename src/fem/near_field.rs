//! Near fields of a crack tip: the fields of K_I = 1 and of K_II = 1, with traction-free faces.
//!
//! The displacement is u_i = √r f_i(θ) in the frame of the tip, x₁ along the crack. For isotropic materials after
//! M. L. Williams, *On the stress distribution at the base of a stationary crack*, J. Appl. Mech. 24 (1957); for others
//! after G. C. Sih, P. C. Paris, G. R. Irwin, *On cracks in rectilinearly anisotropic bodies*, Int. J. Fract. Mech. 1
//! (1965), with the roots μ₁, μ₂ of
//!
//! > S₁₁ μ⁴ − 2 S₁₆ μ³ + (2 S₁₂ + S₆₆) μ² − 2 S₂₆ μ + S₂₂ = 0.

use std::f64::consts::PI;

use nalgebra::{Complex, Matrix2, Matrix3, Matrix4, Vector3};

/// Difference of stiffness coefficients, relative to the largest, up to which a material counts as isotropic;
/// difference of roots up to which they count as equal.
const SAME: f64 = 1e-6;

/// A displacement gradient, ∂u_i/∂x_j.
pub type Gradient = [[f64; 2]; 2];

/// The near fields in a material.
#[derive(Clone, Debug)]
pub struct NearField {
    /// C in the frame of the tip (Pa).
    stiffness: Matrix3<f64>,
    roots: Roots,
}

/// Constants of the near fields.
#[derive(Clone, Debug)]
enum Roots {
    /// The shear modulus (Pa) and Kolosov's constant.
    Isotropic { shear: f64, kolosov: f64 },
    /// Roots μ_k, with p_k and q_k (1/Pa), the coefficients of displacements.
    Anisotropic([[Complex<f64>; 3]; 2]),
}

impl NearField {
    /// The near fields in a material with this `stiffness` in the frame of the tip (Pa); `None` if the roots don't
    /// determine them.
    pub fn new(stiffness: Matrix3<f64>) -> Option<Self> {
        let c = &stiffness;
        let size = c.amax();
        let differences = [
            c[(0, 0)] - c[(1, 1)],
            c[(0, 2)],
            c[(1, 2)],
            c[(0, 0)] - c[(0, 1)] - 2.0 * c[(2, 2)],
        ];
        let is_isotropic = differences.iter().all(|d| d.abs() <= SAME * size);
        let (lame, shear) = (c[(0, 1)], c[(2, 2)]);
        let roots = match is_isotropic {
            true => Roots::Isotropic {
                shear,
                kolosov: (lame + 3.0 * shear) / (lame + shear),
            },
            false => anisotropic(&stiffness.try_inverse()?)?,
        };
        Some(Self { stiffness, roots })
    }

    /// H in the energy release rate G = Kᵀ H K (1/Pa).
    pub fn compliance(&self) -> Matrix2<f64> {
        match &self.roots {
            Roots::Isotropic { shear, kolosov } => {
                Matrix2::from_diagonal_element((kolosov + 1.0) / (8.0 * shear))
            }
            Roots::Anisotropic([[a, ..], [b, ..]]) => {
                // C is positive definite.
                let s = self.stiffness.try_inverse().unwrap_or_default();
                let (s11, s22) = (s[(0, 0)], s[(1, 1)]);
                let first = -0.5 * s22 * ((a + b) / (a * b)).im;
                let second = 0.5 * s11 * (a + b).im;
                let both = 0.5 * (s11 * (a * b).im - s22 * (a * b).inv().im);
                Matrix2::new(first, 0.5 * both, 0.5 * both, second)
            }
        }
    }

    /// f_i and f_i' at an angle θ for the fields of K_I and K_II (1/Pa).
    fn shapes(&self, angle: f64) -> [[[f64; 2]; 2]; 2] {
        let (sin, cos) = angle.sin_cos();
        match &self.roots {
            Roots::Isotropic { shear, kolosov } => {
                let scale = 1.0 / (2.0 * shear * (2.0 * PI).sqrt());
                let (half_sin, half_cos) = (0.5 * angle).sin_cos();
                let opening = kolosov - cos;
                let (g, h) = (kolosov + 2.0 + cos, kolosov - 2.0 + cos);
                let fields = [
                    [
                        [
                            half_cos * opening,
                            half_cos * sin - 0.5 * half_sin * opening,
                        ],
                        [
                            half_sin * opening,
                            half_sin * sin + 0.5 * half_cos * opening,
                        ],
                    ],
                    [
                        [half_sin * g, 0.5 * half_cos * g - half_sin * sin],
                        [-half_cos * h, 0.5 * half_sin * h + half_cos * sin],
                    ],
                ];
                fields.map(|of_mode| of_mode.map(|of_field| of_field.map(|x| scale * x)))
            }
            Roots::Anisotropic(roots) => {
                let scale = (2.0 / PI).sqrt();
                let of_root = roots.map(|[mu, ..]| {
                    let value = (Complex::from(cos) + mu * sin).sqrt();
                    [value, (mu * cos - sin) / (2.0 * value)]
                });
                let [[a, pa, qa], [b, pb, qb]] = *roots;
                [[b, a], [Complex::from(1.0); 2]].map(|[first, second]| {
                    let field = |of: [Complex<f64>; 2]| {
                        [0, 1].map(|k| {
                            let sum =
                                second * of[1] * of_root[1][k] - first * of[0] * of_root[0][k];
                            scale * (sum / (a - b)).re
                        })
                    };
                    [field([pa, pb]), field([qa, qb])]
                })
            }
        }
    }

    /// Displacement at a point, in the frame of the tip, of the field of K_I (0) or K_II (1) (√m).
    #[cfg(test)]
    pub(super) fn displacement(&self, mode: usize, distance: f64, angle: f64) -> [f64; 2] {
        let shape = self.shapes(angle)[mode];
        shape.map(|[f, _]| distance.sqrt() * f)
    }

    /// ∂a_i/∂x_j at a point, in the frame of the tip, of the fields a of K_I and K_II (1/√m).
    pub fn gradients(&self, distance: f64, angle: f64) -> [Gradient; 2] {
        let (sin, cos) = angle.sin_cos();
        let scale = 1.0 / distance.sqrt();
        let gradient = |[f, slope]: [f64; 2]| {
            [
                scale * (0.5 * cos * f - sin * slope),
                scale * (0.5 * sin * f + cos * slope),
            ]
        };
        self.shapes(angle).map(|of_mode| of_mode.map(gradient))
    }

    /// The stress of a displacement gradient, (xx, yy, xy).
    pub fn stress(&self, gradient: &Gradient) -> Vector3<f64> {
        self.stiffness * strain(gradient)
    }
}

/// The strain of a displacement gradient, (xx, yy, γ_xy).
pub fn strain(gradient: &Gradient) -> Vector3<f64> {
    let [[xx, xy], [yx, yy]] = *gradient;
    Vector3::new(xx, yy, xy + yx)
}

/// The roots with positive imaginary part for a compliance S (1/Pa).
fn anisotropic(s: &Matrix3<f64>) -> Option<Roots> {
    let lead = s[(0, 0)];
    let [cubic, square, linear, constant] = [
        -2.0 * s[(0, 2)] / lead,
        (2.0 * s[(0, 1)] + s[(2, 2)]) / lead,
        -2.0 * s[(1, 2)] / lead,
        s[(1, 1)] / lead,
    ];
    #[rustfmt::skip]
    let companion = Matrix4::new(
        0.0, 0.0, 0.0, -constant,
        1.0, 0.0, 0.0, -linear,
        0.0, 1.0, 0.0, -square,
        0.0, 0.0, 1.0, -cubic,
    );
    let all = companion.complex_eigenvalues();
    let mut above: Vec<Complex<f64>> = all.iter().copied().filter(|mu| mu.im > 0.0).collect();
    above.sort_by(|a, b| a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im)));
    let [a, b] = above[..] else {
        return None;
    };
    if (a - b).norm() <= SAME * a.norm() {
        return None;
    }
    let of_root = |mu: Complex<f64>| {
        let p = mu * mu * s[(0, 0)] + s[(0, 1)] - mu * s[(0, 2)];
        let q = mu * s[(0, 1)] + mu.inv() * s[(1, 1)] - s[(1, 2)];
        [mu, p, q]
    };
    Some(Roots::Anisotropic([of_root(a), of_root(b)]))
}

/// C in the frame whose first axis is (cos α, sin α), from C in Cartesian axes (Pa).
pub fn turned(stiffness: &Matrix3<f64>, [cos, sin]: [f64; 2]) -> Matrix3<f64> {
    // Maps strains in the frame to strains in Cartesian axes.
    #[rustfmt::skip]
    let back = Matrix3::new(
        cos * cos, sin * sin, -sin * cos,
        sin * sin, cos * cos, sin * cos,
        2.0 * sin * cos, -2.0 * sin * cos, cos * cos - sin * sin,
    );
    back.transpose() * stiffness * back
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEPS: [f64; 2] = [1e-5, 1e-5];

    fn isotropic() -> Matrix3<f64> {
        Matrix3::new(3.0, 1.0, 0.0, 1.0, 3.0, 0.0, 0.0, 0.0, 1.0)
    }

    fn orthotropic() -> Matrix3<f64> {
        turned(
            &Matrix3::new(9.0, 1.0, 0.0, 1.0, 3.0, 0.0, 0.0, 0.0, 0.8),
            [0.8, 0.6],
        )
    }

    fn at(field: &NearField, mode: usize, x: [f64; 2]) -> [f64; 2] {
        field.displacement(mode, x[0].hypot(x[1]), x[1].atan2(x[0]))
    }

    fn gradient(field: &NearField, mode: usize, x: [f64; 2]) -> Gradient {
        field.gradients(x[0].hypot(x[1]), x[1].atan2(x[0]))[mode]
    }

    fn both(test: impl Fn(&NearField, usize)) {
        for stiffness in [isotropic(), orthotropic()] {
            let field = NearField::new(stiffness).unwrap();
            test(&field, 0);
            test(&field, 1);
        }
    }

    #[test]
    fn gradients_are_those_of_the_displacement() {
        both(|field, mode| {
            for x in [[0.3, 0.7], [-0.5, 0.2], [-0.4, -0.9], [1.0, 0.0]] {
                let exact = gradient(field, mode, x);
                for (axis, step) in STEPS.iter().enumerate() {
                    let ends = [*step, -step].map(|h| {
                        let mut there = x;
                        there[axis] += h;
                        at(field, mode, there)
                    });
                    for i in 0..2 {
                        let slope = (ends[0][i] - ends[1][i]) / (2.0 * step);
                        assert!((slope - exact[i][axis]).abs() < 1e-9);
                    }
                }
            }
        });
    }

    #[test]
    fn stresses_are_balanced_and_leave_the_faces_free() {
        both(|field, mode| {
            let stress = |x| field.stress(&gradient(field, mode, x));
            for x in [[0.3, 0.7], [-0.5, 0.2], [0.4, -0.9]] {
                let slope = |axis: usize| {
                    let ends = [1e-5, -1e-5].map(|h| {
                        let mut there = x;
                        there[axis] += h;
                        stress(there)
                    });
                    (ends[0] - ends[1]) / 2e-5
                };
                let [by_x, by_y] = [slope(0), slope(1)];
                assert!((by_x[0] + by_y[2]).abs() < 1e-8);
                assert!((by_x[2] + by_y[1]).abs() < 1e-8);
            }
            for angle in [PI, -PI] {
                let on_face = field.stress(&field.gradients(0.5, angle)[mode]);
                assert!(on_face[1].abs() < 1e-12 && on_face[2].abs() < 1e-12);
            }
        });
    }

    #[test]
    fn factors_are_those_of_the_stress_ahead_and_release_the_energy_of_closing() {
        both(|field, mode| {
            let ahead = field.stress(&field.gradients(0.5, 0.0)[mode]);
            let expected = 1.0 / PI.sqrt();
            assert!((ahead[1 + mode] - expected).abs() < 1e-12);
            assert!(ahead[2 - mode].abs() < 1e-12);
            // Irwin's integral over the length d: ½ ∫ σ(r) Δu(d − r) dr / d = K Δf √(π/2) / 8 · 2, with
            // ∫ √((d − r)/r) = π d/2.
            let [above, below] = [PI, -PI].map(|angle| field.shapes(angle)[mode]);
            let opening = |i: usize| above[i][0] - below[i][0];
            let released = 0.5 * (PI / 2.0) * opening(1 - mode) / (2.0 * PI).sqrt();
            let h = field.compliance()[(mode, mode)];
            assert!((released - h).abs() < 1e-9 * h, "{released} {h}");
        });
    }

    #[test]
    fn nearly_isotropic_materials_have_nearly_isotropic_fields() {
        let mut stiffness = isotropic();
        stiffness[(0, 0)] *= 1.0 + 1e-4;
        let [near, exact] = [stiffness, isotropic()].map(|c| NearField::new(c).unwrap());
        for mode in 0..2 {
            for angle in [-PI, -1.0, 0.0, 2.0, PI] {
                let fields = [&near, &exact].map(|f| f.gradients(0.3, angle)[mode]);
                let [near, exact] = fields.map(|of| of.concat());
                for (a, b) in near.iter().zip(exact) {
                    assert!((a - b).abs() < 1e-3);
                }
            }
            let h = [&near, &exact].map(|f| f.compliance()[(mode, mode)]);
            assert!((h[0] - h[1]).abs() < 1e-3 * h[1]);
        }
    }
}
