//! Input of the rigid-body analysis, gathered on the root, and its results, sent to all ranks.

use contact_dd_partition::element::geometry::{dot, length};
use contact_dd_partition::id::{BlockId, OnBlocks, OnPairs};
use serde::{Deserialize, Serialize};

use super::analysis::RigidMotions;
use super::bodies::{body_frames, body_states};
use super::closing_motion::closing_motions;
use super::cluster_modes::cluster_modes;
use super::rows::rigid_rows;
use super::scene::Scene;
use crate::comm::is_asked_to_stop;
use crate::context::{Context, Loads};
use crate::error::Failure;
use crate::fem::body_frame::BodyFrame;
use crate::interface::rigid_modes::RigidModes;

/// Free rigid-body motions, and the frames in which they are written.
#[derive(Clone, Debug, Default)]
pub struct RigidBodyAnalysis {
    /// The frame of every body.
    pub frames: Vec<BodyFrame>,
    /// Free motions, their fixing dofs, and warnings.
    pub motions: RigidMotions,
    /// The closing motion of every body, by which it comes into contact.
    pub closing_motions: Vec<Vec<f64>>,
    /// Constraints of every cluster in contact of this rank in the motions that supports leave to the bodies that lie
    /// wholly in it; these motions have no elastic energy in the cluster.
    pub cluster_modes: OnPairs<RigidModes>,
    /// True if supports leave any body a rigid motion.
    pub movable: bool,
    /// The scene of bodies and constraints, on the root.
    pub scene: Option<Scene>,
}

impl RigidBodyAnalysis {
    /// The longest closing motion of a body (m).
    pub fn longest_closing_motion(&self) -> f64 {
        let motions = self.closing_motions.iter().flatten();
        motions.fold(0.0, |longest, z| longest.max(z.abs()))
    }

    /// This analysis without closing motions: the bodies stay where they are before the load deforms them.
    pub fn without_closing_motions(&self) -> Self {
        let at_rest = |of_body: &Vec<f64>| vec![0.0; of_body.len()];
        Self {
            closing_motions: self.closing_motions.iter().map(at_rest).collect(),
            ..self.clone()
        }
    }
}

/// Finds the free rigid-body motions of the scene under `loads`, and the closing motions, which start from those of the
/// step `before`; there are none before the first step. Collective.
///
/// # Errors
/// The load drives a motion that neither supports nor contact restrain.
pub fn analyse_bodies(
    context: &Context<'_>,
    loads: &Loads,
    before: &[Vec<f64>],
) -> Result<RigidBodyAnalysis, Failure> {
    let Context { comm, catalog, .. } = *context;
    let frames = body_frames(context);
    let (rows, conditions) = rigid_rows(context, &frames, loads);
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
                closing_motions: closing_motions(
                    scene.dim,
                    &scene.bodies,
                    &scene.two_sided_rows(),
                    before,
                ),
                motions,
            }
        });
        // After a signal the result may be incomplete.
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

/// Results of the root's analysis, for all ranks.
#[derive(Default, Serialize, Deserialize)]
struct Found {
    motions: RigidMotions,
    movable: bool,
    closing_motions: Vec<Vec<f64>>,
}

/// Length left after the subtraction of a motion, relative to both, up to which it is round-off; a stiff body would
/// turn it into forces.
const ROUND_OFF: f64 = 1e-14;

/// The loads on the blocks with the closing motions subtracted from gaps and prescribed displacements.
pub fn without_closing_motions(
    context: &Context<'_>,
    mut loads: Loads,
    analysis: &RigidBodyAnalysis,
) -> Loads {
    if analysis.longest_closing_motion() == 0.0 {
        return loads;
    }
    let dim = context.catalog.dim;
    for (b, loads) in &mut loads.blocks {
        let block = &context.blocks[b];
        for support in &mut loads.supports {
            if let Some(at) = block.body_points().get(support.node as usize) {
                let moved = moved(analysis, dim, block.subdomain.body, at);
                reduce(&mut support.value, &support.direction, &moved);
            }
        }
    }
    for (g, loads) in &mut loads.groups {
        let group = &context.groups[g];
        let nodes = group.nodes.iter();
        let moved: Vec<[f64; 3]> = nodes
            .map(|node| match node.is_auxiliary {
                true => [0.0; 3],
                false => moved(analysis, dim, node.body, &node.at),
            })
            .collect();
        for (condition, gap) in group.conditions().zip(&mut loads.gaps) {
            for (node, row) in group.row_of(&condition) {
                reduce(gap, &row, &moved[node as usize]);
            }
        }
        for ((node, held), moved) in group.nodes.iter().zip(&mut loads.held).zip(&moved) {
            for ((direction, _), value) in node.supports.iter().zip(held) {
                reduce(value, direction, moved);
            }
        }
    }
    loads
}

/// Subtracts from `whole` the displacement `moved` along `row`; round-off becomes 0.
fn reduce(whole: &mut f64, row: &[f64; 3], moved: &[f64; 3]) {
    let given = whole.abs() + length(*row) * length(*moved);
    *whole -= dot(*row, *moved);
    if whole.abs() <= ROUND_OFF * given {
        *whole = 0.0;
    }
}

/// The displacement of every block, node by node: its solution plus its body's closing motion.
pub fn with_closing_motions<'a>(
    context: &Context<'_>,
    solutions: impl Iterator<Item = (BlockId, &'a [f64])>,
    analysis: &RigidBodyAnalysis,
) -> OnBlocks<Vec<f64>> {
    let (dim, stays) = (
        context.catalog.dim,
        analysis.longest_closing_motion() == 0.0,
    );
    let of_block = |(b, u): (BlockId, &[f64])| {
        let block = context.blocks.get(&b)?;
        let mut u = u.to_vec();
        if stays {
            return Some((b, u));
        }
        for (x, u) in block.body_points().iter().zip(u.chunks_exact_mut(dim)) {
            let moved = moved(analysis, dim, block.subdomain.body, x);
            u.iter_mut().zip(moved).for_each(|(u, m)| *u += m);
        }
        Some((b, u))
    };
    solutions.filter_map(of_block).collect()
}

fn moved(analysis: &RigidBodyAnalysis, dim: usize, body: usize, x: &[f64; 3]) -> [f64; 3] {
    analysis.frames[body].displacement(dim, x, &analysis.closing_motions[body])
}
