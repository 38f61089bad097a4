//! The check of a block: what it says of its own part of the solution.

use std::collections::HashMap;
use std::ops::Range;

use contact_dd_partition::element::geometry::{advance, cross, dot, padded};
use serde::{Deserialize, Serialize};

use super::shared::SharedCheck;
use crate::contact::friction::TangentialCondition;
use crate::fem::balance::Balance;
use crate::fem::block::Block;
use crate::fem::contact_group::ContactGroup;
use crate::fem::frame::{Frame, support_frames};
use crate::fem::load::BlockLoads;
use crate::schur::condensed::InterfaceDof;
use crate::vector::{axpy, larger, largest};

/// Normal force, relative to the largest in the group, without which a closed contact is about to open.
const NO_FORCE: f64 = 1e-12;

/// What is largest in a block, or in several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Most {
    /// Residual along directions that are free (N/m).
    pub residual: f64,
    /// The terms of such a residual (N/m).
    pub scale: f64,
    /// Penetration (m).
    pub penetration: f64,
    /// Tension in a contact (N/m).
    pub tension: f64,
    /// Contact force (N/m).
    pub contact_force: f64,
    /// Load, contact force or support reaction at a node (N/m).
    pub external: f64,
    /// Load at a node (N/m).
    pub load: f64,
    /// Product of contact force and gap (N).
    pub complementarity: f64,
    /// Tangential force beyond its bound (N/m).
    pub beyond_bound: f64,
    /// Way of a point that sticks from where it does (m).
    pub astray: f64,
    /// What friction would have dissipated more under its bound, against the slip (N).
    pub not_opposed: f64,
    /// Displacement (m).
    pub displacement: f64,
    /// Prescribed displacement, gap, slip before, or closing motion (m).
    pub driven: f64,
    /// Jump of the displacement across Γ (m).
    pub jump: f64,
    /// Force that the bodies' closing motions would cause if it weren't rigid (N/m).
    pub rest: f64,
}

impl Most {
    /// Of everything the larger of two.
    pub fn include(&mut self, other: Self) {
        *self = Self {
            residual: larger(self.residual, other.residual),
            scale: larger(self.scale, other.scale),
            penetration: larger(self.penetration, other.penetration),
            tension: larger(self.tension, other.tension),
            contact_force: larger(self.contact_force, other.contact_force),
            external: larger(self.external, other.external),
            load: larger(self.load, other.load),
            complementarity: larger(self.complementarity, other.complementarity),
            beyond_bound: larger(self.beyond_bound, other.beyond_bound),
            astray: larger(self.astray, other.astray),
            not_opposed: larger(self.not_opposed, other.not_opposed),
            displacement: larger(self.displacement, other.displacement),
            driven: larger(self.driven, other.driven),
            jump: larger(self.jump, other.jump),
            rest: larger(self.rest, other.rest),
        };
    }
}

/// Sums of loads, contact forces and support reactions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct External {
    pub force: [f64; 3],
    /// Of absolute values.
    pub force_scale: f64,
    pub moment: [f64; 3],
    /// Of the absolute values of its terms.
    pub moment_scale: f64,
    /// The largest coordinate (m).
    pub reach: f64,
}

impl External {
    /// Adds a force that acts at a point; its own scale is counted by the components that it is made of.
    fn add(&mut self, at: [f64; 3], force: [f64; 3]) {
        self.force = advance(self.force, 1.0, force);
        self.moment = advance(self.moment, 1.0, cross(at, force));
        self.reach = larger(self.reach, largest(&at));
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            self.moment_scale += (at[i] * force[j]).abs() + (at[j] * force[i]).abs();
        }
    }

    /// Adds what acts on another block.
    pub fn include(&mut self, other: Self) {
        *self = Self {
            force: advance(self.force, 1.0, other.force),
            force_scale: self.force_scale + other.force_scale,
            moment: advance(self.moment, 1.0, other.moment),
            moment_scale: self.moment_scale + other.moment_scale,
            reach: larger(self.reach, other.reach),
        };
    }
}

/// What a block says of its own part of the solution.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BlockCheck {
    /// What is largest in it.
    pub most: Most,
    /// What acts on it from outside.
    pub(super) external: External,
}

impl BlockCheck {
    /// Checks displacements `u`, node by node; what it shares with others is for them to [check](SharedCheck), too.
    pub fn new(
        block: &Block,
        loads: &BlockLoads,
        balance: &Balance,
        u: &[f64],
    ) -> (Self, SharedCheck) {
        let (mut check, mut shared) = (Self::default(), SharedCheck::default());
        check.most.displacement = largest(u);
        check.most.load = balance.largest_load;
        let prescribed = loads.supports.iter().map(|support| support.value);
        check.most.driven = prescribed.fold(0.0, larger);
        check.equilibrium(block, loads, balance, &mut shared);
        for &(node, id) in &block.interface {
            shared.nodes.push(id);
            let start = node as usize * block.dim;
            (shared.displacement).extend_from_slice(&u[start..start + block.dim]);
        }
        (check, shared)
    }

    fn equilibrium(
        &mut self,
        block: &Block,
        loads: &BlockLoads,
        balance: &Balance,
        shared: &mut SharedCheck,
    ) {
        let dim = block.dim;
        let frames = support_frames(&loads.supports, block.dim);
        let mut frames = frames.iter().peekable();
        // Residual and scale along the free axes of nodes on Γ, in the order of nodes.
        let mut of_trace = Vec::new();
        let mut of_shared: HashMap<usize, Range<usize>> = HashMap::new();
        let vector = |values: &[f64], node: usize| padded(&values[node * dim..(node + 1) * dim]);
        for (node, &is_shared) in block.is_on_interface().iter().enumerate() {
            let frame = frames
                .next_if(|(supported, _)| **supported as usize == node)
                .map_or(&Frame::CARTESIAN, |(_, frame)| frame);
            let residual = vector(&balance.residual, node);
            let scale = vector(&balance.scale, node);
            let mut force = vector(&balance.external, node);
            self.external.force_scale += force.iter().map(|f| f.abs()).sum::<f64>();
            self.most.external = larger(self.most.external, largest(&force));
            let first = of_trace.len();
            for axis in 0..dim {
                let axes = &frame.axes[axis];
                let along = dot(*axes, residual);
                let along_scale: f64 = axes.iter().zip(&scale).map(|(a, s)| a.abs() * s).sum();
                if frame.prescribed[axis].is_some() {
                    axpy(-along, axes, &mut force);
                    self.external.force_scale += along.abs();
                    self.most.external = larger(self.most.external, along);
                } else if is_shared {
                    of_trace.push((axis as u32, along, along_scale));
                } else {
                    self.most.residual = larger(self.most.residual, along);
                    self.most.scale = larger(self.most.scale, along_scale);
                }
            }
            if is_shared {
                of_shared.insert(node, first..of_trace.len());
            }
            self.external.add(block.points()[node], force);
        }
        for &(node, id) in &block.interface {
            for &(axis, residual, scale) in &of_trace[of_shared[&(node as usize)].clone()] {
                shared.trace_dofs.push(InterfaceDof { node: id, axis });
                shared.residual.push(residual);
                shared.scale.push(scale);
            }
        }
    }
}

impl Most {
    /// What is largest at the points of a contact `group` with these gaps left and these forces at its conditions, of
    /// which these are `closed`.
    pub fn at_points(group: &ContactGroup, gaps: &[f64], forces: &[f64], closed: &[bool]) -> Self {
        let mut most = Self::default();
        let no_force = NO_FORCE * largest(forces);
        for (&gap, &force) in gaps.iter().zip(forces).take(group.points.len()) {
            most.penetration = larger(most.penetration, gap.min(0.0));
            most.tension = larger(most.tension, force.min(0.0));
            most.contact_force = larger(most.contact_force, force);
            most.complementarity = larger(most.complementarity, gap * force);
        }
        let friction = group.friction();
        for of_point in friction.chunk_by(|a, b| a.normal == b.normal) {
            let TangentialCondition { normal, bound, .. } = of_point[0];
            let both = |value: &dyn Fn(usize) -> f64| {
                let second = of_point.get(1).map_or(0.0, |second| value(second.number));
                [value(of_point[0].number), second]
            };
            let (force, stuck) = (
                both(&|j| forces[j]),
                both(&|j| if closed[j] { gaps[j] } else { 0.0 }),
            );
            let slip = both(&|j| if closed[j] { 0.0 } else { -gaps[j] });
            let [size, way] = [force, slip].map(|[a, b]: [f64; 2]| a.hypot(b));
            let is_parting = bound.only_closed && forces[normal] <= no_force;
            let bound = bound.at(forces[normal], closed[normal]);
            most.contact_force = larger(most.contact_force, size);
            most.beyond_bound = larger(most.beyond_bound, (size - bound).max(0.0));
            most.astray = larger(most.astray, stuck[0].hypot(stuck[1]));
            let work = force[0] * slip[0] + force[1] * slip[1];
            let missing = match is_parting {
                true => 0.5 * (size * way - work),
                false => bound * way - work,
            };
            // That is 0 to the second order where the force isn't along the slip.
            let aside = (force[0] * slip[1] - force[1] * slip[0]).abs();
            most.not_opposed = larger(larger(most.not_opposed, missing), aside);
        }
        most
    }
}
