//! Derivatives of a quantity with respect to the parameters of a scene, from the solution of its transposed problem.

use contact_dd_partition::id::{BlockId, GroupId};
use contact_dd_partition::quantity::{Parameter, ParameterKind, QuantityKind};

use super::functional::{Functional, MaterialForces};
use super::slipping::SlippingPoint;
use super::solved::Solved;
use super::transposed::{Transposed, TransposedProblem};
use crate::bytes::Reals;
use crate::vector::dot;

/// The data from which the derivatives of a quantity follow.
#[derive(Clone, Copy)]
pub struct Sensitivity<'a> {
    /// The solution.
    pub solved: Solved<'a>,
    /// The quantity.
    pub functional: &'a Functional,
    /// The transposed problem.
    pub problem: &'a TransposedProblem<'a>,
    /// The solution of the transposed problem.
    pub state: &'a Transposed,
    /// K_m u.
    pub forces: &'a MaterialForces,
}

/// The derivative with respect to every parameter, on the root. Collective.
pub fn derivatives(of: &Sensitivity<'_>) -> Vec<f64> {
    let context = &of.solved.fixed.context;
    let parameters = &context.catalog.parameters;
    let mut sums = vec![0.0; parameters.len()];
    context.comm.gather(
        &context.plan.owners(),
        |b| Reals(of.of_block(b)),
        |_, Reals(parts)| {
            sums.iter_mut()
                .zip(parts)
                .for_each(|(sum, part)| *sum += part)
        },
    );
    context.comm.gather(
        &context.plan.group_owners(),
        |g| {
            let parts = parameters.iter().map(|parameter| of.of_group(g, parameter));
            Reals(parts.collect())
        },
        |_, Reals(parts)| {
            sums.iter_mut()
                .zip(parts)
                .for_each(|(sum, part)| *sum += part)
        },
    );
    for (sum, parameter) in sums.iter_mut().zip(parameters) {
        *sum += of.beside(parameter);
    }
    sums
}

impl Sensitivity<'_> {
    /// The terms of a block in all derivatives: w·df − w·dK u + η·dv.
    fn of_block(&self, b: BlockId) -> Vec<f64> {
        let context = &self.solved.fixed.context;
        let parameters = &context.catalog.parameters;
        let mut parts = vec![0.0; parameters.len()];
        let (Some(block), Some(of_block)) =
            (context.blocks.get(&b), self.state.discrete.blocks.get(&b))
        else {
            return parts;
        };
        let (dim, w) = (block.dim, &of_block.u);
        let solution = &self.solved.solution.discrete;
        let quantity = &context.catalog.quantities[self.functional.number];
        let is_energy = quantity.kind == QuantityKind::Energy;
        for share in &block.subdomain.shares.forces {
            let force = share
                .forces
                .get(self.solved.step)
                .copied()
                .unwrap_or_default();
            let w = &w[share.node as usize * dim..][..dim];
            parts[share.parameter as usize] += dot(w, &force[..dim]);
        }
        let supports = self.solved.fixed.step.loads.blocks.get(&b);
        let supports = supports.map_or(&[][..], |loads| &loads.supports);
        let residual = self.state.residuals.get(&b).map_or(&[][..], Vec::as_slice);
        for (part, parameter) in parts.iter_mut().zip(parameters) {
            match parameter.kind {
                ParameterKind::Stiffness => {
                    let mut work = -self.forces.work(b, w, &parameter.of);
                    if is_energy && let Some(of_block) = solution.blocks.get(&b) {
                        work += 0.5 * self.forces.work(b, &of_block.u, &parameter.of);
                    }
                    *part += work / parameter.value;
                }
                ParameterKind::Displacement => {
                    let axis = parameter.of[1] as usize;
                    let rows = supports.iter().filter(|of| of.condition == parameter.of[0]);
                    for support in rows.filter(|of| of.direction[axis].abs() == 1.0) {
                        let at = support.node as usize * dim;
                        *part += residual[at + axis];
                    }
                }
                _ => {}
            }
        }
        parts
    }

    /// The term of a contact group in a derivative: ν·dg − τ'·dφ.
    fn of_group(&self, g: GroupId, parameter: &Parameter) -> f64 {
        let (Some(group), Some(of_group)) = (
            self.solved.fixed.context.groups.get(&g),
            self.state.discrete.groups.get(&g),
        ) else {
            return 0.0;
        };
        let is_of = |point: usize| group.points[point].contact == parameter.of[0];
        match parameter.kind {
            ParameterKind::Gap => {
                let direct = self
                    .functional
                    .of_gaps
                    .get(&g)
                    .map_or(&[][..], Vec::as_slice);
                let of_point =
                    |j: usize| of_group.forces[j] + direct.get(j).copied().unwrap_or(0.0);
                (0..group.points.len())
                    .filter(|&j| is_of(j))
                    .map(of_point)
                    .sum()
            }
            ParameterKind::Friction => {
                let points = self
                    .problem
                    .slipping
                    .get(&g)
                    .into_iter()
                    .flat_map(|of| &of.0);
                let points = points.filter(|point| point.is_closed && is_of(point.normal));
                let rate = points.map(|point| {
                    let slip = point.tangents.iter();
                    let along: f64 = slip.map(|&(j, e)| e * of_group.gaps[j]).sum();
                    along * point.pressing
                });
                rate.sum()
            }
            _ => 0.0,
        }
    }

    /// Explicit derivative of a mean stress, or of a crack tip quantity, with respect to a stiffness, at fixed
    /// displacements; on the root.
    fn beside(&self, parameter: &Parameter) -> f64 {
        let catalog = self.solved.fixed.context.catalog;
        let quantity = &catalog.quantities[self.functional.number];
        if parameter.kind != ParameterKind::Stiffness {
            return 0.0;
        }
        match quantity.kind {
            QuantityKind::MeanStress if parameter.of.contains(&quantity.of[0]) => {
                let constant = quantity.constants.get(self.solved.step).copied();
                (self.functional.value - constant.unwrap_or_default()) / parameter.value
            }
            QuantityKind::OpeningIntensity
            | QuantityKind::SlidingIntensity
            | QuantityKind::EnergyReleaseRate => {
                let material = catalog.tips[quantity.of[0] as usize].material;
                match parameter.of.contains(&material) {
                    true => self.functional.of_stiffness / parameter.value,
                    false => 0.0,
                }
            }
            _ => 0.0,
        }
    }

    /// Error of the law of reciprocity between the solution and that of the transposed problem,
    ///
    /// > a·u + b·λ + r·ρ = w·f + ν·g + η·v − τ'·φ,
    ///
    /// relative to the sizes of all terms; on the root. Collective.
    pub fn reciprocity(&self) -> f64 {
        let context = &self.solved.fixed.context;
        let mut terms = Vec::new();
        context.comm.gather(
            &context.plan.owners(),
            |b| self.reciprocity_of_block(b),
            |_, part: [f64; 2]| terms.push(part),
        );
        context.comm.gather(
            &context.plan.group_owners(),
            |g| self.reciprocity_of_group(g),
            |_, part: [f64; 2]| terms.push(part),
        );
        let off: f64 = terms.iter().map(|[off, _]| off).sum();
        let size: f64 = terms.iter().map(|[_, size]| size).sum();
        if size > 0.0 { off.abs() / size } else { 0.0 }
    }

    /// The terms of a block in the difference of both sides, and their size.
    fn reciprocity_of_block(&self, b: BlockId) -> [f64; 2] {
        let fixed = self.solved.fixed;
        let solution = &self.solved.solution.discrete;
        let (Some(block), Some(of_block), Some(w)) = (
            fixed.context.blocks.get(&b),
            solution.blocks.get(&b),
            self.state.discrete.blocks.get(&b),
        ) else {
            return [0.0; 2];
        };
        let Some(loads) = fixed.step.loads.blocks.get(&b) else {
            return [0.0; 2];
        };
        let dim = block.dim;
        let of_nodes = self.functional.of_nodes.get(&b);
        let of_nodes = of_nodes.map_or(&[][..], Vec::as_slice);
        let forces = loads.nodal_forces(block);
        let mut off = dot(of_nodes, &of_block.u) - dot(&w.u, &forces);
        let mut size = sizes(of_nodes, &of_block.u) + sizes(&w.u, &forces);
        let of_supports = self.functional.of_supports.get(&b);
        let unbalanced = of_supports.and_then(|_| fixed.balance(b, of_block));
        for (i, support) in loads.supports.iter().enumerate() {
            let rest = |field: &[f64]| {
                let at = &field[support.node as usize * dim..][..dim];
                dot(at, &support.direction[..dim])
            };
            let residual = self.state.residuals.get(&b);
            let mut terms = [residual.map_or(0.0, |of| rest(of)) * support.value, 0.0];
            if let (Some(weights), Some(balance)) = (of_supports, &unbalanced) {
                terms[1] = weights[i] * rest(&balance.residual);
            }
            off -= terms[0] + terms[1];
            size += terms[0].abs() + terms[1].abs();
        }
        [off, size]
    }

    fn reciprocity_of_group(&self, g: GroupId) -> [f64; 2] {
        let fixed = self.solved.fixed;
        let (Some(of_group), Some(state), Some(loads)) = (
            self.solved.solution.discrete.groups.get(&g),
            self.state.discrete.groups.get(&g),
            fixed.step.loads.groups.get(&g),
        ) else {
            return [0.0; 2];
        };
        let weights = self.functional.of_forces.get(&g);
        let weights = weights.map_or(&[][..], Vec::as_slice);
        let mut off = dot(weights, &of_group.forces);
        let mut size = sizes(weights, &of_group.forces);
        let known = (state.forces.iter().zip(&loads.gaps)).zip(&of_group.closed);
        let closed = known.filter(|(_, closed)| **closed);
        for ((force, gap), _) in closed {
            off -= force * gap;
            size += (force * gap).abs();
        }
        for point in self
            .problem
            .slipping
            .get(&g)
            .into_iter()
            .flat_map(|of| &of.0)
        {
            let slip = point.tangents.iter();
            let along: f64 = slip.map(|&(j, e)| e * state.gaps[j]).sum();
            off -= along * point.cohesion;
            size += (along * point.cohesion).abs();
            // Q acts on the slip since the sides last stuck.
            let before: f64 = slip_before(&loads.gaps, point).map(|(_, e, s)| e * s).sum();
            let turned =
                slip_before(&loads.gaps, point).map(|(j, e, s)| state.gaps[j] * (s - e * before));
            off += point.turning * turned.sum::<f64>();
        }
        [off, size]
    }
}

/// Σ |x y|.
fn sizes(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| (x * y).abs()).sum()
}

/// The slipping conditions of a point, its direction's components along them, and the jumps from which slips count.
fn slip_before<'a>(
    gaps: &'a [f64],
    point: &'a SlippingPoint,
) -> impl Iterator<Item = (usize, f64, f64)> + 'a {
    point.tangents.iter().map(|&(j, e)| (j, e, gaps[j]))
}
