//! The model: a scene on its mesh, with all names resolved and all expressions evaluated.
//!
//! Loads are consistent nodal forces, supports are rows `u·d = v`, contact is `B u ≤ g`; the later stages don't depend
//! on how the scene states them.

mod activation;
mod adjust;
mod blend;
mod bodies;
mod clip;
mod constraints;
mod contact;
mod couplings;
mod crack_tips;
mod cyclic;
mod diagnostics;
mod equations;
mod facet_tree;
mod groups;
mod held_nodes;
mod initial_stress;
mod loaded_bodies;
mod loads;
mod locking;
mod mortar;
mod node_pairs;
mod obstacle;
mod parameters;
mod parts;
mod pretension;
mod quantities;
mod ray_search;
mod rules;
mod seams;
mod sides;
mod skin;
mod springs;
mod springs_between;
mod steps;
mod supports;
mod surface;
mod touching;

use self::constraints::Constraints;
use self::diagnostics::Diagnostics;
pub use self::initial_stress::InitialStress;
use self::loaded_bodies::LoadedBodies;
pub use self::parts::{Contact, Formulation, Material, Support};
use self::pretension::Pretensions;
pub use self::springs::SpringBlock;
pub use self::steps::ModelStep;
use crate::crack_tip::CrackTip;
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;
use crate::name;
use crate::quantity::{Goals, NodalShares};
use crate::scene::Scene;
pub use crate::scene::material::PlaneState;
use crate::scene::units::Units;
use crate::solver::SolverSettings;

/// A scene on its mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Title of the scene.
    pub title: String,
    /// Settings of the solver.
    pub solver: SolverSettings,
    /// The units in messages and pictures.
    pub units: Units,
    /// Plane state; `None` in space.
    pub plane: Option<PlaneState>,
    /// Mesh.
    pub mesh: Mesh,
    /// Adjacency of cells across facets.
    pub topology: Topology,
    /// Materials.
    pub materials: Vec<Material>,
    /// Names of the scene's bodies.
    pub bodies: Vec<String>,
    /// Index of its material for every cell.
    pub cell_material: Vec<u32>,
    /// Index of its body for every cell.
    pub cell_body: Vec<u32>,
    /// Names of the boundary conditions that prescribe displacements, followed by those of springs.
    pub support_names: Vec<String>,
    /// Supports in ascending order of nodes, with the values of the first step.
    pub supports: Vec<Support>,
    /// Springs to the ground: stiffness blocks, each with a cell that contains its nodes.
    pub springs: Vec<(u32, SpringBlock)>,
    /// Consistent nodal forces of the first step in ascending order of nodes, one entry for every node loaded in any
    /// step (N per metre of thickness).
    pub forces: Vec<(u32, [f64; 3])>,
    /// Initial stress in the first step.
    pub initial_stress: InitialStress,
    /// Load steps; none if all loads are applied at once.
    pub steps: Vec<ModelStep>,
    /// Contacts in the order of the scene.
    pub contacts: Vec<Contact>,
    /// Crack tips of a plane mesh, each with a cell that contains it.
    pub tips: Vec<(u32, CrackTip)>,
    /// Requested quantities, and the parameters of their derivatives.
    pub goals: Goals,
    /// Descriptions of contacts found automatically, each with its name, and of crack tips left out.
    pub found: Vec<String>,
    /// A cell for each of the last nodes of the mesh, the reference nodes, which belong to no cell: it tells the node's
    /// body.
    pub reference_nodes: Vec<u32>,
    /// The partition prescribed by the scene: the subdomain of every cell.
    pub prescribed_subdomains: Option<Vec<u32>>,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl Model {
    /// True for a reference node, which belongs to no cell.
    pub fn is_reference(&self, node: usize) -> bool {
        node >= self.mesh.points.len() - self.reference_nodes.len()
    }

    /// Builds the model of `scene` on `mesh`.
    ///
    /// # Errors
    /// Groups that don't exist, boundary conditions that contradict each other, sides that don't match.
    pub fn new(scene: &Scene, mesh: Mesh) -> Result<Self, InputError> {
        let plane = plane_state(scene, &mesh)?;
        let mut warnings = mesh.warnings.clone();
        let mut on = LoadedBodies::new(scene, mesh, plane, &mut warnings)?;
        let declared = touching::contacts(scene, &mut on.bodies, &on.topology, &mut warnings)?;
        let couplings = couplings::couplings(scene, (&on.bodies.mesh, &on.topology))?;
        let declared_and_coupled = (&declared[..], &couplings[..]);
        let mut constraints =
            Constraints::new(scene, &on, plane, declared_and_coupled, &mut warnings)?;
        let goals = goals(scene, &on, &constraints)?;
        let mesh = &on.bodies.mesh;
        let between = springs_between::springs_between(scene, mesh, constraints.count())?;
        constraints.equations.extend(between);
        let count = constraints.count();
        let absent_contacts = constraints.absent(scene);
        let contacts = &constraints.contacts;
        let diagnostics = Diagnostics::new(scene, &on, contacts, &declared);
        warnings.extend(diagnostics.warnings()?);
        let prescribed_subdomains = (scene.subdomains.as_ref())
            .map(|names| bodies::prescribed_subdomains(&on.bodies.mesh, names))
            .transpose()?;
        let (bodies, first) = (&on.bodies, count + couplings.len());
        let cut = (bodies, &on.topology);
        let bolts = Pretensions::new(scene, cut, &on.cuts, &mut on.loads, first)?;
        let mut support_names = on.take_support_names();
        let mesh = &mut on.bodies.mesh;
        let (coupled, reference_nodes) =
            couplings::attach((couplings, count), mesh, &mut on.loads, &mut support_names);
        Ok(Self {
            title: scene.title.clone(),
            solver: scene.solver,
            units: scene.units,
            plane,
            materials: on.materials,
            bodies: scene.bodies.keys().cloned().collect(),
            cell_material: on.bodies.cell_material,
            cell_body: on.bodies.cell_body,
            mesh: on.bodies.mesh,
            topology: on.topology,
            support_names,
            supports: on.loads.supports,
            springs: on.springs.blocks,
            forces: on.loads.forces,
            initial_stress: on.loads.initial_stress,
            steps: steps::with_absent_contacts(on.loads.steps, absent_contacts, bolts.absent),
            contacts: ([constraints.contacts, constraints.equations].into_iter())
                .chain([coupled, bolts.contacts])
                .flatten()
                .collect(),
            tips: constraints.tips.tips,
            goals,
            found: constraints.found,
            reference_nodes,
            prescribed_subdomains,
            // Names from a mesh or a deck may hold line breaks, and each warning is a line of the problem file.
            warnings: (warnings.iter().map(|text| name::in_a_line(text))).collect(),
        })
    }
}

/// The quantities of a scene and their parameters.
///
/// # Errors
/// An unknown name, with the existing ones.
fn goals(scene: &Scene, on: &LoadedBodies, constraints: &Constraints) -> Result<Goals, InputError> {
    if scene.quantity.is_empty() {
        return Ok(Goals::default());
    }
    let LoadedBodies {
        bodies,
        topology,
        materials,
        loads,
        springs,
        ..
    } = on;
    let contacts = &constraints.contacts;
    let initial: Vec<&InitialStress> = match loads.steps.is_empty() {
        true => vec![&loads.initial_stress],
        false => loads
            .steps
            .iter()
            .map(|step| &step.initial_stress)
            .collect(),
    };
    let supports: Vec<String> = loads.names.iter().chain(&springs.names).cloned().collect();
    let known = quantities::Known {
        scene,
        bodies,
        topology,
        materials,
        contacts,
        tips: &constraints.tips,
        supports: &supports,
        initial: &initial,
    };
    let (quantities, weights) = quantities::quantities(known)?;
    let on = loads::Loaded {
        scene,
        bodies,
        topology,
    };
    let (parameters, forces) = parameters::parameters(on, loads, contacts)?;
    Ok(Goals {
        quantities,
        parameters,
        shares: NodalShares { weights, forces },
    })
}

/// The plane state of a scene whose mesh lies in the plane.
///
/// # Errors
/// A missing plane state, or one in space; a value that isn't of the mesh's dimension.
fn plane_state(scene: &Scene, mesh: &Mesh) -> Result<Option<PlaneState>, InputError> {
    let fault = match (mesh.dim, scene.plane) {
        (2, None) => {
            "the key 'plane' is missing: the mesh has 2 dimensions; expected plane = \"strain\", \
             \"stress\" or \"axisymmetric\""
        }
        (3, Some(_)) => {
            "the key 'plane' is of plane scenes: the mesh has 3 dimensions; expected none"
        }
        _ => {
            scene.check_dimension(mesh.dim)?;
            return Ok(scene.plane);
        }
    };
    Err(InputError::new(fault))
}
