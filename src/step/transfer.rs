//! Transfer of state from one stage to the next, between which bodies or contacts are added or removed.

use std::collections::BTreeMap;
use std::ops::Range;

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::geometry::{advance, dot, padded};
use contact_dd_partition::id::{GroupId, OnBlocks, OnGroups};
use contact_dd_partition::problem::stage::Stage;
use contact_dd_partition::problem::{Catalog, SubdomainNode};
use serde::{Deserialize, Serialize};

use crate::bytes::Reals;
use crate::context::Context;
use crate::step::state::StepState;

/// Transfer from one stage to the next; contact points are given by their index in the catalog of the whole problem.
/// Empty before the first stage.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct StageTransfer {
    /// The jump ⟦u⟧ of every point when it was added (m).
    pub since: Vec<[f64; 3]>,
    /// The tangential jumps of the points with friction that were present (m).
    slips: BTreeMap<usize, Vec<f64>>,
    /// The closing motions of bodies.
    pub closing_motions: Vec<Vec<f64>>,
}

/// The state at the end of a stage.
#[derive(Clone, Copy)]
pub struct StageEnd<'a> {
    /// The displacement of every block of this rank, node by node (m).
    pub displacement: &'a OnBlocks<Vec<f64>>,
    /// The tangential jumps of every contact group of this rank (m).
    pub slips: &'a OnGroups<Vec<f64>>,
    /// The closing motions of bodies.
    pub closing_motions: &'a [Vec<f64>],
}

impl StageTransfer {
    /// The transfer from the last load step of a `stage`, which began with this transfer and ended in the state `end`,
    /// to the load steps `next`; `whole` is the problem. Collective.
    pub fn after(
        &self,
        context: &Context<'_>,
        stage: &Stage<'_>,
        end: StageEnd<'_>,
        whole: &Catalog,
        next: &Range<usize>,
    ) -> Self {
        let comm = context.comm;
        let coming: Vec<usize> = (0..whole.points.len())
            .filter(|j| stage.points.binary_search(j).is_err())
            .filter(|&j| whole.is_there(&whole.points[j], next.start))
            .collect();
        let jumps = jumps_of(&coming, context, whole, end.displacement);
        let mut transfer = Self {
            since: match self.since.is_empty() {
                true => vec![[0.0; 3]; whole.points.len()],
                false => self.since.clone(),
            },
            slips: slips_of_points(context, stage, whole, end.slips),
            closing_motions: end.closing_motions.to_vec(),
        };
        for (&j, jump) in coming.iter().zip(jumps) {
            transfer.since[j] = jump;
        }
        comm.broadcast(&mut transfer);
        transfer
    }

    /// The transfer within a stage from one working set of contact points to another: the tangential jumps of its
    /// points are `slips`, those of the points `outside` are computed from their jumps. Collective.
    pub fn between_sets(
        context: &Context<'_>,
        stage: &Stage<'_>,
        slips: &OnGroups<Vec<f64>>,
        outside: &BTreeMap<usize, [f64; 3]>,
        whole: &Catalog,
    ) -> Self {
        let mut slips = slips_of_points(context, stage, whole, slips);
        for (&place, jump) in outside {
            let tangents = whole.points[place].tangents(whole.dim).iter();
            slips.insert(place, tangents.map(|t| dot(*t, *jump)).collect());
        }
        let mut transfer = Self {
            since: vec![[0.0; 3]; whole.points.len()],
            slips,
            closing_motions: Vec::new(),
        };
        context.comm.broadcast(&mut transfer);
        transfer
    }

    /// The initial state of a `stage`: added contacts stick where they are added.
    pub fn state(&self, context: &Context<'_>, stage: &Stage<'_>) -> StepState {
        if self.since.is_empty() {
            return StepState::default();
        }
        let of_group = |g: GroupId| {
            let points = &context.plan.tree.nodes[context.plan.groups[g].node].points;
            let of_group = context.groups[&g].points.iter().zip(points);
            let slips =
                of_group.flat_map(
                    |(point, &j)| match self.slips.get(&stage.points[j as usize]) {
                        Some(slips) => slips.clone(),
                        None => {
                            let tangents = point.tangents(context.catalog.dim).iter();
                            tangents.map(|t| dot(*t, point.since)).collect()
                        }
                    },
                );
            slips.collect()
        };
        StepState {
            slips: context.groups.keys().map(|&g| (g, of_group(g))).collect(),
            ..StepState::default()
        }
    }
}

/// The jumps ⟦u⟧ of these contact points of the `whole` problem for the displacement of every block (m); on the root.
/// Collective.
pub fn jumps_of(
    places: &[usize],
    context: &Context<'_>,
    whole: &Catalog,
    displacement: &OnBlocks<Vec<f64>>,
) -> Vec<[f64; 3]> {
    let points = places.iter().map(|&j| whole.points[j].clone());
    jumps_of_points(&points.collect::<Vec<_>>(), context, displacement)
}

/// The jumps ⟦u⟧ of points for the displacement of every block (m); on the root. Collective.
pub fn jumps_of_points(
    points: &[ContactPoint<SubdomainNode>],
    context: &Context<'_>,
    displacement: &OnBlocks<Vec<f64>>,
) -> Vec<[f64; 3]> {
    let (comm, dim) = (context.comm, context.catalog.dim);
    let mut wanted: OnBlocks<Vec<u32>> = BTreeMap::new();
    for (at, _) in points.iter().flat_map(|point| &point.entries) {
        wanted.entry(at.block()).or_default().push(at.node);
    }
    let mut moved = BTreeMap::new();
    comm.gather(
        &context.plan.owners(),
        |b| {
            let u = &displacement[&b];
            let nodes = wanted.get(&b).into_iter().flatten();
            let of_node = |&node: &u32| padded(&u[node as usize * dim..][..dim]);
            nodes.map(of_node).collect::<Vec<[f64; 3]>>()
        },
        |b, u| {
            moved.insert(b, u.into_iter());
        },
    );
    let mut of_node = |at: &SubdomainNode| {
        let u = moved.get_mut(&at.block()).and_then(Iterator::next);
        u.unwrap_or_default()
    };
    let own = points.iter().filter(|_| comm.is_root());
    own.map(|point| jump(point, &mut of_node)).collect()
}

/// The tangential jumps of the contact points of a `stage` with friction (m), by their index in the `whole` problem,
/// from those of the groups of this rank; on the root. Collective.
fn slips_of_points(
    context: &Context<'_>,
    stage: &Stage<'_>,
    whole: &Catalog,
    slips: &OnGroups<Vec<f64>>,
) -> BTreeMap<usize, Vec<f64>> {
    let &Context { comm, plan, .. } = context;
    let mut of_points = BTreeMap::new();
    comm.gather(
        &plan.group_owners(),
        |g| Reals(slips.get(&g).cloned().unwrap_or_default()),
        |g, Reals(slips)| {
            let mut rest = &slips[..];
            for &j in &plan.tree.nodes[plan.groups[g].node].points {
                let place = stage.points[j as usize];
                let (own, others) = rest.split_at(whole.points[place].tangents(whole.dim).len());
                rest = others;
                if !own.is_empty() {
                    of_points.insert(place, own.to_vec());
                }
            }
        },
    );
    of_points
}

/// The jump of a point for the displacements of its nodes; that of an equation is along the axis of its first one.
fn jump(
    point: &ContactPoint<SubdomainNode>,
    mut displacement: impl FnMut(&SubdomainNode) -> [f64; 3],
) -> [f64; 3] {
    let mut jump = [0.0; 3];
    for (i, (at, weight)) in point.entries.iter().enumerate() {
        let u = displacement(at);
        jump = match point.axes.get(i) {
            Some(axis) => advance(jump, weight * dot(*axis, u), point.normal()),
            None => advance(jump, *weight, u),
        };
    }
    jump
}
