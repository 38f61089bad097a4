//! What the forces of a tie lack where supports prescribe its jump, as at a wall that both of its sides end at: nodes
//! there carry no force of the tie, which couldn't be told from that of the supports. The sum of its forces is too small
//! by that part, and the reactions of the supports are too large. It is about the traction beside these nodes on their
//! area, which decreases with the size of facets only, and slowly where stresses are unbounded.

use contact_dd_partition::element::geometry::{advance, dot as along};
use contact_dd_partition::id::{GroupId, OnGroups};
use serde::{Deserialize, Serialize};

use super::contact_edges::neighbours;
use super::functional::Functional;
use super::solved::Solved;
use crate::bytes::Reals;
use crate::fem::contact_group::Condition;
use crate::vector::dot;

/// The estimated forces of conditions whose jump supports prescribe; empty if there are none.
#[derive(Default)]
pub struct HeldEnds(OnGroups<Vec<f64>>);

/// The force of a point of a tie.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct TiedForce {
    /// Its components in the scene's axes (N/m).
    force: [f64; 3],
    /// True if supports prescribe any component of its jump.
    is_held: bool,
}

impl HeldEnds {
    /// The ends of all ties in a solution. Collective.
    pub fn new(solved: Solved<'_>) -> Self {
        let context = &solved.fixed.context;
        let held: OnGroups<Vec<bool>> = (context.groups.iter())
            .map(|(&g, group)| (g, group.prescribed_ties()))
            .collect();
        let any = held.values().flatten().any(|held| *held);
        if context.comm.largest([&f64::from(u8::from(any))]) == 0.0 {
            return Self::default();
        }
        let beside = tractions_beside(solved, &held);
        let of_group = |(&g, held): (&GroupId, &Vec<bool>)| {
            let group = &context.groups[&g];
            let places = &context.plan.tree.nodes[context.plan.groups[g].node].points;
            let force = |(condition, held): (Condition, &bool)| {
                let traction = beside[places[condition.point] as usize];
                match held {
                    true => {
                        group.points[condition.point].area * along(traction, condition.direction)
                    }
                    false => 0.0,
                }
            };
            (g, group.conditions().zip(held).map(force).collect())
        };
        Self(held.iter().map(of_group).collect())
    }

    /// What a quantity lacks: its exact value less the given one; on the root. Collective.
    pub fn lack(&self, solved: Solved<'_>, functional: &Functional) -> f64 {
        let context = &solved.fixed.context;
        if context.comm.largest(self.0.values().flatten()) == 0.0 {
            return 0.0;
        }
        let of_forces = context.sum_of_groups(|g| {
            let weights = functional.of_forces.get(&g);
            (weights.zip(self.0.get(&g))).map_or(0.0, |(weights, lacking)| dot(weights, lacking))
        });
        let pushes = self.0.iter();
        let pushes = pushes.map(|(&g, lacking)| (g, context.groups[&g].pushes(lacking)));
        let on_blocks = (context.plan).nodes_to_blocks(context.comm, &pushes.collect());
        let of_reactions = context.sum_of_blocks(|b| {
            let loads = solved.fixed.step.loads.blocks.get(&b);
            let supports = loads.map_or(&[][..], |loads| &loads.supports);
            let weights = functional.of_supports.get(&b).into_iter().flatten();
            let pushed = on_blocks.get(&b).map_or(&[][..], Vec::as_slice);
            let of_support = supports.iter().zip(weights).map(|(support, weight)| {
                let rows = pushed.iter().filter(|(node, _)| *node == support.node);
                let rows = rows.flat_map(|(_, rows)| rows);
                weight * rows.map(|row| along(*row, support.direction)).sum::<f64>()
            });
            of_support.sum()
        });
        of_forces + of_reactions
    }
}

/// The mean traction of the neighbours of every held point of a tie (Pa), by the points' places in the catalog; 0 at
/// others. Collective.
fn tractions_beside(solved: Solved<'_>, held: &OnGroups<Vec<bool>>) -> Vec<[f64; 3]> {
    let context = &solved.fixed.context;
    let (plan, points) = (context.plan, &context.catalog.points);
    let mut all = vec![TiedForce::default(); points.len()];
    context.comm.gather(
        &plan.group_owners(),
        |g| tied_forces(solved, held, g),
        |g, of_group: Vec<TiedForce>| {
            let places = &plan.tree.nodes[plan.groups[g].node].points;
            for (&place, force) in places.iter().zip(of_group) {
                all[place as usize] = force;
            }
        },
    );
    let mut beside = Reals(vec![0.0; 3 * points.len()]);
    let mut ties: Vec<usize> = (0..points.len()).collect();
    ties.retain(|&j| points[j].law.is_tied() && !points[j].is_equation());
    ties.sort_by_key(|&j| points[j].contact);
    for tie in ties.chunk_by(|&i, &j| points[i].contact == points[j].contact) {
        if !tie.iter().any(|&j| all[j].is_held) {
            continue;
        }
        let at: Vec<[f64; 3]> = tie.iter().map(|&j| points[j].position).collect();
        let mut sums = vec![([0.0; 3], 0.0); tie.len()];
        let pairs = neighbours(&at);
        let both_ways = pairs.iter().flat_map(|&(i, j)| [(i, j), (j, i)]);
        for (i, j) in both_ways.filter(|&(i, j)| all[tie[i]].is_held && !all[tie[j]].is_held) {
            let of_point = tie[j];
            let (sum, count) = &mut sums[i];
            *sum = advance(*sum, points[of_point].area.recip(), all[of_point].force);
            *count += 1.0;
        }
        for (&j, (sum, count)) in tie.iter().zip(sums).filter(|(_, (_, count))| *count > 0.0) {
            (0..3).for_each(|k| beside.0[3 * j + k] = sum[k] / count);
        }
    }
    context.comm.broadcast(&mut beside);
    let tractions = beside.0.chunks_exact(3);
    tractions.map(|of| [of[0], of[1], of[2]]).collect()
}

/// The forces of the points of a group; empty on a rank that doesn't own it.
fn tied_forces(solved: Solved<'_>, held: &OnGroups<Vec<bool>>, g: GroupId) -> Vec<TiedForce> {
    let (Some(group), Some(solution), Some(held)) = (
        solved.fixed.context.groups.get(&g),
        solved.solution.discrete.groups.get(&g),
        held.get(&g),
    ) else {
        return Vec::new();
    };
    let mut all = vec![TiedForce::default(); group.points.len()];
    for ((condition, force), held) in group.conditions().zip(&solution.forces).zip(held) {
        let of_point = &mut all[condition.point];
        of_point.force = advance(of_point.force, *force, condition.direction);
        of_point.is_held |= held;
    }
    all
}
