//! The bases of classes, computed by the owner of each class's first cluster and sent to all its clusters.

use std::collections::BTreeMap;

use contact_dd_partition::id::{MergeRootId, OnMergeRoots};
use contact_dd_partition::numbered::Numbered;

use crate::bddc::classes::Classes;
use crate::bddc::constraints::{Basis, Mechanism, Side};
use crate::bddc::{Bddc, free_motion};
use crate::context::Context;
use crate::error::Failure;

impl Bddc {
    /// The bases of classes for every cluster of this rank whose part of the preconditioner is remade: those that it
    /// had `before`, or new ones from the clusters' sides for the classes that are `made`. The owner of a class's first
    /// cluster computes its basis. Collective.
    pub(super) fn bases(
        &self,
        context: &Context<'_>,
        before: &Classes,
        changed: &Numbered<MergeRootId, bool>,
        made: &[bool],
        sides: OnMergeRoots<Vec<Option<Side>>>,
    ) -> Result<OnMergeRoots<Vec<Basis>>, Failure> {
        let mut new = self.new_bases(context, made, sides)?;
        let mut bases = BTreeMap::new();
        for (c, owner) in self.owners.each() {
            let classes = &self.classes.of_clusters[c];
            let is_new = changed[c] || classes.iter().any(|&k| made[k]);
            if *owner != context.comm.rank() || !is_new {
                continue;
            }
            let of_classes = classes.iter().map(|&k| {
                let class = &self.classes.list[k];
                let kept = || {
                    let at = before.of_clusters.get(c)?;
                    let at = at.binary_search(&before.place_of(class)?).ok()?;
                    Some(self.locals.get(&c)?.bases()[at].clone())
                };
                let made = new.remove(&(k, c)).or_else(kept);
                made.unwrap_or_else(|| Basis::coarse(class.size(), class.clusters[0] == c))
            });
            bases.insert(c, of_classes.collect());
        }
        Ok(bases)
    }

    /// The bases of the classes that are `made`, from the clusters' sides, for every cluster of this rank in a class.
    /// Collective.
    fn new_bases(
        &self,
        context: &Context<'_>,
        made: &[bool],
        mut sides: OnMergeRoots<Vec<Option<Side>>>,
    ) -> Result<BTreeMap<(usize, MergeRootId), Basis>, Failure> {
        let comm = context.comm;
        let ends: Vec<(usize, MergeRootId)> = (0..self.classes.list.len())
            .filter(|&k| made[k])
            .flat_map(|k| self.classes.list[k].clusters.iter().map(move |&c| (k, c)))
            .collect();
        let home = |k: usize| self.owners[self.classes.list[k].clusters[0]];
        let mut arrived: BTreeMap<usize, Vec<Side>> = BTreeMap::new();
        comm.route(
            ends.iter().map(|&(k, c)| (self.owners[c], home(k))),
            |i| {
                let (k, c) = ends[i];
                let at = self.classes.of_clusters[c].binary_search(&k).ok()?;
                sides.get_mut(&c)?[at].take()
            },
            |i, side| arrived.entry(ends[i].0).or_default().extend(side),
        );
        let mut result = Ok(());
        let mut results = BTreeMap::new();
        for (k, sides) in arrived {
            let class = &self.classes.list[k];
            match Basis::new(&sides, || self.nodes.motions_of(class)) {
                Ok(bases) => {
                    let ends = class.clusters.iter().map(|&c| (k, c));
                    results.extend(ends.zip(bases));
                }
                Err(Mechanism) => result = Err(free_motion(Mechanism)),
            }
        }
        comm.agree(result)?;
        let mut of_ends = BTreeMap::new();
        comm.route(
            ends.iter().map(|&(k, c)| (home(k), self.owners[c])),
            |i| results.remove(&ends[i]),
            |i, basis| of_ends.extend(basis.map(|basis| (ends[i], basis))),
        );
        Ok(of_ends)
    }
}
