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
    /// `count`, until none that can be split exceeds the bound.
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
        let most = if self.dim == 3 { DOFS_IN_SPACE } else { DOFS };
        let roots = (0..parents.len()).filter(|&v| parents[v].is_none());
        let mut clusters: Vec<usize> = roots.collect();
        loop {
            let can_be_split = (0..clusters.len()).filter(|&c| !children[clusters[c]].is_empty());
            let largest = can_be_split.max_by_key(|&c| dofs[clusters[c]]);
            let wanted = |&c: &usize| match count {
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
}
