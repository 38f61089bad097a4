//! The contact points at which a solution violates the laws of contact most.

use contact_dd_partition::id::PairId;

use super::{DiscreteSolution, GroupSolution};
use crate::context::Context;
use crate::fem::contact_group::ContactGroup;
use crate::sweep::SweepOutcome;
use crate::vector::largest;

/// Most points that are named; further ones are counted.
const MOST: usize = 20;
/// Violation of a law that counts as round-off, relative to the largest contact force.
const ROUND_OFF: f64 = 1e-9;

/// The contact points that violate their laws most, else those whose status cycles, as text; on the root. Collective.
pub fn names_against_law(
    context: &Context<'_>,
    solution: &DiscreteSolution,
    outcome: Option<&SweepOutcome>,
) -> Vec<String> {
    let mut points = points_against_law(context, solution);
    if points.is_empty() {
        let pairs = outcome
            .iter()
            .flat_map(|o| (0..).map(PairId::new).zip(&o.unsettled));
        points = pairs
            .flat_map(|(p, conditions)| {
                (context.plan).points_of_conditions(context.catalog, p, conditions)
            })
            .collect();
    }
    points.into_iter().map(|j| context.point_name(j)).collect()
}

/// The contact points that violate their laws, by their number among all, the worst first; on the root. Collective.
fn points_against_law(context: &Context<'_>, solution: &DiscreteSolution) -> Vec<u32> {
    let plan = context.plan;
    let (mut all, mut force) = (Vec::new(), 0.0_f64);
    context.comm.gather(
        &plan.group_owners(),
        |g| match solution.groups.get(&g) {
            Some(of_group) => {
                let mut residuals = residuals(&context.groups[&g], of_group);
                residuals.sort_by(|a, b| b.1.total_cmp(&a.1));
                residuals.truncate(MOST);
                (residuals, largest(&of_group.forces))
            }
            None => (Vec::new(), 0.0),
        },
        |g, (residuals, largest): (Vec<(usize, f64)>, f64)| {
            force = force.max(largest);
            let points = &plan.tree.nodes[plan.groups[g].node].points;
            all.extend(residuals.into_iter().map(|(point, x)| (points[point], x)));
        },
    );
    all.retain(|(_, residual)| *residual > ROUND_OFF * force);
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all.into_iter().map(|(point, _)| point).collect()
}

/// Violations of the laws by the points of a group, as forces (N/m): λ − max(0, λ − r gap), and along the tangents λ_t
/// − ξ min(1, b/|ξ|) with ξ = λ_t + r s.
fn residuals(group: &ContactGroup, solution: &GroupSolution) -> Vec<(usize, f64)> {
    let (gaps, forces) = (&solution.gaps, &solution.forces);
    let normal = |j: usize| {
        if group.points[j].law.is_tied() {
            return 0.0;
        }
        let r = group.stiffness_at(j);
        (forces[j] - (forces[j] - r * gaps[j]).max(0.0)).abs()
    };
    let mut residuals: Vec<(usize, f64)> =
        (0..group.points.len()).map(|j| (j, normal(j))).collect();
    for point in group.point_laws() {
        let here = solution.point(&point);
        let xi = point.reach(&here);
        let size = xi[0].hypot(xi[1]);
        let part = match size > here.bound {
            true => here.bound / size,
            false => 1.0,
        };
        let off = [0, 1].map(|k| here.force[k] - part * xi[k]);
        if let Some(n) = point.normal {
            residuals[n].1 = residuals[n].1.max(off[0].hypot(off[1]));
        }
    }
    residuals
}
