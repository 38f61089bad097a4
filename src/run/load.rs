//! The right-hand side of a load step: f condensed onto Γ, and the bounds on approaches.

use std::collections::BTreeMap;

use contact_dd_partition::problem::Catalog;

use super::clusters::settle_load;
use super::condense::dof_failure;
use super::condensed_blocks::CondensedBlocks;
use super::limits::limits_of_clusters;
use super::substitute::Factors;
use crate::comm::{Comm, Message};
use crate::error::Failure;
use crate::fem::load::load;
use crate::fem::owned::OwnedBlock;
use crate::interface::numbering::Numbering;
use crate::interface::operator::{ClusterLoad, Interface};
use crate::plan::Plan;
use crate::rigid::energy::RigidDrive;
use crate::rigid::survey::Survey;
use crate::schur::local::CondensedLoad;

/// What loads follow from beside the factors.
#[derive(Clone, Copy)]
pub struct Loading<'a> {
    /// All ranks.
    pub comm: &'a Comm,
    /// The problem.
    pub catalog: &'a Catalog,
    /// Who owns what.
    pub plan: &'a Plan,
    /// The blocks of this rank, with the supports, forces and gaps of the step.
    pub blocks: &'a BTreeMap<usize, OwnedBlock>,
    /// The rigid motions in the step.
    pub survey: &'a Survey,
}

impl Loading<'_> {
    /// Gives unknowns their constants and clusters in contact the bounds on their approaches, both of which
    /// were made for another step. Collective.
    ///
    /// # Errors
    /// Supports that make two sides penetrate.
    pub fn prescribe(&self, condensed: &mut CondensedBlocks) -> Result<(), Failure> {
        let &Self {
            comm,
            catalog,
            plan,
            blocks,
            ..
        } = self;
        let materials = &catalog.materials;
        let prescribed = condensed.dofs.iter_mut().try_for_each(|(b, dofs)| {
            let Some(owned) = blocks.get(b) else {
                return Ok(());
            };
            dofs.prescribe(&owned.block, &owned.points, &owned.gaps, materials)
                .map_err(|error| dof_failure(error, owned, catalog))
        });
        comm.agree(prescribed)?;
        for (p, limits) in limits_of_clusters(comm, plan, catalog, blocks, condensed)? {
            if let Some(pair) = condensed.pairs.get_mut(&p) {
                pair.set_limits(limits);
            }
        }
        Ok(())
    }

    /// Condenses the loads of all blocks up the hierarchy, f_Γ − K_ΓI K_II⁻¹ f_I, and gives clusters in
    /// contact theirs; returns the load of every node of this rank. Collective.
    pub fn condense(&self, condensed: &mut CondensedBlocks) -> BTreeMap<usize, CondensedLoad> {
        let &Self {
            comm,
            catalog,
            plan,
            blocks,
            survey,
        } = self;
        let of_block = |(&b, owned): (&usize, &OwnedBlock)| {
            let dofs = condensed.dofs.get(&b)?;
            let springs = condensed.springs.get(&b)?;
            Some((b, load(&owned.block, dofs, &catalog.materials, springs)))
        };
        let loads = blocks.iter().filter_map(of_block).collect();
        let factors = Factors {
            comm,
            plan,
            condensed,
        };
        let loads = factors.condense(loads);
        for (p, pair) in &mut condensed.pairs {
            let Some(load) = loads.get(&plan.clusters[plan.contact[*p]].node) else {
                continue;
            };
            let mut load = load.boundary().to_vec();
            if let Some(drive) = survey.inner_motions.get(p) {
                let limits = pair.limits();
                let on_approaches = &mut load[..limits.approaches()];
                settle_load(on_approaches, &limits.defining, drive, pair.diagonal());
            }
            pair.set_load(load);
        }
        loads
    }

    /// Assembles F of the clusters' `loads` on the root, which holds the `interface` problem. Collective.
    pub fn assemble(
        &self,
        condensed: &CondensedBlocks,
        loads: &BTreeMap<usize, CondensedLoad>,
        interface: Option<&mut (Numbering, Interface)>,
    ) {
        let plan = self.plan;
        let mut of_clusters = Vec::new();
        self.comm.gather(
            &plan.cluster_owners(),
            |c| {
                let mut message = Message::default();
                let pair = plan.contact_place(c).and_then(|p| condensed.pairs.get(&p));
                if let Some(pair) = pair {
                    message.reals.push(pair.limits().scale);
                    message.reals.extend(pair.bilateral_load());
                } else if let Some(load) = loads.get(&plan.clusters[c].node) {
                    message.reals.push(0.0);
                    message.reals.extend(load.boundary());
                }
                message
            },
            |_, message| {
                let traces = message.reals.len() - 1;
                let mut reader = message.read();
                of_clusters.push(ClusterLoad {
                    scale: reader.real(),
                    load: reader.reals(traces),
                });
            },
        );
        if let Some((numbering, interface)) = interface {
            let drive = self.drive_of_approaches(interface);
            interface.prescribe(numbering, &of_clusters, &drive);
        }
    }

    /// The approaches of all pairs against the motions that supports leave to the bodies.
    fn drive_of_approaches(&self, interface: &Interface) -> RigidDrive {
        let scene = self.survey.scene.as_ref();
        let Some(scene) = scene.filter(|_| self.survey.movable) else {
            return RigidDrive::default();
        };
        let plan = self.plan;
        let defining: Vec<usize> = (interface.laws.iter().zip(&plan.contact))
            .flat_map(|(law, &c)| {
                let conditions = scene.conditions_of(&plan.clusters[c].groups);
                law.defining.iter().map(move |&j| conditions[j])
            })
            .collect();
        scene.against(&defining)
    }
}
