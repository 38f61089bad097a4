//! Rigid-body motions z: translations, and rotations ω × (x − x_0) about the body's center x_0, scaled by its size.

use contact_dd_partition::element::geometry::{cross, dot, length};
use contact_dd_partition::scene::units::Units;
use serde::{Deserialize, Serialize};

use crate::vector::axpy;

/// Size of a body over its distance from the axis of a rotation, up to which the motion is described as a translation:
/// normals of contacts that differ in their last digits turn a body by that little while it slides straight.
const FAR: f64 = 1e-4;

/// The frame in which a body's rigid motions are expressed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyFrame {
    /// Center of the body's bounding box (m).
    pub center: [f64; 3],
    /// Half the diagonal of that box (m).
    pub size: f64,
}

impl BodyFrame {
    /// The frame of a body with this bounding box.
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

    /// Work of `force` at `x` in every rigid motion: the components of the force, then its moments over the body's
    /// size. It is also the row of a constraint `force`·u.
    pub fn action(&self, dim: usize, x: &[f64; 3], force: &[f64; 3]) -> Vec<f64> {
        let r: [f64; 3] = std::array::from_fn(|k| (x[k] - self.center[k]) / self.size);
        let moment = cross(r, *force);
        let mut action = force[..dim].to_vec();
        // In the plane the only rotation is about the third axis; that axis comes first in space, too.
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
        for (moves, z) in self.moves(dim, x).iter().zip(z) {
            axpy(*z, moves, &mut u);
        }
        u
    }

    /// Displacement of `x` in each rigid motion.
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

    /// Description of a motion, with the units of coordinates: a rotation about an axis far outside of the body moves it as a translation does.
    pub fn describe(&self, dim: usize, units: Units, z: &[f64]) -> String {
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (translation, rotation) = z.split_at(dim);
        if norm(rotation) <= FAR * norm(translation) {
            let length = norm(translation);
            let along: Vec<f64> = translation.iter().map(|t| t / length).collect();
            return format!("translation along ({})", listed(&along, 4));
        }
        if dim == 2 {
            let omega = rotation[0] / self.size;
            let x = self.center[0] - translation[1] / omega;
            let y = self.center[1] + translation[0] / omega;
            let point = listed(&[x, y], self.digits());
            return format!("rotation about ({point}) {}", units.length());
        }
        // The rotations are about the third axis, the first and the second, in the order of `action`.
        let omega = [rotation[1], rotation[2], rotation[0]].map(|w| w / self.size);
        let rate = length(omega);
        let translation = [translation[0], translation[1], translation[2]];
        // Of both directions of the axis, the one whose first non-negligible component is positive.
        let first = omega.iter().find(|w| w.abs() > 1e-6 * rate);
        let axis = omega.map(|w| w / rate.copysign(first.copied().unwrap_or(rate)));
        let arm = cross(omega, translation).map(|x| x / (rate * rate));
        let through = [0, 1, 2].map(|k| self.center[k] + arm[k]);
        let digits = self.digits();
        let shift = match dot(translation, axis).abs() > 1e-6 * rate * self.size {
            true => " and translation along it",
            false => "",
        };
        format!(
            "rotation about the axis through ({}) {} along ({}){shift}",
            listed(&through, digits),
            units.length(),
            listed(&axis, 4)
        )
    }

    /// Decimal places of a coordinate: below a ten thousandth of the body's size they are round-off.
    fn digits(&self) -> usize {
        (4.0 - self.size.log10().floor()).clamp(0.0, 30.0) as usize
    }
}

/// Numbers with this many decimal places, separated by commas, without −0.
fn listed(numbers: &[f64], digits: usize) -> String {
    let step = 10.0_f64.powi(-(digits as i32));
    let rounded = numbers.iter().map(|c| (c / step).round() * step + 0.0);
    let shown = rounded.map(|c| format!("{c:.digits$}"));
    shown.collect::<Vec<_>>().join(", ")
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
    fn the_axis_that_a_rotation_is_about_stays() {
        let frame = BodyFrame::new([0.0, 0.0, -1.0], [2.0, 4.0, 1.0]);
        let (point, axis) = ([3.0, -1.0, 0.5], [0.6, 0.0, 0.8]);
        let at = |x: [f64; 3]| cross(axis, [0, 1, 2].map(|k| x[k] - point[k]));
        let [x, y, z] = at(frame.center);
        let turn = axis.map(|w| w * frame.size);
        let z = [x, y, z, turn[2], turn[0], turn[1]];
        let u = frame.displacement(3, &[0.5, 0.25, 0.7], &z);
        let exact = at([0.5, 0.25, 0.7]);
        assert!(
            (0..3).all(|k| (u[k] - exact[k]).abs() < 1e-14),
            "{u:?} {exact:?}"
        );
        let through = "(2.0400, -1.0000, -0.7800)";
        let words = frame.describe(3, Units::Metre, &z);
        assert_eq!(
            words,
            format!("rotation about the axis through {through} m along (0.6000, 0.0000, 0.8000)")
        );
        let mut screw = z.map(|z| -z);
        screw[1] += 1.0;
        screw[0] -= 2.0;
        assert!(
            frame
                .describe(3, Units::Metre, &screw)
                .ends_with("translation along it")
        );
        assert_eq!(
            frame.describe(3, Units::Metre, &[0.0, -2.0, 0.0, 0.0, 0.0, 0.0]),
            "translation along (0.0000, -1.0000, 0.0000)"
        );
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
        assert_eq!(
            frame.describe(2, Units::Millimetre, &z),
            "rotation about (3.0000, -1.0000) mm"
        );
        let small = BodyFrame::new([-0.01, -0.01, 0.0], [0.01, 0.01, 0.0]);
        assert_eq!(
            small.describe(2, Units::Metre, &[-1e-19, 2e-19, 1.0]),
            "rotation about (0.000000, 0.000000) m"
        );
        assert_eq!(
            frame.describe(2, Units::Metre, &[0.0, -2.0, 0.0]),
            "translation along (0.0000, -1.0000)"
        );
        // A block that slides straight, but for the last digits of its contacts.
        assert_eq!(
            frame.describe(2, Units::Metre, &[2.0, 0.0, 1e-5]),
            "translation along (1.0000, 0.0000)"
        );
    }
}
