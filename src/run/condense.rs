//! Assembling and condensing the blocks of this rank, and bringing them together at the root.

use std::collections::BTreeMap;
use std::time::Instant;

use contact_dd_partition::problem::Catalog;
use faer::{Mat, Par};

use super::read::OwnedBlock;
use crate::comm::{Comm, Message};
use crate::contact::approach::{ApproachOf, defining_conditions};
use crate::contact::law::PairLaw;
use crate::contact::pair::{ContactPair, Limits};
use crate::error::Failure;
use crate::fem::assembly::assemble;
use crate::fem::block::Block;
use crate::fem::dofs::{DofError, Dofs, TraceDof};
use crate::interface::coupled::MAX_APPROACHES;
use crate::interface::numbering::Numbering;
use crate::interface::operator::{Contribution, Interface};
use crate::output::progress::Progress;
use crate::plan::Plan;
use crate::rigid::analysis::Pin;
use crate::rigid::energy::{RigidBasis, RigidDrive};
use crate::rigid::survey::Survey;
use crate::schur::factor::FactorError;
use crate::schur::local::{CondensedLoad, LinearSubdomain, LocalSchur};

/// The condensed blocks of this rank.
#[derive(Debug, Default)]
pub struct CondensedBlocks {
    /// The unknowns of every block.
    pub dofs: BTreeMap<usize, Dofs>,
    /// The diagonal of every block's stiffness (Pa).
    pub diagonals: BTreeMap<usize, Vec<f64>>,
    /// T: the subdomains without contact, by block.
    pub linear: BTreeMap<usize, LinearSubdomain>,
    /// ϑ: the pairs in contact, by their place among all pairs.
    pub pairs: BTreeMap<usize, ContactPair>,
    /// Time for assembling and for factorizing (s).
    pub seconds: [f64; 2],
}

/// Assembles, factorizes and condenses this rank's blocks.
///
/// # Errors
/// A block that can move although its boundary is held, or a condition on Γ.
pub fn condense_blocks(
    blocks: &BTreeMap<usize, OwnedBlock>,
    catalog: &Catalog,
    plan: &Plan,
    survey: &Survey,
    progress: &Progress,
    par: Par,
) -> Result<CondensedBlocks, Failure> {
    let mut condensed = CondensedBlocks::default();
    for (&number, owned) in blocks {
        let began = Instant::now();
        let OwnedBlock {
            block, conditions, ..
        } = owned;
        let dofs = Dofs::new(block, conditions, &catalog.materials)
            .map_err(|error| dof_failure(error, owned, catalog))?;
        let system = assemble(
            block,
            &dofs,
            &catalog.materials,
            &pins_of(block, &survey.motions.pins),
        )
        .ok_or_else(|| size(plan, number))?;
        let assembled = Instant::now();
        let mut schur =
            LocalSchur::new(&system, dofs.interior, par).map_err(|error| match error {
                FactorError::Size => size(plan, number),
                FactorError::Pivot(unknown) => moves(owned, &dofs, unknown, catalog),
            })?;
        let mut load = schur.condense(system.load);
        match plan.pair_of(number) {
            Some(pair) => {
                let limits = limits(owned, &dofs, catalog)?;
                if let Some(drive) = survey.inner_motions.get(&pair) {
                    settle_rigid_motions(&mut schur, &mut load, &dofs, drive);
                }
                condensed
                    .pairs
                    .insert(pair, ContactPair::new(schur, load, limits));
            }
            None => {
                condensed
                    .linear
                    .insert(number, LinearSubdomain { schur, load });
            }
        }
        (condensed.diagonals).insert(number, system.stiffness.diagonal().to_vec());
        condensed.dofs.insert(number, dofs);
        condensed.seconds[0] += (assembled - began).as_secs_f64();
        condensed.seconds[1] += assembled.elapsed().as_secs_f64();
        progress.advance();
    }
    Ok(condensed)
}

/// Makes a pair's S and load on its approaches exact along rigid motions of the bodies that lie wholly
/// in it; `drive` is that of its conditions.
fn settle_rigid_motions(
    schur: &mut LocalSchur,
    load: &mut CondensedLoad,
    dofs: &Dofs,
    drive: &RigidDrive,
) {
    let defining = defining_conditions(&dofs.approach_of, dofs.approaches);
    let m = defining.len();
    let columns = drive.rows.ncols();
    let of_approaches = RigidDrive {
        rows: Mat::from_fn(m, columns, |i, k| drive.rows[(defining[i], k)]),
        load: drive.load.clone(),
    };
    let basis = RigidBasis::new(&of_approaches, &schur.stiffness[..m]);
    let mut h = schur.s.submatrix(0, 0, m, m).to_owned();
    basis.remove_energy(&mut h);
    schur.s.submatrix_mut(0, 0, m, m).copy_from(&h);
    for j in m..schur.s.ncols() {
        let mut column: Vec<f64> = (0..m).map(|i| schur.s[(i, j)]).collect();
        basis.remove_load(&mut column);
        for (i, s) in column.into_iter().enumerate() {
            schur.s[(i, j)] = s;
            schur.s[(j, i)] = s;
        }
    }
    basis.set_load(&mut load.boundary_mut()[..m]);
}

/// The pins that lie in a block: node and component.
fn pins_of(block: &Block, pins: &[Pin]) -> Vec<(u32, usize)> {
    pins.iter()
        .filter_map(|pin| {
            let m = block.member(pin.subdomain as usize)?;
            let node = block.node_of[m][pin.node as usize];
            Some((node, pin.component as usize))
        })
        .collect()
}

/// The bounds on a block's approaches.
fn limits(owned: &OwnedBlock, dofs: &Dofs, catalog: &Catalog) -> Result<Limits, Failure> {
    let scale = prescribed_scale(owned);
    for (j, of) in dofs.approach_of.iter().enumerate() {
        let gap = owned.conditions[j].gap;
        if let &ApproachOf::Prescribed(approach) = of
            && approach > gap + 1e-12 * scale
        {
            let row = &owned.rows[j];
            let contact = &catalog.contacts[row.contact as usize].name;
            return Err(Failure::input(format!(
                "contact '{contact}': nodes {} and {} are prescribed to penetrate by {:.3e}; \
                 expected displacements that leave a gap",
                row.tag_a,
                row.tag_b,
                approach - gap
            )));
        }
    }
    let gaps: Vec<f64> = owned.conditions.iter().map(|c| c.gap).collect();
    Ok(Limits::new(
        dofs.approaches,
        &dofs.approach_of,
        &gaps,
        scale,
    ))
}

/// The largest displacement that is prescribed in a block, initial gaps among them (m).
fn prescribed_scale(owned: &OwnedBlock) -> f64 {
    let prescribed = owned
        .block
        .members
        .iter()
        .flat_map(|m| m.supports.iter().map(|s| s.value.abs()));
    let gaps = owned.conditions.iter().map(|c| c.gap.abs());
    prescribed.chain(gaps).fold(0.0, f64::max)
}

fn size(plan: &Plan, number: usize) -> Failure {
    Failure::internal(format!(
        "subdomain {}: its factor needs more memory than there is; expected more, smaller \
         subdomains",
        plan.blocks[number].subdomains[0]
    ))
}

fn dof_failure(error: DofError, owned: &OwnedBlock, catalog: &Catalog) -> Failure {
    let DofError::OnInterface(j) = error else {
        return Failure::internal("a subdomain has more than 2^32 unknowns");
    };
    let row = &owned.rows[j];
    let contact = &catalog.contacts[row.contact as usize].name;
    Failure::input(format!(
        "contact '{contact}': the condition between nodes {} and {} lies where subdomains are bonded; \
         expected a partition whose interface doesn't meet contact",
        row.tag_a, row.tag_b
    ))
}

fn moves(owned: &OwnedBlock, dofs: &Dofs, unknown: usize, catalog: &Catalog) -> Failure {
    let block = &owned.block;
    let node = (0..block.nodes() as u32).find(|&node| {
        (0..block.dim).any(|c| {
            dofs.terms(node, c)
                .iter()
                .any(|&(dof, _)| dof as usize == unknown)
        })
    });
    let body = &catalog.bodies[block.members[0].body].name;
    let tag = node.map_or(-1, |node| block.tags[node as usize]);
    Failure::ill_posed(format!(
        "body '{body}': subdomain {} can move although its boundary is held (found at node {tag}); \
         expected supports or contact that hold it",
        block.members[0].index
    ))
}

/// Numbers Γ and assembles S_0, F and the bilateral operator on the root. Collective; the other
/// ranks get nothing.
///
/// # Errors
/// Supports that differ between subdomains, or a singular bilateral problem.
pub fn assemble_interface(
    comm: &Comm,
    blocks: &CondensedBlocks,
    catalog: &Catalog,
    plan: &Plan,
    survey: &Survey,
    par: Par,
) -> Result<Option<(Numbering, Interface)>, Failure> {
    let owners = plan.owners();
    let with_laws = with_laws(catalog);
    let mut traces: Vec<Vec<TraceDof>> = Vec::new();
    let mut contributions: Vec<Contribution> = Vec::new();
    comm.gather(
        &owners,
        |b| pack(blocks, plan, b, with_laws),
        |_, message| {
            let (list, contribution) = unpack(message);
            traces.push(list);
            contributions.push(contribution);
        },
    );
    if !comm.is_root() {
        return Ok(None);
    }
    let nodes: Vec<Vec<u32>> = (0..plan.blocks.len())
        .map(|b| plan.shared_nodes(catalog, b))
        .collect();
    let is_pair: Vec<bool> = plan.blocks.iter().map(|b| b.group.is_some()).collect();
    let numbering = Numbering::new(&traces, &nodes, &is_pair)?;
    let motions = motions_of_approaches(survey, &contributions);
    let interface = Interface::new(&numbering, contributions, &is_pair, &motions, par)?;
    Ok(Some((numbering, interface)))
}

/// The approaches of all pairs against the motions that supports leave to the bodies.
fn motions_of_approaches(survey: &Survey, contributions: &[Contribution]) -> RigidDrive {
    let Some(scene) = survey.scene.as_ref().filter(|_| survey.movable) else {
        return RigidDrive::default();
    };
    let laws = contributions.iter().filter_map(|c| c.law.as_ref());
    let defining: Vec<usize> = laws
        .zip(scene.first_conditions())
        .flat_map(|(law, first)| law.defining.iter().map(move |j| first + j))
        .collect();
    scene.against(&defining)
}

/// Whether the pairs have few enough conditions for the root to solve for all of them at once.
fn with_laws(catalog: &Catalog) -> bool {
    let conditions: usize = catalog.contacts.iter().map(|c| c.conditions).sum();
    conditions <= MAX_APPROACHES
}

fn pack(blocks: &CondensedBlocks, plan: &Plan, b: usize, with_laws: bool) -> Message {
    let mut message = Message::default();
    let Some(dofs) = blocks.dofs.get(&b) else {
        return message;
    };
    let pair = plan.pair_of(b).and_then(|p| blocks.pairs.get(&p));
    message.integers.push(dofs.traces.len() as i64);
    message
        .integers
        .push(i64::from(with_laws && pair.is_some()));
    for dof in &dofs.traces {
        message
            .integers
            .extend([i64::from(dof.node), i64::from(dof.axis)]);
    }
    if let Some(pair) = pair {
        message.push_lower(pair.bilateral());
        message.reals.extend(pair.bilateral_load());
        message.reals.push(pair.schur().smallest_pivot());
        if with_laws {
            PairLaw::pack(
                pair,
                &defining_conditions(&dofs.approach_of, dofs.approaches),
                &mut message,
            );
        }
    } else if let Some(LinearSubdomain { schur, load }) = blocks.linear.get(&b) {
        message.push_lower(schur.s.as_ref());
        message.reals.extend(load.boundary());
        message.reals.push(schur.smallest_pivot());
    }
    message
}

fn unpack(message: Message) -> (Vec<TraceDof>, Contribution) {
    let mut reader = message.read();
    let n = reader.count();
    let has_law = reader.integer() != 0;
    let traces = (0..n)
        .map(|_| TraceDof {
            node: reader.integer() as u32,
            axis: reader.integer() as u32,
        })
        .collect();
    let s: Mat<f64> = reader.lower(n);
    let load = reader.reals(n);
    let contribution = Contribution {
        s,
        load,
        smallest_pivot: reader.real(),
        law: has_law.then(|| PairLaw::unpack(&mut reader, n)),
    };
    (traces, contribution)
}
