//! Node frames: the axes along which a node's displacement is prescribed or free.

use std::collections::BTreeMap;

use super::block::Block;
use crate::vector::axpy;
use contact_dd_partition::element::geometry::{dot, length};
use contact_dd_partition::model::Support;

/// An orthonormal frame of a node. Its displacement is u = Σ v_k·axis_k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Axes; the first `dim` are used.
    pub axes: [[f64; 3]; 3],
    /// Prescribed displacement along each axis; `None` where it is free.
    pub prescribed: [Option<f64>; 3],
}

impl Frame {
    /// The Cartesian frame, free.
    pub const CARTESIAN: Self = Self {
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        prescribed: [None; 3],
    };

    /// A free frame whose first axes are the orthonormal `directions`.
    pub fn along(directions: &[[f64; 3]], dim: usize) -> Self {
        let mut frame = Self::CARTESIAN;
        let mut filled = 0;
        for &direction in directions.iter().take(dim) {
            frame.axes[filled] = direction;
            filled += 1;
        }
        while filled < dim {
            frame.axes[filled] = frame.completion(filled, dim);
            filled += 1;
        }
        frame
    }

    /// A unit vector orthogonal to the first `filled` axes, from the coordinate axis with the smallest component in
    /// their span.
    fn completion(&self, filled: usize, dim: usize) -> [f64; 3] {
        let share = |e: usize| -> f64 { self.axes[..filled].iter().map(|a| a[e] * a[e]).sum() };
        let mut least = 0;
        for e in 1..dim {
            if share(e) < share(least) {
                least = e;
            }
        }
        let mut axis = [0.0; 3];
        axis[least] = 1.0;
        // The second pass of Gram-Schmidt removes the round-off of the first; two are enough.
        for _ in 0..2 {
            for a in &self.axes[..filled] {
                let along = dot(*a, axis);
                axpy(-along, a, &mut axis);
            }
        }
        let norm = length(axis);
        axis.map(|x| x / norm)
    }
}

/// The non-Cartesian frames of nodes of `block`: those with `supports`, and those that slide without supports, whose
/// normal comes first.
pub fn node_frames(block: &Block, supports: &[Support]) -> BTreeMap<u32, Frame> {
    let mut frames = support_frames(supports, block.dim);
    for (&node, &normal) in &block.slides {
        let along = || Frame::along(&[normal], block.dim);
        frames.entry(node).or_insert_with(along);
    }
    frames
}

/// The frames of all nodes with supports; the rows of a node are orthonormal.
pub fn support_frames(supports: &[Support], dim: usize) -> BTreeMap<u32, Frame> {
    let mut rows: BTreeMap<u32, Vec<&Support>> = BTreeMap::new();
    for support in supports {
        rows.entry(support.node).or_default().push(support);
    }
    rows.into_iter()
        .map(|(node, rows)| {
            let directions: Vec<[f64; 3]> = rows.iter().map(|s| s.direction).collect();
            let mut frame = Frame::along(&directions, dim);
            for (k, support) in rows.iter().enumerate() {
                frame.prescribed[k] = Some(support.value);
            }
            (node, frame)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_orthonormal_whatever_its_first_axis() {
        for k in 0..40 {
            let phi = 0.17 * k as f64;
            let d = [phi.cos() * 0.6, phi.sin() * 0.6, 0.8];
            let frame = Frame::along(&[d], 3);
            for a in 0..3 {
                for b in 0..3 {
                    let exact = if a == b { 1.0 } else { 0.0 };
                    assert!((dot(frame.axes[a], frame.axes[b]) - exact).abs() < 1e-15);
                }
            }
        }
    }

    #[test]
    fn two_supports_hold_a_plane_node() {
        let support = |direction, value| Support {
            node: 4,
            direction,
            value,
            condition: 0,
        };
        let frames = support_frames(
            &[support([0.0, 1.0, 0.0], 2.0), support([1.0, 0.0, 0.0], 1.0)],
            2,
        );
        assert_eq!(frames[&4].prescribed[..2], [Some(2.0), Some(1.0)]);
    }
}
