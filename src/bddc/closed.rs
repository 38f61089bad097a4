//! Contact conditions between clusters: a closed one ties a displacement to others, an open one ties nothing.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::condense::normal_jumps;
use crate::contact::normal_jump::NoUnknown;
use crate::context::Context;
use crate::error::Failure;
use crate::fem::contact_group::{ContactGroup, JumpRows};
use crate::schur::condensed::InterfaceDof;
use crate::schur::substitution::Replaced;

/// A contact group above all clusters.
#[derive(Clone, Debug)]
pub struct GroupBetween {
    rows: JumpRows,
    /// The normal jumps, t = b·x.
    terms: Vec<Vec<(InterfaceDof, f64)>>,
    /// Which are open.
    pub open: Vec<bool>,
    /// What the closed ones replace.
    replaced: Vec<Replaced>,
}

impl GroupBetween {
    /// Contact group g of this rank, of which no condition is frozen yet.
    ///
    /// # Errors
    /// A contact point that nothing can be replaced for.
    pub fn new(context: &Context<'_>, g: usize, group: &ContactGroup) -> Result<Self, Failure> {
        let rows = group.rows_of(&normal_jumps(context, g, group)?);
        Ok(Self {
            terms: group.terms_of(&rows),
            rows,
            open: Vec::new(),
            replaced: Vec::new(),
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

    /// Freezes which of its conditions are `open`.
    ///
    /// # Errors
    /// A closed one that nothing can be replaced for, which no subset of independent ones has.
    pub fn freeze(
        &mut self,
        group: &ContactGroup,
        open: &[bool],
        eliminated: &[u32],
    ) -> Result<(), NoUnknown> {
        let closed: Vec<usize> = (0..open.len()).filter(|&t| !open[t]).collect();
        self.replaced = group.replaced_by(&self.rows, &closed, eliminated)?;
        self.open = open.to_vec();
        Ok(())
    }

    /// What its conditions tie.
    pub fn ties(&self) -> Ties {
        let of_open = self.terms.iter().zip(&self.open).filter(|(_, open)| **open);
        Ties {
            terms: (self.replaced.iter())
                .map(|replaced| (replaced.dof, replaced.staying.clone()))
                .collect(),
            open: of_open
                .flat_map(|(terms, _)| terms.iter().map(|(dof, _)| *dof))
                .collect(),
        }
    }

    /// The constants of what is tied, where the closed normal jumps have these `values`.
    pub fn constants(&self, values: &[f64]) -> Vec<(InterfaceDof, f64)> {
        let constant = |replaced: &Replaced| {
            let terms = replaced.jumps.iter().map(|&(t, c)| c * values[t]);
            (replaced.dof, terms.sum())
        };
        self.replaced.iter().map(constant).collect()
    }

    /// The normal jumps, and the forces on them, 0 where open, for displacements and unbalanced forces at its
    /// unknowns.
    pub fn answer(
        &self,
        x: &BTreeMap<InterfaceDof, f64>,
        unbalanced: &BTreeMap<InterfaceDof, f64>,
    ) -> (Vec<f64>, Vec<f64>) {
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
        (self.terms.iter().map(jump).collect(), forces)
    }
}

/// What closed conditions tie, on all ranks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ties {
    /// Tied displacements and what is in their place, but for constants.
    terms: BTreeMap<InterfaceDof, Vec<(InterfaceDof, f64)>>,
    /// Unknowns of open conditions.
    open: Vec<InterfaceDof>,
}

impl Ties {
    /// Those of several groups.
    pub fn join(all: Vec<Self>) -> Self {
        let mut joined = Self::default();
        for ties in all {
            joined.terms.extend(ties.terms);
            joined.open.extend(ties.open);
        }
        joined.open.sort_unstable();
        joined
    }

    /// What is in the place of an unknown: itself where it isn't tied.
    pub fn terms(&self, dof: &InterfaceDof) -> Vec<(InterfaceDof, f64)> {
        let terms = self.terms.get(dof);
        terms.cloned().unwrap_or_else(|| vec![(*dof, 1.0)])
    }

    /// Whether an open condition has an unknown.
    pub fn is_open(&self, dof: &InterfaceDof) -> bool {
        self.open.binary_search(dof).is_ok()
    }
}
