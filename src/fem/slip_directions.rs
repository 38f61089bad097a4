//! The tangents along which contact points can slip, where supports hold nodes around them.
//!
//! On a plane of symmetry a point slips along one line alone. Its normal is that of a mesh, so it leaves the plane by as
//! much as facets differ from the surface, and the nodes opposite have a small part in the jump out of the plane. As a
//! condition of its own that jump would be a thousandth or less of a displacement, as stiff as the square of its inverse: a
//! limit that nothing but round-off decides.

use std::array::from_fn;
use std::collections::BTreeMap;

use super::contact_group::{Condition, ContactGroup};
use super::frame::Frame;
use crate::contact::jumps::JumpRow;

/// Square of a row, relative to that of another one, that is round-off.
const NO_ROW: f64 = 1e-28;
/// The same of what supports that prescribe no displacement leave of a row: a tangent along which the jump is up to a
/// thousandth of the displacements is none.
const HELD: f64 = 1e-6;
/// No tangent.
const NONE: [f64; 3] = [0.0; 3];

impl ContactGroup {
    /// Turns the tangents of points around which supports hold nodes. Where a point can slip but along one direction of a
    /// plane, that is the first, so that there is no condition along the second; where it can't at all it has none. What
    /// the normal jump alone moves along a tangent, where the normal isn't along what is held, is no slip.
    pub(super) fn take_slip_directions(&mut self) {
        let frames = self.frames();
        for point in 0..self.points.len() {
            if let Some(tangents) = self.slip_directions(point, &frames) {
                self.points[point].frame.tangents = tangents;
            }
        }
    }

    /// The tangents along which a point can slip, where that aren't all of its frame.
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

    /// True if supports hold nodes of a point, and prescribe no displacement but 0.
    fn is_held_fast(&self, point: usize) -> bool {
        let nodes = self.points[point].entries.iter();
        let mut nodes = nodes.map(|(node, _)| &self.nodes[*node as usize]);
        let mut supports = nodes.clone().flat_map(|node| &node.supports);
        nodes.any(|node| !node.is_auxiliary && !node.supports.is_empty())
            && supports.all(|(_, values)| values.iter().all(|&value| value == 0.0))
    }
}

/// Cosine and sine of the angle by which rows are to be turned so that the square of the second is at most `negligible`;
/// `None` where both are needed or nothing already, or one is.
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

    /// A node of a plane of symmetry, z = 0, under a normal that leaves it by `tilt`, before one of that plane and one beside
    /// it, of which the latter has the weight `beside`.
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
