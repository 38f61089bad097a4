//! Choice of the operator that solves for given contact statuses in the least time: a dense matrix of all contact
//! constraints, the tree of fronts, or iterations between clusters.
//!
//! The constants are fitted to the times of two blocks of tetrahedra in contact, with 50 thousand to a million dofs,
//! and of pins in plates with friction: there they predict the faster operator, elsewhere roughly the size at which
//! another one becomes faster.

use std::collections::BTreeMap;

use super::cost::ACTIVE_SETS;
use super::tree::Tree;
use crate::id::TreeNodeId;
use crate::problem::Catalog;

/// Flops of the dense contact problem over the cube of its size: it is condensed onto the closed contacts some nine
/// times.
const AT_ONCE: f64 = 3.0;
/// Ratio of the time for the fronts above contacts with friction to that without: each of some 20 steps of Newton's
/// method eliminates them again, and solves for slip forces by up to 40 products. Fitted roughly to one pin in a plate
/// (1878 constraints, 20 thousand dofs), which took 6.8 s of CPU in the tree and 1.2 s with the dense matrix.
const WITH_FRICTION: f64 = 4.0;
/// Ratio of the time of iterations with friction to that without. Two boxes of 183 thousand dofs with 4563 constraints take
/// 6.6 s for factors and sweeps, 3.6 s without friction and 11 s with the dense matrix, a ratio of 1.8; it is more because
/// bodies that friction alone holds take more steps.
const ITERATIONS_WITH_FRICTION: f64 = 2.5;
/// Ratio of the time of iterations with mortar to that node by node, and the same with friction. Fitted to two boxes that
/// don't match, of 188 and 609 thousand dofs, 7.7 and 37 s on two ranks where the dense matrix takes 10.7 and 84 s, and to a
/// pin in a plate with 600 thousand, 53 s instead of 111 s; with 80 thousand it takes 5.3 s instead of 2.0 s. With friction
/// boxes take 21 and 106 s instead of 32 and 252 s, but a pin that contact alone holds took ten times as long as with the
/// dense matrix.
const ITERATIONS_WITH_MORTAR: [f64; 2] = [1.5, 5.5];
/// Number of contact constraints up to which the dense matrix is used whatever its cost: it is more robust where bodies
/// are hardly held.
const FEW_CONDITIONS: usize = 600;
/// Number of contact constraints with friction up to which the dense matrix is used: only this operator escapes from
/// active sets that recur.
const FEW_WITH_FRICTION: usize = 3000;
/// Approximate number of iterations for an active set in total.
const ITERATIONS: f64 = 60.0;
/// Flops of an iteration for each entry of a cluster's S: the entry and its factor are read from memory, in the time of this
/// much arithmetic with wide vectors. Fitted to two boxes of 49, 96 and 183 thousand dofs, for which iterations take 2.2, 1.5
/// and 1.1 times as long as the dense matrix.
const PER_ENTRY: f64 = 44.0;
/// Flops of a cluster's part of the preconditioner, over the cube of the cluster's size.
const PER_CUBE: f64 = 0.3;
/// Flops of the coarse problem, over the square of its size, in space.
const PER_COARSE_PAIR: f64 = 12.0;

/// Ratio λ/μ of Lamé's constants at which iterations take twice as long as in compressible cells, and the largest ratio of
/// times. Fitted to two boxes of 212 thousand dofs: 9.0 s with Poisson's ratio 0.45, 11.7 s with 0.49, 29.9 s with 0.499,
/// where the dense matrix takes 12.3 s.
const TWICE_AS_LONG: f64 = 220.0;
const MOST_BY_INCOMPRESSIBILITY: f64 = 5.0;

/// Ratio of the time of iterations with these Poisson's ratios of materials to that in compressible cells.
fn by_incompressibility(poisson: impl Iterator<Item = f64>) -> f64 {
    let of_lame = |nu: f64| 2.0 * nu / (1.0 - 2.0 * nu);
    let largest = poisson.map(of_lame).fold(0.0, f64::max);
    (1.0 + largest / TWICE_AS_LONG).min(MOST_BY_INCOMPRESSIBILITY)
}

/// Estimated flops, with iterations between clusters, of a cluster with `size` unknowns on its boundary.
pub fn iteration_flops(size: f64) -> f64 {
    PER_CUBE * size.powi(3) + ITERATIONS * PER_ENTRY * size * size
}

/// Estimated number of coarse unknowns between the clusters of a tree: the rigid motions of each class of nodes shared
/// by the same clusters.
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

/// The operator that solves for given statuses of contact constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// A dense matrix of all contact constraints.
    Dense,
    /// Fronts up to the roots of the hierarchy; those above changed statuses are eliminated again.
    Tree,
    /// Fronts up to clusters, and iterations between clusters.
    Clusters,
}

/// The operators that are known to solve a problem, with estimated times, in flops: arithmetic and its overhead.
#[derive(Clone, Debug, PartialEq)]
pub struct OperatorTimes {
    /// Operators with their times, the fastest first.
    pub all: Vec<(Operator, f64)>,
    /// The part of the iterations' time that the coarse problem takes.
    pub coarse: f64,
    /// The operator that is used only if memory is short.
    last_resort: Option<Operator>,
    /// Reasons for excluding the other operators.
    left_out: Vec<String>,
    /// Number of contact constraints, tangential ones included.
    conditions: usize,
}

impl OperatorTimes {
    /// The times of a problem, merged along this `tree`. The dense matrix is for few constraints; iterations are for
    /// scenes in space with known clusters and many constraints if there is friction or mortar.
    pub fn new(catalog: &Catalog, tree: &Tree) -> Self {
        let dim = catalog.dim;
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
        let has_mortar = in_contact.any(|point| point.entries.len() > 2);
        let why_not = match catalog.hierarchy.clusters.len() {
            _ if dim == 2 => Some("iterations pay in space alone"),
            0 | 1 => Some("there are no clusters to iterate between"),
            _ if has_friction && conditions <= few => Some("iterations take longer with friction"),
            _ if has_mortar && conditions <= few => Some("iterations take longer with mortar"),
            _ => None,
        };
        match why_not {
            Some(why) => {
                let can_be = dim == 3 && catalog.hierarchy.clusters.len() > 1;
                times.last_resort = can_be.then_some(Operator::Clusters);
                times.left_out.push(why.to_owned());
            }
            None => times.add_iterations(tree, catalog, has_mortar),
        }
        times.all.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        times
    }

    fn add_iterations(&mut self, tree: &Tree, catalog: &Catalog, has_mortar: bool) {
        let dim = catalog.dim;
        let has_friction = catalog.has_friction();
        let mut again = if has_friction {
            ITERATIONS_WITH_FRICTION
        } else {
            1.0
        };
        if has_mortar {
            again *= ITERATIONS_WITH_MORTAR[usize::from(has_friction)];
        }
        again *= by_incompressibility(catalog.materials.iter().filter_map(|of| of.poisson));
        let of_cluster = |&c: &TreeNodeId| {
            let below = tree.subtree(c).into_iter();
            let below: f64 = below.map(|v| tree.time(v, dim, true)).sum();
            below + iteration_flops(tree.nodes[c].dofs[1] as f64)
        };
        let clusters: f64 = tree.clusters.iter().map(of_cluster).sum();
        self.coarse = ACTIVE_SETS * PER_COARSE_PAIR * (coarse_dofs(tree, dim) as f64).powi(2);
        let time = again * (clusters + self.coarse);
        self.all.push((Operator::Clusters, time));
    }

    /// The fastest operator.
    pub fn fastest(&self) -> Operator {
        self.all
            .first()
            .map_or(Operator::Dense, |(operator, _)| *operator)
    }

    /// All operators, the fastest first; iterations with unknown convergence come last, as they take the least memory.
    pub fn operators(&self) -> impl Iterator<Item = Operator> + '_ {
        let known = self.all.iter().map(|(operator, _)| *operator);
        known.chain(self.last_resort)
    }

    /// All operators except iterations, the fastest first.
    pub fn direct(&self) -> impl Iterator<Item = Operator> + '_ {
        let all = self.all.iter().map(|(operator, _)| *operator);
        all.filter(|operator| *operator != Operator::Clusters)
    }

    /// The name of an operator in plain words.
    pub fn name(&self, operator: Operator) -> String {
        match (operator, self.conditions) {
            (Operator::Dense, 0) => "factors up to the roots".into(),
            (Operator::Dense, count) => format!("a dense matrix of {count} conditions"),
            (Operator::Tree, _) => "fixed active sets in the tree of fronts".into(),
            (Operator::Clusters, _) => "iterations between clusters".into(),
        }
    }

    /// Reason for `chosen` in plain words: its time compared with that of others, and why others are excluded.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn iterations_take_longer_in_nearly_incompressible_cells() {
        let measured = [(0.3, 1.0), (0.45, 1.0), (0.49, 1.3), (0.499, 3.3)];
        for (nu, expected) in measured {
            let ratio = by_incompressibility([0.2, nu].into_iter());
            assert!((ratio / expected - 1.0).abs() < 0.1, "{nu}: {ratio}");
        }
        assert_eq!(by_incompressibility([0.499_999].into_iter()), 5.0);
        assert_eq!(by_incompressibility(std::iter::empty()), 1.0);
    }
}
