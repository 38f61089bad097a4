//! The order of the unknowns of a front: eliminated E, kept K, known jumps, [E | K | known jumps].

use std::collections::{BTreeMap, BTreeSet};

use super::condensed::{Condensed, InterfaceDof};
use super::substitution::Replaced;

/// The normal jumps of a front's own contact points.
#[derive(Clone, Copy, Debug, Default)]
pub struct OwnJumps<'a> {
    /// The displacements that jumps replace.
    pub replaced: &'a [Replaced],
    /// Flags of the jumps that are open and eliminated like a displacement; the others are kept. If it is empty, all
    /// are kept.
    pub open: &'a [bool],
    /// Stiffness of a spring on every open jump, relative to the diagonal, against rigid motions that open contacts
    /// don't restrain.
    pub spring: f64,
}

impl OwnJumps<'_> {
    /// Number of jumps that aren't those of ties.
    fn unknowns(&self) -> usize {
        self.replaced.iter().filter(|r| !r.is_tied).count()
    }

    fn is_open(&self, jump: usize) -> bool {
        self.open.get(jump).copied().unwrap_or(false)
    }
}

/// The unknowns of a front in their order.
pub(super) struct FrontOrder {
    /// The eliminated displacements, ascending; they come first.
    pub eliminated: Vec<InterfaceDof>,
    /// The numbers of the open jumps of the front's own contact points, which are eliminated after these.
    open: Vec<usize>,
    /// Number of kept jumps: those of the children, then the front's own ones that aren't open.
    pub jumps: usize,
    /// The kept displacements, ascending.
    pub kept: Vec<InterfaceDof>,
    /// The place of the jump that replaces each replaced displacement.
    pivots: BTreeMap<InterfaceDof, usize>,
    /// Number of known jumps, those of ties, which come last.
    known: usize,
}

impl FrontOrder {
    /// The order of the front of `children` with its `own` jumps; displacements at the `eliminated_nodes` of Γ,
    /// ascending, are eliminated unless jumps replace them.
    pub fn new(children: &[&Condensed], eliminated_nodes: &[u32], own: OwnJumps<'_>) -> Self {
        let (mut eliminated, mut kept) = union_of_interface_dofs(children, eliminated_nodes);
        let count = own.unknowns();
        let numbers = 0..count;
        let (open, closed): (Vec<usize>, Vec<usize>) = numbers.partition(|&j| own.is_open(j));
        let replaced: BTreeSet<InterfaceDof> = own.replaced.iter().map(|r| r.dof).collect();
        eliminated.retain(|dof| !replaced.contains(dof));
        kept.retain(|dof| !replaced.contains(dof));
        let e = eliminated.len() + open.len();
        let of_children: usize = children.iter().map(|c| c.jumps).sum();
        let jumps = of_children + closed.len();
        let places_of_own =
            (open.iter().zip(eliminated.len()..)).chain(closed.iter().zip(e + of_children..));
        let pivots = places_of_own.map(|(&j, place)| (own.replaced[j].dof, place));
        let k = jumps + kept.len();
        let tied = own.replaced[count..].iter().zip(e + k..);
        let tied = tied.map(|(replaced, place)| (replaced.dof, place));
        Self {
            pivots: pivots.chain(tied).collect(),
            known: own.replaced.len() - count,
            eliminated,
            open,
            jumps,
            kept,
        }
    }

    /// Number of eliminated unknowns, of kept ones, and of all including the known jumps.
    pub fn sizes(&self) -> (usize, usize, usize) {
        let e = self.eliminated.len() + self.open.len();
        let k = self.jumps + self.kept.len();
        (e, k, e + k + self.known)
    }

    /// Place of an unknown of Γ: among the eliminated ones, that of the jump that replaces it, or among the kept ones.
    pub fn place(&self, dof: &InterfaceDof) -> usize {
        // Every unknown is in exactly one of the three lists.
        match (
            self.eliminated.binary_search(dof),
            self.kept.binary_search(dof),
        ) {
            (Ok(place), _) => place,
            (_, Ok(place)) => self.eliminated.len() + self.open.len() + self.jumps + place,
            _ => self.pivots.get(dof).copied().unwrap_or_default(),
        }
    }

    /// The unknown of Γ that is eliminated at a place, or that the jump there replaces.
    pub fn dof(&self, place: usize, own: OwnJumps<'_>) -> InterfaceDof {
        match self.eliminated.get(place) {
            Some(dof) => *dof,
            None => own.replaced[self.open[place - self.eliminated.len()]].dof,
        }
    }
}

/// The traces of all children, each once, ascending: those at `eliminated_nodes`, and the others.
fn union_of_interface_dofs(
    children: &[&Condensed],
    eliminated_nodes: &[u32],
) -> (Vec<InterfaceDof>, Vec<InterfaceDof>) {
    let mut all: Vec<InterfaceDof> = children
        .iter()
        .flat_map(|c| c.interface_dofs.iter().copied())
        .collect();
    all.sort_unstable();
    all.dedup();
    let mut next = eliminated_nodes.iter().peekable();
    all.into_iter().partition(|dof| {
        while next.next_if(|&&node| node < dof.node).is_some() {}
        next.peek().is_some_and(|&&node| node == dof.node)
    })
}
