//! Positions of the unknowns of a cluster: [own | shared], shared ones class by class.

use std::collections::HashMap;
use std::ops::Range;

use contact_dd_partition::id::MergeRootId;

use crate::bddc::classes::Classes;
use crate::bddc::closed::Ties;
use crate::bddc::constraints::Side;
use crate::schur::cluster_schur::ClusterSchur;
use crate::schur::condensed::InterfaceDof;

/// The unknowns of a cluster as [own | shared].
#[derive(Debug)]
pub struct Placement {
    /// Each unknown of the cluster in terms of these, without constants.
    pub terms: Vec<Vec<(usize, f64)>>,
    /// Number of own ones.
    pub own: usize,
    /// Ranges of its classes among the shared unknowns.
    pub ranges: Vec<Range<usize>>,
}

impl Placement {
    /// The placement of the unknowns of cluster c.
    pub fn new(c: MergeRootId, cluster: &ClusterSchur, classes: &Classes, ties: &Ties) -> Self {
        let mut places: HashMap<InterfaceDof, Vec<(usize, f64)>> = HashMap::new();
        let mut own = classes.own[c].len();
        for (i, &dof) in classes.own[c].iter().enumerate() {
            places.insert(dof, vec![(i, 1.0)]);
        }
        for &k in &classes.of_clusters[c] {
            let class = &classes.list[k];
            if let Some(turned) = &class.turned {
                let which = 1 + usize::from(class.clusters[0] != c);
                let alone = turned.ends[which]..turned.ends[which + 1];
                for (i, &dof) in class.dofs.iter().enumerate() {
                    let terms = alone.clone().enumerate();
                    let terms = terms.map(|(at, j)| (own + at, turned.q[(i, j)]));
                    places.insert(dof, terms.filter(|(_, q)| *q != 0.0).collect());
                }
                own += alone.len();
            }
        }
        let mut ranges = Vec::new();
        let mut first = 0;
        for &k in &classes.of_clusters[c] {
            let class = &classes.list[k];
            for (i, &dof) in class.dofs.iter().enumerate() {
                let place = places.entry(dof).or_default();
                match &class.turned {
                    None => place.push((own + first + i, 1.0)),
                    Some(turned) => {
                        let both = (0..turned.ends[1]).map(|j| (own + first + j, turned.q[(i, j)]));
                        place.extend(both.filter(|(_, q)| *q != 0.0));
                    }
                }
            }
            ranges.push(first..first + class.size());
            first += class.size();
        }
        let in_place = |dof: &InterfaceDof| -> Vec<(usize, f64)> {
            let terms = ties.terms(dof).into_iter();
            terms
                .flat_map(|(dof, c)| places[&dof].iter().map(move |&(i, q)| (i, c * q)))
                .collect()
        };
        let terms: Vec<_> = cluster.dofs.iter().map(in_place).collect();
        Self { terms, own, ranges }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.own + self.ranges.last().map_or(0, |last| last.end)
    }

    /// The stiffness of each class that `is_chosen`, by its index, from the `diagonal` of the cluster.
    pub fn sides(&self, diagonal: &[f64], is_chosen: impl Fn(usize) -> bool) -> Vec<Option<Side>> {
        let mut of_unknowns = vec![0.0; self.size()];
        for (terms, d) in self.terms.iter().zip(diagonal) {
            terms.iter().for_each(|&(i, c)| of_unknowns[i] += c * c * d);
        }
        let shared = &of_unknowns[self.own..];
        let of = |(at, range): (usize, &Range<usize>)| {
            is_chosen(at).then(|| Side::Diagonal(shared[range.clone()].to_vec()))
        };
        self.ranges.iter().enumerate().map(of).collect()
    }
}
