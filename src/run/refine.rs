//! Iterative refinement with the factors at hand: the full discrete problem's residual is solved
//! for with every active set frozen, wherever the certificate falls short.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;

use super::condense::CondensedBlocks;
use super::read::OwnedBlock;
use super::recover::BlockSolution;
use crate::certificate::{BlockCheck, certificate};
use crate::comm::{Comm, Message};
use crate::contact::pair::FrozenLoad;
use crate::contact::s_con::ConState;
use crate::fem::balance::Balance;
use crate::interface::numbering::Numbering;
use crate::interface::operator::Interface;
use crate::output::report::Certificate;
use crate::plan::Plan;
use crate::schur::local::CondensedLoad;
use crate::sweep::frozen::Frozen;

/// Equilibrium and penetration above which a solution is refined.
const LIMIT: f64 = 4e-15;
/// Most refinements.
const MAX_REFINEMENTS: usize = 3;

/// What this rank holds of the problem.
#[derive(Clone, Copy)]
pub struct Parts<'a> {
    /// All ranks.
    pub comm: &'a Comm,
    /// Blocks of this rank.
    pub blocks: &'a BTreeMap<usize, OwnedBlock>,
    /// Their factors.
    pub condensed: &'a CondensedBlocks,
    /// The problem.
    pub catalog: &'a Catalog,
    /// Who owns what.
    pub plan: &'a Plan,
}

/// What the root holds besides.
#[derive(Clone, Copy)]
pub struct RootParts<'a> {
    /// Numbering of Γ.
    pub numbering: &'a Numbering,
    /// The interface problem.
    pub interface: &'a Interface,
    /// The pairs' active sets.
    pub state: &'a ConState,
    /// Whether those are right: otherwise there is nothing to refine.
    pub converged: bool,
}

/// A block's correction load.
enum Correction {
    Linear(CondensedLoad),
    Pair(FrozenLoad),
}

impl Correction {
    fn traces(&self) -> &[f64] {
        match self {
            Self::Linear(load) => load.boundary(),
            Self::Pair(frozen) => &frozen.traces,
        }
    }
}

/// Refines `solutions` until the certificate holds or gets no better, and returns it; on the root
/// it is that of the whole solution. Collective.
pub fn refine(
    parts: Parts<'_>,
    root: Option<RootParts<'_>>,
    solutions: &mut BTreeMap<usize, BlockSolution>,
) -> Certificate {
    let mut best = parts.certificate(root, solutions);
    for _ in 0..MAX_REFINEMENTS {
        if !parts.decide(root, worst(&best) > LIMIT) {
            break;
        }
        let mut refined = solutions.clone();
        parts.correct(root, &mut refined);
        let after = parts.certificate(root, &refined);
        if !parts.decide(root, worst(&after) < 0.5 * worst(&best)) {
            break;
        }
        *solutions = refined;
        best = after;
    }
    best
}

fn worst(certificate: &Certificate) -> f64 {
    certificate.equilibrium.max(certificate.penetration)
}

impl Parts<'_> {
    /// The root's decision, on all ranks. Collective.
    fn decide(&self, root: Option<RootParts<'_>>, decision: bool) -> bool {
        let mut message = Message {
            integers: vec![i64::from(
                root.is_some_and(|root| root.converged) && decision,
            )],
            reals: Vec::new(),
        };
        self.comm.broadcast(&mut message);
        message.read().integer() != 0
    }

    fn balance(&self, b: usize, solution: &BlockSolution) -> Option<Balance> {
        let owned = self.blocks.get(&b)?;
        let (u, forces) = (&solution.u, &solution.forces);
        let materials = &self.catalog.materials;
        Some(Balance::new(
            &owned.block,
            &owned.conditions,
            materials,
            u,
            forces,
        ))
    }

    fn certificate(
        &self,
        root: Option<RootParts<'_>>,
        solutions: &BTreeMap<usize, BlockSolution>,
    ) -> Certificate {
        let check = |b: usize| {
            let (owned, solution) = (self.blocks.get(&b)?, solutions.get(&b)?);
            let balance = self.balance(b, solution)?;
            let (u, forces) = (&solution.u, &solution.forces);
            Some(BlockCheck::new(
                &owned.block,
                &owned.conditions,
                &balance,
                u,
                forces,
            ))
        };
        let mut checks = Vec::new();
        self.comm.gather(
            &self.plan.owners(),
            |b| check(b).map_or_else(Message::default, |check| check.pack()),
            |_, message| checks.push(BlockCheck::unpack(message)),
        );
        root.map_or_else(Certificate::default, |root| {
            certificate(&checks, &root.numbering.traces, root.interface.len)
        })
    }

    /// Adds the solution of the linear problem whose load is what `solutions` leave unbalanced.
    fn correct(&self, root: Option<RootParts<'_>>, solutions: &mut BTreeMap<usize, BlockSolution>) {
        let corrections: BTreeMap<usize, Correction> = solutions
            .iter()
            .filter_map(|(&b, solution)| Some((b, self.correction(b, solution)?)))
            .collect();
        let owners = self.plan.owners();
        let mut r = vec![0.0; root.map_or(0, |root| root.interface.len)];
        self.comm.gather(
            &owners,
            |b| Message {
                integers: Vec::new(),
                reals: corrections
                    .get(&b)
                    .map_or_else(Vec::new, |c| c.traces().to_vec()),
            },
            |b, message| {
                let traces = root.map_or(&[][..], |root| &root.numbering.traces[b]);
                for (&i, part) in traces.iter().zip(&message.reals) {
                    r[i as usize] += part;
                }
            },
        );
        let scale = r.iter().fold(0.0, |m: f64, r| m.max(r.abs()));
        let change = root.and_then(|root| Frozen::new(root.interface, root.state).solve(&r, scale));
        let change = change.unwrap_or_else(|| vec![0.0; r.len()]);
        let mut received: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        self.comm.scatter(
            &owners,
            |b| Message {
                integers: Vec::new(),
                reals: root.map_or_else(Vec::new, |root| {
                    let traces = &root.numbering.traces[b];
                    traces.iter().map(|&i| change[i as usize]).collect()
                }),
            },
            |b, message| {
                received.insert(b, message.reals);
            },
        );
        for (b, correction) in &corrections {
            if let (Some(solution), Some(u)) = (solutions.get_mut(b), received.get(b)) {
                self.apply(*b, correction, u, solution);
            }
        }
    }

    fn correction(&self, b: usize, solution: &BlockSolution) -> Option<Correction> {
        let dofs = self.condensed.dofs.get(&b)?;
        let balance = self.balance(b, solution)?;
        let mut load = vec![0.0; dofs.len()];
        dofs.add_load(&balance.residual, &mut load);
        if let Some(linear) = self.condensed.linear.get(&b) {
            return Some(Correction::Linear(linear.schur.condense(load)));
        }
        let pair = self.condensed.pairs.get(&self.plan.pair_of(b)?)?;
        let owned = self.blocks.get(&b)?;
        let missing: Vec<f64> = owned
            .conditions
            .iter()
            .map(|condition| condition.gap_left(owned.block.dim, &solution.u))
            .collect();
        pair.condense_frozen(pair.schur().condense(load), &missing)
            .map(Correction::Pair)
    }

    fn apply(&self, b: usize, correction: &Correction, u: &[f64], solution: &mut BlockSolution) {
        let Some(dofs) = self.condensed.dofs.get(&b) else {
            return;
        };
        let pair = self
            .plan
            .pair_of(b)
            .and_then(|p| self.condensed.pairs.get(&p));
        let x = match (correction, self.condensed.linear.get(&b), pair) {
            (Correction::Linear(load), Some(linear), _) => linear.schur.recover(load, u),
            (Correction::Pair(frozen), _, Some(pair)) => {
                let (mut x_b, forces) = pair.recover_frozen(frozen, u);
                x_b.extend_from_slice(u);
                for (force, change) in solution.forces.iter_mut().zip(forces) {
                    *force = (*force + change).max(0.0);
                }
                pair.schur().recover(&frozen.load, &x_b)
            }
            _ => return,
        };
        dofs.add_change(&x, &mut solution.u);
    }
}
