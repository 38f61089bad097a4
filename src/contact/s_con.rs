//! S_CON over all ranks: every pair is evaluated by the rank that owns it.

use std::collections::BTreeMap;

use faer::Mat;

use super::pair::{ContactPair, PairResponse};
use crate::comm::{Comm, Message};
use crate::interface::operator::{Interface, multiply_add};

/// S_CON = Σ R_kᵀ S_kl R_k, (15), as the root drives it and the other ranks serve it.
pub struct SCon<'a> {
    comm: &'a Comm,
    owners: &'a [usize],
    pairs: &'a mut BTreeMap<usize, ContactPair>,
}

/// What the root knows of all pairs after an evaluation.
#[derive(Clone, Debug, Default)]
pub struct ConState {
    traces: Vec<Option<Vec<f64>>>,
    responses: Vec<Option<PairResponse>>,
    openings: Vec<Option<Mat<f64>>>,
}

/// Totals of one evaluation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ConTotals {
    /// Closed conditions.
    pub active: usize,
    /// Conditions that opened or closed.
    pub changed: usize,
    /// Linear systems solved within pairs.
    pub steps: usize,
    /// Pairs that weren't evaluated, because their trace hadn't changed.
    pub unchanged_pairs: usize,
    /// Pairs whose small problem didn't converge.
    pub failed_pairs: usize,
}

/// Which openings an evaluation brings to the root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Openings {
    /// None.
    Keep,
    /// Those of pairs whose active set changed.
    Changed,
    /// All, from pairs whose trace hasn't changed, too.
    All,
}

impl Openings {
    fn from_code(code: i64) -> Self {
        [Self::Keep, Self::Changed, Self::All]
            .into_iter()
            .find(|openings| *openings as i64 == code)
            .unwrap_or(Self::All)
    }
}

const STOP: i64 = 0;
const EVALUATE: i64 = 1;

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

    /// Evaluates all pairs whose trace changed and leaves their answers in `state`. On the root;
    /// the other ranks [`serve`](Self::serve).
    pub fn evaluate(
        &mut self,
        interface: &Interface,
        u: &[f64],
        openings: Openings,
        state: &mut ConState,
    ) -> ConTotals {
        let n = self.len();
        state.traces.resize(n, None);
        state.responses.resize(n, None);
        state.openings.resize(n, None);
        let traces: Vec<Vec<f64>> = (0..n).map(|p| interface.restrict(p, u)).collect();
        let again = openings == Openings::All;
        let moved: Vec<bool> = (0..n)
            .map(|p| again || state.traces[p].as_ref() != Some(&traces[p]))
            .collect();
        let mut totals = ConTotals::default();
        if moved.contains(&true) {
            let mut command = Message {
                integers: vec![EVALUATE, openings as i64],
                reals: Vec::new(),
            };
            command.integers.extend(moved.iter().map(|&m| i64::from(m)));
            self.comm.broadcast(&mut command);
            self.exchange(&moved, openings, Some((&traces, state)));
        }
        for (p, response) in state.responses.iter().enumerate() {
            let Some(response) = response else { continue };
            totals.active += response.active;
            if moved[p] {
                totals.changed += response.changed;
                totals.steps += response.steps;
            } else {
                totals.unchanged_pairs += 1;
            }
            totals.failed_pairs += usize::from(!response.converged);
        }
        state.traces = traces.into_iter().map(Some).collect();
        totals
    }

    /// Evaluates this rank's pairs whenever the root asks, until it stops. On all ranks but the
    /// root.
    pub fn serve(&mut self) {
        loop {
            let mut command = Message::default();
            self.comm.broadcast(&mut command);
            let mut command = command.read();
            if command.integer() == STOP {
                return;
            }
            let openings = Openings::from_code(command.integer());
            let moved: Vec<bool> = command
                .integers(self.len())
                .iter()
                .map(|&m| m != 0)
                .collect();
            self.exchange(&moved, openings, None);
        }
    }

    /// Ends [`serve`](Self::serve) on the other ranks.
    pub fn stop(&self) {
        self.comm.broadcast(&mut Message {
            integers: vec![STOP],
            reals: Vec::new(),
        });
    }

    /// Traces to the owners, responses to the root. Collective.
    fn exchange(
        &mut self,
        moved: &[bool],
        openings: Openings,
        root: Option<(&[Vec<f64>], &mut ConState)>,
    ) {
        let called: Vec<usize> = (0..self.len()).filter(|&p| moved[p]).collect();
        let owners: Vec<usize> = called.iter().map(|&p| self.owners[p]).collect();
        let (traces, mut state) = root.unzip();
        let mut received: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        self.comm.scatter(
            &owners,
            |i| Message {
                integers: Vec::new(),
                reals: traces.map_or_else(Vec::new, |t| t[called[i]].clone()),
            },
            |i, message| {
                received.insert(called[i], message.reals);
            },
        );
        let mut answers: BTreeMap<usize, Message> = received
            .into_iter()
            .filter_map(|(p, u)| {
                let pair = self.pairs.get_mut(&p)?;
                let response = pair.evaluate(&u);
                Some((p, pack(pair, &response, openings)))
            })
            .collect();
        self.comm.gather(
            &owners,
            |i| answers.remove(&called[i]).unwrap_or_default(),
            |i, message| {
                if let Some(state) = state.as_mut() {
                    let (response, opening) = unpack(message);
                    state.responses[called[i]] = Some(response);
                    if opening.is_some() {
                        state.openings[called[i]] = opening;
                    }
                }
            },
        );
    }
}

impl ConState {
    /// r ← r − S_CON(U) and its scale.
    pub fn subtract(&self, interface: &Interface, r: &mut [f64], scale: &mut [f64]) {
        for (p, response) in self.responses.iter().enumerate() {
            let Some(response) = response else { continue };
            let minus: Vec<f64> = response.reaction.iter().map(|x| -x).collect();
            interface.extend(p, &minus, r);
            interface.extend(p, &response.scale, scale);
        }
    }

    /// Wᵀ W of pair p, by which its derivative falls short of the bilateral one; `None` where every
    /// contact is closed.
    pub fn opening(&self, p: usize) -> Option<Mat<f64>> {
        let w = self.openings.get(p)?.as_ref()?;
        (w.nrows() > 0).then(|| w.transpose() * w)
    }

    /// y ← y + a (S_CON'(U) − S_CON' of the bilateral problem) x with the active sets of the last
    /// evaluation.
    pub fn add_openings(&self, interface: &Interface, a: f64, x: &[f64], y: &mut [f64]) {
        for (p, opening) in self.openings.iter().enumerate() {
            let Some(w) = opening else { continue };
            let x_p = interface.restrict(p, x);
            let mut wx = vec![0.0; w.nrows()];
            multiply_add(w.as_ref(), &x_p, &mut wx);
            let y_p: Vec<f64> = w
                .col_iter()
                .map(|column| -a * column.iter().zip(&wx).map(|(w, wx)| w * wx).sum::<f64>())
                .collect();
            interface.extend(p, &y_p, y);
        }
    }
}

/// A response as a message, with the pair's opening if it is asked for.
fn pack(pair: &ContactPair, response: &PairResponse, openings: Openings) -> Message {
    let mut message = Message::default();
    message.integers.extend([
        response.reaction.len() as i64,
        response.active as i64,
        response.changed as i64,
        response.steps as i64,
        i64::from(response.converged),
    ]);
    message.reals.extend(&response.reaction);
    message.reals.extend(&response.scale);
    let asked = match openings {
        Openings::Keep => false,
        Openings::Changed => response.changed > 0,
        Openings::All => true,
    };
    match asked.then(|| pair.opening()).flatten() {
        Some(w) => {
            message
                .integers
                .extend([w.nrows() as i64, w.ncols() as i64]);
            message.push_matrix(w.as_ref());
        }
        None => message.integers.push(-1),
    }
    message
}

/// A response from a message; approaches and forces stay with the owner.
fn unpack(message: Message) -> (PairResponse, Option<Mat<f64>>) {
    let mut reader = message.read();
    let traces = reader.count();
    let active = reader.count();
    let changed = reader.count();
    let steps = reader.count();
    let converged = reader.integer() != 0;
    let response = PairResponse {
        reaction: reader.reals(traces),
        scale: reader.reals(traces),
        active,
        changed,
        steps,
        converged,
    };
    let rows = reader.integer();
    let opening = (rows >= 0).then(|| {
        let columns = reader.count();
        reader.matrix(rows as usize, columns)
    });
    (response, opening)
}
