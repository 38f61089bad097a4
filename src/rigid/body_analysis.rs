//! Gathering what the analysis of rigid motions needs, and handing out what it found.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::analysis::{RigidMotions, Scene};
use super::bodies::{body_frames, body_states};
use super::closing_motion::closing_motions;
use super::cluster_modes::cluster_modes;
use super::energy::RigidModes;
use super::motion::BodyFrame;
use super::rows::rigid_rows;
use crate::comm::is_asked_to_stop;
use crate::context::{Context, Loads};
use crate::error::Failure;

/// Free rigid motions, and the frames that they are written in.
#[derive(Clone, Debug, Default)]
pub struct RigidBodyAnalysis {
    /// The frame of every body.
    pub frames: Vec<BodyFrame>,
    /// Its free motions, their pins, and warnings.
    pub motions: RigidMotions,
    /// The rigid motion by which every body comes to rest.
    pub closing_motions: Vec<Vec<f64>>,
    /// For every cluster in contact of this rank, its conditions against the motions that supports
    /// leave to the bodies that lie wholly in it: what moves them costs the cluster no energy.
    pub cluster_modes: BTreeMap<usize, RigidModes>,
    /// Whether supports leave any rigid motion to any body.
    pub movable: bool,
    /// What all this follows from, on the root.
    pub scene: Option<Scene>,
}

impl RigidBodyAnalysis {
    /// The longest closing motion of a body (m).
    pub fn longest_closing_motion(&self) -> f64 {
        let motions = self.closing_motions.iter().flatten();
        motions.fold(0.0, |longest, z| longest.max(z.abs()))
    }
}

/// Finds the free rigid motions of the scene under `loads`, and those by which its bodies come to rest from
/// where the closing motions of the step `before` left them, none for the first. Collective.
///
/// # Errors
/// The load drives a motion that nothing holds.
pub fn analyse_bodies(
    context: &Context<'_>,
    loads: &Loads,
    before: &[Vec<f64>],
) -> Result<RigidBodyAnalysis, Failure> {
    let Context { comm, catalog, .. } = *context;
    let frames = body_frames(context);
    let (rows, conditions) = rigid_rows(context, &frames);
    let mut scene = Scene {
        dim: catalog.dim,
        bodies: body_states(context, &frames, loads),
        names: catalog.bodies.iter().map(|b| b.name.clone()).collect(),
        rows,
        conditions,
    };
    let find = || -> Result<Found, Failure> {
        let pins = scene.hold(|b| catalog.bodies[b].is_absent)?;
        let found = scene.analyse().map(|mut motions| {
            motions.fixing_dofs.extend(pins);
            Found {
                movable: scene.is_movable(),
                closing_motions: closing_motions(scene.dim, &scene.bodies, &scene.rows, before),
                motions,
            }
        });
        // What was found after that may be half of it.
        match is_asked_to_stop() {
            false => found,
            true => Err(Failure::interrupted(
                "interrupted while analysing rigid motions",
            )),
        }
    };
    let mut found = comm.agree(comm.is_root().then(find).transpose())?;
    comm.broadcast(&mut found);
    let Found {
        motions,
        movable,
        closing_motions,
    } = found.unwrap_or_default();
    Ok(RigidBodyAnalysis {
        cluster_modes: cluster_modes(context, &scene, &motions.fixing_dofs),
        motions,
        movable,
        closing_motions,
        frames,
        scene: comm.is_root().then_some(scene),
    })
}

/// What the root tells all ranks of the motions that it found.
#[derive(Default, Serialize, Deserialize)]
struct Found {
    motions: RigidMotions,
    movable: bool,
    closing_motions: Vec<Vec<f64>>,
}
