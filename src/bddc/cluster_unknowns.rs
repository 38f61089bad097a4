//! The unknowns of all clusters, by the clusters that have them.

use std::collections::{BTreeMap, BTreeSet};

use contact_dd_partition::id::MergeRootId;
use contact_dd_partition::numbered::Numbered;

use crate::bddc::closed::Ties;
use crate::schur::condensed::InterfaceDof;

/// Unknowns, ascending, by the clusters that have them.
type ByClusters = BTreeMap<Vec<MergeRootId>, Vec<InterfaceDof>>;

/// The unknowns of all clusters, on every rank; sorted once, as active sets change the clusters of few of them.
#[derive(Debug)]
pub struct ClusterUnknowns {
    /// The unknowns of every cluster, ascending.
    pub dofs: Numbered<MergeRootId, Vec<InterfaceDof>>,
    /// Every unknown with every cluster that has it, ascending.
    ends: Vec<(InterfaceDof, MergeRootId)>,
    /// The unknowns by their clusters, without ties.
    by_clusters: ByClusters,
}

impl ClusterUnknowns {
    /// The unknowns of clusters that have these `dofs`.
    pub fn new(dofs: Numbered<MergeRootId, Vec<InterfaceDof>>) -> Self {
        let of_cluster = |(c, list): (MergeRootId, &Vec<InterfaceDof>)| {
            let ends: Vec<_> = list.iter().map(|&dof| (dof, c)).collect();
            ends
        };
        let mut ends: Vec<(InterfaceDof, MergeRootId)> = dofs.each().flat_map(of_cluster).collect();
        ends.sort_unstable();
        let mut by_clusters = ByClusters::new();
        for of_dof in ends.chunk_by(|a, b| a.0 == b.0) {
            let clusters = of_dof.iter().map(|&(_, c)| c).collect();
            by_clusters.entry(clusters).or_default().push(of_dof[0].0);
        }
        Self {
            dofs,
            ends,
            by_clusters,
        }
    }

    /// The clusters that have an unknown, ascending.
    pub fn clusters_of(&self, dof: InterfaceDof) -> impl Iterator<Item = MergeRootId> + '_ {
        let first = self.ends.partition_point(|end| end.0 < dof);
        let of_dof = self.ends[first..]
            .iter()
            .take_while(move |end| end.0 == dof);
        of_dof.map(|&(_, c)| c)
    }

    /// The unknowns of every cluster that are tied, ascending.
    pub fn tied(&self, ties: &Ties) -> Numbered<MergeRootId, Vec<InterfaceDof>> {
        let mut tied = self.dofs.like(Vec::new());
        for (&dof, _) in ties.tied() {
            (self.clusters_of(dof)).for_each(|c| tied[c].push(dof));
        }
        tied
    }

    /// The unknowns that are left where `ties` put others in the place of some, by the clusters that have them then; and the
    /// clusters of unknowns that one of them had not before.
    pub fn by_clusters_under(&self, ties: &Ties) -> (ByClusters, BTreeSet<Vec<MergeRootId>>) {
        let mut after: BTreeMap<InterfaceDof, BTreeSet<MergeRootId>> = BTreeMap::new();
        for (&dof, terms) in ties.tied() {
            after.entry(dof).or_default();
            for &(staying, _) in terms {
                let clusters =
                    after
                        .entry(staying)
                        .or_insert_with(|| match ties.terms_of(&staying) {
                            Some(_) => BTreeSet::new(),
                            None => self.clusters_of(staying).collect(),
                        });
                clusters.extend(self.clusters_of(dof));
            }
        }
        let (mut all, mut partial) = (self.by_clusters.clone(), BTreeSet::new());
        let mut changed: BTreeSet<Vec<MergeRootId>> = BTreeSet::new();
        for (&dof, clusters) in &after {
            let before: Vec<MergeRootId> = self.clusters_of(dof).collect();
            if clusters.iter().eq(&before) {
                continue;
            }
            if let Some(of_class) = all.get_mut(&before) {
                of_class.retain(|other| *other != dof);
                changed.insert(before.clone());
            }
            let clusters: Vec<MergeRootId> = clusters.iter().copied().collect();
            if clusters.is_empty() {
                continue;
            }
            if clusters.iter().any(|c| before.binary_search(c).is_err()) {
                partial.insert(clusters.clone());
            }
            all.entry(clusters.clone()).or_default().push(dof);
            changed.insert(clusters);
        }
        for clusters in changed {
            let of_class = all.entry(clusters.clone()).or_default();
            of_class.sort_unstable();
            if of_class.is_empty() {
                all.remove(&clusters);
            }
        }
        (all, partial)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dof(node: u32) -> InterfaceDof {
        InterfaceDof { node, axis: 0 }
    }

    /// All unknowns under `ties`, each with its clusters, sorted anew.
    fn sorted_anew(unknowns: &ClusterUnknowns, ties: &Ties) -> ByClusters {
        let mut clusters: BTreeMap<InterfaceDof, BTreeSet<MergeRootId>> = BTreeMap::new();
        for (c, list) in unknowns.dofs.each() {
            for &dof in list {
                for (dof, _) in ties.terms(&dof) {
                    clusters.entry(dof).or_default().insert(c);
                }
            }
        }
        let mut all = ByClusters::new();
        for (dof, clusters) in clusters {
            let clusters = clusters.into_iter().collect();
            all.entry(clusters).or_default().push(dof);
        }
        all
    }

    #[test]
    fn few_ties_leave_what_sorting_all_unknowns_anew_does() {
        let list = |c: u32| (3 * c..3 * c + 6).map(dof).collect();
        let unknowns = ClusterUnknowns::new((0..5).map(list).collect());
        let ties: [&[(u32, &[u32])]; 8] = [
            &[],
            &[(4, &[0, 1])],
            &[(4, &[9, 7]), (10, &[7])],
            &[(0, &[1])],
            &[(3, &[4])],
            // What stays is tied by a group above, and in no cluster.
            &[(3, &[5]), (5, &[12])],
            &[(2, &[40])],
            &[(3, &[]), (9, &[16]), (10, &[16]), (11, &[16])],
        ];
        for direct in ties {
            let terms = |staying: &[u32]| staying.iter().map(|&at| (dof(at), 0.5)).collect();
            let direct = direct
                .iter()
                .map(|&(tied, staying)| (dof(tied), terms(staying)));
            let ties = Ties::join(vec![Ties::new(direct.collect())]);
            let (all, partial) = unknowns.by_clusters_under(&ties);
            assert_eq!(all, sorted_anew(&unknowns, &ties));
            for (clusters, of_class) in &all {
                let has = |c: &MergeRootId, at| unknowns.dofs[*c].contains(at);
                let whole = of_class
                    .iter()
                    .all(|at| clusters.iter().all(|c| has(c, at)));
                assert_eq!(partial.contains(clusters), !whole, "{clusters:?}");
            }
        }
    }
}
