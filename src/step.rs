//! A load step: its loads, condensed onto Γ, and the interface problem that they lead to.

pub mod halving;
pub mod state;
pub mod transfer;
pub mod working_set;

use contact_dd_partition::id::{OnBlocks, OnGroups, OnPairs, OnTreeNodes, PairId};

use crate::certificate::scales::Scales;
use crate::condense::blocks::{CondensedBlocks, ContactCluster};
use crate::condense::clusters::make_load_exact;
use crate::condense::limits::{TiedJumps, limits_of_clusters, limits_of_groups, tied_jumps};
use crate::condense::substitute::Factors;
use crate::contact::limits::Limits;
use crate::contact::pair::ContactPair;
use crate::context::Context;
use crate::context::Loads;
use crate::error::Failure;
use crate::fem::assembly::load;
use crate::fem::balance::LastBalances;
use crate::fem::prescribed::Prescribed;
use crate::interface::numbering::Numbering;
use crate::interface::operator::Interface;
use crate::interface::problem::{ClusterLoad, InterfaceProblem};
use crate::interface::rigid_modes::RigidModes;
use crate::rigid::body_analysis::RigidBodyAnalysis;
use crate::schur::local::CondensedLoad;
use crate::step::state::StepState;
use crate::vector::largest;

/// The problem of a load step, on this rank.
#[derive(Debug)]
pub struct StepProblem<'a> {
    /// The loads on this rank's blocks and contact groups.
    pub loads: Loads,
    /// Displacements that supports prescribe in these blocks.
    pub prescribed: OnBlocks<Prescribed>,
    /// The jumps of ties.
    pub tied: TiedJumps,
    /// The limits of this rank's contact groups.
    pub limits: OnGroups<Limits>,
    /// The condensed load of every node of the hierarchy.
    pub condensed: OnTreeNodes<CondensedLoad>,
    /// ϑ: the clusters in contact, by their number among the pairs.
    pub pairs: OnPairs<ContactPair>,
    /// S_0 U + S_CON(U) = F; on the root.
    pub interface: Option<InterfaceProblem<'a>>,
    /// The scales of the load steps before; on the root.
    pub earlier: Scales,
    /// The balance of forces of the last solution that was checked, on this rank's blocks.
    pub balances: LastBalances,
}

/// The parts of a load step's problem that don't depend on its loads.
#[derive(Clone, Copy)]
pub struct Loading<'a> {
    /// The context of the run.
    pub context: Context<'a>,
    /// The factors of this rank.
    pub factors: &'a CondensedBlocks,
    /// Γ and the operators on it; on the root.
    pub interface: Option<&'a (Numbering, Interface)>,
    /// The rigid-body analysis of the step.
    pub analysis: &'a RigidBodyAnalysis,
}

impl<'a> Loading<'a> {
    /// The problem under `loads`, started from the state that the step `before` left. Collective.
    ///
    /// # Errors
    /// Prescribed displacements by which two sides of a contact penetrate.
    pub fn problem(&self, mut loads: Loads, before: StepState) -> Result<StepProblem<'a>, Failure> {
        let context = &self.context;
        let prescribed = |(&b, loads)| Some((b, Prescribed::new(context.blocks.get(&b)?, loads)));
        let prescribed = loads.blocks.iter().filter_map(prescribed).collect();
        let of_groups = limits_of_groups(context, &loads)?;
        for (g, limits) in &of_groups {
            if let Some(of_group) = loads.groups.get_mut(g) {
                limits.equalize(&mut of_group.gaps);
            }
        }
        let (limits, tied) = (
            limits_of_clusters(context, &of_groups),
            tied_jumps(&of_groups),
        );
        let earlier = before.scales;
        let (condensed, largest_load) = self.condense(&loads, &prescribed, &tied);
        let pairs = self.pairs(limits, &condensed, before);
        let elsewhere = earlier.terms.max(largest_load);
        let interface = self.assemble(&pairs, &condensed, elsewhere);
        Ok(StepProblem {
            loads,
            prescribed,
            tied,
            limits: of_groups,
            condensed,
            pairs,
            interface,
            earlier,
            balances: LastBalances::default(),
        })
    }

    /// Condenses the loads of all blocks up the hierarchy, f_Γ − K_ΓI K_II⁻¹ f_I; returns the load of every node of
    /// this rank and, on the root, the largest load on any unknown of any block. Collective.
    fn condense(
        &self,
        loads: &Loads,
        prescribed: &OnBlocks<Prescribed>,
        tied: &TiedJumps,
    ) -> (OnTreeNodes<CondensedLoad>, f64) {
        let Context {
            comm,
            catalog,
            blocks,
            ..
        } = self.context;
        let of_block = |(&b, loads)| {
            let (block, factors) = (blocks.get(&b)?, self.factors.blocks.get(&b)?);
            let (dofs, springs) = (&factors.dofs, &factors.springs);
            let prescribed = prescribed.get(&b)?;
            let materials = &catalog.materials;
            Some((b, load(block, loads, dofs, prescribed, materials, springs)))
        };
        let factors = Factors {
            context: self.context,
            condensed: self.factors,
            only: None,
        };
        let of_blocks: OnBlocks<Vec<f64>> = loads.blocks.iter().filter_map(of_block).collect();
        let own = of_blocks.values().map(|load| largest(load));
        let largest_loads = comm.collect(&own.fold(0.0, f64::max)).into_iter();
        let largest_load = largest_loads.fold(0.0, f64::max);
        (factors.condense(of_blocks, tied), largest_load)
    }

    /// The clusters in contact of this rank under their loads.
    fn pairs(
        &self,
        mut limits: OnPairs<Limits>,
        loads: &OnTreeNodes<CondensedLoad>,
        mut before: StepState,
    ) -> OnPairs<ContactPair> {
        let plan = self.context.plan;
        let pair = |(&p, cluster): (&PairId, &ContactCluster)| {
            let condensed = &cluster.condensed;
            let limits = limits.remove(&p)?;
            let mut load = loads
                .get(&plan.clusters[plan.pairs[p]].node)?
                .boundary()
                .to_vec();
            if let Some(drive) = self.analysis.cluster_modes.get(&p) {
                let (on_jumps, _) = load.split_at_mut(condensed.jumps);
                make_load_exact(on_jumps, &limits.defining, drive, &condensed.diagonal);
            }
            // A pair without load is at rest; started elsewhere, round-off would decide which contacts close.
            let is_loaded = load.iter().any(|&f| f != 0.0);
            let before = before.pairs.remove(&p).filter(|_| is_loaded);
            Some((p, ContactPair::new(condensed.clone(), limits, load, before)))
        };
        self.factors.contact.iter().filter_map(pair).collect()
    }

    /// Assembles F on the root; `elsewhere` is the largest force outside Γ. Collective.
    fn assemble(
        &self,
        pairs: &OnPairs<ContactPair>,
        loads: &OnTreeNodes<CondensedLoad>,
        elsewhere: f64,
    ) -> Option<InterfaceProblem<'a>> {
        let Context { comm, plan, .. } = self.context;
        let mut of_clusters = Vec::new();
        comm.gather(
            &plan.cluster_owners(),
            |c| {
                let pair = plan.pair_of(c).and_then(|p| pairs.get(&p));
                let load = loads.get(&plan.clusters[c].node);
                match pair {
                    Some(pair) => ClusterLoad {
                        load: pair.bilateral_load().to_vec(),
                        scale: pair.limits().scale,
                    },
                    None => ClusterLoad {
                        load: load.map_or_else(Vec::new, |load| load.boundary().to_vec()),
                        scale: 0.0,
                    },
                }
            },
            |_, load| of_clusters.push(load),
        );
        let (numbering, interface) = self.interface?;
        let drive = self.modes_of_jumps(interface);
        Some(InterfaceProblem::new(
            interface,
            numbering,
            &of_clusters,
            &drive,
            elsewhere,
        ))
    }

    /// The normal jumps of all pairs in the rigid motions that supports leave to the bodies.
    fn modes_of_jumps(&self, interface: &Interface) -> RigidModes {
        let scene = self.analysis.scene.as_ref();
        let Some(scene) = scene.filter(|_| self.analysis.movable) else {
            return RigidModes::default();
        };
        let plan = self.context.plan;
        let defining: Vec<usize> = (interface.laws.iter().zip(&plan.pairs))
            .flat_map(|(law, &c)| {
                let conditions = scene.conditions_of(&plan.clusters[c].groups);
                law.defining.iter().map(move |&j| conditions[j])
            })
            .collect();
        scene.against(&defining)
    }
}
