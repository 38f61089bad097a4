//! The nodes of a block that have a frame of their own.

use std::collections::BTreeSet;

use contact_dd_partition::element::geometry::length;

use super::frame::{Frame, support_frames};
use super::load::BlockLoads;
use super::owned::OwnedBlock;

/// The frames of those nodes that have one of their own.
#[derive(Clone, Debug)]
pub struct NodeFrames {
    nodes: Vec<u32>,
    frames: Vec<Frame>,
    place: Vec<u32>,
}

impl NodeFrames {
    /// Frames of supported nodes, and of nodes of contact points along the first one's normal.
    pub fn new(owned: &OwnedBlock, loads: &BlockLoads) -> Self {
        let OwnedBlock { block, points } = owned;
        let mut frames = support_frames(&loads.supports, block.dim);
        let shared: BTreeSet<u32> = match points[..] {
            [] => Default::default(),
            _ => block.interface.iter().map(|&(node, _)| node).collect(),
        };
        for point in points {
            for (node, push) in point.row() {
                let norm = length(push);
                if norm > 0.0 && !shared.contains(&node) {
                    let direction = push.map(|c| c / norm);
                    frames
                        .entry(node)
                        .or_insert_with(|| Frame::along(&[direction], block.dim));
                }
            }
        }
        let mut place = vec![u32::MAX; block.nodes()];
        for (k, &node) in frames.keys().enumerate() {
            place[node as usize] = k as u32;
        }
        Self {
            place,
            nodes: frames.keys().copied().collect(),
            frames: frames.into_values().collect(),
        }
    }

    /// The nodes with a frame of their own, ascending, and the frames.
    pub fn special(&self) -> impl Iterator<Item = (u32, &Frame)> {
        self.nodes.iter().copied().zip(&self.frames)
    }

    /// The frame of a node; `None` where that is the coordinates', free.
    pub fn of(&self, node: u32) -> Option<&Frame> {
        self.frames.get(self.place[node as usize] as usize)
    }
}
