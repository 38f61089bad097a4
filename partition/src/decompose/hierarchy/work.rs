//! What a tree costs.

use super::blocks::Blocks;
use crate::flops::Front;
use crate::problem::{Catalog, Hierarchy};

/// What the nodes of a tree cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// The front of every inner node.
    pub fronts: Vec<Front>,
    /// Estimated flops of every node of the tree with all that is under it; those of a group in
    /// contact stand at its first subdomain.
    pub below: Vec<f64>,
}

impl Work {
    /// Flops of all fronts.
    pub fn of_fronts(&self) -> f64 {
        // The empty sum of floats is −0.
        self.fronts.iter().map(Front::flops).fold(0.0, |a, b| a + b)
    }
}

impl Hierarchy {
    /// Estimated work under the heaviest child of the heaviest root, over the mean of all its
    /// children; 1 where there is none.
    pub fn uneven_halves(&self, work: &Work) -> f64 {
        let heavier = |&a: &usize, &b: &usize| work.below[a].total_cmp(&work.below[b]);
        let roots = (0..self.parent.len()).filter(|&node| self.parent[node].is_none());
        let Some(root) = roots.max_by(heavier) else {
            return 1.0;
        };
        // The members of a group beside the first have no work.
        let children: Vec<f64> = (0..root)
            .filter(|&node| self.parent[node] == Some(root as u32) && work.below[node] > 0.0)
            .map(|node| work.below[node])
            .collect();
        let largest = children.iter().copied().fold(0.0, f64::max);
        let sum: f64 = children.iter().sum();
        match children.len() {
            0 => 1.0,
            count => largest * count as f64 / sum,
        }
    }

    /// What this tree costs for the problem that it belongs to.
    pub fn work(&self, catalog: &Catalog) -> Work {
        let blocks = Blocks::new(catalog);
        let subdomains = blocks.of_subdomain.len();
        let mut below = vec![0.0; self.parent.len()];
        // What each node hands up: seams, with the number of their blocks met so far.
        let mut left: Vec<Vec<(u32, u32)>> = vec![Vec::new(); self.parent.len()];
        let mut conditions = vec![0; self.parent.len()];
        let mut known = vec![false; blocks.len()];
        for (subdomain, &block) in blocks.of_subdomain.iter().enumerate() {
            if !std::mem::replace(&mut known[block as usize], true) {
                below[subdomain] = blocks.cost(block);
                conditions[subdomain] = blocks.conditions[block as usize];
                let seams = blocks.seams.of(block as usize).iter();
                left[subdomain] = seams.map(|&seam| (seam, 1)).collect();
            }
        }
        let mut fronts = Vec::with_capacity(self.parent.len() - subdomains);
        let mut met = vec![0u32; blocks.sharing.len()];
        for node in 0..self.parent.len() {
            if node >= subdomains {
                for &(seam, count) in &left[node] {
                    met[seam as usize] += count;
                }
                let mut front = Front {
                    eliminated: 0,
                    kept: conditions[node],
                };
                left[node].retain_mut(|(seam, count)| {
                    *count = std::mem::take(&mut met[*seam as usize]);
                    let all = blocks.sharing.of(*seam as usize).len();
                    let dofs = blocks.seam_dofs[*seam as usize];
                    match *count as usize {
                        // Met before, from another child.
                        0 => false,
                        count if count == all => {
                            front.eliminated += dofs;
                            false
                        }
                        _ => {
                            front.kept += dofs;
                            true
                        }
                    }
                });
                below[node] += front.flops();
                fronts.push(front);
            }
            if let Some(parent) = self.parent[node] {
                let parent = parent as usize;
                below[parent] += below[node];
                conditions[parent] += conditions[node];
                let up = std::mem::take(&mut left[node]);
                left[parent].extend(up);
            }
        }
        Work { fronts, below }
    }
}
