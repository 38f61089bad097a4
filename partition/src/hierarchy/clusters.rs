//! Clusters: the subtrees of the hierarchy between which an iterative interface solver works.
//!
//! They follow from sizes only, never from the number of ranks.

use crate::problem::Catalog;

/// Largest number of dofs of a cluster where the user gives no number of clusters.
const DOFS: usize = 24_000;
/// The same bound in space, where a cluster shares a larger part of its unknowns with others.
const DOFS_IN_SPACE: usize = 5_000;

impl Catalog {
    /// Chooses the clusters: starting with the roots, splits the largest one until there are `count`, or, without
    /// `count`, until none that can be split exceeds the bound. None of several has friction inside, as slip forces
    /// between clusters are found together with what these share.
    pub fn choose_clusters(&mut self, count: Option<usize>) {
        let parents = &self.hierarchy.parent;
        let mut dofs = vec![0; parents.len()];
        for (dofs, subdomain) in dofs.iter_mut().zip(&self.subdomains) {
            *dofs = self.dim * subdomain.nodes;
        }
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); parents.len()];
        for (v, parent) in parents.iter().enumerate() {
            if let Some(parent) = parent.map(|parent| parent as usize) {
                dofs[parent] += dofs[v];
                children[parent].push(v);
            }
        }
        let has_friction = self.subtrees_with_friction();
        let most = if self.dim == 3 { DOFS_IN_SPACE } else { DOFS };
        let roots = (0..parents.len()).filter(|&v| parents[v].is_none());
        let mut clusters: Vec<usize> = roots.collect();
        loop {
            let can_be_split = (0..clusters.len()).filter(|&c| !children[clusters[c]].is_empty());
            let size = |&c: &usize| (has_friction[clusters[c]], dofs[clusters[c]]);
            let largest = can_be_split.max_by_key(size);
            let wanted = |&c: &usize| match count {
                Some(1) => false,
                _ if has_friction[clusters[c]] => true,
                Some(count) => clusters.len() < count,
                None => dofs[clusters[c]] > most,
            };
            let Some(largest) = largest.filter(wanted) else {
                break;
            };
            let split = clusters.swap_remove(largest);
            clusters.extend(&children[split]);
        }
        clusters.sort_unstable();
        self.hierarchy.clusters = clusters.into_iter().map(|v| v as u32).collect();
    }

    /// Flags of the nodes of the hierarchy whose subtrees have all sides of a contact point with friction.
    fn subtrees_with_friction(&self) -> Vec<bool> {
        let parents = &self.hierarchy.parent;
        let above = |v: usize| parents[v].map(|parent| parent as usize);
        let path = |v: usize| std::iter::successors(Some(v), |&v| above(v));
        let mut flags = vec![false; parents.len()];
        let mut sides = vec![0; parents.len()];
        for point in self.points.iter().filter(|point| point.law.has_friction()) {
            let entries = point.entries.iter();
            let mut subdomains: Vec<usize> =
                entries.map(|(node, _)| node.subdomain as usize).collect();
            subdomains.sort_unstable();
            subdomains.dedup();
            let all = subdomains.iter().flat_map(|&s| path(s));
            all.clone().for_each(|v| sides[v] += 1);
            for v in all {
                flags[v] |= sides[v] == subdomains.len();
            }
            let all = subdomains.iter().flat_map(|&s| path(s));
            all.for_each(|v| sides[v] = 0);
        }
        flags
    }
}
