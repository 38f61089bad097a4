//! Stresses, and the results on their way to the root and into the file.

use std::collections::{BTreeMap, HashMap};

use contact_dd_partition::element::{ElementKind, Elements};
use contact_dd_partition::error::OutputError;
use contact_dd_partition::problem::Catalog;

use super::read::OwnedBlock;
use super::recover::BlockSolution;
use crate::comm::{Comm, Message, MessageReader};
use crate::fem::elasticity::{principal_stresses, von_mises};
use crate::fem::stress::{BlockStress, StressSum};
use crate::output::result::{ContactResult, SubdomainResult};
use crate::output::vtkhdf::ResultFile;
use crate::plan::Plan;

/// Stresses of this rank's blocks; what blocks share at nodes of Γ is summed over all of them by
/// the root. Collective.
pub fn stresses(
    comm: &Comm,
    blocks: &BTreeMap<usize, OwnedBlock>,
    solutions: &BTreeMap<usize, BlockSolution>,
    catalog: &Catalog,
    plan: &Plan,
) -> BTreeMap<usize, BlockStress> {
    let mut stresses: BTreeMap<usize, BlockStress> = solutions
        .iter()
        .filter_map(|(b, solution)| {
            let block = &blocks.get(b)?.block;
            let stress = BlockStress::new(block, &catalog.materials, catalog.plane, &solution.u);
            Some((*b, stress))
        })
        .collect();
    let owners = plan.owners();
    let mut totals: HashMap<(i64, i64), StressSum> = HashMap::new();
    let mut asked: Vec<Vec<(i64, i64)>> = Vec::new();
    comm.gather(
        &owners,
        |b| {
            let mut message = Message::default();
            if let (Some(stress), Some(owned)) = (stresses.get(&b), blocks.get(&b)) {
                for (node, material, sum) in stress.shared(&owned.block) {
                    message
                        .integers
                        .extend([i64::from(node), i64::from(material)]);
                    message.reals.extend(sum.stress);
                    message.reals.push(sum.area);
                }
            }
            message
        },
        |_, message| {
            let keys: Vec<(i64, i64)> = message.integers.chunks(2).map(|k| (k[0], k[1])).collect();
            for (key, sum) in keys.iter().zip(message.reals.chunks(7)) {
                totals.entry(*key).or_default().add(&stress_sum(sum));
            }
            asked.push(keys);
        },
    );
    comm.scatter(
        &owners,
        |b| {
            let mut message = Message::default();
            for key in &asked[b] {
                let sum = totals.get(key).copied().unwrap_or_default();
                message.reals.extend(sum.stress);
                message.reals.push(sum.area);
            }
            message
        },
        |b, message| {
            let sums: Vec<StressSum> = message.reals.chunks(7).map(stress_sum).collect();
            if let (Some(stress), Some(owned)) = (stresses.get_mut(&b), blocks.get(&b)) {
                stress.set_shared(&owned.block, &sums);
            }
        },
    );
    stresses
}

fn stress_sum(values: &[f64]) -> StressSum {
    let mut sum = StressSum::default();
    sum.stress.copy_from_slice(&values[..6]);
    sum.area = values[6];
    sum
}

/// What this rank's blocks have found.
#[derive(Clone, Copy, Debug)]
pub struct Fields<'a> {
    /// Solutions, without the bodies' descent.
    pub solutions: &'a BTreeMap<usize, BlockSolution>,
    /// Displacement with it, node by node (m).
    pub displacement: &'a BTreeMap<usize, Vec<f64>>,
    /// Stresses.
    pub stress: &'a BTreeMap<usize, BlockStress>,
}

/// Streams all subdomains and contact rows to the root, which writes each as it arrives.
/// Collective; `file` is the root's.
///
/// # Errors
/// The file can't be written. All messages have arrived even then.
pub fn write_solution(
    comm: &Comm,
    blocks: &BTreeMap<usize, OwnedBlock>,
    fields: Fields<'_>,
    plan: &Plan,
    mut file: Option<&mut ResultFile>,
) -> Result<(), OutputError> {
    let mut failed = Ok(());
    let mut write = |write: &mut dyn FnMut(&mut ResultFile) -> Result<(), OutputError>| {
        if let (Some(file), Ok(())) = (file.as_deref_mut(), &failed) {
            failed = write(file);
        }
    };
    let owner_of = |s: usize| plan.blocks[plan.block_of[s]].owner;
    let owners: Vec<usize> = (0..plan.block_of.len()).map(owner_of).collect();
    comm.gather(
        &owners,
        |s| {
            let b = plan.block_of[s];
            let (Some(owned), Some(displacement), Some(stress)) = (
                blocks.get(&b),
                fields.displacement.get(&b),
                fields.stress.get(&b),
            ) else {
                return Message::default();
            };
            pack_subdomain(owned, displacement, stress, s)
        },
        |s, message| {
            let result = unpack_subdomain(s, message);
            write(&mut |file| file.write_subdomain(&result));
        },
    );
    comm.gather(
        &plan.pair_owners(),
        |p| {
            let b = plan.pairs[p];
            match (blocks.get(&b), fields.solutions.get(&b)) {
                (Some(owned), Some(solution)) => pack_contacts(owned, solution),
                _ => Message::default(),
            }
        },
        |_, message| {
            let rows = unpack_contacts(message);
            write(&mut |file| file.write_contacts(&rows));
        },
    );
    failed
}

fn pack_subdomain(
    owned: &OwnedBlock,
    displacement: &[f64],
    stress: &BlockStress,
    index: usize,
) -> Message {
    let block = &owned.block;
    let mut message = Message::default();
    let Some(m) = block.member(index) else {
        return message;
    };
    let member = &block.members[m];
    let first_cell: usize = block.members[..m].iter().map(|o| o.cells.len()).sum();
    let cells = &stress.cells[first_cell..first_cell + member.cells.len()];
    let integers = &mut message.integers;
    integers.extend([member.points.len() as i64, member.cells.len() as i64]);
    integers.extend(&member.node_tags);
    for (e, (kind, nodes)) in member.cells.iter().enumerate() {
        integers.extend([i64::from(kind.vtk()), i64::from(member.cell_material[e])]);
        integers.extend(nodes.iter().map(|&n| i64::from(n)));
    }
    let reals = &mut message.reals;
    reals.extend(member.points.iter().flatten());
    for &node in &block.node_of[m] {
        let start = node as usize * block.dim;
        let mut u = [0.0; 3];
        u[..block.dim].copy_from_slice(&displacement[start..start + block.dim]);
        reals.extend(u);
    }
    reals.extend(stress.at_nodes(block, m).iter().flatten());
    reals.extend(cells.iter().flatten());
    reals.extend(cells.iter().flat_map(principal_stresses));
    reals.extend(cells.iter().map(von_mises));
    message
}

fn unpack_subdomain(index: usize, message: Message) -> SubdomainResult {
    fn tuples<const N: usize>(reader: &mut MessageReader, n: usize) -> Vec<[f64; N]> {
        (0..n)
            .map(|_| std::array::from_fn(|_| reader.real()))
            .collect()
    }
    let mut reader = message.read();
    let (n, m) = (reader.count(), reader.count());
    let node_tags = reader.integers(n);
    let mut cells = Elements::default();
    let mut cell_material = Vec::with_capacity(m);
    for _ in 0..m {
        // The owner sent a kind that it has read as one.
        let kind = ElementKind::from_vtk(reader.integer() as u8).unwrap_or(ElementKind::Triangle3);
        cell_material.push(reader.integer() as u32);
        let nodes: Vec<u32> = reader
            .integers(kind.nodes())
            .iter()
            .map(|&n| n as u32)
            .collect();
        cells.push(kind, &nodes);
    }
    SubdomainResult {
        index,
        points: tuples(&mut reader, n),
        node_tags,
        cells,
        cell_material,
        displacement: tuples(&mut reader, n),
        nodal_stress: tuples(&mut reader, n),
        cell_stress: tuples(&mut reader, m),
        principal: tuples(&mut reader, m),
        von_mises: reader.reals(m),
    }
}

fn pack_contacts(owned: &OwnedBlock, solution: &BlockSolution) -> Message {
    let mut message = Message::default();
    for (j, (row, condition)) in owned.rows.iter().zip(&owned.conditions).enumerate() {
        let gap = if solution.closed[j] {
            0.0
        } else {
            condition.gap_left(owned.block.dim, &solution.u).max(0.0)
        };
        message.integers.extend([
            i64::from(row.contact),
            i64::from(row.place),
            row.tag_a,
            row.tag_b,
            i64::from(solution.closed[j]),
        ]);
        message.reals.extend(row.position);
        message.reals.extend(row.normal);
        message
            .reals
            .extend([gap, solution.forces[j], solution.forces[j] / row.share]);
    }
    message
}

fn unpack_contacts(message: Message) -> Vec<ContactResult> {
    let integers = message.integers.chunks(5);
    let reals = message.reals.chunks(9);
    integers
        .zip(reals)
        .map(|(i, r)| ContactResult {
            contact: i[0] as usize,
            place: i[1] as usize,
            tag_a: i[2],
            tag_b: i[3],
            position: [r[0], r[1], r[2]],
            normal: [r[3], r[4], r[5]],
            gap: r[6],
            force: r[7],
            pressure: r[8],
            closed: i[4] != 0,
        })
        .collect()
}
