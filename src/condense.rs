//! Assembly and condensation of the blocks of this rank.

pub mod blocks;
pub mod clusters;
mod conditions;
pub mod interface;
pub mod limits;
pub mod substitute;
pub mod tree;

use contact_dd_partition::id::{BlockId, TreeNodeId};
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::mesh::topology::Topology;
use contact_dd_partition::problem::Catalog;
use nalgebra::{DMatrix, DVector};

use crate::condense::blocks::{CondensedBlock, CondensedBlocks};
use crate::context::Context;
use crate::context::Loads;
use crate::context::hierarchy::jumps;
use crate::error::Failure;
use crate::fem::assembly::FixingDof;
use crate::fem::assembly::assemble;
use crate::fem::block::Block;
use crate::fem::body_frame::BodyFrame;
use crate::fem::dofs::{Dofs, TooManyUnknowns};
use crate::schur::condensed::Condensed;
use crate::schur::factor::FactorError;
use crate::schur::local::LocalSchur;
use crate::schur::substitution::Replaced;

/// Smallest squared resistance of the held directions to a rigid motion of a block, relative to the largest, that holds
/// the block.
const HELD: f64 = 1e-12;

/// The data of the condensation of any block.
#[derive(Clone, Copy)]
pub struct Condensation<'a> {
    /// The context of the run.
    pub context: Context<'a>,
    /// Loads on the blocks of this rank in the first load step.
    pub loads: &'a Loads,
    /// Springs that fix the free rigid-body motions.
    pub fixing_dofs: &'a [FixingDof],
}

impl Condensation<'_> {
    /// Assembles, factorizes and condenses block `number`; its factor, which back-substitution needs, goes into
    /// `condensed`.
    ///
    /// # Errors
    /// A block with a free rigid-body motion although its boundary is held, or a block that is too large.
    pub fn condense(
        &self,
        number: BlockId,
        block: &Block,
        condensed: &mut CondensedBlocks,
    ) -> Result<Condensed, Failure> {
        let Context {
            comm, catalog, par, ..
        } = self.context;
        let began = comm.times();
        let dofs = Dofs::new(block, &self.loads.blocks[&number])
            .map_err(|TooManyUnknowns| too_large(number))?;
        let fixing_dofs = fixing_dofs_of(number, self.fixing_dofs);
        let (stiffness, springs) = assemble(block, &dofs, &catalog.materials, &fixing_dofs)
            .ok_or_else(|| too_large(number))?;
        let assembled = comm.times();
        let condensed_block = match LocalSchur::new(&stiffness, dofs.interior, par) {
            Err(FactorError::Pivot(_)) if is_held(block, &fixing_dofs) => {
                LocalSchur::with_springs(&stiffness, dofs.interior, par)
            }
            other => other,
        };
        let (factor, s) = condensed_block.map_err(|error| match error {
            FactorError::Size => too_large(number),
            FactorError::Pivot(unknown) => free_motion(block, &dofs, unknown, catalog),
        })?;
        let of_block = Condensed {
            jumps: 0,
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
        condensed.seconds[0] += assembled - began;
        condensed.seconds[1] += comm.times() - assembled;
        Ok(of_block)
    }

    /// Traces that the jumps of the contact group at node v replace; none where the node has no group.
    ///
    /// # Errors
    /// A contact point none of whose unknowns can be replaced by its jump.
    pub fn replaced(&self, v: TreeNodeId) -> Result<Vec<Replaced>, Failure> {
        let Context { plan, groups, .. } = self.context;
        let Some((g, group)) = plan.group_of(v).and_then(|g| Some((g, groups.get(&g)?))) else {
            return Ok(Vec::new());
        };
        Ok(group.replaced(&jumps(&self.context, g, group)?))
    }
}

/// The fixing dofs of a block: node and component.
fn fixing_dofs_of(number: BlockId, all: &[FixingDof]) -> Vec<(u32, usize)> {
    let own = all
        .iter()
        .filter(|dof| dof.subdomain as usize == number.index());
    own.map(|dof| (dof.node, dof.component as usize)).collect()
}

/// True if fixing the boundary fixes the whole block: its cells are connected across facets, and every rigid motion
/// moves a node on Γ, a support or one of the `fixing_dofs`.
fn is_held(block: &Block, fixing_dofs: &[(u32, usize)]) -> bool {
    let mesh = Mesh {
        dim: block.dim,
        cells: block.subdomain.cells.clone(),
        points: block.points().to_vec(),
        ..Mesh::default()
    };
    if Topology::new(&mesh).pieces().iter().any(|&piece| piece > 0) {
        return false;
    }
    let axis = |k: usize| std::array::from_fn(|i| f64::from(i == k));
    let mut held: Vec<(u32, [f64; 3])> = Vec::new();
    for &(node, _) in &block.interface {
        match block.slides.get(&node) {
            Some(&normal) => held.push((node, normal)),
            None => held.extend((0..block.dim).map(|k| (node, axis(k)))),
        }
    }
    held.extend(fixing_dofs.iter().map(|&(node, k)| (node, axis(k))));
    let supports = block.subdomain.supports.iter();
    held.extend(supports.map(|support| (support.node, support.direction)));
    held.retain(|&(node, _)| (node as usize) < block.subdomain.cell_nodes());
    let bounds = |pick: fn(f64, f64) -> f64, from: f64| {
        let points = block.points().iter();
        points.fold([from; 3], |all, x| {
            std::array::from_fn(|k| pick(all[k], x[k]))
        })
    };
    let frame = BodyFrame::new(
        bounds(f64::min, f64::INFINITY),
        bounds(f64::max, -f64::INFINITY),
    );
    let count = BodyFrame::count(block.dim);
    let mut gram = DMatrix::zeros(count, count);
    for (node, direction) in held {
        let row = frame.action(block.dim, &block.points()[node as usize], &direction);
        let row = DVector::from_vec(row);
        gram += &row * row.transpose();
    }
    let eigenvalues = gram.symmetric_eigenvalues();
    eigenvalues.min() > HELD * eigenvalues.max()
}

fn too_large(subdomain: BlockId) -> Failure {
    Failure::internal(format!(
        "subdomain {subdomain}: its factor needs more memory than there is; expected more, smaller \
         subdomains"
    ))
}

fn free_motion(block: &Block, dofs: &Dofs, unknown: usize, catalog: &Catalog) -> Failure {
    let node = (0..block.nodes() as u32).find(|&node| {
        (0..block.dim).any(|c| {
            dofs.terms(node, c)
                .iter()
                .any(|&(dof, _)| dof as usize == unknown)
        })
    });
    let body = &catalog.bodies[block.subdomain.body].name;
    let tag = node.map_or(-1, |node| block.subdomain.node_tags[node as usize]);
    Failure::ill_posed(format!(
        "body '{body}': subdomain {} can move although its boundary is held (found at node {tag}); \
         expected supports or contact that hold it",
        block.subdomain.index
    ))
}
