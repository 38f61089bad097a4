//! The fronts above all contact, for an active set that is frozen.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use faer::Mat;

use crate::bddc::Bddc;
use crate::bddc::solution::Accuracy;
use crate::bytes::Reals;
use crate::condense::Condensation;
use crate::context::Context;
use crate::error::Failure;
use crate::schur::condensed::Condensed;
use crate::schur::local::CondensedLoad;
use crate::schur::merge::{Merge, OwnJumps, Spare};
use crate::schur::substitution::Replaced;
use crate::vector::dot;

/// The spring on an open normal jump, relative to its diagonal, where some part of the scene moves freely without
/// the contacts that are open: the next active set closes what stops it.
const SPRING: f64 = 1e-9;

/// A front whose own normal jumps are open or closed.
#[derive(Debug)]
struct FrozenFront {
    merge: Merge,
    /// S of the closed ones against them and what is kept, a column each from the diagonal on.
    held: Mat<f64>,
    /// Which are open.
    open: Vec<bool>,
}

/// The fronts of this rank above all contact, and what they are merged from.
#[derive(Debug)]
pub struct FrozenFronts {
    /// The nodes of the hierarchy above all clusters, children before parents, on all ranks the same.
    nodes: Vec<usize>,
    fronts: BTreeMap<usize, FrozenFront>,
    /// S of clusters and fronts, at the owner of the node that they are merged into.
    merged: BTreeMap<usize, Condensed>,
    replaced: BTreeMap<usize, Vec<Replaced>>,
    spring: f64,
    spare: Spare,
    /// The smallest pivot of the last factorization, relative to its diagonal entry.
    pub smallest_pivot: f64,
    /// What works between the nodes that nothing here is above, where these aren't the roots of the hierarchy.
    bddc: Option<Bddc>,
}

/// What a load does where the active set is frozen, on this rank.
#[derive(Clone, Debug, Default)]
pub struct FrozenSolution {
    /// The normal jumps of every contact group (m).
    pub jumps: BTreeMap<usize, Vec<f64>>,
    /// The forces on them, 0 where open (N/m).
    pub forces: BTreeMap<usize, Vec<f64>>,
    /// The unknowns on the boundary of every cluster.
    pub boundaries: BTreeMap<usize, Vec<f64>>,
    /// The unknowns of the nodes between which an iterative solver works.
    pub tops: BTreeMap<usize, Vec<f64>>,
    /// Its iterations.
    pub iterations: usize,
    /// Whether a preconditioner that was made for another active set was too bad.
    pub is_too_far: bool,
}

impl FrozenFronts {
    /// Fronts over the `clusters` of this rank, by their place among all; none is factorized yet. Collective.
    ///
    /// # Errors
    /// A contact point that nothing can be replaced for.
    pub fn new(
        condensation: &Condensation<'_>,
        clusters: &BTreeMap<usize, Condensed>,
    ) -> Result<Self, Failure> {
        let context = &condensation.context;
        let plan = context.plan;
        let mut is_between = vec![false; plan.tree.nodes.len()];
        for v in plan.tops.iter().flat_map(|&v| plan.tree.subtree(v)) {
            is_between[v] = true;
        }
        for cluster in &plan.clusters {
            for v in plan.tree.subtree(cluster.node) {
                is_between[v] = false;
            }
        }
        let mut nodes: Vec<usize> = (0..is_between.len()).filter(|&v| is_between[v]).collect();
        let mut depth = vec![0; is_between.len()];
        for v in (0..depth.len()).rev() {
            depth[v] = (plan.tree.nodes[v].parent).map_or(0, |parent| depth[parent] + 1);
        }
        // The deepest first: what ranks share is near the root, and none waits for another before.
        nodes.sort_by_key(|&v| Reverse(depth[v]));
        let own = plan
            .groups
            .iter()
            .filter(|group| plan.node_owners[group.node] == context.comm.rank());
        let replaced = own.map(|group| Ok((group.node, condensation.replaced(group.node)?)));
        let replaced = context.comm.agree(replaced.collect())?;
        let mut fronts = Self {
            nodes,
            fronts: BTreeMap::new(),
            merged: BTreeMap::new(),
            replaced,
            spring: 0.0,
            spare: Spare::default(),
            smallest_pivot: f64::INFINITY,
            bddc: None,
        };
        for (c, cluster) in plan.clusters.iter().enumerate() {
            fronts.pass_up(context, cluster.node, clusters.get(&c).cloned());
        }
        Ok(fronts)
    }

    /// Number of coarse unknowns of the iterative interface solver, where there is one; 0 but on the root.
    pub fn coarse_dofs(&self) -> Option<usize> {
        self.bddc.as_ref().map(|bddc| bddc.coarse_dofs)
    }

    /// Brings S of a node to the owner of the one that it is merged into. Collective.
    fn pass_up(&mut self, context: &Context<'_>, v: usize, mut condensed: Option<Condensed>) {
        let Context { comm, plan, .. } = *context;
        let Some(parent) = plan.merged_into(v) else {
            self.merged
                .extend(condensed.map(|condensed| (v, condensed)));
            return;
        };
        let way = (plan.node_owners[v], plan.node_owners[parent]);
        comm.route(
            [way],
            |_| condensed.take(),
            |_, arrived| {
                self.merged.extend(arrived.map(|condensed| (v, condensed)));
            },
        );
    }

    /// Eliminates again whatever is above a contact group that isn't `open` as it was; all at first. Collective;
    /// `open` says it of the groups of this rank.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn freeze(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
    ) -> Result<(), Failure> {
        self.make(context, open, false)
    }

    /// Makes the preconditioner that of the active set, where there is one that isn't. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn renew(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
    ) -> Result<(), Failure> {
        match self.bddc.as_ref().is_some_and(Bddc::is_stale) {
            true => self.make(context, open, true),
            false => Ok(()),
        }
    }

    fn make(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
        renewed: bool,
    ) -> Result<(), Failure> {
        let is_known = self.fronts_known(context);
        if self.factorize(context, open, is_known, renewed).is_ok() {
            return Ok(());
        }
        self.spring = SPRING;
        self.factorize(context, open, false, true)
    }

    /// Eliminates what is touched, and makes the preconditioner between clusters. Collective.
    fn factorize(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
        is_known: bool,
        renewed: bool,
    ) -> Result<(), Failure> {
        let Context { comm, plan, .. } = *context;
        let touched = self.touched(context, open, is_known);
        let result = self.eliminate(context, open, &touched);
        comm.agree(result)?;
        if plan.has_one_cluster() || !renewed && !touched.contains(&true) {
            return Ok(());
        }
        let mut bddc = match self.bddc.take() {
            Some(bddc) => bddc,
            None => Bddc::new(context, &self.merged)?,
        };
        let renewed = renewed || !is_known;
        bddc.freeze(context, &self.merged, &touched, open, self.spring, renewed)?;
        self.smallest_pivot = self.smallest_pivot.min(bddc.smallest_pivot);
        self.bddc = Some(bddc);
        Ok(())
    }

    /// Whether all fronts were factorized before. Collective.
    fn fronts_known(&self, context: &Context<'_>) -> bool {
        let Context { comm, plan, .. } = *context;
        let own = self
            .nodes
            .iter()
            .filter(|&&v| plan.node_owners[v] == comm.rank());
        let between = plan.has_one_cluster() || self.bddc.is_some();
        let mine = own.count() == self.fronts.len() && between;
        let all = !comm.collect(&mine).contains(&false);
        comm.decide(all)
    }

    /// The nodes that a change of the active set touches, on all ranks. Collective.
    fn touched(
        &self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
        is_known: bool,
    ) -> Vec<bool> {
        let Context { comm, plan, .. } = *context;
        let changed = |g: usize| {
            let front = self
                .fronts
                .get(&plan.groups[g].node)
                .map(|front| &front.open);
            let between = || self.bddc.as_ref().and_then(|bddc| bddc.open(g));
            front.or_else(between) != Some(&open[&g])
        };
        let mut touched = vec![!is_known; plan.tree.nodes.len()];
        comm.gather(&plan.group_owners(), changed, |g, changed| {
            touched[plan.groups[g].node] |= changed;
        });
        comm.broadcast(&mut touched);
        for v in 0..touched.len() {
            if let (true, Some(parent)) = (touched[v], plan.tree.nodes[v].parent) {
                touched[parent] = true;
            }
        }
        touched
    }

    /// Eliminates what is touched. Collective; what failed on this rank is said at the end.
    fn eliminate(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
        touched: &[bool],
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

    /// Merges the children of node v of this rank; nothing where one of them failed.
    fn merge(
        &mut self,
        context: &Context<'_>,
        v: usize,
        open: &BTreeMap<usize, Vec<bool>>,
    ) -> Result<Option<Condensed>, Failure> {
        let Context { plan, par, .. } = *context;
        let node = &plan.tree.nodes[v];
        let children = node.children.iter().map(|child| self.merged.get(child));
        let Some(children) = children.collect::<Option<Vec<&Condensed>>>() else {
            return Ok(None);
        };
        let none = Vec::new();
        let replaced = self.replaced.get(&v).unwrap_or(&none);
        let open = plan.group_of(v).map_or_else(Vec::new, |g| open[&g].clone());
        let own = OwnJumps {
            replaced,
            open: &open,
            spring: self.spring,
        };
        let (merge, whole) = Merge::of(&children, &node.eliminated, own, &mut self.spare, par)
            .map_err(|free| {
                Failure::ill_posed(format!(
                    "a part of the scene can move although every contact that presses is held (found \
                     at node {} of /interface/interface); expected supports or contact that hold it",
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
        self.fronts.insert(v, FrozenFront { merge, held, open });
        Ok(Some(condensed))
    }

    /// Solves for `loads` on the boundaries of the clusters of this rank, by node, where the closed normal jumps of
    /// every group have the values `prescribed` and others are `open`, as is frozen; an iterative solver goes as far as
    /// `accuracy` says. Collective.
    ///
    /// # Errors
    /// Some part of the scene moves freely even where open contacts have springs.
    pub fn solve(
        &mut self,
        context: &Context<'_>,
        open: &BTreeMap<usize, Vec<bool>>,
        loads: &BTreeMap<usize, Vec<f64>>,
        prescribed: &BTreeMap<usize, Vec<f64>>,
        accuracy: Accuracy<'_>,
    ) -> Result<FrozenSolution, Failure> {
        let solution = self.solve_as_it_is(context, loads.clone(), prescribed, accuracy);
        if !solution.is_too_far {
            return Ok(solution);
        }
        self.renew(context, open)?;
        let from_there = Accuracy {
            start: Some(&solution.tops),
            ..accuracy
        };
        let mut nearer = self.solve_as_it_is(context, loads.clone(), prescribed, from_there);
        nearer.iterations += solution.iterations;
        Ok(nearer)
    }

    fn solve_as_it_is(
        &self,
        context: &Context<'_>,
        mut loads: BTreeMap<usize, Vec<f64>>,
        prescribed: &BTreeMap<usize, Vec<f64>>,
        accuracy: Accuracy<'_>,
    ) -> FrozenSolution {
        let plan = context.plan;
        let mut condensed: BTreeMap<usize, (CondensedLoad, Vec<f64>)> = BTreeMap::new();
        // What arrives at the owner of the node above.
        let mut arrived: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for cluster in &plan.clusters {
            let load = loads.remove(&cluster.node);
            carry(context, cluster.node, load, &mut arrived, Direction::Up);
        }
        for &v in &self.nodes {
            let passed = self.fronts.get(&v).map(|front| {
                let children = plan.tree.nodes[v].children.iter();
                let of_children: Vec<&[f64]> = children.map(|child| &arrived[child][..]).collect();
                let load = front.merge.condense(&of_children);
                let values = front.closed_values(plan.group_of(v).map(|g| &prescribed[&g][..]));
                let closed = values.len();
                let mut kept = load.boundary()[closed..].to_vec();
                for (j, value) in values.iter().enumerate() {
                    let column = &front.held.col_as_slice(j)[closed..];
                    for (kept, s) in kept.iter_mut().zip(column) {
                        *kept -= s * value;
                    }
                }
                condensed.insert(v, (load, values));
                kept
            });
            carry(context, v, passed, &mut arrived, Direction::Up);
        }
        let mut solution = FrozenSolution::default();
        let mut below: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        match &self.bddc {
            // Roots keep nothing.
            None => below.extend(plan.tops.iter().map(|&v| (v, Vec::new()))),
            Some(bddc) => {
                let between = bddc.solve(context, &self.merged, &arrived, prescribed, accuracy);
                solution.tops = between.clusters.clone();
                below = between.clusters;
                solution.iterations = between.iterations;
                solution.is_too_far = bddc.is_stale() && !between.is_solved;
                for (g, (jumps, forces)) in between.groups {
                    solution.jumps.insert(g, jumps);
                    solution.forces.insert(g, forces);
                }
            }
        }
        for &v in self.nodes.iter().rev() {
            let mut of_children: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
            if let (Some(front), Some((load, values)), Some(x)) =
                (self.fronts.get(&v), condensed.get(&v), below.remove(&v))
            {
                let mut boundary = values.clone();
                boundary.extend(x);
                if let Some(g) = plan.group_of(v) {
                    solution.forces.insert(g, front.forces(load, &boundary));
                }
                let (x, jumps) = front.merge.recover(load, &boundary);
                of_children.extend(plan.tree.nodes[v].children.iter().copied().zip(x));
                if let Some(g) = plan.group_of(v) {
                    solution.jumps.insert(g, jumps);
                }
            }
            for &child in &plan.tree.nodes[v].children {
                let x = of_children.remove(&child);
                carry(context, child, x, &mut below, Direction::Down);
            }
        }
        below.retain(|&v, _| plan.node_owners[v] == context.comm.rank());
        solution.boundaries = below;
        solution
    }
}

/// Copies the first columns of the lower triangle from row and column `first` of a matrix on.
fn copy_lower(from: &Mat<f64>, first: usize, to: &mut Mat<f64>) {
    for j in 0..to.ncols() {
        let below = &from.col_as_slice(first + j)[first + j..];
        to.col_as_slice_mut(j)[j..].copy_from_slice(below);
    }
}

/// Carries a vector of node v between its owner and that of the node above. Collective.
fn carry(
    context: &Context<'_>,
    v: usize,
    mut vector: Option<Vec<f64>>,
    into: &mut BTreeMap<usize, Vec<f64>>,
    direction: Direction,
) {
    let Context { comm, plan, .. } = *context;
    let Some(parent) = plan.merged_into(v) else {
        into.extend(vector.map(|vector| (v, vector)));
        return;
    };
    let (here, above) = (plan.node_owners[v], plan.node_owners[parent]);
    let way = match direction {
        Direction::Up => (here, above),
        Direction::Down => (above, here),
    };
    comm.route(
        [way],
        |_| Reals(vector.take().unwrap_or_default()),
        |_, Reals(arrived)| {
            into.insert(v, arrived);
        },
    );
}

impl FrozenFront {
    /// The values of its closed normal jumps, of those that all of its own would have.
    fn closed_values(&self, prescribed: Option<&[f64]>) -> Vec<f64> {
        let all = prescribed.unwrap_or_default().iter().zip(&self.open);
        all.filter(|(_, open)| !**open)
            .map(|(value, _)| *value)
            .collect()
    }

    /// The forces on its own normal jumps, 0 where open: what the load leaves of them at the unknowns `boundary`,
    /// closed normal jumps and what is kept.
    fn forces(&self, load: &CondensedLoad, boundary: &[f64]) -> Vec<f64> {
        let closed = self.held.ncols();
        let mut of_closed = load.boundary()[..closed].to_vec();
        for j in 0..closed {
            let column = &self.held.col_as_slice(j)[j..];
            of_closed[j] -= dot(column, &boundary[j..]);
            for (force, s) in of_closed[j..].iter_mut().zip(column).skip(1) {
                *force -= s * boundary[j];
            }
        }
        let mut of_closed = of_closed.into_iter();
        let of_jump = |open: &bool| match open {
            true => 0.0,
            false => of_closed.next().unwrap_or_default(),
        };
        self.open.iter().map(of_jump).collect()
    }
}

/// Along the hierarchy.
#[derive(Clone, Copy)]
enum Direction {
    Up,
    Down,
}
