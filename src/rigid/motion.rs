//! Rigid motions z of a body: translations, and rotations ω × (x − x_0) about its center scaled by its size.

use contact_dd_partition::element::geometry::cross;
use serde::{Deserialize, Serialize};

/// The frame in which the rigid motions of a body are written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyFrame {
    /// Center of the body's bounding box (m).
    pub center: [f64; 3],
    /// Half its diagonal (m).
    pub size: f64,
}

impl BodyFrame {
    /// The frame of a body within these bounds.
    pub fn new(low: [f64; 3], high: [f64; 3]) -> Self {
        let center = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
        let size = (0..3)
            .map(|k| (0.5 * (high[k] - low[k])).powi(2))
            .sum::<f64>()
            .sqrt();
        Self { center, size }
    }

    /// Number of rigid motions in `dim` dimensions.
    pub fn count(dim: usize) -> usize {
        dim + dim * (dim - 1) / 2
    }

    /// `force` at `x` against every rigid motion: the components of the force, then its moments
    /// over the body's size. Also the row of a condition `force`·u.
    pub fn action(&self, dim: usize, x: &[f64; 3], force: &[f64; 3]) -> Vec<f64> {
        let r: [f64; 3] = std::array::from_fn(|k| (x[k] - self.center[k]) / self.size);
        let moment = cross(r, *force);
        let mut action = force[..dim].to_vec();
        // In the plane the only rotation is about the third axis, which comes first here.
        for k in [2, 0, 1] {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            if i < dim && j < dim {
                action.push(moment[k]);
            }
        }
        action
    }

    /// The displacement at `x` of the rigid motion with coefficients `z`.
    pub fn displacement(&self, dim: usize, x: &[f64; 3], z: &[f64]) -> [f64; 3] {
        let mut u = [0.0; 3];
        for (component, u) in u.iter_mut().enumerate().take(dim) {
            let mut unit = [0.0; 3];
            unit[component] = 1.0;
            let action = self.action(dim, x, &unit);
            *u = action.iter().zip(z).map(|(a, z)| a * z).sum();
        }
        u
    }

    /// How each rigid motion moves `x`.
    pub fn moves(&self, dim: usize, x: &[f64; 3]) -> Vec<[f64; 3]> {
        let mut moves = vec![[0.0; 3]; Self::count(dim)];
        for component in 0..dim {
            let mut unit = [0.0; 3];
            unit[component] = 1.0;
            for (moves, action) in moves.iter_mut().zip(self.action(dim, x, &unit)) {
                moves[component] = action;
            }
        }
        moves
    }

    /// A motion in words.
    pub fn describe(&self, dim: usize, z: &[f64]) -> String {
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (translation, rotation) = z.split_at(dim);
        if norm(rotation) <= 1e-6 * norm(translation) {
            let length = norm(translation);
            let along: Vec<String> = translation
                .iter()
                .map(|t| format!("{:.4}", (1e4 * t / length).round() / 1e4 + 0.0))
                .collect();
            return format!("translation along ({})", along.join(", "));
        }
        if dim == 2 {
            let omega = rotation[0] / self.size;
            let x = self.center[0] - translation[1] / omega;
            let y = self.center[1] + translation[0] / omega;
            // Digits below a ten thousandth of the body are round-off.
            let digits = (4.0 - self.size.log10().floor()).clamp(0.0, 30.0) as usize;
            let step = 10.0_f64.powi(-(digits as i32));
            let [x, y] = [x, y].map(|c| (c / step).round() * step + 0.0);
            return format!("rotation about ({x:.digits$}, {y:.digits$})");
        }
        "rotation".into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_works_on_a_motion_what_its_action_says() {
        let frame = BodyFrame::new([1.0, 2.0, -1.0], [4.0, 3.0, 5.0]);
        let (x, force) = ([3.0, 2.2, 0.7], [0.3, -1.1, 0.6]);
        for dim in [2, 3] {
            let z: Vec<f64> = (0..BodyFrame::count(dim))
                .map(|i| (i as f64).cos())
                .collect();
            let u = frame.displacement(dim, &x, &z);
            let work: f64 = (0..dim).map(|k| u[k] * force[k]).sum();
            let action = frame.action(dim, &x, &force);
            let same: f64 = action.iter().zip(&z).map(|(a, z)| a * z).sum();
            assert!((work - same).abs() < 1e-14);
        }
    }

    #[test]
    fn the_point_that_a_rotation_is_about_stays() {
        let frame = BodyFrame::new([0.0, 0.0, 0.0], [2.0, 4.0, 0.0]);
        // Rotation about (3, −1): u = (−(y + 1), x − 3).
        let about = |x: f64, y: f64| [-(y + 1.0), x - 3.0];
        let center = about(1.0, 2.0);
        let z = [center[0], center[1], frame.size];
        let u = frame.displacement(2, &[0.5, 0.25, 0.0], &z);
        assert!((u[0] - about(0.5, 0.25)[0]).abs() < 1e-14);
        assert!((u[1] - about(0.5, 0.25)[1]).abs() < 1e-14);
        assert_eq!(frame.describe(2, &z), "rotation about (3.0000, -1.0000)");
        let small = BodyFrame::new([-0.01, -0.01, 0.0], [0.01, 0.01, 0.0]);
        assert_eq!(
            small.describe(2, &[-1e-19, 2e-19, 1.0]),
            "rotation about (0.000000, 0.000000)"
        );
        assert_eq!(
            frame.describe(2, &[0.0, -2.0, 0.0]),
            "translation along (0.0000, -1.0000)"
        );
    }
}
