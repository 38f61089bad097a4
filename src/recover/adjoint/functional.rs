//! A quantity as a functional of the solution: value, and derivatives in displacements, forces, reactions and gaps.

use std::collections::BTreeMap;

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::geometry::{cross, difference, dot as along};
use contact_dd_partition::id::{BlockId, GroupId, OnBlocks, OnGroups};
use contact_dd_partition::problem::Catalog;
use contact_dd_partition::quantity::{Quantity, QuantityKind};

use super::solved::Solved;
use crate::context::Context;
use crate::fem::contact_group::Condition;
use crate::fem::elasticity::ElementMatrix;
use crate::fem::gradients::MAX_NODES;
use crate::recover::DiscreteSolution;
use crate::vector::{axpy, dot};

/// K_m u of every material m, by block and node by node (N/m).
#[derive(Default)]
pub struct MaterialForces(OnBlocks<BTreeMap<usize, Vec<f64>>>);

impl MaterialForces {
    /// The forces of the blocks of this rank.
    pub fn new(context: &Context<'_>, solution: &DiscreteSolution) -> Self {
        let mut all = BTreeMap::new();
        let mut k = ElementMatrix::default();
        let (mut points, mut u_e) = (Vec::with_capacity(MAX_NODES), Vec::new());
        for (&b, block) in context.blocks {
            let Some(of_block) = solution.blocks.get(&b) else {
                continue;
            };
            let dim = block.dim;
            let mut materials: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
            for cell in block.cells() {
                points.clear();
                u_e.clear();
                for node in cell.nodes().map(|node| node as usize) {
                    points.push(block.points()[node]);
                    u_e.extend_from_slice(&of_block.u[dim * node..dim * (node + 1)]);
                }
                k.set(
                    &cell.kind,
                    &points,
                    &context.catalog.materials[cell.material],
                );
                let forces = materials.entry(cell.material);
                let forces = forces.or_insert_with(|| vec![0.0; of_block.u.len()]);
                for (a, node) in cell.nodes().enumerate() {
                    for component in 0..dim {
                        let row = k.row(dim * a + component);
                        forces[dim * node as usize + component] += dot(row, &u_e);
                    }
                }
            }
            all.insert(b, materials);
        }
        Self(all)
    }

    /// w·K_m u over block b, for some materials.
    pub fn work(&self, b: BlockId, w: &[f64], materials: &[u32]) -> f64 {
        let of_block = self.0.get(&b).into_iter().flatten();
        let of_block = of_block.filter(|(material, _)| materials.contains(&(**material as u32)));
        of_block.map(|(_, forces)| dot(w, forces)).sum()
    }

    /// K u of block b, node by node.
    fn of_block(&self, b: BlockId) -> impl Iterator<Item = &Vec<f64>> {
        self.0
            .get(&b)
            .into_iter()
            .flatten()
            .map(|(_, forces)| forces)
    }
}

/// A quantity as a functional of the solution, on this rank.
#[derive(Default)]
pub struct Functional {
    /// The number among the quantities.
    pub number: usize,
    /// The value; on the root.
    pub value: f64,
    /// The part of the value proportional to the stiffness around a crack tip, at fixed displacements; on the root.
    pub of_stiffness: f64,
    /// What a moment may lack, as forces of nodes that both sides share act beside them; what the weights of a smoothed
    /// pressure may change by on a finer mesh; on the root.
    pub beside: f64,
    /// Tag of its node, −1 if there is none; for a largest pressure only on the root.
    pub node: i64,
    /// ∂q/∂u of the blocks that it depends on; the parts of blocks add up.
    pub of_nodes: OnBlocks<Vec<f64>>,
    /// ∂q/∂ρ of every support of the blocks that it depends on.
    pub of_supports: OnBlocks<Vec<f64>>,
    /// ∂q/∂λ of every condition of the contact groups that it depends on.
    pub of_forces: OnGroups<Vec<f64>>,
    /// ∂q/∂g of every condition of the contact groups that it depends on.
    pub of_gaps: OnGroups<Vec<f64>>,
}

impl Functional {
    /// The quantity with this number. Collective.
    pub fn new(solved: Solved<'_>, number: usize, forces: &MaterialForces) -> Self {
        let quantity = &solved.fixed.context.catalog.quantities[number];
        let mut functional = Self {
            number,
            node: quantity.node,
            ..Self::default()
        };
        match quantity.kind {
            QuantityKind::Displacement | QuantityKind::MeanStress => {
                functional.weigh_nodes(solved, quantity);
            }
            QuantityKind::Reaction => functional.weigh_reactions(solved, quantity),
            QuantityKind::ContactForce
            | QuantityKind::ContactMoment
            | QuantityKind::MeanPressure => functional.weigh_forces(solved, quantity),
            QuantityKind::LargestPressure if quantity.length > 0.0 => {
                functional.find_smoothed(solved, quantity);
            }
            QuantityKind::LargestPressure => functional.find_largest(solved, quantity),
            QuantityKind::Opening => functional.weigh_gap(solved, quantity),
            QuantityKind::Energy => functional.weigh_energy(solved, forces),
            QuantityKind::OpeningIntensity
            | QuantityKind::SlidingIntensity
            | QuantityKind::EnergyReleaseRate => functional.weigh_tip(solved, quantity),
        }
        functional
    }

    /// Adds weights times displacements, including the bodies' closing motions.
    fn weigh_nodes(&mut self, solved: Solved<'_>, quantity: &Quantity) {
        let context = &solved.fixed.context;
        let mut parts = BTreeMap::new();
        for (&b, block) in context.blocks {
            let weights = block.subdomain.shares.weights.iter();
            let weights = weights.filter(|weight| weight.quantity as usize == self.number);
            let mut of_nodes = vec![0.0; block.dim * block.nodes()];
            let mut is_there = false;
            for weight in weights {
                is_there = true;
                for (component, value) in weight.value.into_iter().enumerate().take(block.dim) {
                    of_nodes[weight.node as usize * block.dim + component] += value;
                }
            }
            if let (true, Some(u)) = (is_there, solved.solution.displacement.get(&b)) {
                parts.insert(b, dot(&of_nodes, u));
                self.of_nodes.insert(b, of_nodes);
            }
        }
        self.value = context.sum_of_blocks(|b| parts.get(&b).copied().unwrap_or_default());
        self.value += quantity
            .constants
            .get(solved.step)
            .copied()
            .unwrap_or_default();
    }

    /// Adds forces of a contact along a direction, or normal ones, over an area for a mean pressure, or their moment.
    fn weigh_forces(&mut self, solved: Solved<'_>, quantity: &Quantity) {
        let context = &solved.fixed.context;
        let share = match quantity.kind {
            QuantityKind::MeanPressure => {
                1.0 / (area(context.catalog, quantity, |_| true) + quantity.length)
            }
            _ => 1.0,
        };
        // Nodes that both sides share have the pressure of the points beside them.
        let beside = &quantity.of[1..];
        let is_beside = |point: &ContactPoint<u32>| beside.contains(&point.place);
        let area_beside = area(context.catalog, quantity, |place| beside.contains(&place));
        let of_shared = match beside.is_empty() {
            true => 0.0,
            false => quantity.length / area_beside,
        };
        let is_moment = quantity.kind == QuantityKind::ContactMoment;
        let is_normal = quantity.direction == [0.0; 3] && !is_moment;
        let axis = match context.catalog.dim {
            2 => [0.0, 0.0, 1.0],
            _ => quantity.direction,
        };
        // In the plane two nodes are in a facet of a width, in space a row of nodes lies beside a front.
        let width = (2.0 * area_beside / beside.len().max(1) as f64)
            .powf(1.0 / (context.catalog.dim as f64 - 1.0));
        let (mut parts, mut levers) = (BTreeMap::new(), BTreeMap::new());
        for (&g, of_group) in &solved.solution.discrete.groups {
            let group = &context.groups[&g];
            let forces = group.conditions().zip(&of_group.forces);
            let shared = forces.filter(|(of, _)| is_moment && is_beside(&group.points[of.point]));
            let shared = shared.filter(|(of, _)| group.points[of.point].contact == quantity.of[0]);
            let lever = shared.map(|(_, force)| of_shared * force.abs() * width);
            levers.insert(g, lever.sum::<f64>());
            let weight = |condition: Condition| {
                let point = &group.points[condition.point];
                if point.contact != quantity.of[0] {
                    return 0.0;
                }
                let part = match is_normal {
                    true if condition.is_tangential => 0.0,
                    true => share,
                    false if is_moment => {
                        let arm = difference(point.force_point, quantity.point);
                        -along(cross(arm, condition.direction), axis)
                    }
                    false => -share * along(condition.direction, quantity.direction),
                };
                match is_beside(point) {
                    true => (1.0 + of_shared) * part,
                    false => part,
                }
            };
            let weights: Vec<f64> = group.conditions().map(weight).collect();
            parts.insert(g, dot(&weights, &of_group.forces));
            self.of_forces.insert(g, weights);
        }
        self.value = context.sum_of_groups(|g| parts.get(&g).copied().unwrap_or_default());
        self.beside = context.sum_of_groups(|g| levers.get(&g).copied().unwrap_or_default());
    }

    /// Finds the point with the largest pressure.
    fn find_largest(&mut self, solved: Solved<'_>, quantity: &Quantity) {
        let context = &solved.fixed.context;
        let contact = quantity.of[0];
        let pressure = |g: GroupId, (j, point): (usize, &ContactPoint<u32>)| {
            let force = solved.solution.discrete.groups[&g].forces[j];
            (force / point.area, j, point.tag())
        };
        let mut largest: Option<(f64, GroupId, usize, i64)> = None;
        context.comm.gather(
            &context.plan.group_owners(),
            |g| {
                let points = context.groups[&g].points.iter().enumerate();
                let points = points.filter(|(_, point)| point.contact == contact);
                let all = points.map(|of| pressure(g, of));
                all.reduce(|a, b| if b.0 > a.0 { b } else { a })
            },
            |g, found: Option<(f64, usize, i64)>| {
                if let Some((pressure, j, tag)) = found
                    && largest.is_none_or(|(most, ..)| pressure > most)
                {
                    largest = Some((pressure, g, j, tag));
                }
            },
        );
        context.comm.broadcast(&mut largest);
        let Some((pressure, g, j, tag)) = largest else {
            return;
        };
        (self.value, self.node) = (pressure, tag);
        if let Some(group) = context.groups.get(&g) {
            let mut weights = vec![0.0; group.conditions().count()];
            weights[j] = 1.0 / group.points[j].area;
            self.of_forces.insert(g, weights);
        }
    }

    /// The remaining gap at a point: g − B u.
    fn weigh_gap(&mut self, solved: Solved<'_>, quantity: &Quantity) {
        let context = &solved.fixed.context;
        let mut pushes = BTreeMap::new();
        let mut gaps = BTreeMap::new();
        for (&g, group) in context.groups {
            let mut weights = vec![0.0; group.conditions().count()];
            let is_it = |point: &ContactPoint<u32>| [point.contact, point.place] == quantity.of[..];
            if let Some(j) = group.points.iter().position(is_it) {
                weights[j] = 1.0;
                gaps.insert(g, solved.solution.discrete.groups[&g].gaps[j]);
                self.of_gaps.insert(g, weights.clone());
            }
            pushes.insert(g, group.pushes(&weights));
        }
        for (b, of_block) in context.plan.nodes_to_blocks(context.comm, &pushes) {
            let Some(block) = context.blocks.get(&b) else {
                continue;
            };
            let mut of_nodes = vec![0.0; block.dim * block.nodes()];
            for (node, rows) in of_block {
                for row in rows {
                    for (component, part) in row.into_iter().enumerate().take(block.dim) {
                        of_nodes[node as usize * block.dim + component] -= part;
                    }
                }
            }
            self.of_nodes.insert(b, of_nodes);
        }
        self.value = context.sum_of_groups(|g| gaps.get(&g).copied().unwrap_or_default());
    }

    /// ½ uᵀ K u.
    fn weigh_energy(&mut self, solved: Solved<'_>, forces: &MaterialForces) {
        let context = &solved.fixed.context;
        let mut parts = BTreeMap::new();
        for (&b, of_block) in &solved.solution.discrete.blocks {
            let mut of_nodes = vec![0.0; of_block.u.len()];
            for forces in forces.of_block(b) {
                axpy(1.0, forces, &mut of_nodes);
            }
            parts.insert(b, 0.5 * dot(&of_nodes, &of_block.u));
            self.of_nodes.insert(b, of_nodes);
        }
        self.value = context.sum_of_blocks(|b| parts.get(&b).copied().unwrap_or_default());
    }
}

/// The area of the points of a quantity's contact at some places.
fn area(catalog: &Catalog, quantity: &Quantity, is_one: impl Fn(u32) -> bool) -> f64 {
    let points = catalog.points.iter();
    let points = points.filter(|of| of.contact == quantity.of[0] && is_one(of.place));
    points.map(|point| point.area).sum()
}

impl Context<'_> {
    /// The sum over all blocks, in their order; on the root. Collective.
    pub(super) fn sum_of_blocks(&self, of_block: impl FnMut(BlockId) -> f64) -> f64 {
        let mut sum = 0.0;
        (self.comm).gather(&self.plan.owners(), of_block, |_, part: f64| sum += part);
        sum
    }

    /// The sum over all contact groups, in their order; on the root. Collective.
    pub(super) fn sum_of_groups(&self, of_group: impl FnMut(GroupId) -> f64) -> f64 {
        let mut sum = 0.0;
        (self.comm).gather(&self.plan.group_owners(), of_group, |_, part: f64| {
            sum += part
        });
        sum
    }
}
