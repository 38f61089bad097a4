//! Rigid motions on the clusters' shared unknowns.

use std::collections::{BTreeMap, BTreeSet};

use contact_dd_partition::id::MergeRootId;
use contact_dd_partition::numbered::Numbered;
use faer::Mat;
use serde::{Deserialize, Serialize};

use crate::bddc::classes::Class;
use crate::context::Context;
use crate::fem::body_frame::BodyFrame;
use crate::fem::frame::{Frame, node_frames};
use crate::schur::condensed::InterfaceDof;

/// Part of a motion, relative to the largest one, below which it counts as dependent.
const DEPENDENT: f64 = 1e-3;

/// Positions of the clusters' shared nodes, and the axes of their unknowns, on all ranks.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct SharedNodes {
    dim: usize,
    /// Position (m) and axes, by the number on Γ.
    nodes: BTreeMap<u32, ([f64; 3], [[f64; 3]; 3])>,
}

impl SharedNodes {
    /// The shared nodes of clusters with these `dofs`. Collective.
    pub fn new(context: &Context<'_>, dofs: &Numbered<MergeRootId, Vec<InterfaceDof>>) -> Self {
        let comm = context.comm;
        let sought: BTreeSet<u32> = dofs.iter().flatten().map(|dof| dof.node).collect();
        let mut nodes = BTreeMap::new();
        for block in context.blocks.values() {
            let supports: Vec<_> = block.subdomain.supports_in(0).collect();
            let frames = node_frames(block, &supports);
            for &(node, number) in &block.interface {
                if sought.contains(&number) {
                    let frame = frames.get(&node).unwrap_or(&Frame::CARTESIAN);
                    let axes = match (node as usize) < block.body_nodes() {
                        true => frame.axes,
                        // Rigid motions of bodies don't move the nodes between them.
                        false => [[0.0; 3]; 3],
                    };
                    nodes.insert(number, (block.points()[node as usize], axes));
                }
            }
        }
        let mut shared = Self {
            dim: context.catalog.dim,
            nodes: comm.collect(&nodes).into_iter().flatten().collect(),
        };
        comm.broadcast(&mut shared);
        shared
    }

    /// Independent rigid motions of the unknowns of a class, one per column.
    pub fn motions_of(&self, class: &Class) -> Mat<f64> {
        let at = |dof: &InterfaceDof| &self.nodes[&dof.node];
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for dof in &class.dofs {
            for (k, x) in at(dof).0.into_iter().enumerate() {
                (low[k], high[k]) = (low[k].min(x), high[k].max(x));
            }
        }
        let frame = BodyFrame::new(low, high);
        let size = if frame.size > 0.0 { frame.size } else { 1.0 };
        let frame = BodyFrame { size, ..frame };
        let action = |dof: &InterfaceDof| {
            let (x, axes) = at(dof);
            frame.action(self.dim, x, &axes[dof.axis as usize])
        };
        let rows: Vec<Vec<f64>> = class.dofs.iter().map(action).collect();
        let count = BodyFrame::count(self.dim);
        let column = |j: usize| class.turn(rows.iter().map(|row| row[j]).collect());
        let columns: Vec<Vec<f64>> = (0..count).map(column).collect();
        let motions = Mat::from_fn(class.size(), count, |i, j| columns[j][i]);
        let qr = motions.col_piv_qr();
        let diagonal: Vec<f64> = (0..count.min(class.size()))
            .map(|i| qr.R()[(i, i)].abs())
            .collect();
        let rank = diagonal
            .iter()
            .take_while(|r| **r > DEPENDENT * diagonal[0]);
        qr.compute_thin_Q().subcols(0, rank.count()).to_owned()
    }
}
