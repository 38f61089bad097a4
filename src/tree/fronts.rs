//! The fronts above all contact, for a fixed active set.

use std::collections::BTreeMap;

use faer::Mat;

use crate::bddc::Bddc;
use crate::bddc::cluster_schur::ClusterSchur;
use crate::condense::Condensation;
use crate::contact::active_equalities::ActiveEqualities;
use crate::contact::dependent::DependentConstraints;
use crate::context::Context;
use crate::context::hierarchy::resting_limits;
use crate::error::Failure;
use crate::schur::condensed::Condensed;
use crate::schur::merge::{Merge, OwnJumps, Spare};
use crate::schur::substitution::Replaced;
use crate::tree::front_jumps::FrontJumps;

/// The spring on an open normal jump, relative to its diagonal, where some part of the scene moves freely without
/// the contacts that are open: the next active set closes what stops it.
const SPRING: f64 = 1e-9;

/// The least pivot between clusters, relative to its diagonal entry, that isn't of round-off.
const NO_PIVOT: f64 = 1e-12;

/// A front whose own normal jumps are open or closed.
#[derive(Debug)]
pub(super) struct ActiveSetFront {
    pub(super) merge: Merge,
    /// S of the closed ones against them and what is kept, a column each from the diagonal on.
    pub(super) held: Mat<f64>,
    /// Its jumps, and which limits of them are open.
    pub(super) jumps: FrontJumps,
}

/// The fronts of this rank above all contact, and what they are merged from.
#[derive(Debug)]
pub struct ActiveSetFronts {
    /// The nodes of the hierarchy above all clusters, children before parents, on all ranks the same.
    pub(super) nodes: Vec<usize>,
    pub(super) fronts: BTreeMap<usize, ActiveSetFront>,
    /// S of clusters and fronts, at the owner of the node that they are merged into.
    merged: BTreeMap<usize, Condensed>,
    /// S of those that nothing here is above.
    pub(super) merge_roots: BTreeMap<usize, ClusterSchur>,
    replaced: BTreeMap<usize, Vec<Replaced>>,
    /// The dependent rows of every contact group of this rank.
    rows: BTreeMap<usize, DependentConstraints>,
    spring: f64,
    spare: Spare,
    /// The smallest pivot of the last factorization, relative to its diagonal entry.
    pub smallest_pivot: f64,
    /// Number of loads that they were solved for.
    pub solves: usize,
    /// What works between the nodes that nothing here is above, where these aren't the roots of the hierarchy.
    pub(super) bddc: Option<Bddc>,
}

impl ActiveSetFronts {
    /// Fronts over the `clusters` of this rank, by their place among all; none is factorized yet. Collective.
    ///
    /// # Errors
    /// A contact point that nothing can be replaced for.
    pub fn new(
        condensation: &Condensation<'_>,
        mut clusters: BTreeMap<usize, Condensed>,
    ) -> Result<Self, Failure> {
        let context = &condensation.context;
        let plan = context.plan;
        let mut is_between = vec![false; plan.tree.nodes.len()];
        for v in plan.merge_roots.iter().flat_map(|&v| plan.tree.subtree(v)) {
            is_between[v] = true;
        }
        for cluster in &plan.clusters {
            for v in plan.tree.subtree(cluster.node) {
                is_between[v] = false;
            }
        }
        let nodes = plan.deepest_first(|v| is_between[v]);
        let own = plan
            .groups
            .iter()
            .filter(|group| plan.node_owners[group.node] == context.comm.rank());
        let replaced = own.map(|group| Ok((group.node, condensation.replaced(group.node)?)));
        let replaced = context.comm.agree(replaced.collect())?;
        let rows = context.groups.iter();
        let rows = rows.map(|(&g, group)| Ok((g, resting_limits(context, g, group)?.rows)));
        let mut fronts = Self {
            nodes,
            fronts: BTreeMap::new(),
            merged: BTreeMap::new(),
            merge_roots: BTreeMap::new(),
            replaced,
            rows: context.comm.agree(rows.collect())?,
            spring: 0.0,
            spare: Spare::default(),
            smallest_pivot: f64::INFINITY,
            solves: 0,
            bddc: None,
        };
        for (c, cluster) in plan.clusters.iter().enumerate() {
            fronts.pass_up(context, cluster.node, clusters.remove(&c));
        }
        Ok(fronts)
    }

    /// Whether what slips is to be held: springs hold what is open, as something moves without them, and friction in space
    /// depends on how far that goes.
    pub fn has_to_hold(&self, context: &Context<'_>) -> bool {
        self.spring > 0.0 && context.catalog.dim == 3 && context.catalog.has_friction()
    }

    /// Closes those of the slipping `limits` of group g that don't follow from what isn't `open`.
    pub(super) fn hold(&self, g: usize, limits: impl Iterator<Item = usize>, open: &mut [bool]) {
        let rows = &self.rows[&g];
        for t in limits {
            let follows = !rows.is_empty()
                && (rows.shares_in(t, open, &ActiveEqualities::new(rows, open))).is_some();
            open[t] = follows;
        }
    }

    /// Number of coarse unknowns of the iterative interface solver, where there is one; 0 but on the root.
    pub fn coarse_dofs(&self) -> Option<usize> {
        self.bddc.as_ref().map(|bddc| bddc.coarse_dofs)
    }

    /// Brings S of a node to the owner of the one that it is merged into. Collective.
    fn pass_up(&mut self, context: &Context<'_>, v: usize, mut condensed: Option<Condensed>) {
        let Context { comm, plan, .. } = *context;
        let Some(parent) = plan.merged_into(v) else {
            self.merge_roots
                .extend(condensed.map(|top| (v, top.into())));
            return;
        };
        let way = (plan.node_owners[v], plan.node_owners[parent]);
        comm.route(
            [way],
            |_| condensed.take(),
            |_, arrived| {
                self.merged.extend(arrived.map(|condensed| (v, condensed)));
            },
        );
    }

    /// Eliminates again whatever is above a contact group that isn't `open` as it was; all at first. Collective;
    /// `open` says it of the groups of this rank.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn fix(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
    ) -> Result<(), Failure> {
        let is_known = self.fronts_known(context);
        self.make(context, open, is_known, false)
    }

    /// Makes the preconditioner that of the active set, where there is one that isn't. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn renew(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
    ) -> Result<(), Failure> {
        match self.bddc.as_ref().is_some_and(Bddc::is_stale) {
            true => self.make(context, open, true, true),
            false => Ok(()),
        }
    }

    /// Makes a preconditioner better that is too bad: that of the active set, else one that looks into what clusters
    /// share. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn make_better(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
    ) -> Result<(), Failure> {
        if let Some(bddc) = self.bddc.as_mut().filter(|bddc| !bddc.is_stale()) {
            bddc.look_deeper();
        }
        self.make(context, open, true, true)
    }

    fn make(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
        is_known: bool,
        renewed: bool,
    ) -> Result<(), Failure> {
        if self.factorize(context, open, is_known, renewed).is_ok() && !self.nearly_moves(context) {
            return Ok(());
        }
        self.spring = SPRING;
        self.factorize(context, open, false, true)
    }

    /// Takes the springs of earlier active sets away where this one needs none; returns whether it did. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn release(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
    ) -> Result<bool, Failure> {
        if self.spring == 0.0 {
            return Ok(false);
        }
        self.spring = 0.0;
        self.make(context, open, false, true)?;
        Ok(self.spring == 0.0)
    }

    /// Whether what the iterative interface solver holds without springs may be held by round-off alone. Collective.
    fn nearly_moves(&self, context: &Context<'_>) -> bool {
        let comm = context.comm;
        let pivot = self.bddc.as_ref().map(Bddc::smallest_pivot);
        let is_small = self.spring == 0.0 && pivot.is_some_and(|pivot| pivot < NO_PIVOT);
        let is_small = comm.collect(&is_small).contains(&true);
        comm.decide(is_small)
    }

    /// Eliminates what is touched, and makes the preconditioner between clusters. Collective.
    fn factorize(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
        is_known: bool,
        renewed: bool,
    ) -> Result<(), Failure> {
        let Context { comm, plan, .. } = *context;
        let touched = self.touched(context, open, is_known);
        let result = self.eliminate(context, open, &touched);
        comm.agree(result)?;
        if plan.has_one_cluster() || !renewed && !touched.contains(&true) {
            return Ok(());
        }
        let mut bddc = match self.bddc.take() {
            Some(bddc) => bddc,
            None => Bddc::new(context, &self.merge_roots)?,
        };
        let renewed = renewed || !is_known;
        // What was made before, with another preconditioner, can't move, nor can what springs hold.
        let is_sound = self.spring > 0.0 || !touched.contains(&true) && !bddc.is_stale();
        let mut fixed = bddc.fix(
            context,
            &self.merge_roots,
            &touched,
            open,
            (self.spring, renewed),
        );
        while fixed.is_err() && (bddc.is_judged() || is_sound) && bddc.look_deeper() {
            fixed = bddc.fix(
                context,
                &self.merge_roots,
                &touched,
                open,
                (self.spring, true),
            );
        }
        fixed?;
        let pivot = bddc.coarse_pivot();
        self.bddc = Some(bddc);
        self.smallest_pivot = self.smallest_pivot.min(pivot);
        Ok(())
    }

    /// Whether all fronts were factorized before. Collective.
    fn fronts_known(&self, context: &Context<'_>) -> bool {
        let Context { comm, plan, .. } = *context;
        let own = self
            .nodes
            .iter()
            .filter(|&&v| plan.node_owners[v] == comm.rank());
        let between = plan.has_one_cluster() || self.bddc.is_some();
        let mine = own.count() == self.fronts.len() && between;
        let all = !comm.collect(&mine).contains(&false);
        comm.decide(all)
    }

    /// The nodes that a change of the active set touches, on all ranks. Collective.
    fn touched(
        &self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
        is_known: bool,
    ) -> Vec<bool> {
        let Context { comm, plan, .. } = *context;
        let changed = |g: usize| {
            let front = self
                .fronts
                .get(&plan.groups[g].node)
                .map(|front| &front.jumps.open);
            let between = || self.bddc.as_ref().and_then(|bddc| bddc.open(g));
            // Of ties alone nothing ever changes.
            !open[&g].is_empty() && front.or_else(between) != Some(&open[&g])
        };
        let mut touched = vec![!is_known; plan.tree.nodes.len()];
        comm.gather(&plan.group_owners(), changed, |g, changed| {
            touched[plan.groups[g].node] |= changed;
        });
        comm.broadcast(&mut touched);
        plan.mark_above(&mut touched);
        touched
    }

    /// Eliminates what is touched. Collective; what failed on this rank is said at the end.
    fn eliminate(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
        touched: &[bool],
    ) -> Result<(), Failure> {
        let mut result = Ok(());
        self.smallest_pivot = f64::INFINITY;
        for v in self.nodes.clone() {
            if !touched[v] {
                continue;
            }
            let mine = context.plan.node_owners[v] == context.comm.rank();
            let merged = match mine && result.is_ok() {
                true => self.merge(context, v, open),
                false => Ok(None),
            };
            let condensed = merged.unwrap_or_else(|failure| {
                self.fronts.remove(&v);
                result = Err(failure);
                None
            });
            self.pass_up(context, v, condensed);
        }
        result
    }

    /// Merges the children of node v of this rank; nothing where one of them failed.
    fn merge(
        &mut self,
        context: &Context<'_>,
        v: usize,
        open: &BTreeMap<usize, Vec<bool>>,
    ) -> Result<Option<Condensed>, Failure> {
        let Context { plan, par, .. } = *context;
        let node = &plan.tree.nodes[v];
        let children = node.children.iter().map(|child| self.merged.get(child));
        let Some(children) = children.collect::<Option<Vec<&Condensed>>>() else {
            return Ok(None);
        };
        let none = Vec::new();
        let replaced = self.replaced.get(&v).unwrap_or(&none);
        let of_group = |g: usize| FrontJumps::new(&self.rows[&g], &open[&g]);
        let jumps = plan.group_of(v).map(of_group).unwrap_or_default();
        let own = OwnJumps {
            replaced: &jumps.replaced(replaced),
            open: &jumps.open_in_front(),
            spring: self.spring,
        };
        let (merge, whole) = Merge::of(&children, &node.eliminated, own, &mut self.spare, par)
            .map_err(|free| {
                Failure::ill_posed(format!(
                    "a part of the scene can move although every contact that presses is held (found \
                     at node {} of /interface/interface); expected supports or contact that hold it",
                    free.0.node
                ))
            })?;
        let (closed, n) = (whole.jumps, whole.s.nrows());
        let mut held = Mat::zeros(n, closed);
        copy_lower(&whole.s, 0, &mut held);
        let s = match closed {
            0 => whole.s,
            _ => {
                let mut kept = Mat::zeros(n - closed, n - closed);
                copy_lower(&whole.s, closed, &mut kept);
                self.spare.keep(whole.s);
                kept
            }
        };
        let condensed = Condensed {
            jumps: 0,
            s,
            diagonal: whole.diagonal[closed..].to_vec(),
            interface_dofs: whole.interface_dofs,
            smallest_pivot: whole.smallest_pivot,
        };
        self.smallest_pivot = self.smallest_pivot.min(whole.smallest_pivot);
        self.fronts.insert(v, ActiveSetFront { merge, held, jumps });
        Ok(Some(condensed))
    }
}

/// Copies the first columns of the lower triangle from row and column `first` of a matrix on.
fn copy_lower(from: &Mat<f64>, first: usize, to: &mut Mat<f64>) {
    for j in 0..to.ncols() {
        let below = &from.col_as_slice(first + j)[first + j..];
        to.col_as_slice_mut(j)[j..].copy_from_slice(below);
    }
}
