//! Choice of the operator for contact constraints, with its reason, before any work is done with it.

use contact_dd_partition::hierarchy::choice::{Operator, OperatorTimes};
use contact_dd_partition::hierarchy::tree::Tree;
use contact_dd_partition::problem::Catalog;
use contact_dd_partition::solver::Method;

use super::Plan;
use super::cluster::Merging;
use super::cost::CostEstimate;
use super::memory::{CERTAIN_SHARE, LIKELY_SHARE, check_memory};
use crate::comm::Comm;
use crate::error::Failure;

/// The user's choices.
#[derive(Clone, Copy, Debug)]
pub struct SolverRequest {
    /// The method of the sweeps.
    pub method: Method,
    /// True for the iterative interface solver, false for the direct one; `None` if not chosen.
    pub iterative: Option<bool>,
    /// True if another solution with friction is sought.
    pub second_start: bool,
}

/// A treatment of contact in merging, and the reason for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The treatment of contact, which determines the operator for contact constraints.
    pub merging: Merging,
    /// The reason, as text.
    pub why: String,
}

/// A choice with its plan and the estimated cost.
#[derive(Clone, Debug)]
pub struct ChosenPlan {
    /// The choice.
    pub choice: Choice,
    /// The plan.
    pub plan: Plan,
    /// The cost of every rank.
    pub costs: Vec<CostEstimate>,
    /// Available memory (bytes).
    pub available: f64,
}

/// The treatment of contact in merging for an operator.
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

    /// The choices for a problem with this `tree`, the best one first: picard inverts S_0 alone, which then consists of
    /// the linear subdomains; anderson needs the contact problems of groups; newton takes the operator with the least cost.
    ///
    /// # Errors
    /// The iterative solver is requested, but the problem file has no clusters.
    pub fn all(
        catalog: &Catalog,
        tree: &Tree,
        request: SolverRequest,
    ) -> Result<Vec<Self>, Failure> {
        let only = |merging, why: &str| Ok(vec![Self::new(merging, why)]);
        match request.method {
            Method::Picard => return only(Merging::Linear, "picard inverts S_0 alone"),
            Method::Anderson => {
                return only(Merging::Groups, "anderson sweeps over contact groups");
            }
            Method::Newton => {}
        }
        if request.iterative == Some(true) && catalog.hierarchy.clusters.is_empty() {
            return Err(Failure::input(
                "dataset /hierarchy/cluster is missing, which --interface iterative needs; make the problem file \
                 anew, or use --interface direct",
            ));
        }
        if catalog.has_friction() && request.second_start {
            return only(
                Merging::All,
                "--second-start solves for all conditions at once",
            );
        }
        if request.iterative == Some(true) {
            return only(
                Merging::Clusters,
                "conjugate gradients between clusters, as --interface iterative demands",
            );
        }
        let times = OperatorTimes::new(catalog, tree);
        let operators: Vec<Operator> = match request.iterative {
            Some(_) => times.direct().collect(),
            None => times.operators().collect(),
        };
        let choice = |operator| Self::new(merging_of(operator), times.reason(operator));
        Ok(operators.into_iter().map(choice).collect())
    }

    /// The choice to take over if newton doesn't converge with a `merging`: from the iterative solver the fastest
    /// direct operator, from the tree the dense matrix of all constraints.
    pub fn more_robust(catalog: &Catalog, tree: &Tree, merging: Merging) -> Option<Self> {
        let times = OperatorTimes::new(catalog, tree);
        let operator = match merging {
            Merging::Clusters => times.direct().next()?,
            Merging::ActiveSet => Operator::Dense,
            _ => return None,
        };
        Some(Self::new(merging_of(operator), times.reason(operator)))
    }

    /// The plan of this choice, if the hosts have memory for this `share` of its estimated need. Collective.
    ///
    /// # Errors
    /// The first host with too little memory.
    fn plan(
        self,
        comm: &Comm,
        (catalog, tree): (&Catalog, &Tree),
        share: f64,
    ) -> Result<ChosenPlan, Refusal> {
        let plan = Plan::new(catalog, tree, comm.size(), self.merging);
        let costs = plan.cost_estimates(catalog, comm.size());
        let needed = CostEstimate::sum(&costs).bytes;
        match check_memory(comm, &costs, share) {
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

/// A choice for which memory is insufficient.
struct Refusal {
    failure: Failure,
    /// Memory needed (bytes).
    needed: f64,
}

impl ChosenPlan {
    /// The first of some choices for a problem and its tree for which there is memory, with a margin if possible.
    /// Collective.
    ///
    /// # Errors
    /// Too little memory for any of them.
    pub fn new(
        comm: &Comm,
        problem: (&Catalog, &Tree),
        choices: &[Choice],
    ) -> Result<Self, Failure> {
        let mut least: Option<Refusal> = None;
        for share in [LIKELY_SHARE, CERTAIN_SHARE] {
            let mut refused = String::new();
            for choice in choices {
                match choice.clone().plan(comm, problem, share) {
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
