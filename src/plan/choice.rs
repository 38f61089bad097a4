//! The choice of the operator that answers for contact conditions, with its reason, before any work is done with it.

use contact_dd_partition::hierarchy::choice::{Operator, OperatorTimes};
use contact_dd_partition::problem::Catalog;
use contact_dd_partition::solver::Method;

use super::Plan;
use super::cluster::Merging;
use super::cost::CostEstimate;
use super::memory::{CERTAIN, LIKELY, afford};
use crate::comm::Comm;
use crate::error::Failure;

/// Wishes of the user.
#[derive(Clone, Copy, Debug)]
pub struct Wishes {
    /// The method of the sweeps.
    pub method: Method,
    /// True if the interface solver is to iterate; `None` where nothing is said.
    pub iterative: Option<bool>,
    /// True if another solution with friction is looked for.
    pub second_start: bool,
}

/// The choice of a treatment of contact in the merging, and its reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The merging, which says what answers for contact conditions.
    pub merging: Merging,
    /// The reason in words.
    pub why: String,
}

/// A choice with the plan that follows from it and what that needs.
#[derive(Clone, Debug)]
pub struct ChosenPlan {
    /// The choice.
    pub choice: Choice,
    /// The plan.
    pub plan: Plan,
    /// The cost of every rank.
    pub costs: Vec<CostEstimate>,
    /// Memory that there is (bytes).
    pub available: f64,
}

/// The merging with which an operator answers.
fn merging_of(operator: Operator) -> Merging {
    match operator {
        Operator::Dense => Merging::All,
        Operator::Tree => Merging::ActiveSet,
        Operator::Clusters => Merging::Clusters,
    }
}

impl Choice {
    fn new(merging: Merging, why: impl Into<String>) -> Self {
        let why = why.into();
        Self { merging, why }
    }

    /// The choices for a problem, the best one first: picard inverts S_0 alone, which has to be that of all linear
    /// subdomains; anderson needs the contact problems of groups; newton takes what costs least.
    ///
    /// # Errors
    /// The iterative solver is asked for, and the problem file has no clusters.
    pub fn all(catalog: &Catalog, wishes: Wishes) -> Result<Vec<Self>, Failure> {
        let only = |merging, why: &str| Ok(vec![Self::new(merging, why)]);
        match wishes.method {
            Method::Picard => return only(Merging::Linear, "picard inverts S_0 alone"),
            Method::Anderson => {
                return only(Merging::Groups, "anderson sweeps over contact groups");
            }
            Method::Newton => {}
        }
        if wishes.iterative == Some(true) && catalog.hierarchy.clusters.is_empty() {
            return Err(Failure::input(
                "dataset /hierarchy/cluster is missing, which --interface iterative needs; make the problem file \
                 anew, or use --interface direct",
            ));
        }
        if catalog.has_friction() && wishes.second_start {
            return only(
                Merging::All,
                "--second-start solves for all conditions at once",
            );
        }
        if wishes.iterative == Some(true) {
            return only(Merging::Clusters, "asked for");
        }
        let times = OperatorTimes::new(catalog);
        let operators: Vec<Operator> = match wishes.iterative {
            Some(_) => times.direct().collect(),
            None => times.operators().collect(),
        };
        let choice = |operator| Self::new(merging_of(operator), times.reason(operator));
        Ok(operators.into_iter().map(choice).collect())
    }

    /// The choice that takes over where newton doesn't converge with a `merging`: the fastest direct operator from
    /// iterations, the dense matrix of all conditions from the tree.
    pub fn more_robust(catalog: &Catalog, merging: Merging) -> Option<Self> {
        let times = OperatorTimes::new(catalog);
        let operator = match merging {
            Merging::Clusters => times.direct().next()?,
            Merging::ActiveSet => Operator::Dense,
            _ => return None,
        };
        Some(Self::new(merging_of(operator), times.reason(operator)))
    }

    /// The plan of this choice, if the hosts have memory for a share of what it needs. Collective.
    ///
    /// # Errors
    /// The first host with too little.
    fn plan(self, comm: &Comm, catalog: &Catalog, share: f64) -> Result<ChosenPlan, Refusal> {
        let plan = Plan::new(catalog, comm.size(), self.merging);
        let costs = plan.cost_estimates(catalog, comm.size());
        let needed = CostEstimate::sum(&costs).bytes;
        match afford(comm, &costs, share) {
            Ok(available) => Ok(ChosenPlan {
                choice: self,
                plan,
                costs,
                available,
            }),
            Err(failure) => Err(Refusal { failure, needed }),
        }
    }
}

/// A choice for which there is too little memory.
struct Refusal {
    failure: Failure,
    /// Memory that it needs (bytes).
    needed: f64,
}

impl ChosenPlan {
    /// The first of some choices for which there is memory, with a margin if that can be. Collective.
    ///
    /// # Errors
    /// There is too little memory for any.
    pub fn new(comm: &Comm, catalog: &Catalog, choices: &[Choice]) -> Result<Self, Failure> {
        let mut least: Option<Refusal> = None;
        for share in [LIKELY, CERTAIN] {
            let mut refused = String::new();
            for choice in choices {
                match choice.clone().plan(comm, catalog, share) {
                    Ok(mut chosen) => {
                        if !refused.is_empty() {
                            chosen.choice.why +=
                                &format!("; there is no memory for others:{refused}");
                        }
                        return Ok(chosen);
                    }
                    Err(refusal) => {
                        let solver = choice.merging.solver();
                        let and = if refused.is_empty() { "" } else { " and" };
                        refused += &format!("{and} {solver} needs {:.1} GB", refusal.needed / 1e9);
                        if least
                            .as_ref()
                            .is_none_or(|known| refusal.needed < known.needed)
                        {
                            least = Some(refusal);
                        }
                    }
                }
            }
        }
        Err(least.map_or_else(
            || Failure::internal("there is no operator to choose"),
            |refusal| refusal.failure,
        ))
    }
}
