//! The interface problem of the whole scene, which the root solves for the loads and limits of all clusters.

use std::collections::BTreeMap;

use contact_dd_partition::id::{ClusterId, OnPairs, OnTreeNodes};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::bytes::Reals;
use crate::interface::coupled::{CoupledChange, CoupledContact, PairChange};
use crate::plan::Plan;
use crate::recover::fixed_active_set::{FixedActiveSet, FixedActiveSetRoot};
use crate::schur::local::CondensedLoad;

/// Request of a cluster's owner to the root.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct ClusterQuestion<S> {
    /// The state of its limits, if it is in contact.
    limits: Option<Vec<S>>,
    /// The load, on normal jumps and traces.
    #[serde(with = "crate::bytes")]
    load: Vec<f64>,
}

/// The change of a cluster if it is in contact, and of the unknowns on the boundary of its node.
type ClusterAnswer<L> = (Option<PairChange<L>>, Reals);

/// The load on Γ, and on the normal jumps of every pair.
pub type InterfaceLoad<'a> = (&'a [f64], &'a [Vec<f64>]);

impl FixedActiveSet<'_> {
    /// Sends the loads and limits of clusters to the root, where `solve` finds the change of U and of all pairs, and
    /// returns the changes of clusters in contact and the unknowns on the boundary of every cluster's node. Collective.
    pub fn solve_interface<S, L>(
        &self,
        limits: &OnPairs<Vec<S>>,
        condensed: &OnTreeNodes<CondensedLoad>,
        solve: impl FnOnce(&CoupledContact<'_>, InterfaceLoad<'_>, &[Vec<S>]) -> CoupledChange<L>,
    ) -> (OnPairs<PairChange<L>>, OnTreeNodes<Vec<f64>>)
    where
        S: Clone + Serialize + DeserializeOwned,
        L: Clone + Serialize + DeserializeOwned,
    {
        let plan = self.context.plan;
        let owners = plan.cluster_owners();
        let boundary = |c: ClusterId| {
            let load = condensed.get(&plan.clusters[c].node);
            load.map_or(&[][..], CondensedLoad::boundary)
        };
        let questions = self.context.comm.gathered(&owners, |c| ClusterQuestion {
            limits: plan.pair_of(c).and_then(|p| limits.get(&p)).cloned(),
            load: boundary(c).to_vec(),
        });
        let mut answers = match self.root {
            Some(root) => root.answer(plan, questions, solve),
            None => Vec::new(),
        };
        let (mut changes, mut boundaries) = (BTreeMap::new(), BTreeMap::new());
        self.context.comm.scatter(
            &owners,
            |c| std::mem::take(&mut answers[c.index()]),
            |c, (change, Reals(x))| {
                changes.extend(plan.pair_of(c).zip(change));
                boundaries.insert(plan.clusters[c].node, x);
            },
        );
        (changes, boundaries)
    }
}

impl FixedActiveSetRoot<'_> {
    /// Answers to all clusters.
    fn answer<S, L: Clone>(
        &self,
        plan: &Plan,
        questions: Vec<ClusterQuestion<S>>,
        solve: impl FnOnce(&CoupledContact<'_>, InterfaceLoad<'_>, &[Vec<S>]) -> CoupledChange<L>,
    ) -> Vec<ClusterAnswer<L>> {
        let Some((numbering, problem)) = self.interface else {
            return Vec::new();
        };
        let mut r = vec![0.0; problem.interface.len];
        let (mut loads, mut limits) = (Vec::new(), Vec::new());
        for (question, interface_dofs) in questions.into_iter().zip(&numbering.interface_dofs) {
            let mut on_jumps = question.load;
            let on_traces = on_jumps.split_off(on_jumps.len() - interface_dofs.len());
            if let Some(of_cluster) = question.limits {
                limits.push(of_cluster);
                loads.push(on_jumps);
            }
            for (&i, part) in interface_dofs.iter().zip(on_traces) {
                r[i as usize] += part;
            }
        }
        let Some(coupled) = CoupledContact::new(problem) else {
            return vec![ClusterAnswer::default(); numbering.interface_dofs.len()];
        };
        let CoupledChange { u, pairs } = solve(&coupled, (&r, &loads), &limits);
        let mut pairs = pairs.into_iter();
        let answer = |c: ClusterId| {
            let change = plan.pair_of(c).and_then(|_| pairs.next());
            let mut x = change
                .as_ref()
                .map_or_else(Vec::new, |change| change.jumps.clone());
            let interface_dofs = numbering.interface_dofs[c.index()].iter();
            x.extend(interface_dofs.map(|&i| u[i as usize]));
            (change, Reals(x))
        };
        plan.clusters.ids().map(answer).collect()
    }
}
