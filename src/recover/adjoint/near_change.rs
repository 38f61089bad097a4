//! Contact points whose status is about to change, at which derivatives hold on one side.

use super::solved::Solved;
use crate::fem::contact_group::ContactGroup;
use crate::recover::GroupSolution;

/// Force, gap or slip, relative to the largest force or displacement, below which it is about to vanish.
const NEAR: f64 = 1e-6;
/// Most points that are named.
const MOST: usize = 20;

/// The points whose status is about to change, as text; on the root. Collective.
pub fn about_to_change(solved: Solved<'_>) -> Vec<String> {
    let context = &solved.fixed.context;
    let discrete = &solved.solution.discrete;
    let forces = discrete.groups.values().flat_map(|of| &of.forces);
    let force = NEAR * context.comm.largest(forces);
    let displacements = discrete.blocks.values().flat_map(|of| &of.u);
    let distance = NEAR * context.comm.largest(displacements);
    let plan = context.plan;
    let mut names = Vec::new();
    let mut more = 0;
    context.comm.gather(
        &plan.group_owners(),
        |g| match discrete.groups.get(&g) {
            Some(of_group) => near(&context.groups[&g], of_group, (force, distance)),
            None => Vec::new(),
        },
        |g, near: Vec<usize>| {
            let points = &plan.tree.nodes[plan.groups[g].node].points;
            for point in near {
                match names.len() < MOST {
                    true => names.push(context.point_name(points[point])),
                    false => more += 1,
                }
            }
        },
    );
    if more > 0 {
        names.push(format!("{more} more"));
    }
    names
}

/// The points of a group with a force or a distance to contact below these sizes, or friction as near to its bound.
fn near(
    group: &ContactGroup,
    solution: &GroupSolution,
    (force, distance): (f64, f64),
) -> Vec<usize> {
    let unilateral = group.points.iter().enumerate();
    let unilateral = unilateral.filter(|(_, point)| !point.law.is_tied());
    let vanishes = |j: usize| match solution.closed[j] {
        true => solution.forces[j] <= force,
        false => solution.gaps[j] <= distance,
    };
    let mut near: Vec<usize> = unilateral
        .map(|(j, _)| j)
        .filter(|&j| vanishes(j))
        .collect();
    for law in group.point_laws() {
        let here = solution.point(&law);
        let sticks = law.limits().all(|j| solution.closed[j]);
        let is_near = match sticks {
            true => here.bound - here.size() <= force,
            false => here.distance() <= distance,
        };
        // Without a bound there is no tangential force, be the point sticking or slipping.
        near.extend(law.normal.filter(|_| is_near && here.bound > force));
    }
    near.sort_unstable();
    near.dedup();
    near
}
