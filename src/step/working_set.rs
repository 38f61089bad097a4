//! Working set of contact points: the points that a run with friction solves for, if most points never close.
//!
//! The matrix of all constraints grows with the square of their number, and in a pin with clearance one point in ten is
//! closed. Points outside the set stay open and have no unknowns. Their gaps are checked after every load step: points
//! that overlap are added, and the step is solved again. If none overlaps, the solution is that of all points.

use std::collections::BTreeMap;

use contact_dd_partition::contact_point::{ContactPoint, Law};
use contact_dd_partition::element::geometry::dot;
use contact_dd_partition::id::OnBlocks;
use contact_dd_partition::problem::{Catalog, SubdomainNode};
use contact_dd_partition::solver::Method;
use serde::{Deserialize, Serialize};

use crate::context::Context;
use crate::fem::contact_state::{ContactRow, ContactState};
use crate::settings::Settings;
use crate::step::transfer::jumps_of;

/// Number of constraints, tangential ones included, up to which all points are solved for at once.
const FEW: usize = 3000;
/// Smallest fraction of points with an initial gap: where sides touch initially, most points stay closed.
const LEAST_OPEN_SHARE: f64 = 0.5;
/// Largest fraction of all points in a set: a larger one saves less than it costs.
const LARGEST_SHARE: f64 = 0.7;

/// A working set, and the jumps of the points outside it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WorkingSet {
    /// The points of the set, by their indices in the catalog, ascending.
    pub points: Vec<usize>,
    /// The jump ⟦u⟧ of every point outside the set after the last load step (m), initially 0.
    pub outside: BTreeMap<usize, [f64; 3]>,
}

/// The closest approaches of contact points in several load steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ClosestApproaches {
    /// Flags of points that were closed in any step.
    pub closed: Vec<bool>,
    /// The smallest gap of every point (m).
    pub gaps: Vec<f64>,
}

impl ClosestApproaches {
    /// The closest approaches of `count` points before the first load step.
    pub fn new(count: usize) -> Self {
        Self {
            closed: vec![false; count],
            gaps: vec![f64::INFINITY; count],
        }
    }
}

/// Result of the check of the points outside a working set at the end of a load step.
pub enum Outside {
    /// All are open; these are their rows.
    Open(Vec<ContactRow>),
    /// Some overlap; this is the larger set for which the step is to be solved again.
    Overlaps(WorkingSet),
}

/// True if a working set may pay for a problem: friction at many points, most of them with an initial gap.
pub fn pays(catalog: &Catalog, settings: &Settings) -> bool {
    let request = settings.solver_request();
    let of_point = |point: &ContactPoint<SubdomainNode>| 1 + point.tangents(catalog.dim).len();
    let conditions: usize = catalog.points.iter().map(of_point).sum();
    let apart = catalog
        .points
        .iter()
        .filter(|point| can_wait(point))
        .count();
    catalog.has_friction()
        && conditions > FEW
        && apart as f64 >= LEAST_OPEN_SHARE * catalog.points.len() as f64
        // Quantities may refer to any point, and added or removed bodies have a state of their own.
        && catalog.quantities.is_empty()
        && !catalog.has_stages()
        && request.method == Method::Newton
        && request.iterative != Some(true)
        && !request.second_start
        && settings.max_sweeps.is_none()
}

/// True if a point has an initial gap, and no force while it is open.
fn can_wait(point: &ContactPoint<SubdomainNode>) -> bool {
    let is_free = match point.law {
        Law::Frictionless => true,
        Law::Coulomb { cohesion, .. } => cohesion == 0.0,
        Law::Given { .. } | Law::Tied => false,
    };
    let has_unknowns = point.is_equation() || point.is_compliant() || !point.motion.is_empty();
    is_free && point.gap > 0.0 && !has_unknowns
}

impl WorkingSet {
    /// The initial set: all points that closed in any load step without friction, and as many more with the smallest
    /// gaps; `None` if these are most points.
    pub fn predicted(catalog: &Catalog, approaches: &ClosestApproaches) -> Option<Self> {
        let ClosestApproaches { closed, gaps } = approaches;
        let always = |j: &usize| closed[*j] || !can_wait(&catalog.points[*j]);
        let set = Self::default().with(catalog, (0..closed.len()).filter(always), gaps);
        set.is_small_enough(catalog).then_some(set)
    }

    /// True if the set is small enough to pay.
    fn is_small_enough(&self, catalog: &Catalog) -> bool {
        self.points.len() as f64 <= LARGEST_SHARE * catalog.points.len() as f64
    }

    /// The set of all points.
    pub fn all(catalog: &Catalog) -> Self {
        Self {
            points: (0..catalog.points.len()).collect(),
            outside: BTreeMap::new(),
        }
    }

    /// The set enlarged by the points `join` and as many more with the smallest `gaps`, which may close as well; all
    /// points if the enlarged set doesn't pay.
    #[must_use]
    fn enlarged(&self, catalog: &Catalog, join: &[usize], gaps: &[f64]) -> Self {
        let grown = self.with(catalog, join.iter().copied(), gaps);
        match grown.is_small_enough(catalog) {
            true => grown,
            false => Self::all(catalog),
        }
    }

    fn with(&self, catalog: &Catalog, join: impl Iterator<Item = usize>, gaps: &[f64]) -> Self {
        let count = catalog.points.len();
        let mut is_in = vec![false; count];
        self.points.iter().for_each(|&j| is_in[j] = true);
        let mut joined = 0;
        for j in join {
            joined += usize::from(!is_in[j]);
            is_in[j] = true;
        }
        let mut others: Vec<usize> = (0..count).filter(|&j| !is_in[j]).collect();
        others.sort_by(|&a, &b| gaps[a].total_cmp(&gaps[b]));
        others.iter().take(joined).for_each(|&j| is_in[j] = true);
        let old = |j: usize| self.outside.get(&j).copied().unwrap_or_default();
        Self {
            points: (0..count).filter(|&j| is_in[j]).collect(),
            outside: (0..count)
                .filter(|&j| !is_in[j])
                .map(|j| (j, old(j)))
                .collect(),
        }
    }

    /// Checks the points outside the set for the displacement at the end of a load step, and keeps their jumps if all
    /// are open. Collective.
    pub fn after_step(
        &mut self,
        context: &Context<'_>,
        whole: &Catalog,
        displacement: &OnBlocks<Vec<f64>>,
    ) -> Outside {
        let jumps = self.jumps_outside(context, whole, displacement);
        let gaps = gaps_left(whole, &jumps);
        let overlap: Vec<usize> = (0..gaps.len()).filter(|&j| gaps[j] < 0.0).collect();
        if !overlap.is_empty() {
            return Outside::Overlaps(self.enlarged(whole, &overlap, &gaps));
        }
        let rows = open_rows(whole, &jumps);
        self.outside = jumps;
        Outside::Open(rows)
    }

    /// The jumps ⟦u⟧ of the points outside the set for a displacement (m), on all ranks. Collective.
    fn jumps_outside(
        &self,
        context: &Context<'_>,
        whole: &Catalog,
        displacement: &OnBlocks<Vec<f64>>,
    ) -> BTreeMap<usize, [f64; 3]> {
        let places: Vec<usize> = self.outside.keys().copied().collect();
        let jumps = jumps_of(&places, context, whole, displacement);
        let mut jumps = places.into_iter().zip(jumps).collect();
        context.comm.broadcast(&mut jumps);
        jumps
    }
}

/// The remaining gaps of points outside a working set from their jumps, infinite for other points (m).
fn gaps_left(catalog: &Catalog, jumps: &BTreeMap<usize, [f64; 3]>) -> Vec<f64> {
    let mut gaps = vec![f64::INFINITY; catalog.points.len()];
    for (&j, jump) in jumps {
        let point = &catalog.points[j];
        gaps[j] = point.gap - dot(point.normal(), *jump);
    }
    gaps
}

/// The rows of the points outside a working set, which are open, with these jumps.
fn open_rows(catalog: &Catalog, jumps: &BTreeMap<usize, [f64; 3]>) -> Vec<ContactRow> {
    let row = |(&j, jump): (&usize, &[f64; 3])| {
        let point = &catalog.points[j];
        let mut slip = [0.0; 3];
        for t in point.tangents(catalog.dim) {
            let along = dot(*t, *jump);
            slip = std::array::from_fn(|k| slip[k] + along * t[k]);
        }
        let state = ContactState {
            gap: point.gap - dot(point.normal(), *jump),
            slip,
            ..ContactState::default()
        };
        (point.rename(|_| None), state)
    };
    jumps.iter().map(row).collect()
}
