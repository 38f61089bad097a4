//! S_CON of (15) over all ranks: every pair is evaluated by the rank that owns it.
//!
//! > S_CON(U) = Σ_ϑ R̄_klᵀ S_kl(R̄_kl U)

use std::collections::BTreeMap;

use super::operator::Interface;
use crate::comm::{Comm, Message};
use crate::contact::pair::{ContactPair, PairResponse};

/// S_CON = Σ R_kᵀ S_kl R_k, (15), as the root drives it and the other ranks serve it.
pub struct SCon<'a> {
    comm: &'a Comm,
    owners: &'a [usize],
    pairs: &'a mut BTreeMap<usize, ContactPair>,
}

/// What the root knows of all pairs after an evaluation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConState {
    traces: Vec<Option<Vec<f64>>>,
    /// The answer of every pair.
    pub responses: Vec<PairResponse>,
}

/// Totals of one evaluation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ConTotals {
    /// Closed approaches and dependent conditions.
    pub active: usize,
    /// Those that opened or closed, against what was expected or the last evaluation.
    pub changed: usize,
    /// Linear systems solved within pairs.
    pub steps: usize,
    /// Pairs that needed the interior-point method.
    pub fallen_back_pairs: usize,
    /// Pairs whose small problem didn't converge.
    pub failed_pairs: usize,
    /// Pairs that weren't asked: their traces are those of the evaluation before.
    pub unmoved_pairs: usize,
}

const STOP: i64 = 0;
const EVALUATE: i64 = 1;
const DIFFERENTIATE: i64 = 2;

impl<'a> SCon<'a> {
    /// S_CON over `pairs` of this rank; `owners` has the owner of every pair.
    pub fn new(
        comm: &'a Comm,
        owners: &'a [usize],
        pairs: &'a mut BTreeMap<usize, ContactPair>,
    ) -> Self {
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

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.owners.is_empty()
    }

    /// Evaluates all pairs whose trace changed and leaves their answers in `state`; a pair's search
    /// begins at the conditions `expected` to be open. On the root; the other ranks
    /// [`serve`](Self::serve).
    pub fn evaluate(
        &mut self,
        interface: &Interface,
        u: &[f64],
        expected: Option<&[Vec<bool>]>,
        state: &mut ConState,
    ) -> ConTotals {
        let n = self.len();
        state.traces.resize(n, None);
        state.responses.resize_with(n, PairResponse::default);
        let traces: Vec<Vec<f64>> = (0..n).map(|p| interface.restrict(p, u)).collect();
        let moved: Vec<usize> = (0..n)
            .filter(|&p| state.traces[p].as_ref() != Some(&traces[p]))
            .collect();
        let question = |p: usize| Message {
            integers: expected.map_or_else(Vec::new, |sets| {
                sets[p].iter().map(|&open| i64::from(open)).collect()
            }),
            reals: traces[p].clone(),
        };
        self.ask(EVALUATE, &moved, question, |p, message| {
            state.responses[p] = unpack(message);
        });
        let mut totals = ConTotals {
            unmoved_pairs: n - moved.len(),
            ..ConTotals::default()
        };
        for (p, response) in state.responses.iter().enumerate() {
            totals.active += response.open.iter().filter(|&&open| !open).count();
            totals.failed_pairs += usize::from(!response.converged);
            if moved.contains(&p) {
                totals.changed += response.changed;
                totals.steps += response.steps;
                totals.fallen_back_pairs += usize::from(response.fell_back);
            }
        }
        state.traces = traces.into_iter().map(Some).collect();
        totals
    }

    /// y ← y + S_CON'(U) x with the active sets of the last evaluation. On the root; the other
    /// ranks [`serve`](Self::serve).
    pub fn add_derivative(&mut self, interface: &Interface, x: &[f64], y: &mut [f64]) {
        let all: Vec<usize> = (0..self.len()).collect();
        let question = |p: usize| Message {
            integers: Vec::new(),
            reals: interface.restrict(p, x),
        };
        self.ask(DIFFERENTIATE, &all, question, |p, message| {
            interface.extend(p, &message.reals, y);
        });
    }

    /// Answers for this rank's pairs whatever the root asks, until it stops. On all ranks but the
    /// root.
    pub fn serve(&mut self) {
        loop {
            let mut command = Message::default();
            self.comm.broadcast(&mut command);
            let Some((&kind, called)) = command.integers.split_first() else {
                return;
            };
            if kind == STOP {
                return;
            }
            let called: Vec<usize> = called.iter().map(|&p| p as usize).collect();
            self.exchange(kind, &called, |_| Message::default(), |_, _| {});
        }
    }

    /// Ends [`serve`](Self::serve) on the other ranks.
    pub fn stop(&self) {
        self.comm.broadcast(&mut Message {
            integers: vec![STOP],
            reals: Vec::new(),
        });
    }

    /// Puts a question to the pairs that are `called`, if any, and takes their answers.
    fn ask(
        &mut self,
        kind: i64,
        called: &[usize],
        question: impl Fn(usize) -> Message,
        take: impl FnMut(usize, Message),
    ) {
        if called.is_empty() {
            return;
        }
        let mut command = Message {
            integers: vec![kind],
            reals: Vec::new(),
        };
        command.integers.extend(called.iter().map(|&p| p as i64));
        self.comm.broadcast(&mut command);
        self.exchange(kind, called, question, take);
    }

    /// Questions to the owners, answers to the root. Collective.
    fn exchange(
        &mut self,
        kind: i64,
        called: &[usize],
        question: impl Fn(usize) -> Message,
        mut take: impl FnMut(usize, Message),
    ) {
        let owners: Vec<usize> = called.iter().map(|&p| self.owners[p]).collect();
        let mut received: BTreeMap<usize, Message> = BTreeMap::new();
        self.comm.scatter(
            &owners,
            |i| question(called[i]),
            |i, message| {
                received.insert(called[i], message);
            },
        );
        let mut answers: BTreeMap<usize, Message> = received
            .into_iter()
            .filter_map(|(p, message)| Some((p, answer(kind, self.pairs.get_mut(&p)?, message))))
            .collect();
        self.comm.gather(
            &owners,
            |i| answers.remove(&called[i]).unwrap_or_default(),
            |i, message| take(called[i], message),
        );
    }
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

    /// The sets of open approaches and dependent conditions, pair by pair.
    pub fn open(&self) -> Vec<Vec<bool>> {
        self.responses.iter().map(|r| r.open.clone()).collect()
    }
}

/// What a pair answers.
fn answer(kind: i64, pair: &mut ContactPair, question: Message) -> Message {
    match kind {
        DIFFERENTIATE => Message {
            integers: Vec::new(),
            reals: pair.derivative(&question.reals),
        },
        _ => {
            let expected: Vec<bool> = question.integers.iter().map(|&open| open != 0).collect();
            let expected = (!expected.is_empty()).then_some(expected);
            pack(&pair.evaluate(&question.reals, expected))
        }
    }
}

/// A response as a message.
fn pack(response: &PairResponse) -> Message {
    let mut message = Message::default();
    message.integers.extend([
        response.reaction.len() as i64,
        response.drives.len() as i64,
        response.open.len() as i64,
        response.changed as i64,
        response.steps as i64,
        i64::from(response.fell_back),
        i64::from(response.converged),
    ]);
    let open = response.open.iter().map(|&open| i64::from(open));
    message.integers.extend(open);
    for list in [
        &response.reaction,
        &response.scale,
        &response.gaps,
        &response.drives,
        &response.drive_scale,
    ] {
        message.reals.extend(list);
    }
    message
}

/// A response from a message.
fn unpack(message: Message) -> PairResponse {
    let mut reader = message.read();
    let traces = reader.count();
    let approaches = reader.count();
    let limits = reader.count();
    PairResponse {
        changed: reader.count(),
        steps: reader.count(),
        fell_back: reader.integer() != 0,
        converged: reader.integer() != 0,
        open: (reader.integers(limits).iter())
            .map(|&open| open != 0)
            .collect(),
        reaction: reader.reals(traces),
        scale: reader.reals(traces),
        gaps: reader.reals(limits),
        drives: reader.reals(approaches),
        drive_scale: reader.reals(approaches),
    }
}
