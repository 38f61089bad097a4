//! Assembling and condensing the blocks of this rank.

pub mod blocks;
pub mod clusters;
mod conditions;
pub mod interface;
pub mod limits;
pub mod substitute;
pub mod tree;

use std::time::Instant;

use contact_dd_partition::problem::Catalog;

use crate::condense::blocks::{CondensedBlock, CondensedBlocks};
use crate::context::Context;
use crate::context::Loads;
use crate::error::Failure;
use crate::fem::assembly::assemble;
use crate::fem::block::{Block, OwnedBlock};
use crate::fem::dofs::{DofError, Dofs};
use crate::plan::Plan;
use crate::rigid::analysis::FixingDof;
use crate::schur::condensed::Condensed;
use crate::schur::factor::FactorError;
use crate::schur::local::LocalSchur;

/// What is needed to condense any block.
#[derive(Clone, Copy)]
pub struct Condensation<'a> {
    /// What the run works on.
    pub context: Context<'a>,
    /// What acts on the blocks of this rank in the first load step.
    pub loads: &'a Loads,
    /// Springs that hold what nothing else does.
    pub fixing_dofs: &'a [FixingDof],
}

impl Condensation<'_> {
    /// Assembles, factorizes and condenses block `number`; what stays behind goes into `condensed`.
    ///
    /// # Errors
    /// A block that can move although its boundary is held, or a contact point on Γ.
    pub fn condense(
        &self,
        number: usize,
        owned: &OwnedBlock,
        condensed: &mut CondensedBlocks,
    ) -> Result<Condensed, Failure> {
        let began = Instant::now();
        let Context {
            catalog, plan, par, ..
        } = self.context;
        let block = &owned.block;
        let dofs = Dofs::new(owned, &self.loads[&number], &catalog.materials)
            .map_err(|error| dof_failure(error, owned, catalog))?;
        let fixing_dofs = pins_of(block, self.fixing_dofs);
        let (stiffness, springs) = assemble(block, &dofs, &catalog.materials, &fixing_dofs)
            .ok_or_else(|| size(plan, number))?;
        let assembled = Instant::now();
        let (factor, s) =
            LocalSchur::new(&stiffness, dofs.interior, par).map_err(|error| match error {
                FactorError::Size => size(plan, number),
                FactorError::Pivot(unknown) => moves(owned, &dofs, unknown, catalog),
            })?;
        let of_block = Condensed {
            jumps: dofs.jumps,
            interface_dofs: dofs.interface_dofs.clone(),
            s,
            diagonal: factor.diagonal.clone(),
            smallest_pivot: factor.smallest_pivot(),
        };
        let stays = CondensedBlock {
            dofs,
            diagonal: stiffness.diagonal().to_vec(),
            springs,
            factor,
        };
        condensed.blocks.insert(number, stays);
        condensed.seconds[0] += (assembled - began).as_secs_f64();
        condensed.seconds[1] += assembled.elapsed().as_secs_f64();
        Ok(of_block)
    }
}

/// The pins that lie in a block: node and component.
fn pins_of(block: &Block, fixing_dofs: &[FixingDof]) -> Vec<(u32, usize)> {
    fixing_dofs
        .iter()
        .filter_map(|fixing_dof| {
            let m = block.member(fixing_dof.subdomain as usize)?;
            let node = block.node_of[m][fixing_dof.node as usize];
            Some((node, fixing_dof.component as usize))
        })
        .collect()
}

fn size(plan: &Plan, number: usize) -> Failure {
    Failure::internal(format!(
        "subdomain {}: its factor needs more memory than there is; expected more, smaller \
         subdomains",
        plan.blocks[number].subdomains[0]
    ))
}

pub(crate) fn dof_failure(error: DofError, owned: &OwnedBlock, catalog: &Catalog) -> Failure {
    let DofError::OnInterface(j) = error else {
        return Failure::internal("a subdomain has more than 2^32 unknowns");
    };
    let point = &owned.points[j];
    let contact = &catalog.contacts[point.contact as usize].name;
    Failure::input(format!(
        "contact '{contact}': the condition between nodes {} and {} lies where subdomains are bonded; \
         expected a partition whose interface doesn't meet contact",
        point.tag_a, point.tag_b
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
