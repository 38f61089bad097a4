//! What the ranks hand over to be written.

use contact_dd_partition::contact_point::ContactPoint;
use serde::{Deserialize, Serialize};

/// How much room a subdomain takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PartitionSize {
    /// Number of nodes.
    pub points: usize,
    /// Number of cells.
    pub cells: usize,
    /// Sum of the number of nodes over all cells.
    pub connectivity: usize,
}

/// The solution on consecutive subdomains: each list holds what belongs to the first one, then
/// what belongs to the next, in the types that the file has.
///
/// Stresses are (Pa) in the order XX, YY, ZZ, XY, YZ, XZ; their lists are empty where they are left
/// out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SubdomainResults {
    /// Number of the first subdomain.
    pub first: usize,
    /// Size of each.
    pub sizes: Vec<PartitionSize>,
    /// Undeformed coordinates of the nodes (m).
    #[serde(with = "crate::bytes")]
    pub points: Vec<[f64; 3]>,
    /// The mesh file's tag of each node.
    #[serde(with = "crate::bytes")]
    pub node_tags: Vec<i64>,
    /// Displacement of the nodes (m).
    #[serde(with = "crate::bytes")]
    pub displacement: Vec<[f64; 3]>,
    /// Stress recovered at the nodes.
    #[serde(with = "crate::bytes")]
    pub nodal_stress: Vec<[f64; 6]>,
    /// Nodes of the cells, numbered within their subdomain.
    #[serde(with = "crate::bytes")]
    pub connectivity: Vec<i64>,
    /// For every subdomain the start of each of its cells in its part of `connectivity`, and the
    /// end: one more than cells.
    #[serde(with = "crate::bytes")]
    pub offsets: Vec<i64>,
    /// VTK's number of the type of every cell.
    #[serde(with = "crate::bytes")]
    pub types: Vec<u8>,
    /// Index of its material for every cell.
    #[serde(with = "crate::bytes")]
    pub materials: Vec<i32>,
    /// Stress of the cells.
    #[serde(with = "crate::bytes")]
    pub cell_stress: Vec<[f64; 6]>,
    /// Principal stresses of the cells, descending (Pa).
    #[serde(with = "crate::bytes")]
    pub principal: Vec<[f64; 3]>,
    /// Von Mises stress of the cells (Pa).
    #[serde(with = "crate::bytes")]
    pub von_mises: Vec<f64>,
    /// Estimated error of the cells in the energy norm (√N, per metre of thickness).
    #[serde(with = "crate::bytes")]
    pub energy_error: Vec<f64>,
}

impl SubdomainResults {
    /// Empties all lists for subdomains from `first` on. Their memory stays: fresh pages cost as
    /// much as what is written into them.
    pub fn restart(&mut self, first: usize) {
        // Every list by its name, so that none can be forgotten.
        let Self {
            first: start,
            sizes,
            points,
            node_tags,
            displacement,
            nodal_stress,
            connectivity,
            offsets,
            types,
            materials,
            cell_stress,
            principal,
            von_mises,
            energy_error,
        } = self;
        *start = first;
        sizes.clear();
        points.clear();
        node_tags.clear();
        displacement.clear();
        nodal_stress.clear();
        connectivity.clear();
        offsets.clear();
        types.clear();
        materials.clear();
        cell_stress.clear();
        principal.clear();
        von_mises.clear();
        energy_error.clear();
    }

    /// Appends those of the next subdomains.
    pub fn append(&mut self, next: Self) {
        let Self {
            first: _,
            sizes,
            points,
            node_tags,
            displacement,
            nodal_stress,
            connectivity,
            offsets,
            types,
            materials,
            cell_stress,
            principal,
            von_mises,
            energy_error,
        } = next;
        self.sizes.extend(sizes);
        self.points.extend(points);
        self.node_tags.extend(node_tags);
        self.displacement.extend(displacement);
        self.nodal_stress.extend(nodal_stress);
        self.connectivity.extend(connectivity);
        self.offsets.extend(offsets);
        self.types.extend(types);
        self.materials.extend(materials);
        self.cell_stress.extend(cell_stress);
        self.principal.extend(principal);
        self.von_mises.extend(von_mises);
        self.energy_error.extend(energy_error);
    }
}

/// The solution at a contact point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactState {
    /// The gap that is left, g − n·⟦u⟧ ≥ 0 (m).
    pub gap: f64,
    /// Normal force ≥ 0 (N, per metre of thickness in the plane).
    pub force: f64,
    /// Whether the contact is closed.
    pub closed: bool,
}

/// A contact point and the solution there.
pub type ContactRow = (ContactPoint<u32>, ContactState);
