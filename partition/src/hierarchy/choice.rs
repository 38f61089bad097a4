//! Choice of the operator that answers for contact conditions in least time: a dense matrix of all of them, the tree
//! of fronts, or iterations between clusters.
//!
//! The constants are fitted to the times of two blocks of tetrahedra in contact, with 50 thousand to a million dofs, and of
//! pins in plates with friction: they say which is faster there, and about where one becomes the other elsewhere.

use std::collections::BTreeMap;

use super::cost::ACTIVE_SETS;
use super::tree::Tree;
use crate::id::TreeNodeId;
use crate::problem::Catalog;

/// Flops that the dense contact problem takes, over the cube of its size: it is condensed some nine times onto what touches.
const AT_ONCE: f64 = 3.0;
/// Times that what is above contacts takes with friction, over those without: each of some 20 steps of Newton's method
/// eliminates it again, and solves for slip forces by up to 40 products. Fitted roughly to one pin in a plate (1878 conditions,
/// 20 thousand dofs), which took 6.8 s of CPU in the tree and 1.2 s with the dense matrix.
const WITH_FRICTION: f64 = 4.0;
/// Contact conditions up to which they are solved for at once, whatever that takes: that is more robust where bodies
/// are held by next to nothing.
const FEW_CONDITIONS: usize = 600;
/// Contact conditions with friction up to which they are solved for at once: active sets that come back find a way
/// out there alone.
const FEW_WITH_FRICTION: usize = 3000;
/// Iterations that an active set takes in all, about.
const ITERATIONS: f64 = 60.0;
/// Flops that an entry of S of a cluster takes in an iteration: it and its factor are read from memory.
const PER_ENTRY: f64 = 24.0;
/// Flops of the part of a cluster in the preconditioner, over the cube of its size.
const PER_CUBE: f64 = 0.3;
/// Flops that the coarse problem takes, over the square of its size, in space.
const PER_COARSE_PAIR: f64 = 12.0;

/// Estimated flops that a cluster with so many unknowns on its boundary takes where iterations run between clusters.
pub fn iteration_flops(size: f64) -> f64 {
    PER_CUBE * size.powi(3) + ITERATIONS * PER_ENTRY * size * size
}

/// Estimated number of coarse unknowns between the clusters of a tree: of the nodes that the same clusters share, their
/// rigid motions.
pub fn coarse_dofs(tree: &Tree, dim: usize) -> usize {
    let mut clusters: BTreeMap<u32, Vec<TreeNodeId>> = BTreeMap::new();
    for &c in &tree.clusters {
        for &node in &tree.nodes[c].kept {
            clusters.entry(node).or_default().push(c);
        }
    }
    let mut classes: BTreeMap<Vec<TreeNodeId>, usize> = BTreeMap::new();
    for of_node in clusters.into_values().filter(|list| list.len() > 1) {
        *classes.entry(of_node).or_default() += 1;
    }
    let motions = dim * (dim + 1) / 2;
    let of_class = classes.into_values().map(|nodes| motions.min(dim * nodes));
    of_class.sum()
}

/// The operator for given statuses of contact conditions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// A dense matrix of all conditions.
    Dense,
    /// Fronts up to the roots of the hierarchy, those above changed statuses eliminated again.
    Tree,
    /// Fronts up to clusters, and iterations between these.
    Clusters,
}

/// The operators that are known to solve a problem, by estimated times: arithmetic, and what goes with it, in flops.
#[derive(Clone, Debug, PartialEq)]
pub struct OperatorTimes {
    /// Each with its time, the fastest first.
    pub all: Vec<(Operator, f64)>,
    /// The time of the coarse problem, a part of that of iterations.
    pub coarse: f64,
    /// The choice that is left for want of memory.
    last_resort: Option<Operator>,
    /// Reasons for which other operators are left out.
    left_out: Vec<String>,
    /// Number of contact conditions, tangential ones among them.
    conditions: usize,
}

impl OperatorTimes {
    /// The times of a problem. Few conditions have a dense matrix; iterations are for scenes in space without friction whose
    /// contact is node by node and whose clusters are known.
    ///
    /// With friction or mortar iterations are left out, because conditions tie many unknowns of several clusters to each
    /// other there: on 2 ranks they took 5 to 7 times as long as the dense matrix on two boxes of 28 thousand dofs, and
    /// didn't converge in 209 s on a pin in a plate of 20 thousand dofs, which the dense matrix solved in 9 s.
    pub fn new(catalog: &Catalog) -> Self {
        let (tree, dim) = (Tree::new(catalog), catalog.dim);
        let has_friction = catalog.has_friction();
        let conditions: usize = tree.roots().map(|root| tree.nodes[root].conditions).sum();
        let few = if has_friction {
            FEW_WITH_FRICTION
        } else {
            FEW_CONDITIONS
        };
        let sum = |has_active_set| {
            let nodes = tree.nodes.ids();
            nodes
                .map(|v| tree.time(v, dim, has_active_set))
                .sum::<f64>()
        };
        let cubes = tree
            .roots()
            .map(|v| (tree.nodes[v].conditions as f64).powi(3));
        let mut times = Self {
            all: vec![(Operator::Dense, sum(false) + AT_ONCE * cubes.sum::<f64>())],
            coarse: 0.0,
            last_resort: None,
            left_out: Vec::new(),
            conditions,
        };
        if conditions > few {
            let again = if has_friction { WITH_FRICTION } else { 1.0 };
            let above = (tree.nodes.ids().skip(tree.subdomains))
                .filter(|&v| tree.nodes[v].conditions > 0)
                .map(|v| tree.time(v, dim, true));
            let time = sum(true) + (again - 1.0) * above.sum::<f64>();
            times.all.push((Operator::Tree, time));
        } else if conditions > 0 {
            let with = if has_friction { " with friction" } else { "" };
            let why = format!(
                "up to {few} conditions{with} have a dense matrix because that is most robust"
            );
            times.left_out.push(why);
        }
        let mut in_contact = catalog.points.iter().filter(|point| !point.law.is_tied());
        let is_node_by_node = in_contact.all(|point| point.entries.len() <= 2);
        let why_not = match catalog.hierarchy.clusters.len() {
            _ if dim == 2 => Some("iterations pay in space alone"),
            0 | 1 => Some("there are no clusters to iterate between"),
            _ if has_friction => Some("iterations take longer with friction or don't converge"),
            _ if !is_node_by_node => Some("iterations take longer with mortar"),
            _ => None,
        };
        match why_not {
            Some(why) => {
                let can_be = dim == 3 && catalog.hierarchy.clusters.len() > 1;
                times.last_resort = can_be.then_some(Operator::Clusters);
                times.left_out.push(why.to_owned());
            }
            None => times.add_iterations(&tree, dim),
        }
        times.all.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        times
    }

    fn add_iterations(&mut self, tree: &Tree, dim: usize) {
        let of_cluster = |&c: &TreeNodeId| {
            let below = tree.subtree(c).into_iter();
            let below: f64 = below.map(|v| tree.time(v, dim, true)).sum();
            below + iteration_flops(tree.nodes[c].dofs[1] as f64)
        };
        let clusters: f64 = tree.clusters.iter().map(of_cluster).sum();
        self.coarse = ACTIVE_SETS * PER_COARSE_PAIR * (coarse_dofs(tree, dim) as f64).powi(2);
        self.all.push((Operator::Clusters, clusters + self.coarse));
    }

    /// The fastest operator.
    pub fn fastest(&self) -> Operator {
        self.all
            .first()
            .map_or(Operator::Dense, |(operator, _)| *operator)
    }

    /// All operators, the fastest first; iterations that aren't known to get there as fast last, as they take least memory.
    pub fn operators(&self) -> impl Iterator<Item = Operator> + '_ {
        let known = self.all.iter().map(|(operator, _)| *operator);
        known.chain(self.last_resort)
    }

    /// The operators but iterations, the fastest first.
    pub fn direct(&self) -> impl Iterator<Item = Operator> + '_ {
        let all = self.all.iter().map(|(operator, _)| *operator);
        all.filter(|operator| *operator != Operator::Clusters)
    }

    /// The name of an operator in words.
    pub fn name(&self, operator: Operator) -> String {
        match (operator, self.conditions) {
            (Operator::Dense, 0) => "factors up to the roots".into(),
            (Operator::Dense, count) => format!("a dense matrix of {count} conditions"),
            (Operator::Tree, _) => "fixed active sets in the tree of fronts".into(),
            (Operator::Clusters, _) => "iterations between clusters".into(),
        }
    }

    /// Reason for `chosen` in words: its time against those of others, and why others are left out.
    pub fn reason(&self, chosen: Operator) -> String {
        let (own, others): (Vec<_>, Vec<_>) = self
            .all
            .iter()
            .partition(|(operator, _)| *operator == chosen);
        let own: Vec<String> = own
            .iter()
            .map(|(_, time)| format!(": {time:.1e} flops"))
            .collect();
        let others: Vec<String> = (others.iter())
            .map(|(operator, time)| format!("{time:.1e} for {}", self.name(*operator)))
            .collect();
        let against = match others.is_empty() {
            true => String::new(),
            false => format!(" against {}", others.join(" and ")),
        };
        let left_out: String = self.left_out.iter().map(|why| format!("; {why}")).collect();
        format!("{}{}{against}{left_out}", self.name(chosen), own.concat())
    }
}
