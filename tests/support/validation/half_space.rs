//! The elastic half space under a ball and under a flat round punch.

use std::f64::consts::PI;

use nalgebra::Complex;

use super::exact::Exact;

/// P.
pub const LOAD: f64 = 10.0;
pub const POISSON: f64 = 0.3;
/// E/(1 − ν²).
pub const STIFFNESS: f64 = 200.0 / (1.0 - POISSON * POISSON);

type C = Complex<f64>;

/// Terms of the stress at a point of the half space: derivatives of F, and of Φ with Φ_z = F, over r where these are
/// finite on the axis.
pub struct Potential {
    f_z: f64,
    f_zz: f64,
    f_rz: f64,
    f_r_by_r: f64,
    phi_r_by_r: f64,
}

impl Potential {
    /// (σ_rr, σ_yy, σ_hoop, σ_ry) at the depth z, with y upwards.
    fn stress(&self, z: f64) -> [f64; 4] {
        let two_nu = 2.0 * POISSON;
        let f_rr = -self.f_zz - self.f_r_by_r;
        let phi_rr = -self.f_z - self.phi_r_by_r;
        [
            -two_nu * self.f_z + (1.0 - two_nu) * phi_rr + z * f_rr,
            -self.f_z + z * self.f_zz,
            -two_nu * self.f_z + (1.0 - two_nu) * self.phi_r_by_r + z * self.f_r_by_r,
            -z * self.f_rz,
        ]
    }
}

/// R, ζ and R + ζ.
fn complex([r, z]: [f64; 2], a: f64) -> [C; 3] {
    let zeta = C::new(z, a);
    let mut root = (zeta * zeta + r * r).sqrt();
    if root.im < 0.0 {
        root = -root;
    }
    [root, zeta, root + zeta]
}

/// The radius of the contact.
pub fn radius() -> f64 {
    (0.75 * LOAD * 8.0 / STIFFNESS).cbrt()
}

/// The pressure at the centre.
pub fn peak() -> f64 {
    1.5 * LOAD / (PI * radius().powi(2))
}

/// The potential under a ball.
pub fn of_ball([r, z]: [f64; 2]) -> Potential {
    let (a, i) = (radius(), C::i());
    let [root, zeta, w] = complex([r, z], a);
    let (ln, ia, scale) = (w.ln(), i * a, -peak() / a);
    let of = |value: C| scale * value.im;
    let thirds = (root * root + root * zeta + zeta * zeta) / (w * 3.0);
    Potential {
        f_z: of(ln * z - root),
        f_zz: of(ln - ia / root),
        f_rz: of(-(w.inv() + ia / (root * w)) * r),
        f_r_by_r: of(-(zeta / w + ln) * 0.5 + ia / w),
        phi_r_by_r: of(-(thirds + zeta * ln - root) * 0.5 + ia * 0.5 * (zeta / w + ln)),
    }
}

/// The potential under a flat punch of radius 1.
pub fn of_punch([r, z]: [f64; 2]) -> Potential {
    let [root, zeta, w] = complex([r, z], 1.0);
    let of = |value: C| -LOAD / (2.0 * PI) * value.im;
    let cube = root * root * root;
    Potential {
        f_z: of(root.inv()),
        f_zz: of(-zeta / cube),
        f_rz: of(-cube.inv() * r),
        f_r_by_r: of((root * w).inv()),
        phi_r_by_r: of(-w.inv()),
    }
}

/// The potential under a force at the origin.
pub fn of_force([r, z]: [f64; 2]) -> Potential {
    let factor = LOAD / (2.0 * PI);
    let far = r.hypot(z);
    let cube = far.powi(3);
    Potential {
        f_z: factor * z / cube,
        f_zz: factor * (1.0 / cube - 3.0 * z * z / far.powi(5)),
        f_rz: -factor * 3.0 * r * z / far.powi(5),
        f_r_by_r: factor / cube,
        phi_r_by_r: -factor / (far * (far + z)),
    }
}

/// Displacement of the axis at a depth z under the punch.
pub fn depth(z: f64) -> f64 {
    let [root, _, w] = complex([0.0, z], 1.0);
    let of = |value: C| -LOAD / (2.0 * PI) * value.im;
    let shear = 100.0 / (1.0 + POISSON);
    (-2.0 * (1.0 - POISSON) * of(w.ln()) + z * of(root.inv())) / (2.0 * shear)
}

/// The stress of the half space y ≤ 0 around the axis y, mirrored above.
pub fn ring(potential: fn([f64; 2]) -> Potential) -> Exact {
    Exact::Ring(Box::new(move |[x, y]| {
        let [rr, yy, hoop, ry] = potential([x, y.abs()]).stress(y.abs());
        [rr, yy, hoop, if y > 0.0 { -ry } else { ry }]
    }))
}

/// The stress of the half space z ≤ 0 around the axis z, mirrored above.
pub fn space(potential: fn([f64; 2]) -> Potential) -> Exact {
    Exact::Space(Box::new(move |[x, y, z]| {
        let r = x.hypot(y);
        let [rr, zz, hoop, rz] = potential([r, z.abs()]).stress(z.abs());
        let rz = if z > 0.0 { -rz } else { rz };
        let [cos, sin] = if r > 0.0 { [x / r, y / r] } else { [1.0, 0.0] };
        [
            rr * cos * cos + hoop * sin * sin,
            rr * sin * sin + hoop * cos * cos,
            zz,
            rz * sin,
            rz * cos,
            (rr - hoop) * sin * cos,
        ]
    }))
}
