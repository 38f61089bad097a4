//! The check of a block: residuals and largest values in its own part of the solution.

use std::collections::HashMap;
use std::ops::Range;

use contact_dd_partition::element::geometry::{advance, cross, dot, padded};
use serde::{Deserialize, Serialize};

use super::most::Most;
use super::scales::SlipScales;
use super::shared::SharedCheck;
use crate::contact::law::{PointLaw, PointState};
use crate::fem::balance::Balance;
use crate::fem::block::Block;
use crate::fem::contact_group::ContactGroup;
use crate::fem::frame::{Frame, support_frames};
use crate::fem::load::BlockLoads;
use crate::schur::condensed::InterfaceDof;
use crate::vector::{axpy, larger, largest};

/// Normal force, relative to the largest in the group, below which a closed contact is about to open.
const NO_FORCE: f64 = 1e-12;

/// Sums of loads, contact forces and support reactions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct External {
    pub force: [f64; 3],
    /// Sum of absolute values of forces.
    pub force_scale: f64,
    pub moment: [f64; 3],
    /// Sum of absolute values of the moments' terms.
    pub moment_scale: f64,
    /// The largest coordinate (m).
    pub reach: f64,
}

impl External {
    /// Adds a force that acts at a point, without its scale, which its components are counted for.
    fn add(&mut self, at: [f64; 3], force: [f64; 3]) {
        self.force = advance(self.force, 1.0, force);
        self.moment = advance(self.moment, 1.0, cross(at, force));
        self.reach = larger(self.reach, largest(&at));
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            self.moment_scale += (at[i] * force[j]).abs() + (at[j] * force[i]).abs();
        }
    }

    /// Adds the external forces on another block.
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

/// Check of a block's own part of the solution.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BlockCheck {
    /// Largest terms in the block.
    pub most: Most,
    /// External load on the block.
    pub(super) external: External,
}

impl BlockCheck {
    /// Checks displacements `u`, node by node; the check of shared nodes and unknowns is [another one](SharedCheck).
    pub fn new(
        block: &Block,
        loads: &BlockLoads,
        balance: &Balance,
        u: &[f64],
    ) -> (Self, SharedCheck) {
        let (mut check, mut shared) = (Self::default(), SharedCheck::default());
        check.most.displacement = largest(&u[..block.dim * block.body_nodes()]);
        check.most.load = balance.largest_load;
        // Springs may carry the load at each node, so that both cancel.
        check.most.external = balance.largest_load;
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
    /// Largest violations at the points of a contact `group` with these remaining gaps and these forces at its
    /// conditions, and flags of the `closed` ones.
    pub fn at_points(group: &ContactGroup, gaps: &[f64], forces: &[f64], closed: &[bool]) -> Self {
        let mut most = Self::default();
        for ((&gap, &force), condition) in gaps.iter().zip(forces).zip(group.conditions()) {
            if condition.is_tied {
                // A tie that is left to a support has no force, and may have any jump.
                let jump = if force == 0.0 { 0.0 } else { gap };
                most.penetration = larger(most.penetration, jump);
                most.contact_force = larger(most.contact_force, force);
                continue;
            }
            if condition.is_tangential {
                continue;
            }
            most.penetration = larger(most.penetration, gap.min(0.0));
            most.tension = larger(most.tension, force.min(0.0));
            most.contact_force = larger(most.contact_force, force);
            most.complementarity = larger(most.complementarity, gap * force);
        }
        for point in group.point_laws() {
            let slipped = slipped(&point, gaps, forces, closed);
            let astray = point.at(|j| if closed[j] { -gaps[j] } else { 0.0 }, forces, closed);
            let (size, bound) = (slipped.size(), slipped.bound);
            most.contact_force = larger(most.contact_force, size);
            most.bound = larger(most.bound, bound);
            most.beyond_bound = larger(most.beyond_bound, (size - bound).max(0.0));
            most.astray = larger(most.astray, astray.distance());
            // That is 0 to the second order where the force isn't along the slip.
            let [slip, force] = [slipped.slip, slipped.force];
            let aside = (force[0] * slip[1] - force[1] * slip[0]).abs();
            most.aside = larger(most.aside, aside);
        }
        most
    }
}

/// The lesser of slip and the shortfall of the opposing force from its bound, each over its scale, at the point of a
/// contact `group` where it is largest.
pub fn not_opposed(
    group: &ContactGroup,
    [gaps, forces]: [&[f64]; 2],
    closed: &[bool],
    scales: SlipScales,
) -> f64 {
    let no_force = NO_FORCE * largest(forces);
    let of_point = |point: PointLaw| {
        let slipped = slipped(&point, gaps, forces, closed);
        let distance = slipped.distance();
        if distance == 0.0 {
            return 0.0;
        }
        let pressure = point.normal.map_or(0.0, |n| forces[n]);
        let opposing = slipped.work() / distance;
        let shortfall = match point.bound.only_closed && pressure <= no_force {
            true => 0.5 * (slipped.size() - opposing),
            false => slipped.bound - opposing,
        };
        scales.lesser(distance, shortfall)
    };
    let points = group.point_laws();
    points.into_iter().map(of_point).fold(0.0, larger)
}

/// A point with the slips of its limits, 0 where it sticks.
fn slipped(point: &PointLaw, gaps: &[f64], forces: &[f64], closed: &[bool]) -> PointState {
    point.at(|j| if closed[j] { 0.0 } else { -gaps[j] }, forces, closed)
}
