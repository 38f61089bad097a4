//! S_CON of (15) over all ranks: every pair is evaluated by the rank that owns it.
//!
//! > S_CON(U) = Σ_ϑ R̄_klᵀ S_kl(R̄_kl U)

use std::collections::BTreeMap;

use contact_dd_partition::id::{OnPairs, PairId};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::operator::Interface;
use crate::bytes::Reals;
use crate::comm::Comm;
use crate::contact::friction::Status;
use crate::contact::pair::{ContactPair, PairResponse};

/// S_CON = Σ R_kᵀ S_kl R_k, (15): the root sends requests, the other ranks evaluate their pairs.
pub struct SCon<'a> {
    comm: &'a Comm,
    owners: &'a [usize],
    pairs: &'a mut OnPairs<ContactPair>,
}

/// The responses of all pairs after an evaluation, on the root.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConState {
    interface_dofs: Vec<Option<Vec<f64>>>,
    /// The response of every pair.
    pub responses: Vec<PairResponse>,
}

/// Totals of one evaluation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ConTotals {
    /// Closed normal jumps and linearly dependent constraints.
    pub active: usize,
    /// Constraints that opened or closed, relative to the expected statuses or those of the last evaluation.
    pub changed: usize,
    /// Linear systems solved within pairs.
    pub steps: usize,
    /// Pairs that needed more than Newton's method.
    pub fallen_back_pairs: usize,
    /// Pairs whose contact problem didn't converge, or wasn't solved.
    pub failed_pairs: usize,
    /// Pairs that weren't evaluated because their traces are unchanged.
    pub unmoved_pairs: usize,
}

/// A request of the root to the pairs.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
enum Request {
    /// The end of the requests.
    #[default]
    Stop,
    /// S_kl(U) of these pairs.
    Evaluate(Vec<usize>),
    /// The same at the pairs' last jumps, of these pairs.
    AtLastJumps(Vec<usize>),
    /// S_kl'(U) x of these pairs.
    Differentiate(Vec<usize>),
    /// The question whether any rank received a signal to stop.
    Signals,
}

/// The statuses expected of a pair, and the change of its jumps; empty if unknown.
pub type Expected = (Vec<Status>, Vec<f64>);

/// U of a pair, and its expected statuses and change of jumps.
type Question = (Reals, Option<(Vec<Status>, Reals)>);

impl<'a> SCon<'a> {
    /// S_CON over `pairs` of this rank; `owners` has the owner of every pair.
    pub fn new(comm: &'a Comm, owners: &'a [usize], pairs: &'a mut OnPairs<ContactPair>) -> Self {
        Self {
            comm,
            owners,
            pairs,
        }
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.owners.len()
    }

    /// True if there is no pair.
    pub fn is_empty(&self) -> bool {
        self.owners.is_empty()
    }

    /// Evaluates all pairs whose traces have changed, and stores their responses in `state`; the active-set iteration
    /// of a pair starts from its `expected` statuses. On the root, while the other ranks [`serve`](Self::serve).
    pub fn evaluate(
        &mut self,
        interface: &Interface,
        u: &[f64],
        expected: Option<&[Expected]>,
        state: &mut ConState,
    ) -> ConTotals {
        let n = self.len();
        state.interface_dofs.resize(n, None);
        state.responses.resize_with(n, PairResponse::default);
        let interface_dofs: Vec<Vec<f64>> = (0..n).map(|p| interface.restrict(p, u)).collect();
        let moved: Vec<usize> = (0..n)
            .filter(|&p| state.interface_dofs[p].as_ref() != Some(&interface_dofs[p]))
            .collect();
        if !moved.is_empty() {
            (self.comm).broadcast(&mut Request::Evaluate(moved.clone()));
            let question = |p: usize| -> Question {
                let of_pair = expected.map(|all| all[p].clone());
                let of_pair = of_pair.map(|(status, changes)| (status, Reals(changes)));
                (Reals(interface_dofs[p].clone()), of_pair)
            };
            self.exchange(&moved, question, evaluate, |p, response| {
                state.responses[p] = response;
            });
        }
        let mut totals = ConTotals {
            unmoved_pairs: n - moved.len(),
            ..ConTotals::default()
        };
        for (p, response) in state.responses.iter().enumerate() {
            totals.active += response.active;
            totals.failed_pairs += usize::from(!response.converged);
            if moved.contains(&p) {
                totals.changed += response.changed;
                totals.steps += response.steps;
                totals.fallen_back_pairs += usize::from(response.fell_back);
            }
        }
        state.interface_dofs = interface_dofs.into_iter().map(Some).collect();
        totals
    }

    /// The responses of all pairs to U at their last jumps, for a method that solves the coupled problem of all pairs next:
    /// their own problems would change statuses that the load step before has found. On the root, while the other ranks
    /// [`serve`](Self::serve).
    pub fn at_last_jumps(
        &mut self,
        interface: &Interface,
        u: &[f64],
        state: &mut ConState,
    ) -> ConTotals {
        let all: Vec<usize> = (0..self.len()).collect();
        // The next evaluation is due even where U stays.
        state.interface_dofs = vec![None; all.len()];
        state.responses = vec![PairResponse::default(); all.len()];
        if !all.is_empty() {
            self.comm.broadcast(&mut Request::AtLastJumps(all.clone()));
            let question = |p: usize| Reals(interface.restrict(p, u));
            self.exchange(&all, question, at_last_jumps, |p, response| {
                state.responses[p] = response;
            });
        }
        ConTotals {
            active: state.responses.iter().map(|response| response.active).sum(),
            failed_pairs: all.len(),
            ..ConTotals::default()
        }
    }

    /// y ← y + S_CON'(U) x with the active sets of the last evaluation. On the root, while the other ranks
    /// [`serve`](Self::serve).
    pub fn add_derivative(&mut self, interface: &Interface, x: &[f64], y: &mut [f64]) {
        if self.is_empty() {
            return;
        }
        let all: Vec<usize> = (0..self.len()).collect();
        self.comm
            .broadcast(&mut Request::Differentiate(all.clone()));
        let question = |p: usize| Reals(interface.restrict(p, x));
        self.exchange(&all, question, differentiate, |p, Reals(y_p)| {
            interface.extend(p, &y_p, y);
        });
    }

    /// True if any rank received a signal to stop. On the root, while the other ranks [`serve`](Self::serve).
    pub fn is_any_asked_to_stop(&self) -> bool {
        self.comm.broadcast(&mut Request::Signals);
        self.comm.is_any_asked_to_stop()
    }

    /// Evaluates this rank's pairs as the root requests, until it sends the end. On all ranks but the root.
    pub fn serve(&mut self) {
        loop {
            let mut request = Request::default();
            self.comm.broadcast(&mut request);
            // Only the root sends inputs and receives results.
            match request {
                Request::Stop => return,
                Request::Evaluate(called) => {
                    self.exchange(&called, |_| Question::default(), evaluate, |_, _| {});
                }
                Request::AtLastJumps(called) => {
                    self.exchange(&called, |_| Reals::default(), at_last_jumps, |_, _| {});
                }
                Request::Differentiate(called) => {
                    self.exchange(&called, |_| Reals::default(), differentiate, |_, _| {});
                }
                Request::Signals => {
                    self.comm.is_any_asked_to_stop();
                }
            }
        }
    }

    /// Ends [`serve`](Self::serve) on the other ranks.
    pub fn stop(&self) {
        self.comm.broadcast(&mut Request::Stop);
    }

    /// Sends inputs to the owners of the pairs in `called`, and results to the root. Collective.
    fn exchange<Q, A>(
        &mut self,
        called: &[usize],
        question: impl Fn(usize) -> Q,
        answer: impl Fn(&mut ContactPair, Q) -> A,
        mut take: impl FnMut(usize, A),
    ) where
        Q: Serialize + DeserializeOwned,
        A: Serialize + DeserializeOwned + Default,
    {
        let owners: Vec<usize> = called.iter().map(|&p| self.owners[p]).collect();
        let received = (self.comm).scattered(&owners, |i| question(called[i]));
        let received = received.into_iter().map(|(i, asked)| (called[i], asked));
        let mut answers: BTreeMap<usize, A> = received
            .filter_map(|(p, asked)| Some((p, answer(self.pairs.get_mut(&PairId::new(p))?, asked))))
            .collect();
        self.comm.gather(
            &owners,
            |i| answers.remove(&called[i]).unwrap_or_default(),
            |i, answer| take(called[i], answer),
        );
    }
}

fn evaluate(pair: &mut ContactPair, (Reals(u), expected): Question) -> PairResponse {
    pair.evaluate(
        &u,
        expected.map(|(status, Reals(changes))| (status, changes)),
    )
}

fn at_last_jumps(pair: &mut ContactPair, Reals(u): Reals) -> PairResponse {
    pair.at_last_jumps(&u)
}

fn differentiate(pair: &mut ContactPair, Reals(x): Reals) -> Reals {
    Reals(pair.derivative(&x))
}

impl ConState {
    /// r ← r − S_CON(U) and its scale.
    pub fn subtract(&self, interface: &Interface, r: &mut [f64], scale: &mut [f64]) {
        for (p, response) in self.responses.iter().enumerate() {
            let minus: Vec<f64> = response.reaction.iter().map(|x| -x).collect();
            interface.extend(p, &minus, r);
            interface.extend(p, &response.scale, scale);
        }
    }

    /// The statuses of every pair.
    pub fn statuses(&self) -> Vec<Vec<Status>> {
        let of_pair = |response: &PairResponse| response.status.clone();
        self.responses.iter().map(of_pair).collect()
    }
}
