//! What blocks and clusters tell each other of contact conditions.

use std::collections::BTreeMap;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::condense::substitute::Factors;

impl Factors<'_> {
    /// Brings what is said of the conditions of every block in contact to its cluster, group after group.
    /// Collective; blocks by number, clusters by their place among those in contact.
    pub fn collect_conditions<T: Serialize + DeserializeOwned>(
        &self,
        mut of_blocks: BTreeMap<usize, Vec<T>>,
    ) -> BTreeMap<usize, Vec<T>> {
        let plan = self.context.plan;
        let places = self.places();
        let mut of_clusters: BTreeMap<usize, Vec<T>> = BTreeMap::new();
        self.context.comm.route(
            plan.ways_to_clusters(),
            |i| of_blocks.remove(&places[i].1).unwrap_or_default(),
            |i, said| of_clusters.entry(places[i].0).or_default().extend(said),
        );
        of_clusters
    }

    /// Brings what is said of every condition of a cluster to the blocks that they belong to. Collective.
    pub fn spread_conditions<T: Serialize + DeserializeOwned>(
        &self,
        mut of_clusters: BTreeMap<usize, Vec<T>>,
    ) -> BTreeMap<usize, Vec<T>> {
        let plan = self.context.plan;
        let places = self.places();
        let mut of_blocks = BTreeMap::new();
        self.context.comm.route(
            plan.ways_to_clusters()
                .map(|(block, cluster)| (cluster, block)),
            |i| -> Vec<T> {
                let (p, block) = places[i];
                let count = plan.tree.nodes[block].conditions;
                let left = of_clusters.get_mut(&p).map(|left| left.drain(..count));
                left.into_iter().flatten().collect()
            },
            |i, said| {
                of_blocks.insert(places[i].1, said);
            },
        );
        of_blocks
    }

    /// Cluster, by its place among those in contact, and block of every group, cluster by cluster.
    fn places(&self) -> Vec<(usize, usize)> {
        let plan = self.context.plan;
        let contact = plan.contact.iter().enumerate();
        contact
            .flat_map(|(p, &c)| {
                plan.clusters[c]
                    .groups
                    .iter()
                    .map(move |&g| (p, plan.groups[g]))
            })
            .collect()
    }
}
