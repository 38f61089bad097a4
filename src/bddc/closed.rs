//! Contact constraints between clusters: a closed one ties a displacement to others, an open one ties nothing.

use std::collections::{BTreeMap, BTreeSet};

use contact_dd_partition::id::GroupId;
use serde::{Deserialize, Serialize};

use crate::contact::active_equalities::ActiveEqualities;
use crate::contact::dependent::DependentConstraints;
use crate::contact::jumps::NoUnknown;
use crate::contact::laws::Iterate;
use crate::contact::sharing::ForceSharing;
use crate::context::Context;
use crate::context::hierarchy::resting_limits;
use crate::error::Failure;
use crate::fem::contact_group::ContactGroup;
use crate::fem::group_jumps::JumpRows;
use crate::schur::condensed::InterfaceDof;
use crate::schur::substitution::Replaced;

/// A contact group above all clusters.
#[derive(Clone, Debug)]
pub struct GroupBetween {
    rows: JumpRows,
    /// The limits: jumps t = b·x, and dependent rows D t = b·x, then the jumps of ties.
    terms: Vec<Vec<(InterfaceDof, f64)>>,
    /// Open limits.
    pub open: Vec<bool>,
    /// The dependent rows.
    dependent: DependentConstraints,
    /// The unknowns that closed limits replace.
    replaced: Vec<Replaced>,
    /// Shares of the forces of closed rows that depend linearly on these.
    sharing: ForceSharing,
}

impl GroupBetween {
    /// Contact group g of this rank, with no condition fixed yet.
    ///
    /// # Errors
    /// A contact point without an unknown that can be replaced.
    pub fn new(context: &Context<'_>, g: GroupId, group: &ContactGroup) -> Result<Self, Failure> {
        let limits = resting_limits(context, g, group)?;
        let rows = group.rows_of(&limits);
        Ok(Self {
            terms: group.terms_of(&rows),
            rows,
            open: Vec::new(),
            dependent: limits.rows,
            replaced: Vec::new(),
            sharing: ForceSharing::default(),
        })
    }

    /// The unknowns of its conditions, ascending.
    pub fn dofs(&self) -> Vec<InterfaceDof> {
        let mut dofs: Vec<InterfaceDof> =
            self.terms.iter().flatten().map(|(dof, _)| *dof).collect();
        dofs.sort_unstable();
        dofs.dedup();
        dofs
    }

    /// Fixes the statuses of its conditions, `open` or closed.
    ///
    /// # Errors
    /// A closed condition none of whose unknowns can be replaced, although it is independent.
    pub fn fix(
        &mut self,
        group: &ContactGroup,
        open: &[bool],
        eliminated: &[u32],
    ) -> Result<(), NoUnknown> {
        let equalities = ActiveEqualities::new(&self.dependent, open);
        let (mut independent, m) = (open.to_vec(), open.len() - self.dependent.len());
        (equalities.redundant.iter()).for_each(|j| independent[m + j] = true);
        self.sharing = ForceSharing::new(&self.dependent, &independent, &equalities);
        let closed: Vec<usize> = (0..open.len()).filter(|&t| !independent[t]).collect();
        self.replaced = group.replaced_by(&self.rows, &closed, eliminated)?;
        self.open = open.to_vec();
        Ok(())
    }

    /// The ties between unknowns due to closed conditions.
    pub fn ties(&self) -> Ties {
        let replaced = self.replaced.iter();
        Ties::new(replaced.map(|one| (one.dof, one.staying.clone())).collect())
    }

    /// The constants of tied unknowns for these `values` of closed limits, and of the jumps of ties after them.
    pub fn constants(&self, values: &[f64]) -> Vec<(InterfaceDof, f64)> {
        let constant = |replaced: &Replaced| {
            let terms = replaced.jumps.iter().map(|&(t, c)| c * values[t]);
            (replaced.dof, terms.sum())
        };
        self.replaced.iter().map(constant).collect()
    }

    /// Loads −Bᵀλ of `forces` on its limits.
    pub fn loads_of(&self, forces: &[f64]) -> Vec<(InterfaceDof, f64)> {
        let acting = forces.iter().zip(&self.terms).filter(|(f, _)| **f != 0.0);
        let loads = acting.flat_map(|(f, terms)| terms.iter().map(move |&(dof, c)| (dof, -c * f)));
        loads.collect()
    }

    /// The jumps and forces of its limits, 0 where open, and the forces at the jumps of ties, from displacements and
    /// unbalanced forces at its unknowns.
    pub fn answer(
        &self,
        x: &BTreeMap<InterfaceDof, f64>,
        unbalanced: &BTreeMap<InterfaceDof, f64>,
    ) -> (Iterate, Vec<f64>) {
        let jump = |terms: &Vec<(InterfaceDof, f64)>| {
            let terms = terms.iter().map(|(dof, c)| c * x[dof]);
            terms.sum()
        };
        let mut forces = vec![0.0; self.terms.len()];
        for replaced in &self.replaced {
            for &(t, c) in &replaced.jumps {
                forces[t] += c * unbalanced[&replaced.dof];
            }
        }
        let tied = forces.split_off(self.rows.limits());
        self.sharing.share(&mut forces);
        let jumps = self.terms[..forces.len()].iter().map(jump).collect();
        (Iterate { jumps, forces }, tied)
    }
}

/// Ties of closed conditions, on all ranks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ties {
    /// Tied displacements and the terms that replace them, without constants, group by group up the hierarchy: unknowns
    /// in a group's terms may be tied by one above.
    direct: Vec<(InterfaceDof, Terms)>,
    /// The tied unknowns in terms of untied ones.
    resolved: BTreeMap<InterfaceDof, Terms>,
}

/// Unknowns and their coefficients.
type Terms = Vec<(InterfaceDof, f64)>;

impl Ties {
    /// The ties of unknowns to the linear combinations that replace them, without constants; not yet resolved.
    pub fn new(direct: Vec<(InterfaceDof, Terms)>) -> Self {
        Self {
            direct,
            resolved: BTreeMap::new(),
        }
    }

    /// The ties of all groups, in their order.
    pub fn join(all: Vec<Self>) -> Self {
        let mut joined = Self::default();
        for ties in all {
            joined.direct.extend(ties.direct);
        }
        for (dof, terms) in joined.direct.iter().rev() {
            let mut resolved: BTreeMap<InterfaceDof, f64> = BTreeMap::new();
            for (staying, factor) in terms {
                let own = vec![(*staying, 1.0)];
                for (dof, c) in joined.resolved.get(staying).unwrap_or(&own) {
                    *resolved.entry(*dof).or_insert(0.0) += factor * c;
                }
            }
            joined.resolved.insert(*dof, resolved.into_iter().collect());
        }
        joined
    }

    /// The tied unknowns, ascending, and the terms in their places.
    pub fn tied(&self) -> impl Iterator<Item = (&InterfaceDof, &Terms)> {
        self.resolved.iter()
    }

    /// The terms in the place of an unknown that is tied.
    pub fn terms_of(&self, dof: &InterfaceDof) -> Option<&Terms> {
        self.resolved.get(dof)
    }

    /// The terms of an unknown: itself if it isn't tied.
    pub fn terms(&self, dof: &InterfaceDof) -> Terms {
        let terms = self.terms_of(dof);
        terms.cloned().unwrap_or_else(|| vec![(*dof, 1.0)])
    }

    /// The unknowns between which ties interpolate: those in the place of another node's, of several nodes.
    pub fn interpolated(&self) -> BTreeSet<InterfaceDof> {
        let mut interpolated = BTreeSet::new();
        for (tied, terms) in self.tied() {
            let others = terms.iter().map(|(dof, _)| *dof);
            let others: Vec<InterfaceDof> = others.filter(|dof| dof.node != tied.node).collect();
            if others.iter().any(|dof| dof.node != others[0].node) {
                interpolated.extend(others);
            }
        }
        interpolated
    }

    /// Adds the constants of the unknowns in their terms to those of tied displacements.
    pub fn resolve(&self, constants: &mut BTreeMap<InterfaceDof, f64>) {
        for (dof, terms) in self.direct.iter().rev() {
            let staying = terms.iter();
            let of_others = staying.filter_map(|(dof, c)| Some(c * constants.get(dof)?));
            let sum: f64 = of_others.sum();
            *constants.entry(*dof).or_insert(0.0) += sum;
        }
    }

    /// The ties, by their index, that carry forces from these unknowns to others, directly or by way of others.
    pub fn reached(&self, mut unknowns: BTreeSet<InterfaceDof>) -> Vec<usize> {
        let mut reached = Vec::new();
        for (i, (dof, terms)) in self.direct.iter().enumerate() {
            if unknowns.contains(dof) {
                reached.push(i);
                unknowns.extend(terms.iter().map(|(staying, _)| *staying));
            }
        }
        reached
    }

    /// Adds forces at tied displacements to those at the unknowns in their terms, without removing them, by the ties
    /// that are `reached` from the unknowns of the forces.
    pub fn carry(&self, reached: &[usize], forces: &mut BTreeMap<InterfaceDof, f64>) {
        for (dof, terms) in reached.iter().map(|&i| &self.direct[i]) {
            let force = forces.get(dof).copied().unwrap_or(0.0);
            for (staying, c) in terms {
                *forces.entry(*staying).or_insert(0.0) += c * force;
            }
        }
    }

    /// The unknowns that aren't tied as in `others`.
    pub fn differences<'a>(&'a self, others: &'a Self) -> impl Iterator<Item = InterfaceDof> + 'a {
        let differs = |dof: &&InterfaceDof| self.resolved.get(dof) != others.resolved.get(dof);
        let all = self.resolved.keys().chain(others.resolved.keys());
        all.filter(differs).copied()
    }
}
