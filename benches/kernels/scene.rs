//! The blocks of a built-in scene, as one rank would have them.

use contact_dd_mpi::fem::assembly::assemble;
use contact_dd_mpi::fem::assembly::load;
use contact_dd_mpi::fem::block::Block;
use contact_dd_mpi::fem::dofs::Dofs;
use contact_dd_mpi::fem::load::BlockLoads;
use contact_dd_mpi::fem::prescribed::Prescribed;
use contact_dd_mpi::plan::Plan;
use contact_dd_mpi::plan::cluster::Merging;
use contact_dd_mpi::schur::condensed::Condensed;
use contact_dd_mpi::schur::local::{CondensedLoad, LocalSchur};
use contact_dd_mpi::schur::pattern::SparseSymmetric;
use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::example;
use contact_dd_partition::hierarchy::tree::Tree;
use contact_dd_partition::model::{Material, Model};
use contact_dd_partition::problem::{Catalog, Problem};
use faer::{Mat, Par};

/// A scene cut into subdomains.
pub struct Scene {
    pub catalog: Catalog,
    pub plan: Plan,
    pub blocks: Vec<Block>,
}

impl Scene {
    /// The granite scene, its cells cut in four `refine` times, in `count` subdomains.
    pub fn granite(refine: u32, count: usize) -> Self {
        let (scene, mesh) = example::find("granite").unwrap().make(refine).unwrap();
        let model = Model::new(&scene, mesh).unwrap();
        let decomposition = Decomposition::new(&model, Some(count)).unwrap();
        let problem = Problem::new(&model, &decomposition).unwrap();
        let plan = Plan::new(
            &problem.catalog,
            &Tree::new(&problem.catalog),
            1,
            Merging::All,
        );
        let dim = problem.catalog.dim;
        let block = |subdomain| Block::new(subdomain, &plan.tree, dim);
        let blocks = problem.subdomains.into_iter().map(block).collect();
        Self {
            catalog: problem.catalog,
            plan,
            blocks,
        }
    }

    pub fn materials(&self) -> &[Material] {
        &self.catalog.materials
    }

    /// The largest subdomain without contact.
    pub fn largest_linear(&self) -> usize {
        let subdomains = &self.catalog.subdomains;
        let linear = (0..self.blocks.len()).filter(|&b| subdomains[b].group.is_none());
        linear.max_by_key(|&b| self.blocks[b].nodes()).unwrap()
    }

    /// The loads on a block.
    pub fn loads(&self, b: usize) -> BlockLoads {
        BlockLoads::new(&self.blocks[b], 0)
    }

    /// Displacements that supports prescribe in it.
    pub fn prescribed(&self, b: usize) -> Prescribed {
        Prescribed::new(&self.blocks[b], &self.loads(b))
    }

    /// A block's unknowns and stiffness.
    pub fn assembled(&self, b: usize) -> (Dofs, SparseSymmetric) {
        let block = &self.blocks[b];
        let dofs = Dofs::new(block, &self.loads(b)).unwrap();
        let (stiffness, _) = assemble(block, &dofs, self.materials(), &[]).unwrap();
        (dofs, stiffness)
    }

    /// A block condensed onto its boundary.
    pub fn condensed(&self, b: usize) -> (Dofs, LocalSchur, Mat<f64>, CondensedLoad) {
        let (dofs, stiffness) = self.assembled(b);
        let (schur, s) = LocalSchur::new(&stiffness, dofs.interior, Par::Seq).unwrap();
        let (block, loads) = (&self.blocks[b], self.loads(b));
        let prescribed = self.prescribed(b);
        let load = load(block, &loads, &dofs, &prescribed, self.materials(), &[]);
        let load = schur.condense(load);
        (dofs, schur, s, load)
    }

    /// A condensed block in the form that a merge takes.
    pub fn of_block(&self, b: usize) -> Condensed {
        let (dofs, schur, s, _) = self.condensed(b);
        Condensed {
            jumps: 0,
            interface_dofs: dofs.interface_dofs.clone(),
            smallest_pivot: schur.smallest_pivot(),
            diagonal: schur.diagonal,
            s,
        }
    }
}
