//! The data that every phase of a run works on.

pub mod hierarchy;

use contact_dd_partition::id::{OnBlocks, OnGroups};
use contact_dd_partition::magnitude::short;
use contact_dd_partition::problem::Catalog;
use faer::Par;

use crate::comm::Comm;
use crate::error::{Failure, FailureKind};
use crate::fem::block::Block;
use crate::fem::contact_group::{ContactGroup, GroupLoads};
use crate::fem::load::BlockLoads;
use crate::plan::Plan;

/// The receiver of progress reports.
pub trait Listener {
    /// Reports the `share` done of the phase, or of a part of it such as a linear system: from 0, at the start of a
    /// part, to 1.
    fn done(&self, share: f64);
}

/// Ratio of the largest to the smallest stiffness of materials from which on the smallest may be below the round-off of
/// the assembled largest.
const INDISTINCT: f64 = 1e11;

/// Data that every phase of a run works on.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// All ranks.
    pub comm: &'a Comm,
    /// The problem.
    pub catalog: &'a Catalog,
    /// The owners of blocks and fronts.
    pub plan: &'a Plan,
    /// The blocks of this rank, by their number.
    pub blocks: &'a OnBlocks<Block>,
    /// The contact groups of this rank, by their number.
    pub groups: &'a OnGroups<ContactGroup>,
    /// Threads.
    pub par: Par,
    /// The receiver of progress reports.
    pub listener: &'a dyn Listener,
}

/// A point of the load path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadPoint {
    /// The load step.
    pub step: usize,
    /// Fraction of the change from the loads of the step before, none before the first, to those of this step.
    pub part: f64,
}

impl LoadPoint {
    /// The end of a load step.
    pub fn end_of(step: usize) -> Self {
        Self { step, part: 1.0 }
    }
}

/// The loads on the blocks and contact groups of this rank.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loads {
    /// Loads on its blocks, by their number.
    pub blocks: OnBlocks<BlockLoads>,
    /// Loads on its contact groups, by their number.
    pub groups: OnGroups<GroupLoads>,
}

impl Context<'_> {
    /// The loads at a point of the load path.
    pub fn loads(&self, load_point: LoadPoint) -> Loads {
        let mut loads = self.loads_of_step(load_point.step);
        if load_point.part < 1.0 {
            let before = (load_point.step.checked_sub(1)).map(|step| self.loads_of_step(step));
            for (b, loads) in &mut loads.blocks {
                // Loads of the step before don't act on a body that is now absent.
                if self.catalog.bodies[self.catalog.body_of(*b)].is_absent {
                    continue;
                }
                let before = before.as_ref().map(|before| &before.blocks[b]);
                loads.go_back(before, load_point.part);
            }
            for (g, loads) in &mut loads.groups {
                let before = before.as_ref().map(|before| &before.groups[g]);
                loads.go_back(before, load_point.part);
            }
        }
        loads
    }

    /// The loads at the end of load step k.
    fn loads_of_step(&self, k: usize) -> Loads {
        let (blocks, groups) = (self.blocks.iter(), self.groups.iter());
        Loads {
            blocks: blocks
                .map(|(&b, block)| (b, BlockLoads::new(block, k)))
                .collect(),
            groups: groups
                .map(|(&g, group)| (g, GroupLoads::new(group, k)))
                .collect(),
        }
    }

    /// The failure of a factorization at a non-positive pivot: either a part is free to move, or its support is weaker
    /// than round-off. Where the ratio of the materials' stiffnesses exceeds double precision, the message names these
    /// materials instead.
    pub fn of_pivot(&self, mut failure: Failure) -> Failure {
        let all = || self.catalog.materials.iter();
        let soft = all().map(|m| (m.stiffness.smallest(), &m.name));
        let stiff = all().map(|m| (m.stiffness.largest(), &m.name));
        let soft = soft.min_by(|a, b| a.0.total_cmp(&b.0));
        let stiff = stiff.max_by(|a, b| a.0.total_cmp(&b.0));
        let (Some((least, soft)), Some((most, stiff))) = (soft, stiff) else {
            return failure;
        };
        let ratio = most / least;
        if failure.kind != FailureKind::IllPosed {
            return failure;
        }
        // A NaN ratio doesn't count as small.
        if ratio < INDISTINCT {
            failure
                .message
                .push_str("; or its support is too weak for double precision");
            return failure;
        }
        Failure::input(format!(
            "the largest stiffness, of '{stiff}', is {} times the smallest, of '{soft}' (of one material: against a change \
             of volume and of shape), and double precision loses what restrains the softest part; expected less \
             than {} times; found where {}",
            short(ratio),
            short(INDISTINCT),
            failure.message
        ))
    }

    /// Description of contact point j: its node, its contact, the bodies in contact, and its position.
    pub fn point_name(&self, j: u32) -> String {
        let Catalog {
            points,
            contacts,
            subdomains,
            bodies,
            ..
        } = self.catalog;
        let point = &points[j as usize];
        let mut names: Vec<String> = Vec::new();
        for (at, _) in &point.entries {
            let body = &bodies[subdomains[at.subdomain as usize].body].name;
            let name = format!("'{body}'");
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let place: Vec<String> = (point.position.iter().take(self.catalog.dim))
            .map(|&x| short(x))
            .collect();
        format!(
            "node {} of contact '{}' ({} at ({}))",
            point.tag(),
            contacts[point.contact as usize].name,
            names.join(" and "),
            place.join(", ")
        )
    }

    /// The failure with the name of its load step added.
    pub fn in_step(&self, mut failure: Failure, k: usize) -> Failure {
        if let Some(step) = self.catalog.steps.get(k) {
            failure.message = format!("step '{}': {}", step.name, failure.message);
        }
        failure
    }
}
