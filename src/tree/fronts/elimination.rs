//! The elimination of the fronts that a change of the active set touches, children before parents.

use contact_dd_partition::id::{GroupId, OnGroups, TreeNodeId};
use contact_dd_partition::numbered::Numbered;
use faer::Mat;

use super::{ActiveSetFront, ActiveSetFronts};
use crate::context::Context;
use crate::error::Failure;
use crate::schur::cluster_schur::ClusterSchur;
use crate::schur::condensed::Condensed;
use crate::schur::front_order::OwnJumps;
use crate::schur::merge::Merge;
use crate::tree::front_jumps::FrontJumps;

impl ActiveSetFronts {
    /// Sends S of a node to the owner of the node that it is merged into. Collective.
    pub(super) fn pass_up(
        &mut self,
        context: &Context<'_>,
        v: TreeNodeId,
        mut condensed: Option<Condensed>,
    ) {
        let Context { comm, plan, .. } = *context;
        let Some(parent) = plan.merged_into(v) else {
            if let Some(top) = condensed {
                let (packed, s) = ClusterSchur::packed(top);
                self.merge_roots.insert(v, packed);
                self.spare.keep(s);
            }
            return;
        };
        let route = (plan.node_owners[v], plan.node_owners[parent]);
        comm.route(
            [route],
            |_| condensed.take(),
            |_, arrived| {
                self.merged.extend(arrived.map(|condensed| (v, condensed)));
            },
        );
    }

    /// The nodes that a change of the active set touches, on all ranks. Collective.
    pub(super) fn touched(
        &self,
        context: &Context<'_>,
        open: &OnGroups<Vec<bool>>,
        is_known: bool,
    ) -> Numbered<TreeNodeId, bool> {
        let Context { comm, plan, .. } = *context;
        let changed = |g: GroupId| {
            let front = self
                .fronts
                .get(&plan.groups[g].node)
                .map(|front| &front.jumps.open);
            let between = || self.bddc.as_ref().and_then(|bddc| bddc.open(g));
            // Groups of ties only never change.
            !open[&g].is_empty() && front.or_else(between) != Some(&open[&g])
        };
        let mut touched = plan.tree.nodes.like(!is_known);
        comm.gather(&plan.group_owners(), changed, |g, changed| {
            touched[plan.groups[g].node] |= changed;
        });
        comm.broadcast(&mut touched);
        plan.mark_above(&mut touched);
        touched
    }

    /// Eliminates the touched fronts. Collective; failures of this rank are returned at the end.
    pub(super) fn eliminate(
        &mut self,
        context: &Context<'_>,
        open: &OnGroups<Vec<bool>>,
        touched: &Numbered<TreeNodeId, bool>,
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

    /// Merges the children of node v of this rank; `None` if one of them failed.
    fn merge(
        &mut self,
        context: &Context<'_>,
        v: TreeNodeId,
        open: &OnGroups<Vec<bool>>,
    ) -> Result<Option<Condensed>, Failure> {
        let Context { plan, par, .. } = *context;
        let node = &plan.tree.nodes[v];
        let children = node.children.iter().map(|child| self.merged.get(child));
        let Some(children) = children.collect::<Option<Vec<&Condensed>>>() else {
            return Ok(None);
        };
        let none = Vec::new();
        let replaced = self.replaced.get(&v).unwrap_or(&none);
        let of_group = |g: GroupId| FrontJumps::new(&self.rows[&g], &open[&g]);
        let jumps = plan.group_of(v).map(of_group).unwrap_or_default();
        let own = OwnJumps {
            replaced: &jumps.replaced(replaced),
            open: &jumps.open_in_front(),
            spring: self.spring,
        };
        let (merge, whole) = Merge::of(&children, &node.eliminated, own, &mut self.spare, par)
            .map_err(|free| {
                Failure::ill_posed(format!(
                    "a part of the scene can move although all contacts under pressure are closed \
                     (found at node {} of /interface/interface); expected supports or contact against it",
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
