//! The nodes of a block that have a frame of their own.

use std::collections::{BTreeMap, BTreeSet};

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::geometry::length;
use contact_dd_partition::model::Support;

use super::block::Block;
use super::frame::{Frame, support_frames};

/// The frames of those nodes that have one of their own.
#[derive(Clone, Debug)]
pub struct NodeFrames {
    nodes: Vec<u32>,
    frames: Vec<Frame>,
    place: Vec<u32>,
}

impl NodeFrames {
    /// Frames of supported nodes, and of nodes of contact `points` along the first one's normal.
    pub fn new(block: &Block, points: &[ContactPoint<u32>]) -> Self {
        let mut frames = supported_frames(block);
        let shared: BTreeSet<u32> = match points {
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

/// The frames of a block's supported nodes.
pub fn supported_frames(block: &Block) -> BTreeMap<u32, Frame> {
    support_frames(&supports(block), block.dim)
}

/// The supports of a block, by its nodes.
pub fn supports(block: &Block) -> Vec<Support> {
    let of_members = block.members.iter().zip(&block.node_of);
    let all = of_members.flat_map(|(member, node_of)| {
        member.supports.iter().map(|s| Support {
            node: node_of[s.node as usize],
            ..*s
        })
    });
    without_repetition(all.collect())
}

/// Supports of nodes that several members share, once.
fn without_repetition(supports: Vec<Support>) -> Vec<Support> {
    let mut kept: BTreeMap<u32, Vec<Support>> = BTreeMap::new();
    for support in supports {
        let rows = kept.entry(support.node).or_default();
        if !rows.contains(&support) {
            rows.push(support);
        }
    }
    kept.into_values().flatten().collect()
}
