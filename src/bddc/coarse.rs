//! The coarse problem: the clusters' Schur complements on coarse unknowns, merged up the hierarchy above them.
//!
//! The unknowns of a class are eliminated at the lowest node above all of its clusters. Nodes are distributed over
//! ranks like the clusters, and only nodes above changed clusters are factorized again.

use std::collections::BTreeMap;

use contact_dd_partition::id::{MergeRootId, OnMergeRoots, OnTreeNodes, TreeNodeId};
use contact_dd_partition::numbered::Numbered;
use faer::{Mat, Par};
use serde::{Deserialize, Serialize};

use crate::bddc::classes::Classes;
use crate::bddc::local::{Local, Vectors};
use crate::context::Context;
use crate::context::hierarchy::{Direction, carry};
use crate::error::Failure;
use crate::plan::Plan;
use crate::schur::condensed::InterfaceDof;
use crate::schur::symmetric::PackedSymmetric;
use crate::schur::trapezoid::{NotDefinite, Trapezoid};

/// The Schur complement of a cluster or a node on coarse unknowns.
#[derive(Debug, Serialize, Deserialize)]
pub struct Part {
    /// The classes, each by its first unknown, with their numbers of coarse unknowns.
    classes: Vec<(InterfaceDof, usize)>,
    s: PackedSymmetric,
    /// The diagonal of the coarse matrix, as far as it is assembled.
    #[serde(with = "crate::bytes")]
    diagonal: Vec<f64>,
}

impl Part {
    /// The part of cluster c with the Schur complement `s`.
    pub fn of(c: MergeRootId, local: &Local, s: PackedSymmetric, classes: &Classes) -> Self {
        let first = |&k: &usize| classes.list[k].dofs[0];
        let counts = local.bases().iter().map(|basis| basis.coarse);
        Self {
            classes: (classes.of_clusters[c].iter().map(first))
                .zip(counts)
                .collect(),
            diagonal: (0..s.size()).map(|i| s.column(i)[0]).collect(),
            s,
        }
    }
}

/// A node above clusters.
#[derive(Debug)]
struct Front {
    factor: Trapezoid<f64>,
    /// Positions of the unknowns of each child, eliminated ones first.
    places: Vec<Vec<usize>>,
    /// The smallest pivot relative to its diagonal entry.
    smallest_pivot: f64,
}

impl Front {
    /// Assembles `children`, with a share of the diagonal of each, eliminates the classes that `is_own`, and returns
    /// the Schur complement on the others.
    fn new(
        children: &[(&Part, f64)],
        is_own: impl Fn(&InterfaceDof) -> bool,
        par: Par,
    ) -> Result<(Self, Part), NotDefinite> {
        let all = children
            .iter()
            .flat_map(|(part, _)| part.classes.iter().copied());
        let all: BTreeMap<InterfaceDof, usize> = all.collect();
        let (own, kept): (Vec<_>, Vec<_>) = all.into_iter().partition(|(class, _)| is_own(class));
        let mut first = BTreeMap::new();
        let mut n = 0;
        for (class, count) in own.iter().chain(&kept) {
            first.insert(*class, n);
            n += count;
        }
        let eliminated: usize = own.iter().map(|(_, count)| count).sum();
        let (mut sum, mut diagonal) = (Mat::zeros(n, n), vec![0.0; n]);
        let mut places = Vec::new();
        for (part, share) in children {
            let of_class = |(class, count): &(InterfaceDof, usize)| {
                let first = first[class];
                first..first + count
            };
            let of_part: Vec<usize> = part.classes.iter().flat_map(of_class).collect();
            for (j, (&b, d)) in of_part.iter().zip(&part.diagonal).enumerate() {
                diagonal[b] += d;
                sum[(b, b)] += share * d;
                for (&a, s) in of_part[j..].iter().zip(part.s.column(j)) {
                    sum[(a.max(b), a.min(b))] += s;
                }
            }
            places.push(of_part);
        }
        let (factor, whole) = Trapezoid::new(sum, eliminated, par)?;
        let front = Self {
            smallest_pivot: factor.smallest_pivot(&diagonal),
            factor,
            places,
        };
        let part = Part {
            classes: kept,
            s: PackedSymmetric::trailing(&whole, eliminated),
            diagonal: diagonal.split_off(eliminated),
        };
        Ok((front, part))
    }
}

/// The coarse problem, on this rank.
#[derive(Debug)]
pub struct Coarse {
    /// The nodes of the hierarchy above clusters, children before parents.
    nodes: Vec<TreeNodeId>,
    /// The fronts of this rank.
    fronts: OnTreeNodes<Front>,
    /// The coarse matrices of clusters and nodes, at the owner of the node above.
    parts: OnTreeNodes<Part>,
    /// The share of the diagonal that is added; `None` before the first factorization.
    share: Option<f64>,
}

impl Coarse {
    /// The coarse problem above the clusters of a `plan`, not factorized yet.
    pub fn new(plan: &Plan) -> Self {
        Self {
            nodes: plan.deepest_first(|v| plan.is_above_merge_roots(v)),
            fronts: BTreeMap::new(),
            parts: BTreeMap::new(),
            share: None,
        }
    }

    /// Factorizes all nodes above clusters that are `remade`, which have these `parts`, by cluster; adds the first of
    /// `shifts`, shares of the diagonal, that makes the matrix definite. Collective.
    ///
    /// # Errors
    /// A part of the scene can move.
    pub fn factorize(
        &mut self,
        context: &Context<'_>,
        classes: &Classes,
        mut parts: OnMergeRoots<Part>,
        remade: &Numbered<MergeRootId, bool>,
        shifts: &[f64],
    ) -> Result<(), Failure> {
        let Context { comm, plan, .. } = *context;
        for (c, &top) in plan.merge_roots.each().filter(|&(c, _)| remade[c]) {
            self.pass_up(context, top, parts.remove(&c));
        }
        let mut factorized = Ok(());
        for &share in shifts {
            let is_other = self.share != Some(share);
            let mut touched = plan.tree.nodes.like(false);
            for (&top, is_remade) in plan.merge_roots.iter().zip(remade) {
                touched[top] = is_other || *is_remade;
            }
            plan.mark_above(&mut touched);
            factorized = comm.agree(self.merge(context, classes, &touched, share));
            self.share = factorized.is_ok().then_some(share);
            if factorized.is_ok() {
                break;
            }
        }
        factorized
    }

    /// Merges the `touched` nodes. Collective; failures of this rank are returned at the end.
    fn merge(
        &mut self,
        context: &Context<'_>,
        classes: &Classes,
        touched: &Numbered<TreeNodeId, bool>,
        share: f64,
    ) -> Result<(), Failure> {
        let Context {
            comm, plan, par, ..
        } = *context;
        let homes = classes.homes(&plan.tree, &plan.merge_roots);
        let homes: BTreeMap<InterfaceDof, TreeNodeId> = (classes.list.iter().zip(homes))
            .map(|(class, home)| (class.dofs[0], home))
            .collect();
        let mut result = Ok(());
        for v in self.nodes.clone() {
            if !touched[v] {
                continue;
            }
            let child = |&child: &TreeNodeId| {
                let share = if plan.is_merge_root(child) {
                    share
                } else {
                    0.0
                };
                Some((self.parts.get(&child)?, share))
            };
            let children: Option<Vec<(&Part, f64)>> =
                plan.tree.nodes[v].children.iter().map(child).collect();
            let is_due = plan.node_owners[v] == comm.rank() && result.is_ok();
            // The part of a failed child is missing; its owner reports why.
            let merged = children
                .filter(|_| is_due)
                .map(|children| Front::new(&children, |class| homes.get(class) == Some(&v), par));
            let part = match merged.transpose() {
                Ok(merged) => merged.map(|(front, part)| {
                    self.fronts.insert(v, front);
                    part
                }),
                Err(NotDefinite) => {
                    result = Err(Failure::ill_posed(
                        "the coarse problem of the clusters can't be solved: some part of the scene is held neither by \
                         supports nor by contact",
                    ));
                    None
                }
            };
            self.pass_up(context, v, part);
        }
        result
    }

    /// Sends the part of node v to the owner of the node above. Collective.
    fn pass_up(&mut self, context: &Context<'_>, v: TreeNodeId, mut part: Option<Part>) {
        let Context { comm, plan, .. } = *context;
        let Some(parent) = plan.tree.nodes[v].parent else {
            return;
        };
        let route = (plan.node_owners[v], plan.node_owners[parent]);
        self.parts.remove(&v);
        comm.route(
            [route],
            |_| part.take(),
            |_, arrived| self.parts.extend(arrived.map(|part| (v, part))),
        );
    }

    /// Number of coarse unknowns that this rank eliminates.
    pub fn len(&self) -> usize {
        let fronts = self.fronts.values();
        fronts.map(|front| front.factor.eliminated()).sum()
    }

    /// The smallest pivot of this rank relative to its diagonal entry.
    pub fn smallest_pivot(&self) -> f64 {
        let pivots = self.fronts.values().map(|front| front.smallest_pivot);
        pivots.fold(f64::INFINITY, f64::min)
    }

    /// The coarse unknowns of the clusters of this rank, for the loads of all. Collective.
    pub fn solve(&self, context: &Context<'_>, mut loads: Vectors) -> Vectors {
        let plan = context.plan;
        let parent = |v: TreeNodeId| plan.tree.nodes[v].parent;
        let mut arrived = BTreeMap::new();
        for (c, &top) in plan.merge_roots.each() {
            let load = loads.remove(&c);
            carry(context, top, parent(top), load, &mut arrived, Direction::Up);
        }
        let mut eliminated: OnTreeNodes<Vec<f64>> = BTreeMap::new();
        for &v in &self.nodes {
            let passed = self.fronts.get(&v).map(|front| {
                let mut load = vec![0.0; front.factor.size()];
                for (child, places) in plan.tree.nodes[v].children.iter().zip(&front.places) {
                    let of_child = arrived.remove(child).unwrap_or_default();
                    for (&i, f) in places.iter().zip(of_child) {
                        load[i] += f;
                    }
                }
                front.factor.forward(&mut load);
                let passed = load.split_off(front.factor.eliminated());
                eliminated.insert(v, load);
                passed
            });
            carry(context, v, parent(v), passed, &mut arrived, Direction::Up);
        }
        let mut solved = BTreeMap::new();
        for &v in self.nodes.iter().rev() {
            let x = self.fronts.get(&v).map(|front| {
                let mut x = eliminated.remove(&v).unwrap_or_default();
                x.extend(solved.remove(&v).unwrap_or_default());
                front.factor.backward(&mut x);
                x
            });
            for (i, &child) in plan.tree.nodes[v].children.iter().enumerate() {
                let of_child = x.as_ref().zip(self.fronts.get(&v)).map(|(x, front)| {
                    let places = front.places[i].iter();
                    places.map(|&i| x[i]).collect()
                });
                carry(
                    context,
                    child,
                    Some(v),
                    of_child,
                    &mut solved,
                    Direction::Down,
                );
            }
        }
        let of_clusters = plan.merge_roots.each();
        of_clusters
            .filter_map(|(c, top)| Some((c, solved.remove(top)?)))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use faer::linalg::solvers::Solve;

    use super::*;

    /// The unknowns of class k among all.
    const UNKNOWNS: [std::ops::Range<usize>; 3] = [0..2, 2..5, 5..6];

    fn first(k: usize) -> InterfaceDof {
        InterfaceDof {
            node: 10 - k as u32,
            axis: 0,
        }
    }

    /// The part on these `classes`, in this order, and their positions among all.
    fn part(classes: &[usize]) -> (Part, Mat<f64>, Vec<usize>) {
        let places: Vec<usize> = classes.iter().flat_map(|&k| UNKNOWNS[k].clone()).collect();
        let n = places.len();
        let root = Mat::from_fn(n, n, |i, j| ((7 * i + 3 * j + classes[0]) as f64).sin());
        let s = &root * root.transpose() + Mat::<f64>::identity(n, n);
        let part = Part {
            classes: (classes.iter())
                .map(|&k| (first(k), UNKNOWNS[k].len()))
                .collect(),
            diagonal: (0..n).map(|i| s[(i, i)]).collect(),
            s: PackedSymmetric::new(&s),
        };
        (part, s, places)
    }

    #[test]
    fn merges_one_above_the_other_solve_for_the_sum_of_all_parts() {
        const SHARE: f64 = 0.25;
        let parts = [part(&[0, 1]), part(&[2, 1]), part(&[2, 0])];
        let mut sum = Mat::<f64>::zeros(6, 6);
        for (_, s, places) in &parts {
            for (i, &a) in places.iter().enumerate() {
                for (j, &b) in places.iter().enumerate() {
                    sum[(a, b)] += s[(i, j)] * if i == j { 1.0 + SHARE } else { 1.0 };
                }
            }
        }
        let [a, b, c] = &parts;
        let children = [(&a.0, SHARE), (&b.0, SHARE)];
        let (below, left) = Front::new(&children, |class| *class == first(1), Par::Seq).unwrap();
        let children = [(&left, 0.0), (&c.0, SHARE)];
        let (above, nothing) = Front::new(&children, |_| true, Par::Seq).unwrap();
        assert!(nothing.classes.is_empty());

        // Loads on class 1 are carried up by the front below, all others by the third part.
        let load = |i: usize| 1.0 + i as f64;
        let mut of_below = vec![0.0; 6];
        let eliminated = below.factor.eliminated();
        (0..eliminated).for_each(|i| of_below[i] = load(UNKNOWNS[1].start + i));
        below.factor.forward(&mut of_below);
        let mut of_above = vec![0.0; above.factor.size()];
        for (i, &place) in above.places[0].iter().enumerate() {
            of_above[place] += of_below[eliminated + i];
        }
        for (&place, &at) in above.places[1].iter().zip(&c.2) {
            of_above[place] += load(at);
        }
        above.factor.forward(&mut of_above);
        above.factor.backward(&mut of_above);
        for (i, &place) in above.places[0].iter().enumerate() {
            of_below[eliminated + i] = of_above[place];
        }
        below.factor.backward(&mut of_below);

        let exact = sum
            .llt(faer::Side::Lower)
            .unwrap()
            .solve(&Mat::from_fn(6, 1, |i, _| load(i)));
        for (front_place, &at) in below.places[0].iter().zip(&a.2) {
            assert!((of_below[*front_place] - exact[(at, 0)]).abs() < 1e-13);
        }
        for (front_place, &at) in above.places[1].iter().zip(&c.2) {
            assert!((of_above[*front_place] - exact[(at, 0)]).abs() < 1e-13);
        }
        let pivots = [&below, &above].map(|front| front.smallest_pivot);
        assert!(pivots.iter().all(|pivot| (1e-3..=1.25).contains(pivot)));
    }
}
