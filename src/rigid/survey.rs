//! Gathering what the analysis of rigid motions needs, and handing out what it found.

use std::collections::BTreeMap;

use contact_dd_partition::problem::{Catalog, Subdomain};
use serde::{Deserialize, Serialize};

use super::analysis::{RigidMotions, Scene};
use super::bodies::{body_frames, body_states};
use super::descent::descent;
use super::energy::RigidDrive;
use super::inner::inner_motions;
use super::motion::BodyFrame;
use super::rows::rigid_rows;
use crate::comm::Comm;
use crate::error::Failure;
use crate::fem::owned::OwnedBlock;
use crate::plan::Plan;

/// Free rigid motions, and the frames that they are written in.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    /// The frame of every body.
    pub frames: Vec<BodyFrame>,
    /// Its free motions, their pins, and warnings.
    pub motions: RigidMotions,
    /// The rigid motion by which every body comes to rest.
    pub descent: Vec<Vec<f64>>,
    /// For every cluster in contact of this rank, its conditions against the motions that supports
    /// leave to the bodies that lie wholly in it: what moves them costs the cluster no energy.
    pub inner_motions: BTreeMap<usize, RigidDrive>,
    /// Whether supports leave any rigid motion to any body.
    pub movable: bool,
    /// What all this follows from, on the root.
    pub scene: Option<Scene>,
}

impl Survey {
    /// The longest way of a body to rest (m).
    pub fn longest_descent(&self) -> f64 {
        let motions = self.descent.iter().flatten();
        motions.fold(0.0, |longest, z| longest.max(z.abs()))
    }
}

/// Finds the free rigid motions of the scene in load step `step`, and those by which its bodies come to rest.
/// Collective.
///
/// # Errors
/// The load drives a motion that nothing holds.
pub fn survey(
    comm: &Comm,
    blocks: &BTreeMap<usize, OwnedBlock>,
    catalog: &Catalog,
    plan: &Plan,
    step: usize,
) -> Result<Survey, Failure> {
    let subdomains: BTreeMap<usize, &Subdomain> = blocks
        .values()
        .flat_map(|owned| owned.block.members.iter().map(|m| (m.index, m)))
        .collect();
    let owners = plan.subdomain_owners();
    let frames = body_frames(comm, &subdomains, catalog, &owners);
    let (rows, conditions) = rigid_rows(comm, blocks, catalog, plan, &frames);
    let scene = Scene {
        dim: catalog.dim,
        bodies: body_states(comm, &subdomains, catalog, &owners, &frames, step),
        names: catalog.bodies.iter().map(|b| b.name.clone()).collect(),
        rows,
        conditions,
    };
    let found = comm.is_root().then(|| scene.analyse()).transpose();
    let found = comm.agree(found)?;
    let mut found = found.map(|motions| Found {
        movable: scene.is_movable(),
        descent: descent(scene.dim, &scene.bodies, &scene.rows),
        motions,
    });
    comm.broadcast(&mut found);
    let Found {
        motions,
        movable,
        descent,
    } = found.unwrap_or_default();
    Ok(Survey {
        inner_motions: inner_motions(comm, &scene, &motions.pins, catalog, plan),
        motions,
        movable,
        descent,
        frames,
        scene: comm.is_root().then_some(scene),
    })
}

/// What the root tells all ranks of the motions that it found.
#[derive(Default, Serialize, Deserialize)]
struct Found {
    motions: RigidMotions,
    movable: bool,
    descent: Vec<Vec<f64>>,
}
