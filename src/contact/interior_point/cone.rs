//! The cone of a point with given friction: its slip v under |v| ≤ τ, its force under |λ_t| ≤ b.
//!
//! x = (τ, v) and z = (b, −λ_t) are in the cone x₀ ≥ |x₁₂|, and x·z = 0 is the law of friction. The symmetric matrix W
//! with W z = W⁻¹ x makes the linear equations of a step symmetric.
//!
//! Yu. Nesterov, M. Todd, *Primal-dual interior-point methods for self-scaled cones*, SIAM J. Optim. 8 (1998).

/// Smallest x₀ − |x₁₂| relative to x₀.
const BOUNDARY: f64 = 1e-16;

/// A vector of the cone.
type Vector = [f64; 3];

/// x and z of a point, or a step of them.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// (τ, v).
    pub x: Vector,
    /// (b, −λ_t).
    pub z: Vector,
}

/// W = η (2 v vᵀ − J) and what follows from it, J = diag(1, −1, −1).
#[derive(Debug)]
pub struct Scaling {
    x: Vector,
    w: [Vector; 3],
    inverse: [Vector; 3],
    /// W z.
    scaled: Vector,
    /// (W²)₀₁ and (W²)₀₂.
    head: [f64; 2],
    /// Stiffness against a change of the slip, the inverse of the rest of W².
    pub stiffness: [[f64; 2]; 2],
}

impl Cone {
    /// x·z, at least 0.
    pub fn product(&self) -> f64 {
        dot(&self.x, &self.z).max(0.0)
    }

    /// Length of a step to the boundary of either cone.
    pub fn reach(&self, step: &Self) -> f64 {
        reach(&self.x, &step.x).min(reach(&self.z, &step.z))
    }

    /// The point after this share of a step.
    pub fn moved(&self, step: &Self, share: f64) -> Self {
        let moved = |a: &Vector, by: &Vector| [0, 1, 2].map(|i| a[i] + share * by[i]);
        Self {
            x: moved(&self.x, &step.x),
            z: moved(&self.z, &step.z),
        }
    }

    /// W at this point. W² = η² (2 w wᵀ − J); sums are arranged so that little cancels near the boundary.
    pub fn scaling(&self) -> Scaling {
        let ([x, [of_x, ..]], [z, [of_z, ..]]) = (normalized(&self.x), normalized(&self.z));
        let gamma = (0.5 * (1.0 + dot(&x, &z).max(1.0))).sqrt();
        let mean = [x[0] + z[0], x[1] - z[1], x[2] - z[2]].map(|sum| sum / (2.0 * gamma));
        let size = (2.0 * (mean[0] + 1.0)).sqrt();
        let v = [(mean[0] + 1.0) / size, mean[1] / size, mean[2] / size];
        let eta = (of_x / of_z).sqrt();
        let along = |k: usize| (gamma + z[0]) * x[k] + (gamma + x[0]) * z[k];
        let share = 1.0 / (x[0] + z[0] + 2.0 * gamma);
        let scaled = [gamma, share * along(1), share * along(2)];
        let across = mean[1].hypot(mean[2]);
        let [e, f] = match across > 0.0 {
            true => [mean[1] / across, mean[2] / across],
            false => [1.0, 0.0],
        };
        let soft = 1.0 / (1.0 + 2.0 * across * across);
        let stiffness = [
            [e * e * soft + f * f, e * f * (soft - 1.0)],
            [e * f * (soft - 1.0), f * f * soft + e * e],
        ];
        Scaling {
            x: self.x,
            scaled: scaled.map(|s| s * (of_x * of_z).sqrt()),
            head: [mean[1], mean[2]].map(|w| 2.0 * eta * eta * mean[0] * w),
            stiffness: stiffness.map(|row| row.map(|entry| entry / (eta * eta))),
            w: reflection(&v, eta),
            inverse: reflection(&[v[0], -v[1], -v[2]], 1.0 / eta),
        }
    }
}

impl Scaling {
    /// W r for a step to x·z = 0.
    pub fn predictor(&self) -> Vector {
        self.x.map(|x| -x)
    }

    /// W r for a step to the product `aim`, with the second-order term of the step `predicted`.
    pub fn corrector(&self, aim: f64, predicted: &Cone) -> Vector {
        let dx = times(&self.inverse, &predicted.x);
        let dz = times(&self.w, &predicted.z);
        let [head, first, second] = jordan(&dx, &dz);
        let left = [aim - head, -first, -second];
        let s = &self.scaled;
        let across = s[1].hypot(s[2]);
        let determinant = (s[0] - across).max(BOUNDARY * s[0]) * (s[0] + across);
        let head = (s[0] * left[0] - s[1] * left[1] - s[2] * left[2]) / determinant;
        let along = |k: usize| (left[k] - head * s[k]) / s[0];
        let change = times(&self.w, &[head, along(1), along(2)]);
        [0, 1, 2].map(|i| change[i] - self.x[i])
    }

    /// stiffness · slip.
    pub fn pushed(&self, slip: [f64; 2]) -> [f64; 2] {
        self.stiffness
            .map(|row| row[0] * slip[0] + row[1] * slip[1])
    }

    /// The step with this W r and this change of the slip; b stays.
    pub fn step(&self, target: &Vector, slip: [f64; 2]) -> Cone {
        let [first, second] = self.pushed([target[1] - slip[0], target[2] - slip[1]]);
        let head = self.head[0] * first + self.head[1] * second;
        Cone {
            x: [target[0] - head, slip[0], slip[1]],
            z: [0.0, first, second],
        }
    }
}

fn dot(x: &Vector, y: &Vector) -> f64 {
    x[0] * y[0] + x[1] * y[1] + x[2] * y[2]
}

fn times(matrix: &[Vector; 3], x: &Vector) -> Vector {
    [0, 1, 2].map(|i| dot(&matrix[i], x))
}

/// The product x∘y of the cone's Jordan algebra.
fn jordan(x: &Vector, y: &Vector) -> Vector {
    [
        dot(x, y),
        x[0] * y[1] + y[0] * x[1],
        x[0] * y[2] + y[0] * x[2],
    ]
}

/// √(x₀² − |x₁₂|²).
fn size(x: &Vector) -> f64 {
    let across = x[1].hypot(x[2]);
    ((x[0] - across).max(BOUNDARY * x[0]) * (x[0] + across)).sqrt()
}

/// x over its size, and the size.
fn normalized(x: &Vector) -> [Vector; 2] {
    let size = size(x);
    let [first, second] = [x[1] / size, x[2] / size];
    let head = (1.0 + first * first + second * second).sqrt();
    [[head, first, second], [size; 3]]
}

/// ratio·(2 v vᵀ − J) with J = diag(1, −1, −1).
fn reflection(v: &Vector, ratio: f64) -> [Vector; 3] {
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| {
            let mirror = match (i == j, i) {
                (true, 0) => 1.0,
                (true, _) => -1.0,
                (false, _) => 0.0,
            };
            ratio * (2.0 * v[i] * v[j] - mirror)
        })
    })
}

/// Largest α with x + α step in the cone.
fn reach(x: &Vector, step: &Vector) -> f64 {
    let a = step[0] * step[0] - step[1] * step[1] - step[2] * step[2];
    let b = x[0] * step[0] - x[1] * step[1] - x[2] * step[2];
    let c = size(x).powi(2);
    let mut reach = match step[0] < 0.0 {
        true => -x[0] / step[0],
        false => f64::INFINITY,
    };
    let discriminant = b * b - a * c;
    if discriminant >= 0.0 {
        let q = -(b + discriminant.sqrt().copysign(b));
        for root in [q / a, c / q] {
            if root > 0.0 {
                reach = reach.min(root);
            }
        }
    }
    reach
}
