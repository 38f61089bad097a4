//! Exchange of data of contact constraints between contact groups and clusters.

use std::collections::BTreeMap;

use contact_dd_partition::id::{GroupId, OnGroups, OnPairs, PairId};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::condense::substitute::Factors;

impl Factors<'_> {
    /// Sends data of the constraints of every contact group to its cluster, group after group. Collective; groups by
    /// number, clusters by their number among the pairs.
    pub fn collect_conditions<T: Serialize + DeserializeOwned>(
        &self,
        mut of_groups: OnGroups<Vec<T>>,
    ) -> OnPairs<Vec<T>> {
        let plan = self.context.plan;
        let places = self.places();
        let mut of_clusters: OnPairs<Vec<T>> = BTreeMap::new();
        self.context.comm.route(
            plan.routes_to_clusters(),
            |i| of_groups.remove(&places[i].1).unwrap_or_default(),
            |i, data| of_clusters.entry(places[i].0).or_default().extend(data),
        );
        of_clusters
    }

    /// Sends data of every constraint of a cluster to the group that it belongs to. Collective.
    pub fn spread_conditions<T: Serialize + DeserializeOwned>(
        &self,
        mut of_clusters: OnPairs<Vec<T>>,
    ) -> OnGroups<Vec<T>> {
        let plan = self.context.plan;
        let places = self.places();
        let mut of_groups = BTreeMap::new();
        self.context.comm.route(
            plan.routes_to_clusters()
                .map(|(group, cluster)| (cluster, group)),
            |i| -> Vec<T> {
                let (p, g) = places[i];
                let count = plan.groups[g].conditions;
                let left = of_clusters.get_mut(&p).map(|left| left.drain(..count));
                left.into_iter().flatten().collect()
            },
            |i, data| {
                of_groups.insert(places[i].1, data);
            },
        );
        of_groups
    }

    /// Pair and group, cluster by cluster.
    fn places(&self) -> Vec<(PairId, GroupId)> {
        let plan = self.context.plan;
        let contact = plan.pairs.each();
        contact
            .flat_map(|(p, &c)| plan.clusters[c].groups.iter().map(move |&g| (p, g)))
            .collect()
    }
}
