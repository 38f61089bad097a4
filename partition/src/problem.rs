//! The problem file: what one subdomain, one group in contact and the catalog of both hold.
//!
//! The writer and the reader of `problem.h5` share these types; docs/problem-file.md says the
//! same for somebody who writes one with h5py.

pub mod auxiliary;
pub mod consistency;
mod contact_summary;
pub mod copies;
mod datasets;
pub mod digest;
mod friction;
mod goals;
mod law;
pub mod read;
pub mod schema;
pub mod stage;
mod strings;
mod tips;
pub mod trial;
pub mod vtkhdf;
pub mod write;

pub use self::contact_summary::{ContactKind, ContactSummary};
use crate::contact_point::{ContactPoint, Probe};
use crate::crack_tip::CrackTip;
use crate::element::Elements;
use crate::element::geometry::{advance, dot};
use crate::id::BlockId;
use crate::model::{Material, PlaneState, SpringBlock, Support};
use crate::quantity::{NodalShares, Parameter, Quantity};
use crate::scene::units::Units;
use crate::solver::SolverSettings;

/// Version of the format, attribute `version` of the file.
pub const VERSION: i64 = 2;

/// Attribute `format` of the file.
pub const FORMAT: &str = "contact-dd-mpi problem";

/// The square of a unit normal's part that supports leave free above which a node can move along it.
const LEAST_FREE: f64 = 0.01;

/// Largest difference of a unit vector's length from 1, and of two orthogonal ones' product from 0.
const UNIT_TOLERANCE: f64 = 1e-10;

/// A node on Γ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InterfaceNode {
    /// Node of the subdomain.
    pub node: u32,
    /// Number on Γ, equal in all subdomains that share it.
    pub interface: u32,
}

/// One subdomain Ω^n: a piece of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Subdomain {
    /// Number.
    pub index: usize,
    /// Index of its body among [`Catalog::bodies`].
    pub body: usize,
    /// Coordinates of its nodes (m).
    pub points: Vec<[f64; 3]>,
    /// The mesh file's tag of each node.
    pub node_tags: Vec<i64>,
    /// Cells, by node of the subdomain.
    pub cells: Elements,
    /// Index of its material for every cell.
    pub cell_material: Vec<u32>,
    /// Supports, by node of the subdomain.
    pub supports: Vec<Support>,
    /// Springs to the ground, by node of the subdomain.
    pub springs: Vec<SpringBlock>,
    /// Nodal forces, by node of the subdomain (N per metre of thickness).
    pub forces: Vec<(u32, [f64; 3])>,
    /// Stress without strain.
    pub initial_stress: InitialStress,
    /// Nodes on Γ, in ascending order of their number on Γ.
    pub interface: Vec<InterfaceNode>,
    /// The parts of its nodes in quantities and loads that are parameters.
    pub shares: NodalShares,
    /// Values of its supports and forces in every load step; none where the problem has none.
    pub steps: Vec<StepLoads>,
    /// Number of its nodes behind those of its cells that move with its body: those of the reference points of couplings.
    pub reference_nodes: usize,
    /// Number of the nodes behind these, which no file lists: those [between](auxiliary) the sides of contact points.
    pub auxiliary_nodes: usize,
}

/// The loads of a subdomain in a load step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepLoads {
    /// Prescribed displacement of every support (m).
    pub supports: Vec<f64>,
    /// Force on every loaded node (N per metre of thickness).
    pub forces: Vec<[f64; 3]>,
    /// Stress without strain.
    pub initial_stress: InitialStress,
}

/// Stress that a subdomain has without strain, XX YY ZZ XY YZ XZ (Pa); empty where the problem has none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitialStress {
    /// The mean over every cell.
    pub cells: Vec<[f64; 6]>,
    /// Stress at every node, in the first of the materials around it.
    pub nodes: Vec<[f64; 6]>,
}

impl Subdomain {
    /// Number of the nodes of its cells, which come first.
    pub fn cell_nodes(&self) -> usize {
        self.body_nodes() - self.reference_nodes
    }

    /// Number of the nodes that move with its body, which come first.
    pub fn body_nodes(&self) -> usize {
        self.points.len() - self.auxiliary_nodes
    }

    /// Supports with the values that they have in a load step.
    pub fn supports_in(&self, step: usize) -> impl Iterator<Item = Support> + '_ {
        let loads = self.steps.get(step);
        let supports = self.supports.iter().enumerate();
        supports.map(move |(i, support)| Support {
            value: loads.map_or(support.value, |loads| loads.supports[i]),
            ..*support
        })
    }

    /// Loaded nodes and the forces on them in a load step.
    pub fn forces_in(&self, step: usize) -> impl Iterator<Item = (u32, [f64; 3])> + '_ {
        let loads = self.steps.get(step);
        let forces = self.forces.iter().enumerate();
        forces.map(move |(i, &(node, force))| (node, loads.map_or(force, |loads| loads.forces[i])))
    }

    /// Stress without strain in a load step.
    pub fn initial_stress_in(&self, step: usize) -> &InitialStress {
        let loads = self.steps.get(step);
        loads.map_or(&self.initial_stress, |loads| &loads.initial_stress)
    }

    /// The initial stresses of every load step, or the one that it has.
    fn initial_stresses(&self) -> Vec<&InitialStress> {
        match self.steps.is_empty() {
            true => vec![&self.initial_stress],
            false => self.steps.iter().map(|step| &step.initial_stress).collect(),
        }
    }

    /// The values of a support: in every load step, or the one that it has.
    fn support(&self, i: usize) -> Vec<f64> {
        match self.steps.is_empty() {
            true => vec![self.supports[i].value],
            false => self.steps.iter().map(|step| step.supports[i]).collect(),
        }
    }

    /// The values of a nodal force: in every load step, or the one that it has.
    fn force(&self, i: usize) -> Vec<&[f64; 3]> {
        match self.steps.is_empty() {
            true => vec![&self.forces[i].1],
            false => self.steps.iter().map(|step| &step.forces[i]).collect(),
        }
    }
}

/// A node of a subdomain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SubdomainNode {
    /// Subdomain.
    pub subdomain: u32,
    /// Node of that subdomain.
    pub node: u32,
}

impl SubdomainNode {
    /// The subdomain as a block.
    pub fn block(self) -> BlockId {
        BlockId::new(self.subdomain as usize)
    }
}

/// A node of a contact point in the catalog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointNode {
    /// Number on Γ, if several subdomains have it.
    pub interface: Option<u32>,
    /// True if supports leave it free along the normal of the point, or nearly so, and where the point has friction
    /// along its tangents, too: one free direction is not enough for two.
    pub is_free: bool,
}

impl PointNode {
    /// A node that `supports` hold along these directions, in a point that has conditions along those.
    pub fn new(
        interface: Option<u32>,
        conditions: impl IntoIterator<Item = [f64; 3]>,
        supports: impl Iterator<Item = [f64; 3]>,
    ) -> Self {
        let mut taken: Vec<[f64; 3]> = supports.collect();
        let is_free = |direction: [f64; 3]| {
            let held: f64 = taken.iter().map(|d| dot(*d, direction).powi(2)).sum();
            let free = 1.0 - held;
            let along = |rest, d: &[f64; 3]| advance(rest, -dot(*d, direction), *d);
            let rest = taken.iter().fold(direction, along);
            taken.push(rest.map(|x| x / free.sqrt()));
            free > LEAST_FREE
        };
        Self {
            interface,
            is_free: conditions.into_iter().all(is_free),
        }
    }
}

/// A subdomain in the catalog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SubdomainSummary {
    /// Index of its body.
    pub body: usize,
    /// Group in contact; `None` for a linear subdomain.
    pub group: Option<usize>,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of cells.
    pub cells: usize,
}

/// A load step: quasi-static and without friction its solution depends on its own loads alone.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadStep {
    /// Name.
    pub name: String,
    /// Time on the load path.
    pub time: f64,
    /// The bodies and contacts that are absent.
    pub absent: Absent,
}

/// The bodies and contacts that aren't there in a load step, by their numbers, ascending; contacts of absent bodies
/// needn't be among these.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Absent {
    /// Bodies.
    pub bodies: Vec<u32>,
    /// Contacts.
    pub contacts: Vec<u32>,
}

/// A body: one piece of the mesh that hangs together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Body {
    /// Name of the scene's body, numbered where that one has several pieces.
    pub name: String,
    /// True if it isn't there in the [stage](stage::Stage) that the catalog is of.
    pub is_absent: bool,
}

/// A tree over the subdomains, up which their Schur complements are merged.
///
/// Nodes 0 to N − 1 are the N subdomains, those from N on are inner nodes. Subdomains that share a
/// node of Γ are under one root.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Hierarchy {
    /// The parent of every node, greater than its own number; `None` for a root.
    pub parent: Vec<Option<u32>>,
    /// The clusters: the nodes between which an iterative interface solver works, ascending, one above every
    /// subdomain or the subdomain itself. None where the file doesn't say.
    pub clusters: Vec<u32>,
}

/// The catalog of the whole problem, which every rank has.
#[derive(Clone, Debug, PartialEq)]
pub struct Catalog {
    /// Title of the scene.
    pub title: String,
    /// Dimension of space, and the number of dofs of a node.
    pub dim: usize,
    /// The units that messages and pictures name.
    pub units: Units,
    /// Plane state; `None` in space.
    pub plane: Option<PlaneState>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Bodies.
    pub bodies: Vec<Body>,
    /// Names of the conditions that prescribe displacements.
    pub supports: Vec<String>,
    /// Contacts.
    pub contacts: Vec<ContactSummary>,
    /// Load steps; none where all loads are there at once.
    pub steps: Vec<LoadStep>,
    /// Subdomains.
    pub subdomains: Vec<SubdomainSummary>,
    /// The nodes of Γ of each subdomain, by their number on Γ, ascending.
    pub interface: Vec<Vec<u32>>,
    /// Number of nodes on Γ.
    pub interface_nodes: usize,
    /// Number of contact points of each group in contact.
    pub groups: Vec<usize>,
    /// The contact points, group by group.
    pub points: Vec<ContactPoint<SubdomainNode>>,
    /// Places at which solutions are checked for penetration.
    pub probes: Vec<Probe<SubdomainNode>>,
    /// Crack tips of the plane.
    pub tips: Vec<CrackTip>,
    /// Quantities that are asked for.
    pub quantities: Vec<Quantity>,
    /// Parameters of their derivatives.
    pub parameters: Vec<Parameter>,
    /// The nodes of every contact point.
    pub point_nodes: Vec<Vec<PointNode>>,
    /// The tree along which Schur complements are merged.
    pub hierarchy: Hierarchy,
    /// Settings of the solver.
    pub solver: SolverSettings,
    /// Warnings of the partition tool, to be repeated in the report.
    pub warnings: Vec<String>,
}

impl Body {
    /// A body that is there.
    pub fn new(name: String) -> Self {
        Self {
            name,
            is_absent: false,
        }
    }
}

impl Catalog {
    /// The number of the body that a block is of.
    pub fn body_of(&self, block: BlockId) -> usize {
        self.subdomains[block.index()].body
    }

    /// Number of nodes, those on Γ counted once.
    pub fn nodes(&self) -> usize {
        let nodes: usize = self.subdomains.iter().map(|s| s.nodes).sum();
        let copies: usize = self.interface.iter().map(Vec::len).sum();
        nodes - copies + self.interface_nodes
    }

    /// Number of dofs, those of nodes on Γ counted once.
    pub fn dofs(&self) -> usize {
        self.dim * self.nodes()
    }

    /// True if a contact has friction.
    pub fn has_friction(&self) -> bool {
        self.points.iter().any(|point| point.law.has_friction())
    }

    /// Number of contact conditions.
    pub fn conditions(&self) -> usize {
        self.conditions_of(ContactKind::Unilateral)
    }

    /// Number of points of the contacts of a kind.
    pub fn conditions_of(&self, kind: ContactKind) -> usize {
        let contacts = self.contacts.iter().filter(|contact| contact.kind == kind);
        contacts.map(|contact| contact.conditions).sum()
    }
}

/// A whole problem, as the partition tool holds it before it is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Catalog.
    pub catalog: Catalog,
    /// Subdomains.
    pub subdomains: Vec<Subdomain>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_direction_that_a_support_leaves_is_not_enough_for_two_conditions() {
        let (normal, tangent, up) = ([0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 1.0, 0.0]);
        let is_free = |conditions: &[[f64; 3]], supports: &[[f64; 3]]| {
            let conditions = conditions.iter().copied();
            PointNode::new(None, conditions, supports.iter().copied()).is_free
        };
        assert!(is_free(&[normal, tangent], &[]));
        assert!(is_free(&[normal], &[up]));
        assert!(!is_free(&[normal, tangent], &[up]));
        assert!(!is_free(&[normal], &[normal]));
    }
}
