//! Stresses and the estimate of the mesh's error: what blocks share at nodes of Γ is summed up over
//! all of them by the root.

use std::collections::{BTreeMap, HashMap};

use contact_dd_partition::problem::Catalog;

use super::read::OwnedBlock;
use super::recover::BlockSolution;
use crate::comm::{Comm, Message};
use crate::fem::block::Block;
use crate::fem::estimate::CellError;
use crate::fem::patch::{PatchSum, Polynomial};
use crate::fem::recovery::Recovery;
use crate::fem::stress::{BlockStress, RecoveredStress};
use crate::plan::Plan;

/// The stresses of a block.
#[derive(Clone, Debug)]
pub struct Stress {
    /// Of every cell, member by member (Pa).
    pub cells: Vec<[f64; 6]>,
    /// At nodes, with the cells' error.
    pub recovered: RecoveredStress,
}

/// What blocks know in parts of a node on Γ in one material.
trait Part: Clone {
    /// Appends it to a message.
    fn pack(&self, reals: &mut Vec<f64>);
    /// Takes one off the front of what was packed.
    fn unpack(reals: &mut &[f64]) -> Option<Self>;
    /// Adds another part.
    fn add(&mut self, other: &Self);
}

impl Part for PatchSum {
    fn pack(&self, reals: &mut Vec<f64>) {
        self.pack(reals);
    }

    fn unpack(reals: &mut &[f64]) -> Option<Self> {
        Self::unpack(reals)
    }

    fn add(&mut self, other: &Self) {
        self.add(other);
    }
}

/// A sum of polynomials and how many these are.
impl Part for (Polynomial, f64) {
    fn pack(&self, reals: &mut Vec<f64>) {
        reals.push(self.1);
        reals.extend(self.0.as_slice());
    }

    fn unpack(reals: &mut &[f64]) -> Option<Self> {
        let mut sum = Polynomial::default();
        let (record, rest) = reals.split_at_checked(1 + sum.as_slice().len())?;
        sum.add_slice(&record[1..]);
        *reals = rest;
        Some((sum, record[0]))
    }

    fn add(&mut self, other: &Self) {
        self.0.add(1.0, &other.0);
        self.1 += other.1;
    }
}

/// Stresses of this rank's blocks. Collective.
pub fn stresses(
    comm: &Comm,
    blocks: &BTreeMap<usize, OwnedBlock>,
    solutions: &BTreeMap<usize, BlockSolution>,
    catalog: &Catalog,
    plan: &Plan,
) -> BTreeMap<usize, Stress> {
    // Fresh memory for every block would cost more than what is done with it.
    let mut patches = Vec::new();
    let found = solutions.iter().filter_map(|(b, solution)| {
        let block = &blocks.get(b)?.block;
        let (materials, u) = (&catalog.materials, &solution.u);
        let stress = BlockStress::new(block, materials, catalog.plane, u, &mut patches);
        Some((*b, (block, stress)))
    });
    let mut stresses: BTreeMap<usize, (&Block, BlockStress)> = found.collect();
    let exchange = Exchange { comm, plan };
    exchange.sum(
        &mut stresses,
        |recovery, _| (recovery.shared().map(|(place, patch)| (place, *patch))).collect(),
        |recovery, block, place, whole: PatchSum| recovery.set_shared(block, place, &whole),
    );
    for (block, stress) in stresses.values_mut() {
        for recovery in &mut stress.recoveries {
            recovery.gather_neighbours(block);
        }
    }
    exchange.sum(
        &mut stresses,
        |recovery, block| {
            let shared = recovery.shared_neighbours(block);
            shared
                .map(|(place, &sum, count)| (place, (sum, count)))
                .collect()
        },
        |recovery, block, place, (sum, count)| recovery.set_neighbours(block, place, sum, count),
    );
    let recover = |(b, (block, mut stress)): (usize, (&Block, BlockStress))| {
        let u = &solutions.get(&b)?.u;
        let recovered = stress.recover(block, &catalog.materials, u);
        let cells = stress.cells;
        Some((b, Stress { cells, recovered }))
    };
    stresses.into_iter().filter_map(recover).collect()
}

/// The way of parts to the root and of their sums back.
struct Exchange<'a> {
    comm: &'a Comm,
    plan: &'a Plan,
}

impl Exchange<'_> {
    /// Sums up what `parts` gives for places on the interface of every block, and hands the sums
    /// to `set`. Sums run in the order of blocks, whoever owns them. Collective.
    fn sum<P: Part>(
        &self,
        stresses: &mut BTreeMap<usize, (&Block, BlockStress)>,
        parts: impl Fn(&Recovery, &Block) -> Vec<(usize, P)>,
        set: impl Fn(&mut Recovery, &Block, usize, P),
    ) {
        let owners = self.plan.owners();
        let of_block = |(&b, (block, stress)): (&usize, &(&Block, BlockStress))| {
            let recoveries = stress.recoveries.iter();
            let all: Vec<_> = recoveries.map(|recovery| parts(recovery, block)).collect();
            (b, all)
        };
        let own: BTreeMap<usize, Vec<Vec<(usize, P)>>> = stresses.iter().map(of_block).collect();
        let mut totals: HashMap<(i64, i64), P> = HashMap::new();
        let mut asked: Vec<Vec<(i64, i64)>> = Vec::new();
        self.comm.gather(
            &owners,
            |b| {
                let mut message = Message::default();
                let Some((block, stress)) = stresses.get(&b) else {
                    return message;
                };
                for (recovery, parts) in stress.recoveries.iter().zip(&own[&b]) {
                    for (place, part) in parts {
                        let node = i64::from(block.interface[*place].1);
                        let material = recovery.material() as i64;
                        message.integers.extend([node, material]);
                        part.pack(&mut message.reals);
                    }
                }
                message
            },
            |_, message| {
                let keys = message.integers.chunks(2).map(|k| (k[0], k[1]));
                let keys: Vec<(i64, i64)> = keys.collect();
                let mut reals = &message.reals[..];
                for (key, part) in keys
                    .iter()
                    .zip(std::iter::from_fn(|| P::unpack(&mut reals)))
                {
                    (totals.entry(*key))
                        .and_modify(|sum| sum.add(&part))
                        .or_insert(part);
                }
                asked.push(keys);
            },
        );
        self.comm.scatter(
            &owners,
            |b| {
                let mut message = Message::default();
                for total in asked[b].iter().filter_map(|key| totals.get(key)) {
                    total.pack(&mut message.reals);
                }
                message
            },
            |b, message| {
                let Some((block, stress)) = stresses.get_mut(&b) else {
                    return;
                };
                let mut reals = &message.reals[..];
                for (recovery, parts) in stress.recoveries.iter_mut().zip(&own[&b]) {
                    for (place, _) in parts {
                        if let Some(total) = P::unpack(&mut reals) {
                            set(recovery, block, *place, total);
                        }
                    }
                }
            },
        );
    }
}

/// The estimate for all cells, on the root. Collective.
pub fn error_estimate(comm: &Comm, stresses: &BTreeMap<usize, Stress>, plan: &Plan) -> CellError {
    let mut total = CellError::default();
    comm.gather(
        &plan.owners(),
        |b| {
            let mut sum = CellError::default();
            for &error in stresses.get(&b).iter().flat_map(|s| &s.recovered.errors) {
                sum.add(error);
            }
            Message {
                integers: Vec::new(),
                reals: vec![sum.error, sum.energy],
            }
        },
        |_, message| {
            let mut reader = message.read();
            let (error, energy) = (reader.real(), reader.real());
            total.add(CellError { error, energy });
        },
    );
    total
}
