//! What the ranks hand over to be written.

/// How much room a subdomain takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SubdomainResults {
    /// Number of the first subdomain.
    pub first: usize,
    /// Size of each.
    pub sizes: Vec<PartitionSize>,
    /// Undeformed coordinates of the nodes (m).
    pub points: Vec<[f64; 3]>,
    /// The mesh file's tag of each node.
    pub node_tags: Vec<i64>,
    /// Displacement of the nodes (m).
    pub displacement: Vec<[f64; 3]>,
    /// Stress recovered at the nodes.
    pub nodal_stress: Vec<[f64; 6]>,
    /// Nodes of the cells, numbered within their subdomain.
    pub connectivity: Vec<i64>,
    /// For every subdomain the start of each of its cells in its part of `connectivity`, and the
    /// end: one more than cells.
    pub offsets: Vec<i64>,
    /// VTK's number of the type of every cell.
    pub types: Vec<u8>,
    /// Index of its material for every cell.
    pub materials: Vec<i32>,
    /// Stress of the cells.
    pub cell_stress: Vec<[f64; 6]>,
    /// Principal stresses of the cells, descending (Pa).
    pub principal: Vec<[f64; 3]>,
    /// Von Mises stress of the cells (Pa).
    pub von_mises: Vec<f64>,
    /// Estimated error of the cells in the energy norm (√N, per metre of thickness).
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
}

/// The solution at one contact condition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactResult {
    /// Index of its contact among those of the catalog.
    pub contact: usize,
    /// Its place within that contact.
    pub place: usize,
    /// Tag of its node on side a, −1 where there is none.
    pub tag_a: i64,
    /// Tag of its node on side b, −1 where there is none.
    pub tag_b: i64,
    /// Undeformed position on side a (m).
    pub position: [f64; 3],
    /// Where the force on side a acts (m); the file doesn't hold it.
    pub acts_at: [f64; 3],
    /// Unit normal of the undeformed side a, outward.
    pub normal: [f64; 3],
    /// The gap that is left, g − B u ≥ 0 (m).
    pub gap: f64,
    /// Contact force ≥ 0 (N, per metre of thickness in the plane).
    pub force: f64,
    /// Force over the condition's share of side a, ≥ 0 (Pa).
    pub pressure: f64,
    /// Whether the contact is closed.
    pub closed: bool,
}

/// One sweep; the first row of a run is its bilateral start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvergenceRow {
    /// Number of the load step.
    pub step: usize,
    /// Relative residual of the interface problem after the sweep.
    pub residual: f64,
    /// Number of closed contact conditions.
    pub active: usize,
    /// Time since the sweeps began (s).
    pub seconds: f64,
}
