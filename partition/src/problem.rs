//! The problem file: the content of a subdomain, of a contact group and of the catalog of both.
//!
//! The writer and the reader of `problem.h5` share these types; docs/problem-file.md describes the format for users who
//! write one with h5py.

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

/// Squared norm, at a node, of the part of a unit normal that supports leave free, above which the node counts as free
/// along it.
const LEAST_FREE: f64 = 0.01;

/// Largest deviation of a unit vector's length from 1, and of the product of orthogonal ones from 0.
const UNIT_TOLERANCE: f64 = 1e-10;

/// A node on Γ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InterfaceNode {
    /// Node of the subdomain.
    pub node: u32,
    /// Number on Γ, equal in all subdomains that share it.
    pub interface: u32,
}

/// A subdomain Ω^n: a piece of one body.
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
    /// Cells, by local nodes.
    pub cells: Elements,
    /// Index of its material for every cell.
    pub cell_material: Vec<u32>,
    /// Supports, by local nodes.
    pub supports: Vec<Support>,
    /// Springs to the ground, by local nodes.
    pub springs: Vec<SpringBlock>,
    /// Nodal forces, by local nodes (N per metre of thickness).
    pub forces: Vec<(u32, [f64; 3])>,
    /// Initial stress.
    pub initial_stress: InitialStress,
    /// Nodes on Γ, in ascending order of their number on Γ.
    pub interface: Vec<InterfaceNode>,
    /// Nodal weights of its nodes in quantities, and nodal forces of loads that are parameters.
    pub shares: NodalShares,
    /// Values of its supports and forces in every load step; none where the problem has none.
    pub steps: Vec<StepLoads>,
    /// Number of reference nodes of couplings, which follow the nodes of its cells and move with its body.
    pub reference_nodes: usize,
    /// Number of [auxiliary] nodes of contact points, which are the last ones and aren't stored in files.
    pub auxiliary_nodes: usize,
}

/// The loads of a subdomain in a load step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepLoads {
    /// Prescribed displacement of every support (m).
    pub supports: Vec<f64>,
    /// Force on every loaded node (N per metre of thickness).
    pub forces: Vec<[f64; 3]>,
    /// Initial stress.
    pub initial_stress: InitialStress,
}

/// Initial stress of a subdomain, XX YY ZZ XY YZ XZ (Pa); empty where the problem has none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitialStress {
    /// The average over every cell.
    pub cells: Vec<[f64; 6]>,
    /// Stress at every node, in the first of the adjacent materials.
    pub nodes: Vec<[f64; 6]>,
}

impl Subdomain {
    /// Number of nodes of its cells, which come first.
    pub fn cell_nodes(&self) -> usize {
        self.body_nodes() - self.reference_nodes
    }

    /// Number of nodes that move with its body, which come first.
    pub fn body_nodes(&self) -> usize {
        self.points.len() - self.auxiliary_nodes
    }

    /// Supports with their values in a load step.
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

    /// Initial stress in a load step.
    pub fn initial_stress_in(&self, step: usize) -> &InitialStress {
        let loads = self.steps.get(step);
        loads.map_or(&self.initial_stress, |loads| &loads.initial_stress)
    }

    /// The initial stress of every load step, or the single one without load steps.
    fn initial_stresses(&self) -> Vec<&InitialStress> {
        match self.steps.is_empty() {
            true => vec![&self.initial_stress],
            false => self.steps.iter().map(|step| &step.initial_stress).collect(),
        }
    }

    /// The values of a support in every load step, or the single one without load steps.
    fn support(&self, i: usize) -> Vec<f64> {
        match self.steps.is_empty() {
            true => vec![self.supports[i].value],
            false => self.steps.iter().map(|step| step.supports[i]).collect(),
        }
    }

    /// The values of a nodal force in every load step, or the single one without load steps.
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
    /// True if supports leave it free, at least approximately, along the normal of the point and, with friction, along
    /// its tangents: one free direction isn't enough for two.
    pub is_free: bool,
}

impl PointNode {
    /// A node of a point that has constraints along these directions, where `supports` are the directions in which it
    /// is held.
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
    /// Contact group; `None` for a linear subdomain.
    pub group: Option<usize>,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of cells.
    pub cells: usize,
}

/// A load step: quasi-static, and without friction its solution depends only on its own loads.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadStep {
    /// Name.
    pub name: String,
    /// Time on the load path.
    pub time: f64,
    /// The bodies and contacts that are absent.
    pub absent: Absent,
}

/// The bodies and contacts that are absent in a load step, by their numbers, ascending; contacts of absent bodies
/// needn't be listed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Absent {
    /// Bodies.
    pub bodies: Vec<u32>,
    /// Contacts.
    pub contacts: Vec<u32>,
}

/// A body: one connected piece of the mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Body {
    /// Name of the scene's body, numbered if that one has several pieces.
    pub name: String,
    /// True if it is absent in the [stage](stage::Stage) of the catalog.
    pub is_absent: bool,
}

/// A tree over the subdomains, along which their Schur complements are merged.
///
/// Nodes 0 to N − 1 are the N subdomains, those from N on are inner nodes. Subdomains that share a node of Γ have a
/// common root.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Hierarchy {
    /// The parent of every node, greater than its own number; `None` for a root.
    pub parent: Vec<Option<u32>>,
    /// The clusters of the iterative interface solver: nodes, ascending, such that every subdomain is one of them or
    /// under exactly one. Empty if the file doesn't define them.
    pub clusters: Vec<u32>,
}

/// The catalog of the whole problem, stored on every rank.
#[derive(Clone, Debug, PartialEq)]
pub struct Catalog {
    /// Title of the scene.
    pub title: String,
    /// Dimension of space, and the number of dofs of a node.
    pub dim: usize,
    /// The units in messages and pictures.
    pub units: Units,
    /// Plane state; `None` in space.
    pub plane: Option<PlaneState>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Bodies.
    pub bodies: Vec<Body>,
    /// Names of the boundary conditions that prescribe displacements.
    pub supports: Vec<String>,
    /// Contacts.
    pub contacts: Vec<ContactSummary>,
    /// Load steps; none if all loads are applied at once.
    pub steps: Vec<LoadStep>,
    /// Subdomains.
    pub subdomains: Vec<SubdomainSummary>,
    /// The nodes of Γ of each subdomain, by their number on Γ, ascending.
    pub interface: Vec<Vec<u32>>,
    /// Number of nodes on Γ.
    pub interface_nodes: usize,
    /// Number of contact points of each contact group.
    pub groups: Vec<usize>,
    /// The contact points, group by group.
    pub points: Vec<ContactPoint<SubdomainNode>>,
    /// Points at which solutions are checked for penetration.
    pub probes: Vec<Probe<SubdomainNode>>,
    /// Crack tips of a plane mesh.
    pub tips: Vec<CrackTip>,
    /// Requested quantities.
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
    /// A body that is present.
    pub fn new(name: String) -> Self {
        Self {
            name,
            is_absent: false,
        }
    }
}

impl Catalog {
    /// The body of a block.
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

    /// Number of contact constraints.
    pub fn conditions(&self) -> usize {
        self.conditions_of(ContactKind::Unilateral)
    }

    /// Number of constraints of the contacts of a kind.
    pub fn conditions_of(&self, kind: ContactKind) -> usize {
        let contacts = self.contacts.iter().filter(|contact| contact.kind == kind);
        contacts.map(|contact| contact.conditions).sum()
    }
}

/// A whole problem, as produced by the partition tool.
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
