//! What blocks and clusters tell each other of contact conditions.

use std::collections::BTreeMap;

use super::substitute::Factors;
use crate::comm::Message;

impl Factors<'_> {
    /// Brings a message on the conditions of every block in contact to its cluster, group after group.
    /// Collective; blocks by number, clusters by their place among those in contact.
    pub fn collect_conditions(
        &self,
        mut of_blocks: BTreeMap<usize, Message>,
    ) -> BTreeMap<usize, Vec<Message>> {
        let plan = self.context.plan;
        let places = self.places();
        let mut of_clusters: BTreeMap<usize, Vec<Message>> = BTreeMap::new();
        self.context.comm.route(
            plan.ways_to_clusters(),
            |i| of_blocks.remove(&places[i].1).unwrap_or_default(),
            |i, message| of_clusters.entry(places[i].0).or_default().push(message),
        );
        of_clusters
    }

    /// Brings an integer and a real for every condition of a cluster to the blocks that they belong to.
    /// Collective.
    pub fn spread_conditions(
        &self,
        of_clusters: BTreeMap<usize, Message>,
    ) -> BTreeMap<usize, Message> {
        let plan = self.context.plan;
        let places = self.places();
        let mut left: BTreeMap<usize, _> = (of_clusters.into_iter())
            .map(|(p, message)| (p, message.read()))
            .collect();
        let mut of_blocks = BTreeMap::new();
        self.context.comm.route(
            plan.ways_to_clusters()
                .map(|(block, cluster)| (cluster, block)),
            |i| {
                let (p, block) = places[i];
                let count = plan.tree.nodes[block].conditions;
                left.get_mut(&p)
                    .map_or_else(Message::default, |reader| Message {
                        integers: reader.integers(count),
                        reals: reader.reals(count),
                    })
            },
            |i, message| {
                of_blocks.insert(places[i].1, message);
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
