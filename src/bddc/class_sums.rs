//! Sums over clusters of values on the unknowns that they share.
//!
//! They run in the order of clusters, so that the result doesn't depend on the ranks.

use std::collections::BTreeMap;
use std::ops::Range;

use contact_dd_partition::id::{MergeRootId, OnMergeRoots};
use contact_dd_partition::numbered::Numbered;

use crate::bddc::classes::Classes;
use crate::bddc::local::{Local, Vectors};
use crate::comm::collectives::Routes;
use crate::comm::{Comm, ROOT};
use crate::vector::{axpy, dot};

/// The messages of sums over clusters, as far as this rank takes part: the values of each class go to the rank of its
/// first cluster, and their sum back.
#[derive(Debug, Default)]
pub struct ClassSums {
    /// Classes, each with one of its clusters, where this rank has that cluster or the first one of the class.
    ends: Vec<(usize, MergeRootId)>,
    there: Routes,
    back: Routes,
    /// Routes from every cluster's rank to the root.
    to_root: Routes,
}

impl ClassSums {
    /// The messages for `classes` of clusters with these `owners`.
    pub fn new(comm: &Comm, classes: &Classes, owners: &Numbered<MergeRootId, usize>) -> Self {
        let me = comm.rank();
        let (mut ends, mut ranks) = (Vec::new(), Vec::new());
        for (k, class) in classes.list.iter().enumerate() {
            let home = owners[class.clusters[0]];
            for &c in &class.clusters {
                if owners[c] == me || home == me {
                    ends.push((k, c));
                    ranks.push((owners[c], home));
                }
            }
        }
        Self {
            ends,
            there: Routes::new(me, ranks.iter().copied()),
            back: Routes::new(me, ranks.iter().map(|&(from, to)| (to, from))),
            to_root: Routes::new(me, owners.iter().map(|&owner| (owner, ROOT))),
        }
    }

    /// Replaces the values of each cluster of this rank by the sum over all clusters that share an unknown. Collective.
    pub fn add_up(
        &self,
        comm: &Comm,
        classes: &Classes,
        locals: &OnMergeRoots<Local>,
        v: &mut Vectors,
    ) {
        let range = |c: MergeRootId, k: usize| {
            let at = classes.of_clusters[c].binary_search(&k);
            at.map_or(0..0, |at| locals[&c].ranges()[at].clone())
        };
        let own = |i: usize| {
            let (k, c) = self.ends[i];
            v[&c][range(c, k)].to_vec()
        };
        let mut sums: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for (i, part) in comm.route_lists(&self.there, own) {
            match sums.get_mut(&self.ends[i].0) {
                Some(sum) => sum
                    .iter_mut()
                    .zip(part)
                    .for_each(|(sum, part)| *sum += part),
                None => drop(sums.insert(self.ends[i].0, part)),
            }
        }
        for (i, sum) in comm.route_lists(&self.back, |i| sums[&self.ends[i].0].clone()) {
            let (k, c) = self.ends[i];
            if let Some(of_cluster) = v.get_mut(&c) {
                of_cluster[range(c, k)].copy_from_slice(&sum);
            }
        }
    }

    /// x·y for several y, with each unknown counted once, on all ranks. Collective.
    pub fn products(
        &self,
        comm: &Comm,
        classes: &Classes,
        locals: &OnMergeRoots<Local>,
        (x, all): (&Vectors, &[&Vectors]),
    ) -> Vec<f64> {
        let parts = comm.route_lists(&self.to_root, |i| {
            let c = MergeRootId::new(i);
            let of_cluster = classes.of_clusters[c].iter().zip(locals[&c].ranges());
            let own = of_cluster.filter(|(k, _)| classes.list[**k].clusters[0] == c);
            let own: Vec<_> = own.map(|(_, range)| range.clone()).collect();
            let product = |y: &&Vectors| {
                let of_class =
                    |range: &Range<usize>| dot(&x[&c][range.clone()], &y[&c][range.clone()]);
                own.iter().map(of_class).sum::<f64>()
            };
            all.iter().map(product).collect()
        });
        let mut sums = vec![0.0; all.len()];
        for of_cluster in parts.into_values() {
            axpy(1.0, &of_cluster, &mut sums);
        }
        comm.broadcast(&mut sums);
        sums
    }
}
