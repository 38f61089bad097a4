//! The certificate: the full discrete problem (1), checked without any Schur complement.
//!
//! > K u − f + Bᵀ λ = 0,   B u ≤ g,   λ ≥ 0,   λᵀ (g − B u) = 0

use std::collections::HashMap;

use contact_dd_partition::element::geometry::{advance, cross, dot, padded};
use serde::Serialize;

use crate::comm::{Message, MessageReader};
use crate::fem::balance::Balance;
use crate::fem::block::Block;
use crate::fem::condition::BlockCondition;
use crate::fem::frame::Frame;
use crate::fem::node_frames::supported_frames;
use crate::vector::{larger, largest};

/// Sum of forces, relative to the terms that they are sums of, that is no load.
const NO_LOAD: f64 = 1e-12;

/// Checks of the full discrete problem, all relative to the scale of what they check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, schemars::JsonSchema)]
pub struct Certificate {
    /// ‖K u − f + Bᵀλ‖∞ / ‖|K||u| + |f| + |Bᵀλ|‖∞.
    pub equilibrium: f64,
    /// ‖K u − f + Bᵀλ‖∞ over the largest load, contact force or reaction at a node: what the
    /// condition of the scene makes of round-off.
    pub equilibrium_of_load: f64,
    /// The largest load at a node over that scale: near 0 where the forces are round-off of a scene
    /// without load, or displacements drive it.
    #[serde(skip)]
    pub load_share: f64,
    /// Largest penetration over the largest displacement.
    pub penetration: f64,
    /// Largest tension in a contact over the load scale.
    pub tension: f64,
    /// Largest product of contact force and gap over the product of their scales.
    pub complementarity: f64,
    /// Sum of loads and reactions over the load scale.
    pub force_balance: f64,
    /// Sum of their moments over the load scale times the size of the scene.
    pub moment_balance: f64,
    /// Largest jump of the displacement across Γ over the largest displacement.
    pub interface_jump: f64,
}

impl Certificate {
    /// For every check the worse of two.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        // What isn't a number is worse than any.
        let worse = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
        Self {
            equilibrium: worse(self.equilibrium, other.equilibrium),
            equilibrium_of_load: worse(self.equilibrium_of_load, other.equilibrium_of_load),
            load_share: worse(self.load_share, other.load_share),
            penetration: worse(self.penetration, other.penetration),
            tension: worse(self.tension, other.tension),
            complementarity: worse(self.complementarity, other.complementarity),
            force_balance: worse(self.force_balance, other.force_balance),
            moment_balance: worse(self.moment_balance, other.moment_balance),
            interface_jump: worse(self.interface_jump, other.interface_jump),
        }
    }
}

/// What a block says of its own part of the solution.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlockCheck {
    /// The number of the node on Γ and the axis of its traces.
    trace_dofs: Vec<(u32, u32)>,
    /// Residual on them, to be summed over the blocks that share them.
    traces: Vec<f64>,
    trace_scale: Vec<f64>,
    /// Largest residual elsewhere, along directions that are free.
    residual: f64,
    scale: f64,
    penetration: f64,
    tension: f64,
    largest_force: f64,
    /// Largest load, contact force or support reaction at a node.
    largest_external: f64,
    /// Largest load at a node.
    largest_load: f64,
    complementarity: f64,
    largest_displacement: f64,
    /// Forces that the bodies' way to rest would cause if it weren't rigid.
    pub rest_scale: f64,
    /// Sum of loads, contact forces and support reactions, and of their absolute values.
    force: [f64; 3],
    force_scale: f64,
    moment: [f64; 3],
    moment_scale: f64,
    /// Displacement on the nodes that it shares.
    shared_nodes: Vec<u32>,
    shared_displacement: Vec<f64>,
}

impl BlockCheck {
    /// Checks displacements `u`, node by node, and contact `forces`, one a condition.
    pub fn new(
        block: &Block,
        conditions: &[BlockCondition],
        balance: &Balance,
        u: &[f64],
        forces: &[f64],
    ) -> Self {
        let mut check = Self {
            largest_displacement: largest(u),
            largest_load: balance.largest_load,
            ..Self::default()
        };
        check.equilibrium(block, balance);
        check.contact(block.dim, conditions, u, forces);
        for &(node, id) in &block.interface {
            check.shared_nodes.push(id);
            let start = node as usize * block.dim;
            check
                .shared_displacement
                .extend_from_slice(&u[start..start + block.dim]);
        }
        check
    }

    fn equilibrium(&mut self, block: &Block, balance: &Balance) {
        let dim = block.dim;
        let frames = supported_frames(block);
        let mut frames = frames.iter().peekable();
        let is_shared = block.is_on_interface();
        // Residual and scale along the free axes of nodes on Γ, in the order of nodes.
        let mut of_trace = Vec::new();
        let mut first_trace = vec![
            0..0;
            if block.interface.is_empty() {
                0
            } else {
                block.nodes()
            }
        ];
        let vector = |values: &[f64], node: usize| padded(&values[node * dim..(node + 1) * dim]);
        for node in 0..block.nodes() {
            let frame = frames
                .next_if(|(supported, _)| **supported as usize == node)
                .map_or(&Frame::CARTESIAN, |(_, frame)| frame);
            let residual = vector(&balance.residual, node);
            let scale = vector(&balance.scale, node);
            let mut force = vector(&balance.external, node);
            self.force_scale += force.iter().map(|f| f.abs()).sum::<f64>();
            self.largest_external = force
                .iter()
                .fold(self.largest_external, |m, &f| larger(m, f));
            let first = of_trace.len();
            for axis in 0..dim {
                let axes = &frame.axes[axis];
                let along = dot(*axes, residual);
                let along_scale: f64 = axes.iter().zip(&scale).map(|(a, s)| a.abs() * s).sum();
                if frame.prescribed[axis].is_some() {
                    for (f, a) in force.iter_mut().zip(axes) {
                        *f -= along * a;
                    }
                    self.force_scale += along.abs();
                    self.largest_external = larger(self.largest_external, along);
                } else if is_shared[node] {
                    of_trace.push((axis as u32, along, along_scale));
                } else {
                    self.residual = larger(self.residual, along);
                    self.scale = larger(self.scale, along_scale);
                }
            }
            if is_shared[node] {
                first_trace[node] = first..of_trace.len();
            }
            self.add_force(&block.points[node], &force);
        }
        for &(node, id) in &block.interface {
            for &(axis, residual, scale) in &of_trace[first_trace[node as usize].clone()] {
                self.trace_dofs.push((id, axis));
                self.traces.push(residual);
                self.trace_scale.push(scale);
            }
        }
    }

    fn add_force(&mut self, at: &[f64; 3], force: &[f64; 3]) {
        self.force = advance(self.force, 1.0, *force);
        self.moment = advance(self.moment, 1.0, cross(*at, *force));
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            self.moment_scale += (at[i] * force[j]).abs() + (at[j] * force[i]).abs();
        }
    }

    fn contact(&mut self, dim: usize, conditions: &[BlockCondition], u: &[f64], forces: &[f64]) {
        for (condition, &force) in conditions.iter().zip(forces) {
            let gap = condition.gap_left(dim, u);
            self.penetration = larger(self.penetration, gap.min(0.0));
            self.tension = larger(self.tension, force.min(0.0));
            self.largest_force = larger(self.largest_force, force);
            self.complementarity = larger(self.complementarity, gap * force);
        }
    }

    /// As a message.
    pub fn pack(&self) -> Message {
        let mut message = Message::default();
        message.integers.push(self.traces.len() as i64);
        message.integers.push(self.shared_nodes.len() as i64);
        message.integers.push(self.shared_displacement.len() as i64);
        message
            .integers
            .extend(self.shared_nodes.iter().map(|&id| i64::from(id)));
        for &(node, axis) in &self.trace_dofs {
            message.integers.extend([node, axis].map(i64::from));
        }
        message.reals.extend([
            self.residual,
            self.scale,
            self.penetration,
            self.tension,
            self.largest_force,
            self.largest_external,
            self.largest_load,
            self.complementarity,
            self.largest_displacement,
            self.rest_scale,
            self.force_scale,
            self.moment_scale,
        ]);
        message.reals.extend(self.force);
        message.reals.extend(self.moment);
        message.reals.extend(&self.traces);
        message.reals.extend(&self.trace_scale);
        message.reals.extend(&self.shared_displacement);
        message
    }

    /// From a message.
    pub fn unpack(message: Message) -> Self {
        let mut reader = message.read();
        let traces = reader.count();
        let nodes = reader.count();
        let components = reader.count();
        let shared_nodes = reader.integers(nodes).iter().map(|&id| id as u32).collect();
        let vector = |reader: &mut MessageReader| [reader.real(), reader.real(), reader.real()];
        Self {
            shared_nodes,
            trace_dofs: (0..traces)
                .map(|_| (reader.integer() as u32, reader.integer() as u32))
                .collect(),
            residual: reader.real(),
            scale: reader.real(),
            penetration: reader.real(),
            tension: reader.real(),
            largest_force: reader.real(),
            largest_external: reader.real(),
            largest_load: reader.real(),
            complementarity: reader.real(),
            largest_displacement: reader.real(),
            rest_scale: reader.real(),
            force_scale: reader.real(),
            moment_scale: reader.real(),
            force: vector(&mut reader),
            moment: vector(&mut reader),
            traces: reader.reals(traces),
            trace_scale: reader.reals(traces),
            shared_displacement: reader.reals(components),
        }
    }
}

/// The certificate of the whole solution, where Γ has so many nodes of `dim` components.
pub fn certificate(checks: &[BlockCheck], interface_nodes: usize, dim: usize) -> Certificate {
    let mut total = BlockCheck::default();
    let mut on_interface = vec![0.0; interface_nodes * dim];
    let mut interface_scale = vec![0.0; interface_nodes * dim];
    let mut known: HashMap<u32, Vec<f64>> = HashMap::new();
    let mut jump = 0.0;
    for check in checks {
        let traces = check.trace_dofs.iter().zip(&check.traces);
        for ((&(node, axis), r), s) in traces.zip(&check.trace_scale) {
            let dof = node as usize * dim + axis as usize;
            on_interface[dof] += r;
            interface_scale[dof] += s;
        }
        total.residual = larger(total.residual, check.residual);
        total.scale = larger(total.scale, check.scale);
        total.penetration = larger(total.penetration, check.penetration);
        total.tension = larger(total.tension, check.tension);
        total.largest_force = larger(total.largest_force, check.largest_force);
        total.largest_external = larger(total.largest_external, check.largest_external);
        total.largest_load = larger(total.largest_load, check.largest_load);
        total.complementarity = larger(total.complementarity, check.complementarity);
        total.largest_displacement = larger(total.largest_displacement, check.largest_displacement);
        total.rest_scale = larger(total.rest_scale, check.rest_scale);
        total.force_scale += check.force_scale;
        total.moment_scale += check.moment_scale;
        for k in 0..3 {
            total.force[k] += check.force[k];
            total.moment[k] += check.moment[k];
        }
        let displacement = check.shared_displacement.chunks(dim);
        for (&node, u) in check.shared_nodes.iter().zip(displacement) {
            let first = known.entry(node).or_insert_with(|| u.to_vec());
            for (a, b) in first.iter().zip(u) {
                jump = larger(jump, a - b);
            }
        }
    }
    total.residual = larger(total.residual, largest(&on_interface));
    total.scale = larger(total.scale, largest(&interface_scale));
    if total.scale < NO_LOAD * total.rest_scale {
        // Bodies that only came to rest: what is left is round-off of their way.
        total.scale = total.rest_scale;
    }
    let force_scale = larger(total.scale, total.largest_force);
    // Without load what is left of forces is round-off of the terms that they are sums of.
    let loaded = total.force_scale >= NO_LOAD * total.scale;
    let to_load = if loaded {
        1.0
    } else {
        total.force_scale / total.scale
    };
    Certificate {
        equilibrium: ratio(total.residual, total.scale),
        equilibrium_of_load: ratio(total.residual, total.largest_external),
        load_share: ratio(total.largest_load, total.largest_external),
        penetration: ratio(total.penetration, total.largest_displacement),
        tension: ratio(total.tension, force_scale),
        complementarity: ratio(
            total.complementarity,
            total.largest_force * total.largest_displacement,
        ),
        force_balance: to_load * ratio(largest(&total.force), total.force_scale),
        moment_balance: to_load * ratio(largest(&total.moment), total.moment_scale),
        interface_jump: ratio(jump, total.largest_displacement),
    }
}

fn ratio(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / b }
}
