//! What the place of the edges of contact has to do with the error of a quantity: where a closed point has an open
//! neighbour, contact ends somewhere between the two, on the mesh at a node.
//!
//! With the force λ and the gap g of the solution, and the jump ω and the force ν of the transposed problem,
//!
//! ```text
//! q(u) − q(u_h) contains λ ω + ν g,
//! ```
//!
//! which are 0 at every node but not between them: λ and ν of one node meet ω and g of the next one. The same holds
//! between a sticking and a slipping node, with the force that is left to the bound in place of λ, and the slip.

use contact_dd_partition::element::geometry::{difference, length};
use contact_dd_partition::id::GroupId;
use serde::{Deserialize, Serialize};

use super::solved::Solved;
use super::transposed::Transposed;

/// Distance of neighbours, relative to that of the nearest one.
const NEIGHBOUR: f64 = 1.5;

/// A contact point in the solution and in the transposed problem, by components: normal, tangential.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct PointPair {
    /// λ (N/m).
    force: [f64; 3],
    /// The remaining gap, and slips (m).
    gap: [f64; 3],
    /// ν.
    multiplier: [f64; 3],
    /// ω less what the quantity prescribes.
    jump: [f64; 3],
    /// What of the friction bound is left (N/m).
    left: f64,
    /// True if its sides touch; and if they stick.
    is_closed: bool,
    sticks: bool,
    /// True of a tie, which has no edge.
    is_tied: bool,
}

impl PointPair {
    /// Σ |λ ω + ν g| if contact ends between this point and its neighbour.
    fn product(&self, next: &Self) -> f64 {
        let sum = |of: &[f64; 3], with: &[f64; 3], components: std::ops::Range<usize>| {
            components.map(|k| (of[k] * with[k]).abs()).sum::<f64>()
        };
        match (self.is_closed, next.is_closed) {
            (true, false) => {
                sum(&self.force, &next.jump, 0..3) + sum(&self.multiplier, &next.gap, 0..1)
            }
            (true, true) if self.sticks && !next.sticks => {
                let along = next.jump[1].hypot(next.jump[2]);
                self.left * along + sum(&self.multiplier, &next.gap, 1..3)
            }
            _ => 0.0,
        }
    }
}

/// Σ |λ ω + ν g| over all edges of contact and of sticking zones; on the root. Collective.
pub fn edges(solved: Solved<'_>, of: &Transposed) -> f64 {
    let context = &solved.fixed.context;
    let plan = context.plan;
    let points = &context.catalog.points;
    let mut pairs = vec![PointPair::default(); points.len()];
    context.comm.gather(
        &plan.group_owners(),
        |g| point_pairs(solved, of, g),
        |g, of_group: Vec<PointPair>| {
            let places = &plan.tree.nodes[plan.groups[g].node].points;
            for (&place, pair) in places.iter().zip(of_group) {
                pairs[place as usize] = pair;
            }
        },
    );
    if !context.comm.is_root() {
        return 0.0;
    }
    let mut contacts: Vec<usize> = (0..points.len()).filter(|&j| !pairs[j].is_tied).collect();
    contacts.sort_by_key(|&j| points[j].contact);
    let of_contact = contacts.chunk_by(|&i, &j| points[i].contact == points[j].contact);
    let all = of_contact.map(|of_contact| {
        let at: Vec<[f64; 3]> = of_contact.iter().map(|&j| points[j].position).collect();
        let pairs: Vec<&PointPair> = of_contact.iter().map(|&j| &pairs[j]).collect();
        let mut largest = vec![0.0_f64; at.len()];
        for (i, j) in neighbours(&at) {
            largest[i] = largest[i].max(pairs[i].product(pairs[j]));
            largest[j] = largest[j].max(pairs[j].product(pairs[i]));
        }
        largest.iter().sum::<f64>()
    });
    all.sum()
}

/// The points of a group; empty on a rank that doesn't own it.
fn point_pairs(solved: Solved<'_>, of: &Transposed, g: GroupId) -> Vec<PointPair> {
    let (Some(group), Some(solution), Some(state)) = (
        solved.fixed.context.groups.get(&g),
        solved.solution.discrete.groups.get(&g),
        of.discrete.groups.get(&g),
    ) else {
        return Vec::new();
    };
    let mut pairs = vec![PointPair::default(); group.points.len()];
    let mut components = vec![0; group.points.len()];
    for (j, condition) in group.conditions().enumerate() {
        let (pair, k) = (
            &mut pairs[condition.point],
            &mut components[condition.point],
        );
        pair.is_tied = condition.is_tied;
        pair.force[*k] = solution.forces[j];
        pair.gap[*k] = solution.gaps[j];
        pair.multiplier[*k] = state.forces[j];
        pair.jump[*k] = state.gaps[j];
        match *k {
            0 => pair.is_closed = solution.closed[j],
            _ => pair.sticks = solution.closed[j],
        }
        *k += 1;
    }
    for law in group.point_laws() {
        if let Some(normal) = law.normal {
            let here = solution.point(&law);
            pairs[normal].left = (here.bound - here.size()).max(0.0);
        }
    }
    pairs
}

/// The pairs of neighbouring points: hardly farther from each other than from their nearest ones.
pub(super) fn neighbours(at: &[[f64; 3]]) -> Vec<(usize, usize)> {
    let extent = |axis: usize| {
        let all = at.iter().map(|x| x[axis]);
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        high - low
    };
    let axis = (0..3)
        .max_by(|&a, &b| extent(a).total_cmp(&extent(b)))
        .unwrap_or(0);
    let mut order: Vec<usize> = (0..at.len()).collect();
    order.sort_by(|&i, &j| at[i][axis].total_cmp(&at[j][axis]));
    let away = |i: usize, j: usize| length(difference(at[i], at[j]));
    // Both ways along the axis, until that alone is farther than `most`.
    let mut nearest = vec![f64::INFINITY; at.len()];
    for (place, &i) in order.iter().enumerate() {
        for &j in &order[place + 1..] {
            if at[j][axis] - at[i][axis] > nearest[i] {
                break;
            }
            let distance = away(i, j);
            if distance > 0.0 {
                nearest[i] = nearest[i].min(distance);
                nearest[j] = nearest[j].min(distance);
            }
        }
        for &j in order[..place].iter().rev() {
            if at[i][axis] - at[j][axis] > nearest[i] {
                break;
            }
            let distance = away(i, j);
            if distance > 0.0 {
                nearest[i] = nearest[i].min(distance);
            }
        }
    }
    let farthest = nearest
        .iter()
        .filter(|d| d.is_finite())
        .fold(0.0, |m: f64, &d| m.max(d));
    let mut pairs = Vec::new();
    for (place, &i) in order.iter().enumerate() {
        let near = order[place + 1..]
            .iter()
            .take_while(|&&j| at[j][axis] - at[i][axis] <= NEIGHBOUR * farthest);
        let near = near.filter(|&&j| away(i, j) <= NEIGHBOUR * nearest[i].max(nearest[j]));
        pairs.extend(near.map(|&j| (i, j)));
    }
    pairs
}
