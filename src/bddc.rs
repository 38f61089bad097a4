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

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use faer::Mat;

use self::classes::Classes;
use self::closed::{GroupBetween, Ties};
use self::coarse::{Coarse, CoarsePart};
use self::constraints::{Basis, Side};
use self::gradients::{Gradients, Vectors};
use self::local::{Local, Moves, Shared};
use crate::bytes::Reals;
use crate::comm::Comm;
use crate::contact::normal_jump::NoUnknown;
use crate::context::Context;
use crate::error::Failure;
use crate::plan::Plan;
use crate::schur::condensed::{Condensed, InterfaceDof};
use crate::vector::dot;

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

/// How far a solution is iterated.
#[derive(Clone, Copy, Debug)]
pub struct Accuracy<'a> {
    /// What the error in the energy norm is to be below, relative to that of the solution, about.
    pub tolerance: f64,
    /// The unknowns of every cluster, by its node, in a solution that isn't far.
    pub start: Option<&'a BTreeMap<usize, Vec<f64>>>,
}

impl Accuracy<'_> {
    /// As far as round-off lets it be, about, from nothing.
    pub const FULL: Self = Self {
        tolerance: 1e-12,
        start: None,
    };
}

/// What a load does, on this rank.
#[derive(Debug, Default)]
pub struct BddcSolution {
    /// The unknowns of every cluster, by its node.
    pub clusters: BTreeMap<usize, Vec<f64>>,
    /// The normal jumps of every contact group between clusters (m), and the forces on them, 0 where open (N/m).
    pub groups: BTreeMap<usize, (Vec<f64>, Vec<f64>)>,
    /// Iterations that it took.
    pub iterations: usize,
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

    /// Solves for `loads` on the unknowns of the clusters of this rank, by node, where the closed normal jumps of
    /// every contact group between them have these `values`. Collective.
    pub fn solve(
        &self,
        context: &Context<'_>,
        condensed: &BTreeMap<usize, Condensed>,
        loads: &BTreeMap<usize, Vec<f64>>,
        values: &BTreeMap<usize, Vec<f64>>,
        accuracy: Accuracy,
    ) -> BddcSolution {
        let Context { comm, plan, .. } = *context;
        let constants = self.constants(comm, values);
        let constants_of = |c: usize| -> Vec<f64> {
            let dofs = self.dofs[c].iter();
            dofs.map(|dof| constants.get(dof).copied().unwrap_or(0.0))
                .collect()
        };
        let (mut own, mut b) = (Vectors::new(), Vectors::new());
        for (&c, local) in &self.locals {
            let mut load = loads[&plan.tops[c]].clone();
            let held = product_of_lower(&condensed[&plan.tops[c]].s, &constants_of(c));
            load.iter_mut()
                .zip(held)
                .for_each(|(load, held)| *load -= held);
            let (of_own, of_shared) = local.condense(&load);
            own.insert(c, of_own);
            b.insert(c, of_shared);
        }
        let gradients = Gradients {
            comm,
            owners: &self.owners,
            classes: &self.classes,
            locals: &self.locals,
            coarse: self.coarse.as_ref(),
        };
        let start = accuracy.start.map(|known| self.start(comm, known, plan));
        let (x, iterations) = gradients.solve(b, start, accuracy.tolerance);
        let mut clusters = Vectors::new();
        for (&c, local) in &self.locals {
            let mut all = local.recover(&own[&c], &x[&c]);
            all.iter_mut()
                .zip(constants_of(c))
                .for_each(|(x, constant)| *x += constant);
            clusters.insert(c, all);
        }
        let unbalanced = clusters.iter().map(|(&c, x)| {
            let mut r = loads[&plan.tops[c]].clone();
            let s_x = product_of_lower(&condensed[&plan.tops[c]].s, x);
            r.iter_mut().zip(s_x).for_each(|(r, s_x)| *r -= s_x);
            (c, r)
        });
        let groups = self.answers(comm, &clusters, &unbalanced.collect());
        let by_node = clusters.into_iter().map(|(c, x)| (plan.tops[c], x));
        BddcSolution {
            clusters: by_node.collect(),
            groups,
            iterations,
        }
    }

    /// What clusters share where their unknowns, by node, are `known`. Collective.
    fn start(&self, comm: &Comm, known: &BTreeMap<usize, Vec<f64>>, plan: &Plan) -> Vectors {
        let classes = &self.classes.list;
        let ends: Vec<(usize, usize)> = (classes.iter().enumerate())
            .flat_map(|(k, class)| class.clusters.iter().map(move |&c| (k, c)))
            .collect();
        let home = |k: usize| self.owners[classes[k].clusters[0]];
        let mut values: BTreeMap<usize, Vec<Option<f64>>> = BTreeMap::new();
        comm.route(
            ends.iter().map(|&(k, c)| (self.owners[c], home(k))),
            |i| {
                let (k, c) = ends[i];
                let of_cluster = &known[&plan.tops[c]];
                let dofs = classes[k].dofs.iter();
                let at = dofs.map(|dof| self.dofs[c].binary_search(dof).ok());
                at.map(|at| at.map(|at| of_cluster[at])).collect::<Vec<_>>()
            },
            |i, said| {
                let of_class = values.entry(ends[i].0).or_insert_with(|| said.clone());
                of_class
                    .iter_mut()
                    .zip(said)
                    .for_each(|(value, said)| *value = value.or(said));
            },
        );
        let turned = values.into_iter().map(|(k, values)| {
            let values = values.into_iter().map(Option::unwrap_or_default);
            (k, classes[k].turn(values.collect()))
        });
        let values: BTreeMap<usize, Vec<f64>> = turned.collect();
        let mut start: Vectors = self.locals.keys().map(|&c| (c, Vec::new())).collect();
        comm.route(
            ends.iter().map(|&(k, c)| (home(k), self.owners[c])),
            |i| Reals(values[&ends[i].0].clone()),
            // Class after class, as the cluster has them.
            |i, Reals(values)| start.entry(ends[i].1).or_default().extend(values),
        );
        for (c, shared) in &mut start {
            self.locals[c].turn(shared);
        }
        start
    }

    /// What tied displacements are beside the terms of others, on all ranks. Collective.
    fn constants(
        &self,
        comm: &Comm,
        values: &BTreeMap<usize, Vec<f64>>,
    ) -> BTreeMap<InterfaceDof, f64> {
        let mut constants = Vec::new();
        comm.gather(
            &self.group_owners(),
            |i| {
                let number = self.between[i].number;
                self.groups[&number].constants(&values[&number])
            },
            |_, of_group| constants.extend(of_group),
        );
        comm.broadcast(&mut constants);
        let mut constants = constants.into_iter().collect();
        self.ties.resolve(&mut constants);
        constants
    }

    /// Jumps and forces of the contact groups of this rank, for the unknowns of clusters and what is `unbalanced` there.
    /// Collective.
    fn answers(
        &self,
        comm: &Comm,
        clusters: &Vectors,
        unbalanced: &Vectors,
    ) -> BTreeMap<usize, (Vec<f64>, Vec<f64>)> {
        let ways: Vec<(usize, usize)> = (self.between.iter().enumerate())
            .flat_map(|(i, group)| group.clusters.iter().map(move |&c| (i, c)))
            .collect();
        let forces = self.locals.keys().map(|&c| {
            let at = self.dofs[c]
                .iter()
                .copied()
                .zip(unbalanced[&c].iter().copied());
            let mut forces = at.collect();
            self.ties.carry(&mut forces);
            (c, forces)
        });
        let forces: BTreeMap<usize, BTreeMap<InterfaceDof, f64>> = forces.collect();
        let mut of_groups: BTreeMap<usize, [BTreeMap<InterfaceDof, f64>; 2]> = BTreeMap::new();
        comm.route(
            ways.iter()
                .map(|&(i, c)| (self.owners[c], self.between[i].owner)),
            |way| {
                let (i, c) = ways[way];
                let said = self.between[i].dofs.iter().map(|dof| {
                    let at = self.dofs[c].binary_search(dof).ok();
                    (at.map(|at| clusters[&c][at]), forces[&c].get(dof).copied())
                });
                said.collect::<Vec<_>>()
            },
            |way, said| {
                let group = &self.between[ways[way].0];
                let [x, r] = of_groups.entry(group.number).or_default();
                for (dof, (of_x, of_r)) in group.dofs.iter().zip(said) {
                    if let Some(of_x) = of_x {
                        x.entry(*dof).or_insert(of_x);
                    }
                    *r.entry(*dof).or_insert(0.0) += of_r.unwrap_or(0.0);
                }
            },
        );
        let answers = of_groups.iter();
        answers
            .map(|(g, [x, r])| (*g, self.groups[g].answer(x, r)))
            .collect()
    }
}

fn moves(Moves: Moves) -> Failure {
    Failure::ill_posed(
        "a part of the scene can move although every contact that presses is held; expected supports or contact that \
         hold it",
    )
}

/// S x, where the lower triangle of S counts.
fn product_of_lower(s: &Mat<f64>, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; x.len()];
    for j in 0..x.len() {
        let column = &s.col_as_slice(j)[j..];
        y[j] += dot(column, &x[j..]);
        for (y, s) in y[j + 1..].iter_mut().zip(&column[1..]) {
            *y += s * x[j];
        }
    }
    y
}
