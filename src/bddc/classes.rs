//! The classes of Γ: unknowns that the same clusters share, such as vertices and edges of the clusters.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use contact_dd_partition::disjoint_sets::DisjointSets;
use contact_dd_partition::hierarchy::tree::Tree;
use contact_dd_partition::id::{MergeRootId, TreeNodeId};
use contact_dd_partition::numbered::Numbered;
use faer::Mat;
use faer::linalg::solvers::Solve;

use crate::bddc::closed::Ties;
use crate::bddc::cluster_unknowns::ClusterUnknowns;
use crate::schur::condensed::InterfaceDof;

/// Most unknowns of a class that is coarse as a whole.
const SMALL: usize = 4;
/// Length, relative to a unit vector, below which it is round-off.
const ROUND_OFF: f64 = 1e-12;

/// Unknowns that the same clusters share.
#[derive(Clone, Debug, PartialEq)]
pub struct Class {
    /// The clusters, ascending.
    pub clusters: Vec<MergeRootId>,
    /// The unknowns, ascending.
    pub dofs: Vec<InterfaceDof>,
    /// True if one of the clusters has only some combinations of the unknowns.
    is_partial: bool,
    /// True if a closed contact constraint interpolates between some of the unknowns, as mortar does: it may hold one of
    /// the clusters hardly or in no direction of its own, so that clusters can't be solved independently there.
    is_interpolated: bool,
    /// New unknowns of the class if one of its two clusters has only some combinations.
    pub turned: Option<Arc<Turned>>,
}

/// Combinations of the unknowns of a class of two clusters: those that both have, then those that one of them has.
///
/// They occur under closed contact constraints: with its own displacements replaced by another cluster's, a cluster has
/// only as many combinations of these as it has conditions.
#[derive(Debug)]
pub struct Turned {
    /// The new unknowns, a column each.
    pub q: Mat<f64>,
    /// Bounds of the unknowns of both clusters, of the first and of the second.
    pub ends: [usize; 4],
}

impl PartialEq for Turned {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other) || self.ends == other.ends && self.q == other.q
    }
}

impl Class {
    /// Number of unknowns that all of its clusters share.
    pub fn size(&self) -> usize {
        (self.turned.as_ref()).map_or(self.dofs.len(), |turned| turned.ends[1])
    }

    /// The combinations that both of its clusters share, for `values` of its unknowns.
    pub fn turn(&self, values: Vec<f64>) -> Vec<f64> {
        let Some(turned) = &self.turned else {
            return values;
        };
        let values = Mat::from_fn(values.len(), 1, |i, _| values[i]);
        let combinations = turned.q.partial_piv_lu().solve(values);
        (0..turned.ends[1]).map(|j| combinations[(j, 0)]).collect()
    }

    /// True if all of its unknowns are coarse, like a vertex's.
    pub fn is_coarse(&self) -> bool {
        let is_independent = !self.is_interpolated && (!self.is_partial || self.turned.is_some());
        !is_independent || self.size() <= SMALL
    }
}

/// All classes.
#[derive(Clone, Debug, Default)]
pub struct Classes {
    /// The classes of several clusters, in ascending order of these.
    pub list: Vec<Class>,
    /// Numbers of the classes of every cluster, ascending.
    pub of_clusters: Numbered<MergeRootId, Vec<usize>>,
    /// Unknowns of each cluster alone.
    pub own: Numbered<MergeRootId, Vec<InterfaceDof>>,
}

impl Classes {
    /// The index of a class, if it is among these.
    pub fn place_of(&self, class: &Class) -> Option<usize> {
        let at = (self.list).binary_search_by(|other| other.clusters.cmp(&class.clusters));
        at.ok().filter(|&k| self.list[k] == *class)
    }

    /// The class with the same clusters and unknowns, none of which were `retied` since.
    fn as_before(&self, class: &Class, retied: &BTreeSet<InterfaceDof>) -> Option<&Class> {
        let at = (self.list).binary_search_by(|other| other.clusters.cmp(&class.clusters));
        let same = &self.list[at.ok()?];
        let is_same = same.dofs == class.dofs && same.is_partial == class.is_partial;
        (is_same && !class.dofs.iter().any(|dof| retied.contains(dof))).then_some(same)
    }

    /// True if cluster c has the same unknowns in the same classes as in `others`.
    pub fn are_as_in(&self, others: &Self, c: MergeRootId) -> bool {
        let (Some(own), Some(list)) = (others.own.get(c), others.of_clusters.get(c)) else {
            return false;
        };
        let mut pairs = self.of_clusters[c].iter().zip(list);
        *own == self.own[c]
            && list.len() == self.of_clusters[c].len()
            && pairs.all(|(&k, &other)| self.list[k] == others.list[other])
    }

    /// The lowest node above all clusters of each class, where the `nodes` of a tree are the clusters'.
    pub fn homes(&self, tree: &Tree, nodes: &Numbered<MergeRootId, TreeNodeId>) -> Vec<TreeNodeId> {
        let home = |class: &Class| {
            let first = nodes[class.clusters[0]];
            let clusters = class.clusters.iter().map(|&c| nodes[c]);
            clusters.fold(first, |v, w| tree.lowest_above(v, w))
        };
        self.list.iter().map(home).collect()
    }

    /// The classes of clusters that have these unknowns, with closed contact constraints that tie some to others; classes
    /// `before` some unknowns were `retied` keep the combinations of theirs that aren't among those.
    pub fn new(
        unknowns: &ClusterUnknowns,
        ties: &Ties,
        (before, retied): (&Self, &BTreeSet<InterfaceDof>),
    ) -> Self {
        let dofs = &unknowns.dofs;
        let (of, partial) = unknowns.by_clusters_under(ties);
        let mut classes = Self {
            list: Vec::new(),
            of_clusters: dofs.like(Vec::new()),
            own: dofs.like(Vec::new()),
        };
        let interpolated = ties.interpolated();
        let tied = unknowns.tied(ties);
        for (clusters, of_class) in of {
            if let [cluster] = clusters[..] {
                classes.own[cluster] = of_class;
                continue;
            }
            for &c in &clusters {
                classes.of_clusters[c].push(classes.list.len());
            }
            let mut class = Class {
                is_partial: partial.contains(&clusters),
                is_interpolated: of_class.iter().any(|dof| interpolated.contains(dof)),
                clusters,
                dofs: of_class,
                turned: None,
            };
            if class.is_partial && class.size() > SMALL {
                class.turned = match before.as_before(&class, retied) {
                    Some(same) => same.turned.clone(),
                    None => turned(&class, unknowns, &tied, ties).map(Arc::new),
                };
            }
            classes.list.push(class);
        }
        classes
    }
}

/// The combinations of the unknowns of a class with two clusters, one of which lacks some; `None` for more than two
/// clusters and for combinations that neither has. `tied` are the unknowns of each cluster that are tied, ascending.
fn turned(
    class: &Class,
    unknowns: &ClusterUnknowns,
    tied: &Numbered<MergeRootId, Vec<InterfaceDof>>,
    ties: &Ties,
) -> Option<Turned> {
    let [a, b] = class.clusters[..] else {
        return None;
    };
    // The combinations of each, in terms of the class.
    let n = class.dofs.len();
    let row = |dof: &InterfaceDof| -> Vec<(usize, f64)> {
        let place = |dof: &InterfaceDof| class.dofs.binary_search(dof).ok();
        let terms = ties.terms(dof).into_iter();
        terms
            .filter_map(|(dof, c)| Some((place(&dof)?, c)))
            .collect()
    };
    let rows = [a, b].map(|c| {
        let of_class =
            (class.dofs.iter()).filter(|dof| unknowns.dofs[c].binary_search(dof).is_ok());
        let mut of_cluster: Vec<&InterfaceDof> = of_class.chain(&tied[c]).collect();
        of_cluster.sort_unstable();
        of_cluster.dedup();
        let rows = of_cluster.into_iter().map(row);
        rows.filter(|row| !row.is_empty()).collect::<Vec<_>>()
    });
    let (set_of, members) = linked(n, rows.iter().flatten());
    let by_set = rows.each_ref().map(|rows| {
        let mut by_set: BTreeMap<u32, Vec<&Vec<(usize, f64)>>> = BTreeMap::new();
        for row in rows {
            by_set.entry(set_of[row[0].0]).or_default().push(row);
        }
        by_set
    });
    let mut columns: [Vec<Vec<f64>>; 3] = [const { Vec::new() }; 3];
    for (set, members) in members {
        let k = members.len();
        let place = |i: usize| members.binary_search(&i).unwrap_or_default();
        let [not_a, not_b] = by_set.each_ref().map(|by_set| {
            let of_set = by_set.get(&set).map_or(&[][..], Vec::as_slice);
            let mut all = Mat::<f64>::zeros(k, of_set.len());
            for (j, row) in of_set.iter().enumerate() {
                row.iter().for_each(|&(i, c)| all[(place(i), j)] += c);
            }
            complement(&all)
        });
        let alone = Mat::from_fn(k, not_a.ncols() + not_b.ncols(), |i, j| {
            match j.checked_sub(not_b.ncols()) {
                Some(j) => not_a[(i, j)],
                None => not_b[(i, j)],
            }
        });
        for (columns, part) in columns.iter_mut().zip([complement(&alone), not_b, not_a]) {
            for column in part.col_iter() {
                let mut of_class = vec![0.0; n];
                let values = members.iter().zip(column.iter());
                values.for_each(|(&at, value)| of_class[at] = *value);
                columns.push(of_class);
            }
        }
    }
    let [both, first, second] = columns.each_ref().map(Vec::len);
    let columns = columns.concat();
    (columns.len() == n).then(|| Turned {
        q: Mat::from_fn(n, n, |i, j| columns[j][i]),
        ends: [0, both, both + first, both + first + second],
    })
}

/// The set of each of n unknowns among the sets that rows connect, and the members of each set.
fn linked<'a>(
    n: usize,
    rows: impl Iterator<Item = &'a Vec<(usize, f64)>>,
) -> (Vec<u32>, BTreeMap<u32, Vec<usize>>) {
    let mut linked = DisjointSets::new(n);
    for pair in rows.flat_map(|row| row.windows(2)) {
        linked.unite(pair[0].0 as u32, pair[1].0 as u32);
    }
    let set_of: Vec<u32> = (0..n).map(|i| linked.find(i as u32)).collect();
    let mut members: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (i, &set) in set_of.iter().enumerate() {
        members.entry(set).or_default().push(i);
    }
    (set_of, members)
}

/// An orthonormal basis of the orthogonal complement of a matrix's columns.
fn complement(a: &Mat<f64>) -> Mat<f64> {
    if a.ncols() == 0 {
        return Mat::identity(a.nrows(), a.nrows());
    }
    let qr = a.col_piv_qr();
    let r = qr.R();
    let largest = r[(0, 0)].abs();
    let diagonal = 0..r.nrows().min(r.ncols());
    let independent = diagonal.filter(|&i| r[(i, i)].abs() > ROUND_OFF * largest);
    let rank = independent.count();
    qr.compute_Q().subcols(rank, a.nrows() - rank).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dof(node: u32) -> InterfaceDof {
        InterfaceDof { node, axis: 0 }
    }

    /// The classes of two clusters, with ten nodes each, after the nodes of the first are tied to these of the second.
    fn tied(to: impl Fn(u32) -> Vec<(InterfaceDof, f64)>) -> Classes {
        let of_cluster = |c: u32| (10 * c..10 * (c + 1)).map(dof).collect();
        let unknowns = ClusterUnknowns::new((0..2).map(of_cluster).collect());
        let ties = (0..8).map(|node| (dof(node), to(node))).collect();
        let ties = Ties::join(vec![Ties::new(ties)]);
        Classes::new(&unknowns, &ties, (&Classes::default(), &BTreeSet::new()))
    }

    #[test]
    fn only_classes_with_other_ties_get_other_combinations() {
        let of_cluster = |c: u32| (20 * c..20 * (c + 1)).map(dof).collect();
        let unknowns = ClusterUnknowns::new((0..3).map(of_cluster).collect());
        let between = |first: u32, to: u32, count: u32| {
            (0..count).map(move |i| {
                let terms = vec![(dof(to + i), 0.5), (dof(to + i + 1), 0.5)];
                (dof(first + i), terms)
            })
        };
        let ties = |count| {
            let direct = between(0, 20, 7).chain(between(40, 30, count));
            Ties::join(vec![Ties::new(direct.collect())])
        };
        let none = Classes::default();
        let before = Classes::new(&unknowns, &ties(7), (&none, &BTreeSet::new()));
        let retied = [36, 37, 46].map(dof).into();
        let after = Classes::new(&unknowns, &ties(6), (&before, &retied));
        let anew = Classes::new(&unknowns, &ties(6), (&none, &BTreeSet::new()));
        assert_eq!(after.list, anew.list);
        let turned = |classes: &Classes| {
            let turned = classes.list.iter().filter_map(|class| class.turned.clone());
            turned.collect::<Vec<_>>()
        };
        let (before, after) = (turned(&before), turned(&after));
        assert_eq!((before.len(), after.len()), (2, 2));
        assert!(Arc::ptr_eq(&before[0], &after[0]));
        assert_ne!(before[1], after[1]);
    }

    #[test]
    fn what_contact_constraints_interpolate_is_coarse() {
        let of_nodes = tied(|node| vec![(dof(node + 10), 1.0)]);
        assert!(of_nodes.list.iter().all(|class| !class.is_coarse()));
        let of_mortar = tied(|node| vec![(dof(node + 10), 0.5), (dof(node + 11), 0.5)]);
        assert_eq!(of_mortar.list[0].dofs.len(), 9);
        assert!(of_mortar.list.iter().all(Class::is_coarse));
    }
}
