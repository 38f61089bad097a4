//! Scalable interface solver: conjugate gradients on the unknowns shared by clusters, preconditioned by balancing
//! domain decomposition by constraints (BDDC).
//!
//! The clusters are those of the problem file. Unknowns shared by the same clusters form a class. Of each class, some
//! linear combinations, the coarse unknowns, are equal in all of its clusters; the others are solved for in every
//! cluster independently. Contact constraints between clusters are ties where they are closed.

mod bases;
mod between;
mod class_sums;
mod classes;
mod closed;
mod cluster_unknowns;
mod coarse;
mod conjugate_gradients;
mod constraints;
mod householder;
pub mod loads;
mod local;
mod motions;
mod placement;
mod preconditioner_level;
mod slipping;
pub mod solution;
mod transform;

use std::collections::{BTreeMap, BTreeSet};

use contact_dd_partition::id::{
    GroupId, MergeRootId, OnGroups, OnMergeRoots, OnTreeNodes, TreeNodeId,
};
use contact_dd_partition::numbered::Numbered;

use self::between::{Between, between};
use self::class_sums::ClassSums;
use self::classes::{Class, Classes};
use self::closed::{GroupBetween, Ties};
use self::cluster_unknowns::ClusterUnknowns;
use self::coarse::{Coarse, Part};
use self::constraints::{Mechanism, Side};
use self::local::{Local, Shared};
use self::motions::SharedNodes;
use self::placement::Placement;
use self::preconditioner_level::PreconditionerLevel;
use crate::comm::Comm;
use crate::contact::jumps::NoUnknown;
use crate::context::Context;
use crate::error::Failure;
use crate::schur::cluster_schur::ClusterSchur;
use crate::schur::condensed::InterfaceDof;
use crate::schur::symmetric::PackedSymmetric;

/// The unknowns of contact groups in a cluster.
#[derive(Debug)]
struct AtContact {
    /// Their places among the unknowns of the cluster, ascending.
    places: Vec<usize>,
    /// The ties that carry forces from them to others.
    ties: Vec<usize>,
}

/// The clusters and the contact groups between them.
#[derive(Debug)]
pub struct Bddc {
    /// The owner of every cluster.
    owners: Numbered<MergeRootId, usize>,
    /// The unknowns of all clusters, on all ranks.
    unknowns: ClusterUnknowns,
    /// The contact groups between clusters.
    between: Vec<Between>,
    /// The contact groups of this rank, by number.
    groups: OnGroups<GroupBetween>,
    ties: Ties,
    /// The unknowns of contact groups in every cluster of this rank.
    at_contact: OnMergeRoots<AtContact>,
    nodes: SharedNodes,
    classes: Classes,
    sums: ClassSums,
    level: PreconditionerLevel,
    /// The clusters of this rank, in the bases of their classes.
    locals: OnMergeRoots<Local>,
    /// Flags, on all ranks, of the clusters whose S has changed since their part of the preconditioner was computed.
    stale: Numbered<MergeRootId, bool>,
    coarse: Coarse,
    /// Number of coarse unknowns; on the root.
    pub coarse_dofs: usize,
}

impl Bddc {
    /// The solver for these `clusters`, by node; nothing is factorized yet. Collective.
    ///
    /// # Errors
    /// A contact point none of whose unknowns can be replaced by its jump.
    pub fn new(
        context: &Context<'_>,
        clusters: &OnTreeNodes<ClusterSchur>,
    ) -> Result<Self, Failure> {
        let Context { comm, plan, .. } = *context;
        let owners = plan.owners_of(&plan.merge_roots);
        let own = |c: MergeRootId| Some(clusters.get(&plan.merge_roots[c])?.dofs.clone());
        let dofs = comm.gathered(&owners, own).into_iter();
        let mut dofs: Numbered<MergeRootId, Vec<InterfaceDof>> = dofs.flatten().collect();
        comm.broadcast(&mut dofs);
        let numbers: Vec<GroupId> = (plan.groups.ids())
            .filter(|&g| plan.is_above_merge_roots(plan.groups[g].node))
            .collect();
        let own = numbers
            .iter()
            .filter_map(|g| Some((*g, context.groups.get(g)?)));
        let groups = own.map(|(g, group)| Ok((g, GroupBetween::new(context, g, group)?)));
        let groups: OnGroups<GroupBetween> = comm.agree(groups.collect())?;
        let group_owners: Vec<usize> = (numbers.iter())
            .map(|&g| plan.node_owners[plan.groups[g].node])
            .collect();
        let mut of_groups = comm.gathered(&group_owners, |i| groups[&numbers[i]].dofs());
        comm.broadcast(&mut of_groups);
        let between = between(&dofs, numbers.into_iter().zip(group_owners).zip(of_groups));
        let in_contact = unknowns_of(&between);
        let own = owners.each().filter(|(_, owner)| **owner == comm.rank());
        let at_contact = own.map(|(c, _)| {
            let places = dofs[c].iter().enumerate();
            let places = places.filter(|(_, dof)| in_contact.contains(dof));
            let places = places.map(|(i, _)| i).collect();
            let ties = Vec::new();
            (c, AtContact { places, ties })
        });
        let at_contact = at_contact.collect();
        Ok(Self {
            at_contact,
            stale: dofs.like(true),
            nodes: SharedNodes::new(context, &dofs),
            level: PreconditionerLevel::first(context.catalog.dim),
            between,
            owners,
            unknowns: ClusterUnknowns::new(dofs),
            groups,
            ties: Ties::default(),
            classes: Classes::default(),
            sums: ClassSums::default(),
            locals: BTreeMap::new(),
            coarse: Coarse::new(plan),
            coarse_dofs: 0,
        })
    }

    /// Fixes the set of `open` constraints of the groups between clusters. Collective.
    ///
    /// # Errors
    /// A closed jump that replaces no unknown.
    fn fix_groups(
        &mut self,
        context: &Context<'_>,
        open: &OnGroups<Vec<bool>>,
    ) -> Result<(), Failure> {
        let plan = context.plan;
        let mut fixed = Ok(());
        for (&g, of_group) in &mut self.groups {
            let eliminated = &plan.tree.nodes[plan.groups[g].node].eliminated;
            let result = of_group.fix(&context.groups[&g], &open[&g], eliminated);
            fixed = fixed.and(result.map_err(|NoUnknown(t)| {
                Failure::internal(format!(
                    "contact group {g}: closed jump {t} replaces nothing"
                ))
            }));
        }
        context.comm.agree(fixed)
    }

    /// The classes whose basis is recomputed: those that differ from the ones `before`, and, if the preconditioner is
    /// to be `renewed`, those of clusters that have `changed`.
    fn made(
        &self,
        before: &Classes,
        changed: &Numbered<MergeRootId, bool>,
        renewed: bool,
    ) -> Vec<bool> {
        let made = |class: &Class| {
            let has_changed = || class.clusters.iter().any(|&c| changed[c]);
            let is_new = before.place_of(class).is_none();
            !class.is_coarse() && (is_new || renewed && has_changed())
        };
        self.classes.list.iter().map(made).collect()
    }

    /// Replaces the data of clusters on the unknowns that they share.
    fn refresh(&mut self, shared: OnMergeRoots<Shared>) {
        for (c, shared) in shared {
            let local = self.locals.entry(c);
            local.and_modify(|local| local.shared = shared);
        }
    }

    /// Fixes the set of `open` constraints; `touched` are the clusters that this affects. A `spring`, relative to the
    /// diagonal, acts on all unknowns of constraints between clusters. The preconditioner is recomputed where clusters
    /// share other unknowns than before, and, if it is to be `renewed`, wherever S has changed. Collective.
    ///
    /// # Errors
    /// A part of the scene has a free rigid-body motion.
    pub fn fix(
        &mut self,
        context: &Context<'_>,
        clusters: &OnTreeNodes<ClusterSchur>,
        touched: &Numbered<TreeNodeId, bool>,
        open: &OnGroups<Vec<bool>>,
        (spring, renewed): (f64, bool),
    ) -> Result<(), Failure> {
        let Context {
            comm, plan, par, ..
        } = *context;
        self.fix_groups(context, open)?;
        let (before, changed) = self.classify(context, touched, renewed);
        let sprung = unknowns_of(&self.between);
        let cluster = |c: MergeRootId| &clusters[&plan.merge_roots[c]];
        let placement = |c| Placement::new(c, cluster(c), &self.classes, &self.ties);
        let shared = |c| Shared::new(cluster(c), placement(c), (&sprung, spring), par);
        let made = self.made(&before, &changed, renewed);
        let own = self.owners.each();
        let own = own.filter(|(_, owner)| **owner == comm.rank());
        let sides = own.map(|(c, _)| {
            let classes = &self.classes.of_clusters[c];
            let is_made = |at: usize| made[classes[at]];
            if !(0..classes.len()).any(is_made) {
                return Ok((c, Vec::new()));
            }
            let sides = match self.level {
                PreconditionerLevel::Diagonals => {
                    Ok(placement(c).sides(&cluster(c).diagonal, is_made))
                }
                level => shared(c).and_then(|(shared, s)| {
                    let uses_energies = level == PreconditionerLevel::Energies;
                    shared.sides(&s, is_made, uses_energies, par)
                }),
            };
            Ok((c, sides.map_err(free_motion)?))
        });
        let sides: OnMergeRoots<Vec<Option<Side>>> = comm.agree(sides.collect())?;
        let bases = self.bases(context, &before, &changed, &made, sides)?;
        let locals = bases.into_iter().map(|(c, bases)| {
            let local = shared(c).and_then(|shared| Local::new(shared, bases, self.level, par));
            Ok((c, local.map_err(free_motion)?))
        });
        let made_anew: OnMergeRoots<(Local, PackedSymmetric)> = comm.agree(locals.collect())?;
        let (mut locals, mut parts) = (BTreeMap::new(), BTreeMap::new());
        for (c, (local, s)) in made_anew {
            parts.insert(c, Part::of(c, &local, s, &self.classes));
            locals.insert(c, local);
        }
        let others = (self.locals.keys().copied()).filter(|c| !locals.contains_key(c));
        let touched = others.filter(|&c| touched[plan.merge_roots[c]] && self.locals[&c].own() > 0);
        let refreshed = touched.map(|c| Ok((c, shared(c).map_err(free_motion)?.0)));
        self.refresh(comm.agree(refreshed.collect())?);
        self.locals.extend(locals);
        if !changed.values().contains(&true) {
            return Ok(());
        }
        self.factorize_coarse(context, parts, &changed, &made)
    }

    /// The factor of the coarse problem, recomputed from the `parts` of clusters that have `changed` and of classes
    /// that were `made` anew. Collective.
    ///
    /// # Errors
    /// A part of the scene has a free rigid-body motion.
    fn factorize_coarse(
        &mut self,
        context: &Context<'_>,
        parts: BTreeMap<MergeRootId, Part>,
        changed: &Numbered<MergeRootId, bool>,
        made: &[bool],
    ) -> Result<(), Failure> {
        let is_remade =
            |c: MergeRootId| changed[c] || self.classes.of_clusters[c].iter().any(|&k| made[k]);
        let remade: Numbered<MergeRootId, bool> = changed.ids().map(is_remade).collect();
        let shifts = self.level.shifts();
        (self.coarse).factorize(context, &self.classes, parts, &remade, shifts)?;
        self.coarse_dofs = context.comm.collect(&self.coarse.len()).into_iter().sum();
        Ok(())
    }

    /// Sorts the shared unknowns into classes again. Returns the classes before, and flags of the clusters that share
    /// other unknowns than before or, if the preconditioner is to be `renewed`, were `touched`. Collective.
    fn classify(
        &mut self,
        context: &Context<'_>,
        touched: &Numbered<TreeNodeId, bool>,
        renewed: bool,
    ) -> (Classes, Numbered<MergeRootId, bool>) {
        let Context { comm, plan, .. } = *context;
        let ties = self.ties(comm);
        let mut is_retied = self.stale.like(false);
        let mut retied: BTreeSet<InterfaceDof> = BTreeSet::new();
        for dof in ties.differences(&self.ties) {
            (self.unknowns.clusters_of(dof)).for_each(|c| is_retied[c] = true);
            let terms = [&ties, &self.ties].map(|ties| ties.terms(&dof));
            retied.extend(terms.iter().flatten().map(|(staying, _)| *staying));
            retied.insert(dof);
        }
        let classes = Classes::new(&self.unknowns, &ties, (&self.classes, &retied));
        let shares_the_same = |c: MergeRootId| !is_retied[c] && classes.are_as_in(&self.classes, c);
        let is_touched = |c: MergeRootId| self.stale[c] || touched[plan.merge_roots[c]];
        let is_changed = |c: MergeRootId| !shares_the_same(c) || renewed && is_touched(c);
        let changed: Numbered<MergeRootId, bool> =
            self.unknowns.dofs.ids().map(is_changed).collect();
        self.stale = (changed.ids())
            .map(|c| !changed[c] && is_touched(c))
            .collect();
        for (&c, at) in &mut self.at_contact {
            let dofs = &self.unknowns.dofs[c];
            at.ties = ties.reached(at.places.iter().map(|&i| dofs[i]).collect());
        }
        self.ties = ties;
        self.sums = ClassSums::new(comm, &classes, &self.owners);
        (std::mem::replace(&mut self.classes, classes), changed)
    }

    /// Moves to the next level of the preconditioner where it converges too slowly or can't be factorized:
    /// first coarse unknowns chosen by their energies, then rigid motions with weak springs on all unknowns. The
    /// classes are determined anew. Returns false after the last level.
    pub fn raise_level(&mut self) -> bool {
        let Some(deeper) = self.level.next() else {
            return false;
        };
        self.level = deeper;
        self.classes = Classes::default();
        true
    }

    /// True at the levels that are abandoned for a better preconditioner when they converge slowly.
    pub fn is_provisional(&self) -> bool {
        matches!(
            self.level,
            PreconditionerLevel::Diagonals | PreconditionerLevel::Motions
        )
    }

    /// The smallest pivot of the coarse problem on this rank, relative to its diagonal entry.
    pub fn smallest_coarse_pivot(&self) -> f64 {
        self.coarse.smallest_pivot()
    }

    /// The smallest pivot on this rank, relative to its diagonal entry, including the coarse problem.
    pub fn smallest_pivot(&self) -> f64 {
        let pivots = (self.locals.values()).map(|local| local.shared.smallest_pivot);
        pivots.fold(self.smallest_coarse_pivot(), f64::min)
    }

    /// True if S of any cluster has changed since the preconditioner was computed; the same on all ranks.
    pub fn is_stale(&self) -> bool {
        self.stale.values().contains(&true)
    }

    /// Open constraints of contact group g of this rank, which lies between clusters.
    pub fn open(&self, g: GroupId) -> Option<&Vec<bool>> {
        self.groups.get(&g).map(|group| &group.open)
    }

    /// The ties of closed constraints, on all ranks. Collective.
    fn ties(&self, comm: &Comm) -> Ties {
        let of_group = |i: usize| self.groups[&self.between[i].number].ties();
        let mut ties = Ties::join(comm.gathered(&self.group_owners(), of_group));
        comm.broadcast(&mut ties);
        ties
    }

    fn group_owners(&self) -> Vec<usize> {
        self.between.iter().map(|group| group.owner).collect()
    }
}

/// The unknowns of contact groups between clusters.
fn unknowns_of(between: &[Between]) -> BTreeSet<InterfaceDof> {
    let unknowns = between.iter().flat_map(|group| &group.dofs);
    unknowns.copied().collect()
}

fn free_motion(Mechanism: Mechanism) -> Failure {
    Failure::ill_posed(
        "a part of the scene can move although all contacts under pressure are closed; expected supports or contact \
         against it",
    )
}
