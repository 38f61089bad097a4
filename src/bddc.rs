//! An interface solver that scales: conjugate gradients between clusters, preconditioned by balancing domain
//! decomposition by constraints (BDDC).
//!
//! The clusters are those of the problem file. What they share is sorted into classes; of each class some
//! combinations of unknowns, the coarse ones, are the same in all clusters, the others are solved for in
//! every cluster by itself. Contact conditions between clusters are tied where they are closed.

mod classes;
mod closed;
mod coarse;
mod constraints;
mod gradients;
mod local;
pub mod solution;

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use self::classes::Classes;
use self::closed::{GroupBetween, Ties};
use self::coarse::{Coarse, CoarsePart};
use self::constraints::{Basis, Side};
use self::local::{Local, Moves, Shared};
use crate::comm::Comm;
use crate::contact::jumps::NoUnknown;
use crate::context::Context;
use crate::error::Failure;
use crate::schur::condensed::{Condensed, InterfaceDof};

/// Clusters and what is between them.
#[derive(Debug)]
pub struct Bddc {
    /// The owner of every cluster.
    owners: Vec<usize>,
    /// Their unknowns, on all ranks.
    dofs: Vec<Vec<InterfaceDof>>,
    /// The contact groups between clusters.
    between: Vec<Between>,
    /// Those of this rank, by number.
    groups: BTreeMap<usize, GroupBetween>,
    ties: Ties,
    classes: Classes,
    /// The clusters of this rank, onto what they share and in the bases of their classes.
    shared: BTreeMap<usize, Rc<Shared>>,
    locals: BTreeMap<usize, Local>,
    coarse: Option<Coarse>,
    /// Number of coarse unknowns; on the root.
    pub coarse_dofs: usize,
    /// The smallest pivot of the coarse problem relative to its diagonal entry; on the root.
    pub smallest_pivot: f64,
}

/// A contact group between clusters.
#[derive(Debug)]
struct Between {
    number: usize,
    owner: usize,
    /// Its unknowns, ascending.
    dofs: Vec<InterfaceDof>,
    /// The clusters that have some of them, or what may be tied to some, ascending.
    clusters: Vec<usize>,
}

impl Bddc {
    /// Between the clusters that `condensed` has, by node; nothing is factorized yet. Collective.
    ///
    /// # Errors
    /// A contact point that nothing can be replaced for.
    pub fn new(
        context: &Context<'_>,
        condensed: &BTreeMap<usize, Condensed>,
    ) -> Result<Self, Failure> {
        let Context { comm, plan, .. } = *context;
        let owners = plan.owners_of(&plan.tops);
        let mut dofs: Vec<Vec<InterfaceDof>> = Vec::new();
        comm.gather(
            &owners,
            |c| {
                condensed
                    .get(&plan.tops[c])
                    .map(|of| of.interface_dofs.clone())
            },
            |_, of_cluster| dofs.extend(of_cluster),
        );
        comm.broadcast(&mut dofs);
        let numbers: Vec<usize> = (0..plan.groups.len())
            .filter(|&g| plan.is_above_tops(plan.groups[g].node))
            .collect();
        let own = numbers
            .iter()
            .filter_map(|g| Some((*g, context.groups.get(g)?)));
        let groups = own.map(|(g, group)| Ok((g, GroupBetween::new(context, g, group)?)));
        let groups: BTreeMap<usize, GroupBetween> = comm.agree(groups.collect())?;
        let mut of_groups: Vec<Vec<InterfaceDof>> = Vec::new();
        let group_owners: Vec<usize> = (numbers.iter())
            .map(|&g| plan.node_owners[plan.groups[g].node])
            .collect();
        comm.gather(
            &group_owners,
            |i| groups[&numbers[i]].dofs(),
            |_, of_group| of_groups.push(of_group),
        );
        comm.broadcast(&mut of_groups);
        let has_some = |c: usize, sought: &[InterfaceDof]| {
            (sought.iter()).any(|dof| dofs[c].binary_search(dof).is_ok())
        };
        let mut between: Vec<Between> = Vec::new();
        for ((number, owner), sought) in numbers.into_iter().zip(group_owners).zip(of_groups) {
            let mut clusters: BTreeSet<usize> =
                (0..dofs.len()).filter(|&c| has_some(c, &sought)).collect();
            // What a group below ties may be tied to unknowns of this one.
            for below in &between {
                if (below.dofs.iter()).any(|dof| sought.binary_search(dof).is_ok()) {
                    clusters.extend(&below.clusters);
                }
            }
            between.push(Between {
                number,
                owner,
                dofs: sought,
                clusters: clusters.into_iter().collect(),
            });
        }
        Ok(Self {
            between,
            owners,
            dofs,
            groups,
            ties: Ties::default(),
            classes: Classes::default(),
            shared: BTreeMap::new(),
            locals: BTreeMap::new(),
            coarse: None,
            coarse_dofs: 0,
            smallest_pivot: f64::INFINITY,
        })
    }

    /// Makes the preconditioner for `condensed` clusters and conditions that are `open`, with a `spring`, relative to
    /// the diagonal, on what these have let go; of clusters that aren't `touched` what is as it was is kept. Collective.
    ///
    /// # Errors
    /// A part of the scene can move.
    pub fn freeze(
        &mut self,
        context: &Context<'_>,
        condensed: &BTreeMap<usize, Condensed>,
        touched: &[bool],
        open: &BTreeMap<usize, Vec<bool>>,
        spring: f64,
    ) -> Result<(), Failure> {
        let Context {
            comm, plan, par, ..
        } = *context;
        let mut frozen = Ok(());
        for (&g, of_group) in &mut self.groups {
            let eliminated = &plan.tree.nodes[plan.groups[g].node].eliminated;
            let result = of_group.freeze(&context.groups[&g], &open[&g], eliminated);
            frozen = frozen.and(result.map_err(|NoUnknown(t)| {
                Failure::internal(format!(
                    "contact group {g}: closed jump {t} replaces nothing"
                ))
            }));
        }
        comm.agree(frozen)?;
        let ties = self.ties(comm);
        let classes = Classes::new(&self.dofs, &ties);
        let is_as_it_was = |c: usize| {
            let mut dofs = self.dofs[c].iter();
            !touched[plan.tops[c]]
                && classes.are_as_in(&self.classes, c)
                && dofs.all(|dof| ties.is_as_in(&self.ties, dof))
        };
        let changed: Vec<bool> = (0..self.dofs.len()).map(|c| !is_as_it_was(c)).collect();
        (self.ties, self.classes) = (ties, classes);

        let own = self.owners.iter().enumerate();
        let own = own.filter(|(c, owner)| changed[*c] && **owner == comm.rank());
        let shared = own.map(|(c, _)| {
            let of_cluster = &condensed[&plan.tops[c]];
            let shared = Shared::new(c, of_cluster, &self.classes, &self.ties, spring, par);
            Ok((c, Rc::new(shared.map_err(moves)?)))
        });
        let shared: BTreeMap<usize, Rc<Shared>> = comm.agree(shared.collect())?;
        self.shared.extend(shared);
        let bases = self.bases(context, &changed)?;
        let locals = bases.into_iter().map(|(c, bases)| {
            let local = Local::new(Rc::clone(&self.shared[&c]), bases, par);
            Ok((c, local.map_err(moves)?))
        });
        let locals: BTreeMap<usize, Local> = comm.agree(locals.collect())?;
        self.locals.extend(locals);

        let mut parts = Vec::new();
        comm.gather(
            &self.owners,
            |c| CoarsePart::of(&self.locals[&c], &self.classes.of_clusters[c]),
            |_, part| parts.push(part),
        );
        let coarse = comm.is_root().then(|| Coarse::new(&parts, par));
        self.coarse = comm.agree(coarse.transpose())?;
        if let Some(coarse) = &self.coarse {
            self.coarse_dofs = coarse.len();
            self.smallest_pivot = coarse.smallest_pivot();
        }
        Ok(())
    }

    /// Which conditions of contact group g of this rank, between clusters, are open.
    pub fn open(&self, g: usize) -> Option<&Vec<bool>> {
        self.groups.get(&g).map(|group| &group.open)
    }

    /// What closed conditions tie, on all ranks. Collective.
    fn ties(&self, comm: &Comm) -> Ties {
        let mut all = Vec::new();
        comm.gather(
            &self.group_owners(),
            |i| self.groups[&self.between[i].number].ties(),
            |_, ties| all.push(ties),
        );
        let mut ties = Ties::join(all);
        comm.broadcast(&mut ties);
        ties
    }

    fn group_owners(&self) -> Vec<usize> {
        self.between.iter().map(|group| group.owner).collect()
    }

    /// The bases of the classes of every cluster of this rank that has one with a cluster that `changed`: each is made
    /// where the first cluster of the class is. Collective.
    fn bases(
        &self,
        context: &Context<'_>,
        changed: &[bool],
    ) -> Result<BTreeMap<usize, Vec<Basis>>, Failure> {
        let Context { comm, par, .. } = *context;
        let is_made = |k: usize| {
            let class = &self.classes.list[k];
            !class.is_coarse() && class.clusters.iter().any(|&c| changed[c])
        };
        let ends: Vec<(usize, usize)> = (0..self.classes.list.len())
            .filter(|&k| is_made(k))
            .flat_map(|k| self.classes.list[k].clusters.iter().map(move |&c| (k, c)))
            .collect();
        let mut made = BTreeMap::new();
        let sides = self.shared.iter().flat_map(|(&c, shared)| {
            let classes = self.classes.of_clusters[c].iter().zip(&shared.ranges);
            let made = classes.filter(|(k, _)| is_made(**k));
            made.map(move |(&k, range)| ((k, c), shared.on(range, par)))
        });
        let sides = sides.map(|(end, side)| Ok((end, side.map_err(moves)?)));
        let mut sides: BTreeMap<(usize, usize), Side> = comm.agree(sides.collect())?;
        let home = |k: usize| self.owners[self.classes.list[k].clusters[0]];
        let mut arrived: BTreeMap<usize, Vec<Side>> = BTreeMap::new();
        comm.route(
            ends.iter().map(|&(k, c)| (self.owners[c], home(k))),
            |i| sides.remove(&ends[i]),
            |i, side| arrived.entry(ends[i].0).or_default().extend(side),
        );
        let mut result = Ok(());
        for (k, sides) in arrived {
            if let [a, b] = &sides[..] {
                match Basis::adaptive([a, b]) {
                    Ok(bases) => {
                        let clusters = &self.classes.list[k].clusters;
                        let ends = clusters.iter().map(|&c| (k, c));
                        made.extend(ends.zip(bases));
                    }
                    Err(Moves) => result = Err(moves(Moves)),
                }
            }
        }
        comm.agree(result)?;
        let mut of_ends = BTreeMap::new();
        comm.route(
            ends.iter().map(|&(k, c)| (home(k), self.owners[c])),
            |i| made.remove(&ends[i]),
            |i, basis| of_ends.extend(basis.map(|basis| (ends[i], basis))),
        );
        let mut bases = BTreeMap::new();
        for (&c, shared) in &self.shared {
            let classes = &self.classes.of_clusters[c];
            if !changed[c] && !classes.iter().any(|&k| is_made(k)) {
                continue;
            }
            let of_classes = classes.iter().enumerate().map(|(at, &k)| {
                let class = &self.classes.list[k];
                match (of_ends.remove(&(k, c)), self.locals.get(&c)) {
                    (Some(basis), _) => basis,
                    (None, Some(local)) if !changed[c] => local.bases()[at].clone(),
                    _ => Basis::coarse(shared.ranges[at].len(), class.clusters[0] == c),
                }
            });
            bases.insert(c, of_classes.collect());
        }
        Ok(bases)
    }
}

fn moves(Moves: Moves) -> Failure {
    Failure::ill_posed(
        "a part of the scene can move although every contact that presses is held; expected supports or contact that \
         hold it",
    )
}
