//! Load steps on the mesh: the values of supports and forces in each of them.

use super::bodies::Bodies;
use super::initial_stress::InitialStress;
use super::{Material, Support, activation, loads, supports};
use crate::error::InputError;
use crate::mesh::topology::Topology;
use crate::scene::Scene;

/// A load step of a model: values at the supports and nodes that any step prescribes or loads.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelStep {
    /// Name.
    pub name: String,
    /// Time on the load path.
    pub time: f64,
    /// Prescribed displacement of every support (m).
    pub supports: Vec<f64>,
    /// Force on every loaded node (N per metre of thickness).
    pub forces: Vec<[f64; 3]>,
    /// Initial stress.
    pub initial_stress: InitialStress,
    /// The absent bodies of the scene, ascending.
    pub absent_bodies: Vec<u32>,
    /// The contacts that are switched off, ascending; those of absent bodies aren't listed.
    pub absent_contacts: Vec<u32>,
}

/// The loads of a scene.
pub(super) struct Loads {
    /// Names of the boundary conditions that prescribe displacements.
    pub names: Vec<String>,
    /// Supports, with the values of the first step.
    pub supports: Vec<Support>,
    /// Forces of the first step on all nodes that are loaded in any step.
    pub forces: Vec<(u32, [f64; 3])>,
    /// Initial stress in the first step.
    pub initial_stress: InitialStress,
    /// The steps; none where the scene has none.
    pub steps: Vec<ModelStep>,
    /// Flags of the boundary conditions that prescribe a displacement which one of another kind prescribes, too.
    pub decides: Vec<bool>,
}

impl Loads {
    /// The loads of `scene` in all its steps.
    pub fn new(
        scene: &Scene,
        bodies: &Bodies,
        topology: &Topology,
        materials: &[Material],
    ) -> Result<Self, InputError> {
        let loadings = scene.loadings();
        let mut all = Vec::with_capacity(loadings.len());
        let (mut names, mut decides) = (Vec::new(), Vec::new());
        let on = loads::Loaded {
            scene,
            bodies,
            topology,
        };
        let absent = activation::bodies(scene);
        for (k, loading) in loadings.iter().enumerate() {
            let supports = supports::supports(scene, loading, &bodies.mesh, topology)?;
            if k == 0 {
                decides = supports.decide(loading.displacement.len());
                names = supports.names(supports::names(scene, loading, &bodies.mesh));
            }
            let supports = supports.rows;
            let (forces, initial) = loads::forces(on, loading, materials)?;
            all.push((supports, forces, initial));
            if let (Some(absent), Some(loads)) = (absent.get(k), all.last_mut()) {
                activation::unload(bodies, absent, loads);
            }
        }
        for (k, (supports, ..)) in all.iter().enumerate().skip(1) {
            check_places(k, &all[0].0, supports, &bodies.mesh.node_tags)?;
        }
        let is_loaded = |&node: &u32| {
            let mut forces = all.iter().map(|(_, forces, _)| forces[node as usize]);
            forces.any(|force| force != [0.0; 3])
        };
        let loaded: Vec<u32> = (0..bodies.mesh.points.len() as u32)
            .filter(is_loaded)
            .collect();
        let steps = model_steps(scene, &all, &loaded, absent);
        let forces = (loaded.iter().copied().zip(at(&loaded, &all[0].1))).collect();
        let (supports, _, initial_stress) = all.swap_remove(0);
        Ok(Self {
            names,
            steps,
            forces,
            supports,
            initial_stress,
            decides,
        })
    }

    /// The values of support i in all steps, or its single value without steps.
    pub fn values(&self, i: usize) -> Vec<f64> {
        match self.steps.is_empty() {
            true => vec![self.supports[i].value],
            false => self.steps.iter().map(|step| step.supports[i]).collect(),
        }
    }
}

/// The supports, the forces at all nodes and the initial stress of a load step.
type Loading = (Vec<Support>, Vec<[f64; 3]>, InitialStress);

/// The load steps of a scene: each loading with its supports, its forces at the nodes that are `loaded`, its initial
/// stress and the bodies that are `absent`.
fn model_steps(
    scene: &Scene,
    loadings: &[Loading],
    loaded: &[u32],
    absent: Vec<Vec<u32>>,
) -> Vec<ModelStep> {
    let steps = scene.step.iter().zip(loadings).zip(absent).enumerate();
    let steps = steps.map(
        |(k, ((step, (supports, forces, initial)), absent))| ModelStep {
            name: step.name_or_number(k),
            time: step.time.unwrap_or((k + 1) as f64),
            supports: supports.iter().map(|support| support.value).collect(),
            forces: at(loaded, forces),
            initial_stress: initial.clone(),
            absent_bodies: absent,
            absent_contacts: Vec::new(),
        },
    );
    steps.collect()
}

/// The forces at some nodes, from those at all nodes.
fn at(nodes: &[u32], forces: &[[f64; 3]]) -> Vec<[f64; 3]> {
    nodes.iter().map(|&node| forces[node as usize]).collect()
}

/// The steps with the inactive contacts of each, those of the scene and those of bolts.
pub(super) fn with_absent_contacts(
    steps: Vec<ModelStep>,
    of_scene: Vec<Vec<u32>>,
    of_bolts: Vec<Vec<u32>>,
) -> Vec<ModelStep> {
    (steps.into_iter().zip(of_scene))
        .zip(of_bolts)
        .map(|((step, of_scene), of_bolts)| ModelStep {
            absent_contacts: [of_scene, of_bolts].concat(),
            ..step
        })
        .collect()
}

/// Checks that step k prescribes displacements at the nodes and in the directions of the first step, as all steps share
/// one factorization.
fn check_places(
    k: usize,
    first: &[Support],
    of_step: &[Support],
    tags: &[i64],
) -> Result<(), InputError> {
    let place = |support: &Support| (support.node, support.direction);
    let differs = |(a, b): (&Support, &Support)| place(a) != place(b);
    let same = first.len().min(of_step.len());
    let Some(at) = (first.iter().zip(of_step).position(differs))
        .or((first.len() != of_step.len()).then_some(same))
    else {
        return Ok(());
    };
    let nodes = [first.get(at), of_step.get(at)].into_iter().flatten();
    let node = nodes.map(|support| support.node).min().unwrap_or_default();
    Err(InputError::new(format!(
        "step[{}].displacement: node {} isn't held in the same directions as in the first step; \
         expected other values only, at the same nodes: steps share their factorization",
        k + 1,
        tags[node as usize]
    )))
}
