//! Rigid motions of the bodies against fields on the nodes of the blocks, displacements and forces.

use contact_dd_partition::id::{BlockId, OnBlocks};
use contact_dd_partition::problem::Catalog;

use crate::context::Context;
use crate::fem::block::Block;
use crate::fem::body_frame::BodyFrame;
use crate::rigid::free_motion::FreeMotion;
use crate::rigid::projection::{BodyProducts, MotionProducts};
use crate::vector::axpy;

/// Kind of a field on nodes that several blocks share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// Every block has the full value, as of a displacement.
    Shared,
    /// Every block has a part, as of the forces that elements exert; the parts add up.
    Summed,
}

/// Rigid motions of the bodies.
#[derive(Clone, Copy)]
pub struct Motions<'a> {
    /// The rigid-body modes.
    pub list: &'a [FreeMotion],
    /// The frame of every body.
    pub frames: &'a [BodyFrame],
}

impl<'a> Motions<'a> {
    /// Makes a field orthogonal to every motion, in the Euclidean sense over the nodes of the bodies that take part.
    /// Collective.
    pub fn project(&self, context: &Context<'_>, kind: Field, fields: OnBlocks<&mut Vec<f64>>) {
        if self.list.is_empty() {
            return;
        }
        let products = self.products(context, kind, &fields);
        let found = (context.comm.is_root()).then(|| products.coefficients());
        let mut coefficients = found.unwrap_or_default();
        context.comm.broadcast(&mut coefficients);
        self.take_out(context, kind, &coefficients, fields);
    }

    /// The products of motions with each other and with a field, on the root. Collective.
    pub fn products(
        &self,
        context: &Context<'_>,
        kind: Field,
        fields: &OnBlocks<&mut Vec<f64>>,
    ) -> MotionProducts {
        let catalog = context.catalog;
        let dim = catalog.dim;
        let first_of = first_blocks(catalog);
        let zeros = || BodyProducts::zeros(BodyFrame::count(dim));
        let mut of_bodies: Vec<BodyProducts> = self.frames.iter().map(|_| zeros()).collect();
        context.comm.gather(
            &context.plan.owners(),
            |b| {
                let mut products = zeros();
                if let (Some(block), Some(field)) = (context.blocks.get(&b), fields.get(&b)) {
                    let is_first = first_in(block, b, &first_of);
                    let frame = &self.frames[block.subdomain.body];
                    for (node, x) in block.body_points().iter().enumerate() {
                        let moves = frame.moves(dim, x);
                        if is_first[node] {
                            products.add_node(&moves);
                        }
                        if is_first[node] || kind == Field::Summed {
                            products.add_value(&moves, &field[node * dim..(node + 1) * dim]);
                        }
                    }
                }
                products
            },
            |b, products| of_bodies[catalog.body_of(b)].add(&products),
        );
        let mut total = MotionProducts::zeros(self.list.len());
        for (shares, products) in self.shares().iter().zip(&of_bodies) {
            total.add_body(shares, products);
        }
        total
    }

    /// v ← v − Σ c z.
    pub fn take_out(
        &self,
        context: &Context<'_>,
        kind: Field,
        coefficients: &[f64],
        fields: OnBlocks<&mut Vec<f64>>,
    ) {
        let dim = context.catalog.dim;
        let first_of = first_blocks(context.catalog);
        let shares = self.shares();
        for (b, field) in fields {
            let Some(block) = context.blocks.get(&b) else {
                continue;
            };
            let body = block.subdomain.body;
            let mut taken = vec![0.0; BodyFrame::count(dim)];
            for &(motion, share) in shares.get(body).into_iter().flatten() {
                let c = coefficients.get(motion).copied().unwrap_or_default();
                axpy(c, share, &mut taken);
            }
            let is_first = first_in(block, b, &first_of);
            for (node, x) in block.body_points().iter().enumerate() {
                if kind == Field::Shared || is_first[node] {
                    let moved = self.frames[body].displacement(dim, x, &taken);
                    axpy(-1.0, &moved, &mut field[node * dim..(node + 1) * dim]);
                }
            }
        }
    }

    /// Displacements of every body in the motions that it takes part in, by their numbers.
    fn shares(&self) -> Vec<Vec<(usize, &'a [f64])>> {
        let mut shares = vec![Vec::new(); self.frames.len()];
        for (number, motion) in self.list.iter().enumerate() {
            for (body, z) in &motion.bodies {
                shares[*body].push((number, &z[..]));
            }
        }
        shares
    }
}

/// The lowest block at every node of several blocks.
fn first_blocks(catalog: &Catalog) -> Vec<BlockId> {
    let mut first = vec![BlockId::new(usize::MAX); catalog.interface_nodes];
    for (b, nodes) in (0..).map(BlockId::new).zip(&catalog.interface) {
        for &node in nodes {
            let first = &mut first[node as usize];
            *first = b.min(*first);
        }
    }
    first
}

/// Nodes of block b that belong to no lower one.
fn first_in(block: &Block, b: BlockId, first_of: &[BlockId]) -> Vec<bool> {
    let mut is_first = vec![true; block.nodes()];
    for on in &block.subdomain.interface {
        is_first[on.node as usize] = first_of[on.interface as usize] >= b;
    }
    is_first
}
