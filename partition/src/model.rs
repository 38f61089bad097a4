//! The model: a scene on its mesh, with no names to look up any more, no expression to evaluate.
//!
//! Loads are consistent nodal forces, supports are rows `u·d = v`, contact is `B u ≤ g`; nothing
//! behind this point knows how they came about.

mod activation;
mod adjust;
mod blend;
mod bodies;
mod clip;
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
mod loads;
mod mortar;
mod node_pairs;
mod obstacle;
mod parameters;
mod parts;
mod pretension;
mod quantities;
mod ray_search;
mod rules;
mod sides;
mod skin;
mod springs;
mod springs_between;
mod steps;
mod supports;
mod surface;
mod touching;

pub use self::initial_stress::InitialStress;
pub use self::parts::{Contact, Formulation, Material, Support};
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
    /// The units that messages and pictures name.
    pub units: Units,
    /// Plane state; `None` in space.
    pub plane: Option<PlaneState>,
    /// Mesh.
    pub mesh: Mesh,
    /// Cells that meet at facets.
    pub topology: Topology,
    /// Materials.
    pub materials: Vec<Material>,
    /// Names of the scene's bodies.
    pub bodies: Vec<String>,
    /// Index of its material for every cell.
    pub cell_material: Vec<u32>,
    /// Index of its body for every cell.
    pub cell_body: Vec<u32>,
    /// Names of the conditions that prescribe displacements, and of springs after them.
    pub support_names: Vec<String>,
    /// Supports in ascending order of nodes, with the values of the first step.
    pub supports: Vec<Support>,
    /// Springs to the ground: blocks of their stiffness, each with a cell that has its nodes.
    pub springs: Vec<(u32, SpringBlock)>,
    /// Consistent nodal forces of the first step in ascending order of nodes, one entry for every node
    /// that is loaded in any step (N per metre of thickness).
    pub forces: Vec<(u32, [f64; 3])>,
    /// Stress without strain in the first step.
    pub initial_stress: InitialStress,
    /// Load steps; none where all loads are there at once.
    pub steps: Vec<ModelStep>,
    /// Contacts in the order of the scene.
    pub contacts: Vec<Contact>,
    /// Crack tips of the plane, each with a cell that has it.
    pub tips: Vec<(u32, CrackTip)>,
    /// Quantities that are asked for, and the parameters of their derivatives.
    pub goals: Goals,
    /// Description of contacts that were found, each with its name, and of crack tips that are passed by.
    pub found: Vec<String>,
    /// The last nodes of the mesh, which no cell has, each by a cell of the body that it belongs to.
    pub reference_nodes: Vec<u32>,
    /// The partition that the scene asks for, a subdomain for every cell.
    pub prescribed_subdomains: Option<Vec<u32>>,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl Model {
    /// True if a node of the mesh is one that no cell has.
    pub fn is_reference(&self, node: usize) -> bool {
        node >= self.mesh.points.len() - self.reference_nodes.len()
    }

    /// Finds out what `scene` means on `mesh`.
    ///
    /// # Errors
    /// Groups that don't exist, conditions that contradict each other, sides that don't match.
    pub fn new(scene: &Scene, mesh: Mesh) -> Result<Self, InputError> {
        let plane = plane_state(scene, &mesh)?;
        let mut warnings = mesh.warnings.clone();
        let mut bodies = bodies::Bodies::new(scene, mesh, &mut warnings)?;
        let cuts = pretension::cut(scene, &mut bodies)?;
        let topology = Topology::new(&bodies.mesh);
        (topology.check_sides(&bodies.mesh)).map_err(|error| error.in_file(&scene.mesh))?;
        adjust::adjust(scene, &mut bodies, &topology, &mut warnings)?;
        let materials = bodies.with_variants(bodies::materials(scene, plane));
        let mut loads = steps::Loads::new(scene, &bodies, &topology, &materials)?;
        let springs = springs::Springs::new(scene, &bodies, &topology, loads.names.len())?;
        let declared = touching::contacts(scene, &mut bodies, &topology, &mut warnings)?;
        let held = held_nodes::HeldNodes::new(&loads);
        let sides = contact::Contacts::new(&bodies.mesh, &topology, held, scene);
        let MadeContacts {
            mut contacts,
            tables,
            found,
        } = MadeContacts::new(&sides, &declared, &mut warnings)?;
        activation::check(scene, &bodies, &contacts)?;
        let on = (&bodies.mesh, &topology);
        let (tips, coarse) = crack_tips::find(on, plane, &bodies.cell_material, &contacts);
        let mut equations = equations::equations(scene, &bodies.mesh, contacts.len())?;
        let count = contacts.len() + equations.len();
        equations.extend(cyclic::cyclic(scene, &bodies, &mut contacts, count)?);
        let goals = goals(
            (scene, &bodies, &topology),
            &materials,
            (&loads, &springs),
            (&contacts, &tips),
        )?;
        let count = contacts.len() + equations.len();
        equations.extend(springs_between::springs_between(
            scene,
            &bodies.mesh,
            count,
        )?);
        let count = contacts.len() + equations.len();
        let couplings = couplings::couplings(scene, (&bodies.mesh, &topology), count)?;
        let names = equations.iter().map(|of| &of.name[..]);
        let tables: Vec<&str> = tables.into_iter().chain(names).collect();
        let absent_contacts = activation::contacts(scene, &tables);
        let diagnostics = diagnostics::Diagnostics {
            scene,
            bodies: &bodies,
            topology: &topology,
            materials: &materials,
            loads: &loads,
            contacts: &contacts,
            declared: &declared,
        };
        let all: Vec<&str> = declared.iter().map(|of| &of.table[..]).collect();
        diagnostics.check_repeated_contacts(&activation::contacts(scene, &all))?;
        warnings.extend(diagnostics.warnings()?);
        let found = found
            .into_iter()
            .chain(crack_tips::remark(coarse))
            .collect();
        let prescribed_subdomains = (scene.subdomains.as_ref())
            .map(|names| bodies::prescribed_subdomains(&bodies.mesh, names))
            .transpose()?;
        let on = (&bodies, &topology);
        let first = count + couplings.len();
        let bolts = pretension::Pretensions::new(scene, on, &cuts, &mut loads, first)?;
        let own = std::mem::take(&mut loads.names);
        let mut support_names: Vec<String> = own.into_iter().chain(springs.names).collect();
        let (coupled, reference_nodes) =
            couplings::attach(couplings, &mut bodies.mesh, &mut loads, &mut support_names);
        Ok(Self {
            title: scene.title.clone(),
            solver: scene.solver,
            units: scene.units,
            plane,
            materials,
            bodies: scene.bodies.keys().cloned().collect(),
            cell_material: bodies.cell_material,
            cell_body: bodies.cell_body,
            mesh: bodies.mesh,
            topology,
            support_names,
            supports: loads.supports,
            springs: springs.blocks,
            forces: loads.forces,
            initial_stress: loads.initial_stress,
            steps: (loads.steps.into_iter().zip(absent_contacts))
                .zip(bolts.absent)
                .map(|((step, of_scene), of_bolts)| ModelStep {
                    absent_contacts: [of_scene, of_bolts].concat(),
                    ..step
                })
                .collect(),
            contacts: (contacts.into_iter().chain(equations))
                .chain(coupled)
                .chain(bolts.contacts)
                .collect(),
            tips,
            goals,
            found,
            reference_nodes,
            prescribed_subdomains,
            // Words of a mesh or a deck may hold anything, and each warning is a line of the problem file.
            warnings: (warnings.iter().map(|text| name::in_a_line(text))).collect(),
        })
    }
}

/// The quantities of a scene, and with them its parameters.
///
/// # Errors
/// A name that isn't there, with those that are.
fn goals(
    (scene, bodies, topology): (&Scene, &bodies::Bodies, &Topology),
    materials: &[Material],
    (loads, springs): (&steps::Loads, &springs::Springs),
    (contacts, tips): (&[Contact], &[(u32, CrackTip)]),
) -> Result<Goals, InputError> {
    if scene.quantity.is_empty() {
        return Ok(Goals::default());
    }
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
        materials,
        contacts,
        tips,
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

/// The contacts that were declared or found and have points.
#[derive(Default)]
struct MadeContacts<'a> {
    contacts: Vec<Contact>,
    /// The table of each in the scene.
    tables: Vec<&'a str>,
    /// The contacts that were found, in words.
    found: Vec<String>,
}

impl<'a> MadeContacts<'a> {
    /// Makes them between their `sides`.
    ///
    /// # Errors
    /// Sides that don't match, or that supports press into each other.
    fn new(
        sides: &contact::Contacts,
        declared: &'a [touching::Declared],
        warnings: &mut Vec<String>,
    ) -> Result<Self, InputError> {
        let mut all = Self::default();
        for of in declared {
            let made = sides.declared(all.contacts.len() as u32, &of.contact, warnings)?;
            // Where all nodes are held no bodies touch each other that could part.
            if of.words.is_none() || !made.points.is_empty() {
                all.contacts.push(made);
                all.tables.push(&of.table[..]);
                all.found.extend(of.words.clone());
            }
        }
        Ok(all)
    }
}

/// The plane state of a scene whose mesh lies in the plane.
///
/// # Errors
/// None where one is expected, or one in space; a value that isn't of the mesh's dimension.
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
