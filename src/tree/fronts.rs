//! The fronts above all contact, for a fixed active set.

mod elimination;

use std::collections::BTreeMap;

use contact_dd_partition::id::{GroupId, OnClusters, OnGroups, OnTreeNodes, TreeNodeId};
use faer::Mat;

use crate::bddc::Bddc;
use crate::condense::Condensation;
use crate::contact::active_equalities::ActiveEqualities;
use crate::contact::dependent::DependentConstraints;
use crate::context::Context;
use crate::context::hierarchy::resting_limits;
use crate::error::Failure;
use crate::schur::cluster_schur::ClusterSchur;
use crate::schur::condensed::Condensed;
use crate::schur::merge::{MatrixPool, Merge};
use crate::schur::substitution::Replaced;
use crate::tree::front_jumps::FrontJumps;

/// Spring on an open normal jump, relative to its diagonal, where some part of the scene moves freely unless open
/// contacts hold it: the next active set closes those that stop it.
const SPRING: f64 = 1e-9;

/// Pivot between clusters, relative to its diagonal entry, above which it is more than round-off.
const NO_PIVOT: f64 = 1e-12;

/// A front with a fixed status of its own normal jumps.
#[derive(Debug)]
pub(super) struct ActiveSetFront {
    pub(super) merge: Merge,
    /// S of the closed jumps against themselves and the kept unknowns, a column each from the diagonal on.
    pub(super) held: Mat<f64>,
    /// Jumps of the front, with flags of its open limits.
    pub(super) jumps: FrontJumps,
}

/// The fronts of this rank above all contact, and the matrices that they are merged from.
#[derive(Debug)]
pub struct ActiveSetFronts {
    /// The nodes of the hierarchy above all clusters, children before parents, on all ranks the same.
    pub(super) nodes: Vec<TreeNodeId>,
    pub(super) fronts: OnTreeNodes<ActiveSetFront>,
    /// S of clusters and fronts, at the owner of the node that they are merged into.
    merged: OnTreeNodes<Condensed>,
    /// S of the roots among them.
    pub(super) merge_roots: OnTreeNodes<ClusterSchur>,
    replaced: OnTreeNodes<Vec<Replaced>>,
    /// The dependent rows of every contact group of this rank.
    rows: OnGroups<DependentConstraints>,
    spring: f64,
    spare: MatrixPool,
    /// The smallest pivot of the last factorization, relative to its diagonal entry.
    pub smallest_pivot: f64,
    /// Number of solves.
    pub solves: usize,
    /// Iterative solver between these roots, if they aren't the roots of the hierarchy.
    pub(super) bddc: Option<Bddc>,
}

impl ActiveSetFronts {
    /// Fronts over the `clusters` of this rank, by their index among all, beside those that are `merge_roots`
    /// themselves; none is factorized yet. Collective.
    ///
    /// # Errors
    /// A contact point without an unknown that can be replaced.
    pub fn new(
        condensation: &Condensation<'_>,
        mut clusters: OnClusters<Condensed>,
        merge_roots: OnTreeNodes<ClusterSchur>,
    ) -> Result<Self, Failure> {
        let context = &condensation.context;
        let plan = context.plan;
        let mut is_between = plan.tree.nodes.like(false);
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
            merge_roots,
            replaced,
            rows: context.comm.agree(rows.collect())?,
            spring: 0.0,
            spare: MatrixPool::default(),
            smallest_pivot: f64::INFINITY,
            solves: 0,
            bddc: None,
        };
        for (c, cluster) in plan.clusters.each() {
            fronts.pass_up(context, cluster.node, clusters.remove(&c));
        }
        Ok(fronts)
    }

    /// True if slipping points have to be held: springs restrain motions that the contacts leave free, and friction in
    /// space depends on the length of these motions.
    pub fn must_hold_slipping(&self, context: &Context<'_>) -> bool {
        self.spring > 0.0 && context.catalog.dim == 3 && context.catalog.has_friction()
    }

    /// Closes the slipping `limits` of group g, except those determined by limits that aren't `open`.
    pub(super) fn hold(&self, g: GroupId, limits: impl Iterator<Item = usize>, open: &mut [bool]) {
        let rows = &self.rows[&g];
        for t in limits {
            let follows = !rows.is_empty()
                && (rows.shares_in(t, open, &ActiveEqualities::new(rows, open))).is_some();
            open[t] = follows;
        }
    }

    /// Number of coarse unknowns of the iterative interface solver, if there is one; 0 except on the root.
    pub fn coarse_dofs(&self) -> Option<usize> {
        self.bddc.as_ref().map(|bddc| bddc.coarse_dofs)
    }

    /// Eliminates again all fronts above contact groups whose `open` flags changed; at first all. `open` has the groups
    /// of this rank. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn fix(
        &mut self,
        context: &Context<'_>,
        open: &OnGroups<Vec<bool>>,
    ) -> Result<(), Failure> {
        let is_known = self.fronts_known(context);
        self.factorize_definite(context, open, is_known, false)
    }

    /// Renews a preconditioner of an earlier active set for the present one. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn renew(
        &mut self,
        context: &Context<'_>,
        open: &OnGroups<Vec<bool>>,
    ) -> Result<(), Failure> {
        match self.bddc.as_ref().is_some_and(Bddc::is_stale) {
            true => self.factorize_definite(context, open, true, true),
            false => Ok(()),
        }
    }

    /// Improves an insufficient preconditioner: it is renewed for the active set, else its level is raised. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn improve_preconditioner(
        &mut self,
        context: &Context<'_>,
        open: &OnGroups<Vec<bool>>,
    ) -> Result<(), Failure> {
        if let Some(bddc) = self.bddc.as_mut().filter(|bddc| !bddc.is_stale()) {
            bddc.raise_level();
        }
        self.factorize_definite(context, open, true, true)
    }

    fn factorize_definite(
        &mut self,
        context: &Context<'_>,
        open: &OnGroups<Vec<bool>>,
        is_known: bool,
        renewed: bool,
    ) -> Result<(), Failure> {
        if self.factorize(context, open, is_known, renewed).is_ok() && !self.nearly_moves(context) {
            return Ok(());
        }
        self.spring = SPRING;
        self.factorize(context, open, false, true)
    }

    /// Removes the springs of earlier active sets if this one needs none; returns whether it did. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn release(
        &mut self,
        context: &Context<'_>,
        open: &OnGroups<Vec<bool>>,
    ) -> Result<bool, Failure> {
        if self.spring == 0.0 {
            return Ok(false);
        }
        self.spring = 0.0;
        self.factorize_definite(context, open, false, true)?;
        Ok(self.spring == 0.0)
    }

    /// True if the iterative interface solver's matrix without springs may be definite by round-off only. Collective.
    fn nearly_moves(&self, context: &Context<'_>) -> bool {
        let comm = context.comm;
        let pivot = self.bddc.as_ref().map(Bddc::smallest_pivot);
        let is_small = self.spring == 0.0 && pivot.is_some_and(|pivot| pivot < NO_PIVOT);
        let is_small = comm.collect(&is_small).contains(&true);
        comm.decide(is_small)
    }

    /// Eliminates the touched fronts, and makes the preconditioner between clusters. Collective.
    fn factorize(
        &mut self,
        context: &Context<'_>,
        open: &OnGroups<Vec<bool>>,
        is_known: bool,
        renewed: bool,
    ) -> Result<(), Failure> {
        let Context { comm, plan, .. } = *context;
        let touched = self.touched(context, open, is_known);
        let result = self.eliminate(context, open, &touched);
        comm.agree(result)?;
        if plan.has_one_cluster() || !renewed && !touched.values().contains(&true) {
            return Ok(());
        }
        let mut bddc = match self.bddc.take() {
            Some(bddc) => bddc,
            None => Bddc::new(context, &self.merge_roots)?,
        };
        let renewed = renewed || !is_known;
        // Matrices that an earlier preconditioner was made of have no mechanism, nor have those with springs.
        let is_sound = self.spring > 0.0 || !touched.values().contains(&true) && !bddc.is_stale();
        let mut fixed = bddc.fix(
            context,
            &self.merge_roots,
            &touched,
            open,
            (self.spring, renewed),
        );
        while fixed.is_err() && (bddc.is_provisional() || is_sound) && bddc.raise_level() {
            fixed = bddc.fix(
                context,
                &self.merge_roots,
                &touched,
                open,
                (self.spring, true),
            );
        }
        fixed?;
        let pivot = bddc.smallest_coarse_pivot();
        self.bddc = Some(bddc);
        self.smallest_pivot = self.smallest_pivot.min(pivot);
        Ok(())
    }

    /// True if all fronts were factorized before. Collective.
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
}
