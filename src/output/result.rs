//! What the ranks hand over to be written.

use contact_dd_partition::element::Elements;

/// The solution on one subdomain.
///
/// Stresses are (Pa) in the order XX, YY, ZZ, XY, YZ, XZ; vectors that belong to nodes have one
/// entry for each of `points`, those that belong to cells one for each of `cells`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SubdomainResult {
    /// Number of the subdomain.
    pub index: usize,
    /// Undeformed coordinates of its nodes (m).
    pub points: Vec<[f64; 3]>,
    /// The mesh file's tag of each node.
    pub node_tags: Vec<i64>,
    /// Cells, by node of the subdomain.
    pub cells: Elements,
    /// Index of its material for every cell.
    pub cell_material: Vec<u32>,
    /// Displacement of the nodes (m).
    pub displacement: Vec<[f64; 3]>,
    /// Stress recovered at the nodes.
    pub nodal_stress: Vec<[f64; 6]>,
    /// Stress of the cells.
    pub cell_stress: Vec<[f64; 6]>,
    /// Principal stresses of the cells, descending (Pa).
    pub principal: Vec<[f64; 3]>,
    /// Von Mises stress of the cells (Pa).
    pub von_mises: Vec<f64>,
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
    /// Relative residual of the interface problem after the sweep.
    pub residual: f64,
    /// Number of closed contact conditions.
    pub active: usize,
    /// Time that the sweep took (s).
    pub seconds: f64,
}
