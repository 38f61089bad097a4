//! The solution for a load: clusters condense, conjugate gradients solve for shared unknowns, clusters recover.

use std::collections::BTreeMap;

use contact_dd_partition::id::{MergeRootId, OnGroups, OnMergeRoots, OnTreeNodes};

use crate::bddc::Bddc;
use crate::bddc::conjugate_gradients::ConjugateGradients;
use crate::bddc::loads::{ClusterAnswer, ClusterLoads, Constants};
use crate::bddc::local::Vectors;
use crate::bddc::slipping::{Slipping, SlippingSolution};
use crate::bytes::Reals;
use crate::comm::Comm;
use crate::contact::laws::Iterate;
use crate::context::Context;
use crate::plan::Plan;
use crate::schur::cluster_schur::ClusterSchur;
use crate::schur::condensed::InterfaceDof;
use crate::vector::axpy;

/// Accuracy to which a solution is iterated.
#[derive(Clone, Copy, Debug)]
pub struct Accuracy<'a> {
    /// Approximate bound of the error in the energy norm, relative to that of the solution.
    pub tolerance: f64,
    /// The unknowns of every cluster, by its node, in a nearby solution.
    pub start: Option<&'a OnTreeNodes<Vec<f64>>>,
}

impl Accuracy<'_> {
    /// Accuracy of about round-off, from zero: less would require refinement more often than not.
    pub const FULL: Self = Self {
        tolerance: 1e-14,
        start: None,
    };
}

/// The response to a load, on this rank.
#[derive(Debug, Default)]
pub struct BddcSolution {
    /// The unknowns of every cluster, by its node.
    pub clusters: OnTreeNodes<Vec<f64>>,
    /// The jumps and forces of every contact group between clusters; 0 force where open.
    pub groups: OnGroups<Iterate>,
    /// The forces at the jumps of their ties.
    pub tied: OnGroups<Vec<f64>>,
    /// The forces on open jumps: those of the load, or of slipping points.
    pub forces: OnGroups<Vec<f64>>,
    /// Number of iterations.
    pub iterations: usize,
    /// True if the iteration converged.
    pub is_solved: bool,
}

impl Bddc {
    /// Solves for `loads` on the unknowns of the clusters of this rank, and for the forces of slipping points if they
    /// have laws. Collective.
    pub fn solve(
        &self,
        context: &Context<'_>,
        clusters: &OnTreeNodes<ClusterSchur>,
        loads: ClusterLoads<'_>,
        accuracy: Accuracy,
    ) -> BddcSolution {
        let Context { comm, plan, .. } = *context;
        let constants = self.constants(comm, loads.prescribed);
        let matrices = plan
            .merge_roots
            .iter()
            .map(|v| clusters.get(v).map(|of| &of.s));
        let gradients = ConjugateGradients {
            context,
            classes: &self.classes,
            sums: &self.sums,
            locals: &self.locals,
            matrices: &matrices.collect(),
            coarse: &self.coarse,
            is_stale: self.is_stale(),
            is_provisional: self.is_provisional(),
        };
        let start = accuracy.start.map(|known| self.start(comm, known, plan));
        let solution = match loads.laws {
            Some(laws) => {
                let slipping = Slipping {
                    bddc: self,
                    context,
                    clusters,
                    gradients,
                    loads,
                    constants: &constants,
                    laws,
                };
                slipping.solve(start, accuracy.tolerance)
            }
            None => {
                let acting = self.acting(context, Some(loads.clusters), loads.forces);
                let (own, b) = self.condense(context, clusters, &acting, &constants);
                let (x, iterations, is_solved) = gradients.solve(b, start, accuracy.tolerance);
                let solved = self.recovered(&own, &x, &constants);
                let unbalanced = self.unbalanced(context, clusters, acting, &solved);
                SlippingSolution {
                    answer: self.answer(comm, solved, &unbalanced),
                    forces: loads.forces.clone(),
                    iterations,
                    is_solved,
                }
            }
        };
        let ClusterAnswer {
            mut clusters,
            groups,
            tied,
        } = solution.answer;
        self.equalize(comm, &mut clusters);
        let by_node = clusters.into_iter().map(|(c, x)| (plan.merge_roots[c], x));
        BddcSolution {
            clusters: by_node.collect(),
            groups,
            tied,
            forces: solution.forces,
            iterations: solution.iterations,
            is_solved: solution.is_solved,
        }
    }

    /// The loads on the unknowns of this rank's clusters, with `forces` on the jumps of its contact groups. Collective.
    pub(super) fn acting(
        &self,
        context: &Context<'_>,
        loads: Option<&OnTreeNodes<Vec<f64>>>,
        forces: &OnGroups<Vec<f64>>,
    ) -> Vectors {
        let plan = context.plan;
        let mut acting = Vectors::new();
        for &c in self.locals.keys() {
            let none = || vec![0.0; self.unknowns.dofs[c].len()];
            let of_cluster = loads.map(|loads| loads[&plan.merge_roots[c]].clone());
            acting.insert(c, of_cluster.unwrap_or_else(none));
        }
        if context.catalog.has_friction() {
            for (c, place, force) in self.loads_of(context.comm, forces) {
                if let Some(load) = acting.get_mut(&c) {
                    load[place] += force;
                }
            }
        }
        acting
    }

    /// The parts of clusters that reduce these loads and `constants`: on own unknowns, and on shared ones.
    pub(super) fn condense(
        &self,
        context: &Context<'_>,
        clusters: &OnTreeNodes<ClusterSchur>,
        acting: &Vectors,
        constants: &Constants,
    ) -> (Vectors, Vectors) {
        let (mut own, mut b) = (Vectors::new(), Vectors::new());
        for (&c, local) in &self.locals {
            let mut load = acting[&c].clone();
            let known = self.constants_of(c, constants);
            if known.iter().any(|x| *x != 0.0) {
                let s = &clusters[&context.plan.merge_roots[c]].s;
                axpy(-1.0, &local.forces(s, &known), &mut load);
            }
            let (of_own, of_shared) = match load.iter().any(|f| *f != 0.0) {
                true => local.condense(&load),
                false => (vec![0.0; local.own()], vec![0.0; local.shared()]),
            };
            own.insert(c, of_own);
            b.insert(c, of_shared);
        }
        (own, b)
    }

    /// The part of the loads that the unknowns of clusters leave unbalanced: the forces of closed conditions.
    pub(super) fn unbalanced(
        &self,
        context: &Context<'_>,
        clusters: &OnTreeNodes<ClusterSchur>,
        mut acting: Vectors,
        solved: &Vectors,
    ) -> Vectors {
        for (c, load) in &mut acting {
            let s = &clusters[&context.plan.merge_roots[*c]].s;
            axpy(-1.0, &self.locals[c].forces(s, &solved[c]), load);
        }
        acting
    }

    /// The answer of contact groups to the unknowns of clusters and these unbalanced forces. Collective.
    pub(super) fn answer(
        &self,
        comm: &Comm,
        clusters: Vectors,
        unbalanced: &Vectors,
    ) -> ClusterAnswer {
        let (mut groups, mut tied) = (OnGroups::new(), OnGroups::new());
        for (g, (at, forces)) in self.answers(comm, &clusters, unbalanced) {
            groups.insert(g, at);
            tied.insert(g, forces);
        }
        ClusterAnswer {
            clusters,
            groups,
            tied,
        }
    }

    /// Gives unknowns that clusters compute from others, by ties or turned classes, the value of their first cluster in all
    /// that have them: the clusters' sums differ by the round-off of their largest term, which in a stiff body beside a soft
    /// one is more than that of its own displacements. Collective.
    fn equalize(&self, comm: &Comm, clusters: &mut Vectors) {
        let turned = (self.classes.list.iter()).filter(|class| class.turned.is_some());
        let turned = turned.flat_map(|class| class.dofs.iter().copied());
        let mut shared: BTreeMap<[MergeRootId; 2], Vec<[usize; 2]>> = BTreeMap::new();
        for dof in self.ties.tied().map(|(&dof, _)| dof).chain(turned) {
            let place = |c: MergeRootId| Some((c, self.unknowns.dofs[c].binary_search(&dof).ok()?));
            let mut all = self.unknowns.clusters_of(dof).filter_map(place);
            if let Some((first, from)) = all.next() {
                all.for_each(|(c, to)| shared.entry([first, c]).or_default().push([from, to]));
            }
        }
        let pairs: Vec<([MergeRootId; 2], Vec<[usize; 2]>)> = shared.into_iter().collect();
        let mut arrived = Vec::new();
        comm.route(
            pairs
                .iter()
                .map(|(ends, _)| ends.map(|c| self.owners[c]).into()),
            |i| {
                let ([first, _], places) = &pairs[i];
                Reals(
                    places
                        .iter()
                        .map(|&[from, _]| clusters[first][from])
                        .collect(),
                )
            },
            |i, Reals(values)| arrived.push((i, values)),
        );
        for (i, values) in arrived {
            let ([_, c], places) = &pairs[i];
            if let Some(of_cluster) = clusters.get_mut(c) {
                for (&[_, to], value) in places.iter().zip(values) {
                    of_cluster[to] = value;
                }
            }
        }
    }

    /// The `constants` on the unknowns of a cluster.
    fn constants_of(&self, c: MergeRootId, constants: &Constants) -> Vec<f64> {
        let dofs = self.unknowns.dofs[c].iter();
        dofs.map(|dof| constants.get(dof).copied().unwrap_or(0.0))
            .collect()
    }

    /// All unknowns of the clusters of this rank, from condensed loads, shared unknowns and the `constants`.
    pub(super) fn recovered(&self, own: &Vectors, x: &Vectors, constants: &Constants) -> Vectors {
        let mut solved = Vectors::new();
        for (&c, local) in &self.locals {
            let mut all = local.recover(&own[&c], &x[&c]);
            all.iter_mut()
                .zip(self.constants_of(c, constants))
                .for_each(|(x, constant)| *x += constant);
            solved.insert(c, all);
        }
        solved
    }

    /// The shared unknowns of clusters from `known` unknowns by node. Collective.
    fn start(&self, comm: &Comm, known: &OnTreeNodes<Vec<f64>>, plan: &Plan) -> Vectors {
        let classes = &self.classes.list;
        let ends: Vec<(usize, MergeRootId)> = (classes.iter().enumerate())
            .flat_map(|(k, class)| class.clusters.iter().map(move |&c| (k, c)))
            .collect();
        let home = |k: usize| self.owners[classes[k].clusters[0]];
        let mut values: BTreeMap<usize, Vec<Option<f64>>> = BTreeMap::new();
        comm.route(
            ends.iter().map(|&(k, c)| (self.owners[c], home(k))),
            |i| {
                let (k, c) = ends[i];
                let of_cluster = &known[&plan.merge_roots[c]];
                let dofs = classes[k].dofs.iter();
                let at = dofs.map(|dof| self.unknowns.dofs[c].binary_search(dof).ok());
                at.map(|at| at.map(|at| of_cluster[at])).collect::<Vec<_>>()
            },
            |i, of_cluster| {
                let of_class = values
                    .entry(ends[i].0)
                    .or_insert_with(|| of_cluster.clone());
                of_class
                    .iter_mut()
                    .zip(of_cluster)
                    .for_each(|(value, other)| *value = value.or(other));
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
        start
    }

    /// Loads on clusters due to forces on the jumps of this rank's contact groups, on all ranks: the first cluster that
    /// has an unknown, and its index there. Collective.
    fn loads_of(&self, comm: &Comm, forces: &OnGroups<Vec<f64>>) -> Vec<(MergeRootId, usize, f64)> {
        let mut loads = Vec::new();
        comm.gather(
            &self.group_owners(),
            |i| {
                let number = self.between[i].number;
                let forces = forces.get(&number).map_or(&[][..], Vec::as_slice);
                self.groups[&number].loads_of(forces)
            },
            |_, of_group| {
                loads.extend(of_group.into_iter().filter_map(|(dof, load)| {
                    let c = self.unknowns.clusters_of(dof).next()?;
                    let place = self.unknowns.dofs[c].binary_search(&dof).ok()?;
                    Some((c, place, load))
                }));
            },
        );
        comm.broadcast(&mut loads);
        loads
    }

    /// The constants of tied displacements, added to the terms of others, on all ranks. Collective.
    fn constants(&self, comm: &Comm, values: &OnGroups<Vec<f64>>) -> Constants {
        let of_group = |i: usize| {
            let number = self.between[i].number;
            self.groups[&number].constants(&values[&number])
        };
        let mut constants = comm.gathered(&self.group_owners(), of_group).concat();
        comm.broadcast(&mut constants);
        let mut constants = constants.into_iter().collect();
        self.ties.resolve(&mut constants);
        constants
    }

    /// Jumps and forces of this rank's contact groups, and the forces of their ties, from the unknowns of clusters and
    /// the `unbalanced` forces there. Collective.
    fn answers(
        &self,
        comm: &Comm,
        clusters: &Vectors,
        unbalanced: &Vectors,
    ) -> OnGroups<(Iterate, Vec<f64>)> {
        let routes: Vec<(usize, MergeRootId)> = (self.between.iter().enumerate())
            .flat_map(|(i, group)| group.clusters.iter().map(move |&c| (i, c)))
            .collect();
        let forces = self.locals.keys().map(|&c| {
            let at = &self.at_contact[&c];
            let force = |&i: &usize| (self.unknowns.dofs[c][i], unbalanced[&c][i]);
            let mut forces = at.places.iter().map(force).collect();
            self.ties.carry(&at.ties, &mut forces);
            (c, forces)
        });
        let forces: OnMergeRoots<BTreeMap<InterfaceDof, f64>> = forces.collect();
        let mut of_groups: OnGroups<[BTreeMap<InterfaceDof, f64>; 2]> = BTreeMap::new();
        comm.route(
            routes
                .iter()
                .map(|&(i, c)| (self.owners[c], self.between[i].owner)),
            |route| {
                let (i, c) = routes[route];
                let of_dof = |(dof, force): (&InterfaceDof, &f64)| {
                    let place = self.between[i].dofs.binary_search(dof).ok()?;
                    let at = self.unknowns.dofs[c].binary_search(dof).ok();
                    Some((place, at.map(|at| clusters[&c][at]), *force))
                };
                forces[&c].iter().filter_map(of_dof).collect::<Vec<_>>()
            },
            |route, of_dofs| {
                let group = &self.between[routes[route].0];
                let [x, r] = of_groups.entry(group.number).or_default();
                for (place, of_x, of_r) in of_dofs {
                    let dof = group.dofs[place];
                    if let Some(of_x) = of_x {
                        x.entry(dof).or_insert(of_x);
                    }
                    *r.entry(dof).or_insert(0.0) += of_r;
                }
            },
        );
        let answers = of_groups.iter();
        answers
            .map(|(g, [x, r])| (*g, self.groups[g].answer(x, r)))
            .collect()
    }
}
