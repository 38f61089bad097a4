//! Tangents along which contact points can slip, where supports constrain nodes around them.
//!
//! On a plane of symmetry a point slips along one line only. As its normal is that of the mesh, which deviates from the
//! surface, it points out of the plane slightly, and the opposite nodes have a small component in the jump out of the
//! plane. As a constraint of its own, that jump would be a thousandth of a displacement or less, with a stiffness that
//! grows with the inverse square: round-off alone would determine its status.

use std::array::from_fn;
use std::collections::BTreeMap;

use super::contact_group::{Condition, ContactGroup};
use super::frame::Frame;
use crate::contact::jumps::JumpRow;

/// Square of a row, relative to that of another one, that is round-off.
const NO_ROW: f64 = 1e-28;
/// Square of the part of a row left free by supports that prescribe zero displacement, relative to the row, that is
/// round-off: a tangent counts as constrained if the jump along it is at most a thousandth of the displacements.
const HELD: f64 = 1e-6;
/// No tangent.
const NONE: [f64; 3] = [0.0; 3];

impl ContactGroup {
    /// Rotates the tangents of points around which supports constrain nodes. If a point can slip along one direction
    /// only, that becomes the first tangent, and there is no constraint along the second; if it can't slip at all, it
    /// has no tangents. A tangential jump proportional to the normal jump, where the normal deviates from the
    /// constrained directions, is no slip.
    pub(super) fn take_slip_directions(&mut self) {
        let frames = self.frames();
        for point in 0..self.points.len() {
            if let Some(tangents) = self.slip_directions(point, &frames) {
                self.points[point].frame.tangents = tangents;
            }
        }
    }

    /// The tangents along which a point can slip, if they are not all tangents of its frame.
    fn slip_directions(&self, point: usize, frames: &[Frame]) -> Option<[[f64; 3]; 2]> {
        let of_point = &self.points[point];
        if of_point.law.is_tied() {
            return None;
        }
        let [first, second] = *of_point.tangents(self.dim) else {
            return None;
        };
        let [n, a, b] = [of_point.normal(), first, second].map(|direction| {
            let condition = Condition {
                point,
                direction,
                is_tangential: true,
                is_tied: false,
            };
            self.row(&condition, frames)
        });
        let turned = |x: f64, y: f64| from_fn(|k| x * first[k] + y * second[k]);
        if !self.is_held_fast(point) {
            let round_off = NO_ROW * (product(&a, &a) + product(&b, &b));
            let (cos, sin) = only_direction(&a, &b, round_off)?;
            return Some([turned(cos, sin), turned(-sin, cos)]);
        }
        let of_normal = product(&n, &n).max(f64::MIN_POSITIVE);
        let [a, b] = [a, b].map(|row| less(&row, product(&row, &n) / of_normal, &n));
        let weights = of_point.entries.iter().map(|(_, weight)| weight * weight);
        let negligible = HELD * weights.sum::<f64>();
        match product(&a, &a) + product(&b, &b) <= negligible {
            true => Some([NONE; 2]),
            false => {
                let (cos, sin) = only_direction(&a, &b, negligible)?;
                Some([turned(cos, sin), NONE])
            }
        }
    }

    /// True if supports constrain nodes of a point, with zero prescribed displacement only.
    fn is_held_fast(&self, point: usize) -> bool {
        let nodes = self.points[point].entries.iter();
        let mut nodes = nodes.map(|(node, _)| &self.nodes[*node as usize]);
        let mut supports = nodes.clone().flat_map(|node| &node.supports);
        nodes.any(|node| !node.is_auxiliary && !node.supports.is_empty())
            && supports.all(|(_, values)| values.iter().all(|&value| value == 0.0))
    }
}

/// Cosine and sine of the rotation of two rows after which the square of the second is at most `negligible`; `None` if
/// both rows are needed, or one is zero already.
fn only_direction(a: &JumpRow, b: &JumpRow, negligible: f64) -> Option<(f64, f64)> {
    if a.is_empty() || b.is_empty() {
        return None;
    }
    let (of_a, of_b) = (product(a, a), product(b, b));
    let (sin, cos) = (0.5 * (2.0 * product(a, b)).atan2(of_a - of_b)).sin_cos();
    let rest = less(&scaled(b, cos), sin, a);
    (product(&rest, &rest) <= negligible).then_some((cos, sin))
}

/// Σ a_v b_v.
fn product(a: &JumpRow, b: &JumpRow) -> f64 {
    let at = |v: &u32| b.iter().find(|(w, _)| w == v).map_or(0.0, |(_, c)| *c);
    a.iter().map(|(v, c)| c * at(v)).sum()
}

fn scaled(row: &JumpRow, factor: f64) -> JumpRow {
    row.iter().map(|&(v, c)| (v, factor * c)).collect()
}

/// a − factor·b.
fn less(a: &JumpRow, factor: f64, b: &JumpRow) -> JumpRow {
    let mut sum: BTreeMap<u32, f64> = a.iter().copied().collect();
    for &(v, c) in b {
        *sum.entry(v).or_default() -= factor * c;
    }
    sum.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use contact_dd_partition::contact_point::{ContactPoint, Law, LocalFrame};
    use contact_dd_partition::element::geometry::dot;

    use super::*;
    use crate::fem::contact_node::ContactNode;

    /// Tangents of a node on a plane of symmetry, z = 0, with a normal tilted out of it by `tilt`, opposite a node of
    /// that plane and one beside it, of which the latter has the weight `beside`.
    fn tangents(tilt: f64, beside: f64) -> [[f64; 3]; 2] {
        let node = |interface: u32| ContactNode {
            is_auxiliary: false,
            interface,
            tag: i64::from(interface),
            body: 0,
            at: [0.0; 3],
            stiffness: 1.0,
            supports: match interface {
                2 => Vec::new(),
                _ => vec![([0.0, 0.0, 1.0], vec![0.0, 0.0])],
            },
            slides: None,
        };
        let entries = vec![(0, 1.0), (1, beside - 1.0), (2, -beside)];
        let normal = [0.6, 0.8, tilt];
        let size = dot(normal, normal).sqrt();
        let mut point = ContactPoint::new(entries, normal.map(|c| c / size), [0.0; 3], 0);
        point.law = Law::coulomb(0.3, 0.0);
        point.frame = LocalFrame::new(point.normal());
        let nodes = [0, 1, 2].map(node).to_vec();
        ContactGroup::new(vec![point], nodes, 3).points[0]
            .frame
            .tangents
    }

    #[test]
    fn a_point_on_a_plane_of_symmetry_slips_along_one_line() {
        for (tilt, beside) in [
            (0.0, 0.0),
            (1e-5, 0.0),
            (1e-2, 0.0),
            (3e-5, -2e-5),
            (0.0, 3e-4),
        ] {
            let [first, second] = tangents(tilt, beside);
            assert_eq!(second, [0.0; 3], "{tilt} {beside}");
            let along = dot(first, [0.8, -0.6, 0.0]).abs();
            assert!((along - 1.0).abs() < 1e-7, "{tilt} {beside}: {along}");
        }
    }

    #[test]
    fn a_point_before_nodes_beside_the_plane_slips_along_both_tangents() {
        let [first, second] = tangents(1e-2, 0.05);
        assert!((dot(first, first) - 1.0).abs() < 1e-14);
        assert!((dot(second, second) - 1.0).abs() < 1e-14);
    }
}
