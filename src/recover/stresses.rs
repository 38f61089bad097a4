//! Stresses and the estimate of the mesh's error: parts that blocks have of nodal values on Γ go to all ranks that
//! share the nodes.

use std::collections::BTreeSet;

use contact_dd_partition::id::{BlockId, OnBlocks};
use contact_dd_partition::problem::Catalog;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::comm::Comm;
use crate::fem::block::Block;
use crate::fem::estimate::CellError;
use crate::fem::patch::PatchSum;
use crate::fem::polynomial::Polynomial;
use crate::fem::recovery::Recovery;
use crate::fem::strain::LargestStrain;
use crate::fem::stress::BlockStress;
use crate::plan::Plan;
use crate::recover::BlockSolution;

/// The stresses of a block.
#[derive(Clone, Debug)]
pub struct Stress {
    /// Stress in every cell (Pa).
    pub cells: Vec<[f64; 6]>,
    /// Stress recovered at nodes (Pa).
    pub nodes: Vec<[f64; 6]>,
    /// Estimated error of every cell.
    pub errors: Vec<CellError>,
    /// The largest strain of a cell.
    pub largest_strain: LargestStrain,
}

/// A nodal quantity on Γ in one material that is a sum over blocks.
trait Part: Clone + Serialize + DeserializeOwned {
    /// Adds another part.
    fn add(&mut self, other: &Self);
}

impl Part for PatchSum {
    fn add(&mut self, other: &Self) {
        self.add(other);
    }
}

/// A sum of polynomials and their number.
impl Part for (Polynomial, f64) {
    fn add(&mut self, other: &Self) {
        self.0.add(1.0, &other.0);
        self.1 += other.1;
    }
}

/// Stresses of this rank's blocks in load step `step`. Collective.
pub fn stresses(
    comm: &Comm,
    blocks: &OnBlocks<Block>,
    solutions: &OnBlocks<BlockSolution>,
    catalog: &Catalog,
    plan: &Plan,
    step: usize,
) -> OnBlocks<Stress> {
    // Fresh memory for every block would cost more than the computation.
    let mut patches = Vec::new();
    let found = solutions.iter().filter_map(|(b, solution)| {
        let block = blocks.get(b)?;
        let (materials, u) = (&catalog.materials, &solution.u);
        let stress = BlockStress::new(block, materials, catalog.plane, u, &mut patches);
        Some((*b, (block, stress)))
    });
    let mut stresses: OnBlocks<(&Block, BlockStress)> = found.collect();
    let exchange = Exchange::new(comm, catalog, plan);
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
    let recover = |(b, (block, mut stress)): (BlockId, (&Block, BlockStress))| {
        let u = &solutions.get(&b)?.u;
        let initial = block.subdomain.initial_stress_in(step);
        let recovered = stress.recover(block, &catalog.materials, u, &initial.cells);
        let (mut cells, mut nodes) = (stress.cells, recovered.at_nodes(block));
        add(&mut cells, &initial.cells);
        add(&mut nodes, &initial.nodes);
        let errors = recovered.errors;
        let stress = Stress {
            cells,
            nodes,
            errors,
            largest_strain: stress.largest_strain,
        };
        Some((b, stress))
    };
    stresses.into_iter().filter_map(recover).collect()
}

fn add(stresses: &mut [[f64; 6]], initial: &[[f64; 6]]) {
    for (stress, initial) in stresses.iter_mut().zip(initial) {
        *stress = std::array::from_fn(|k| stress[k] + initial[k]);
    }
}

/// Exchange of parts among all ranks that share a node.
struct Exchange<'a> {
    comm: &'a Comm,
    /// The ranks that share every node on Γ, ascending.
    ranks: Vec<Vec<usize>>,
    /// The pairs of ranks that share any node.
    routes: Vec<(usize, usize)>,
}

/// A part: number on Γ, material, block.
type Place = (u32, usize, BlockId);

impl<'a> Exchange<'a> {
    fn new(comm: &'a Comm, catalog: &Catalog, plan: &Plan) -> Self {
        let mut ranks: Vec<Vec<usize>> = vec![Vec::new(); plan.tree.interface_nodes];
        for (nodes, &owner) in catalog.interface.iter().zip(&plan.node_owners) {
            for &node in nodes {
                let ranks = &mut ranks[node as usize];
                if let Err(at) = ranks.binary_search(&owner) {
                    ranks.insert(at, owner);
                }
            }
        }
        let pairs = ranks.iter().flat_map(|of_node| {
            let to = move |&from: &usize| of_node.iter().map(move |&to| (from, to));
            of_node.iter().flat_map(to)
        });
        let routes: BTreeSet<(usize, usize)> = pairs.filter(|(from, to)| from != to).collect();
        Self {
            comm,
            ranks,
            routes: routes.into_iter().collect(),
        }
    }

    /// Sums the `parts` at interface nodes of every block, and hands the sums to `set`. Sums run in the order of
    /// blocks, whatever rank owns them. Collective.
    fn sum<P: Part>(
        &self,
        stresses: &mut OnBlocks<(&Block, BlockStress)>,
        parts: impl Fn(&Recovery, &Block) -> Vec<(usize, P)>,
        set: impl Fn(&mut Recovery, &Block, usize, P),
    ) {
        let mut all: Vec<(Place, P)> = Vec::new();
        let mut own: Vec<Vec<usize>> = Vec::new();
        for (&b, (block, stress)) in &*stresses {
            for recovery in &stress.recoveries {
                let mut places = Vec::new();
                for (place, part) in parts(recovery, block) {
                    let of_part = (block.interface[place].1, recovery.material(), b);
                    places.push(place);
                    all.push((of_part, part));
                }
                own.push(places);
            }
        }
        let mine = all.len();
        let mut arrived = Vec::new();
        self.comm.route(
            self.routes.iter().copied(),
            |route| {
                let to = self.routes[route].1;
                let shared = |node: u32| self.ranks[node as usize].contains(&to);
                let parts = all[..mine].iter().filter(|((node, ..), _)| shared(*node));
                parts.cloned().collect::<Vec<(Place, P)>>()
            },
            |_, parts| arrived.extend(parts),
        );
        all.append(&mut arrived);
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_unstable_by_key(|&i| all[i].0);
        let same = |&i: &usize, &j: &usize| (all[i].0.0, all[i].0.1) == (all[j].0.0, all[j].0.1);
        let mut totals: Vec<P> = Vec::new();
        let mut total_of = vec![0; all.len()];
        for of_node in order.chunk_by(same) {
            let mut total = all[of_node[0]].1.clone();
            for &i in &of_node[1..] {
                total.add(&all[i].1);
            }
            for &i in of_node {
                total_of[i] = totals.len();
            }
            totals.push(total);
        }
        let mut next = total_of.into_iter();
        let mut own = own.into_iter();
        for (block, stress) in stresses.values_mut() {
            for recovery in &mut stress.recoveries {
                // Own parts come first, in this very order.
                for (place, total) in own.next().into_iter().flatten().zip(&mut next) {
                    set(recovery, block, place, totals[total].clone());
                }
            }
        }
    }
}

/// The estimate over all cells, on the root. Collective.
pub fn error_estimate(comm: &Comm, stresses: &OnBlocks<Stress>, plan: &Plan) -> CellError {
    let mut total = CellError::default();
    comm.gather(
        &plan.owners(),
        |b| {
            let mut sum = CellError::default();
            for &error in stresses.get(&b).iter().flat_map(|s| &s.errors) {
                sum.add(error);
            }
            sum
        },
        |_, sum| total.add(sum),
    );
    total
}

/// The largest strain of a cell, and the block that has it, on the root; of equal ones the first. Collective.
pub fn largest_strain(
    comm: &Comm,
    stresses: &OnBlocks<Stress>,
    plan: &Plan,
) -> (BlockId, LargestStrain) {
    let mut largest = (BlockId::new(0), LargestStrain::default());
    comm.gather(
        &plan.owners(),
        |b| (stresses.get(&b)).map_or_else(LargestStrain::default, |s| s.largest_strain),
        |b, strain: LargestStrain| {
            if largest.1.add(strain) {
                largest.0 = b;
            }
        },
    );
    largest
}
