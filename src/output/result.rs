//! Results that ranks send to the root for writing.

use serde::{Deserialize, Serialize};

use super::vtkhdf::column::List;

/// Sizes of the parts of a subdomain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PartitionSize {
    /// Number of nodes.
    pub points: usize,
    /// Number of cells.
    pub cells: usize,
    /// Sum of the number of nodes over all cells.
    pub connectivity: usize,
}

impl PartitionSize {
    /// Adds the size of another subdomain.
    pub(super) fn add(&mut self, other: &Self) {
        self.points += other.points;
        self.cells += other.cells;
        self.connectivity += other.connectivity;
    }
}

/// The entity to which each row of a list belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Per {
    Node,
    Cell,
    NodeOfCell,
    /// Start of each cell and the end of the last: one row more than cells in each subdomain.
    StartOfCell,
}

impl Per {
    /// Number of rows of this many subdomains of this total `size`.
    pub(super) fn rows(self, size: &PartitionSize, subdomains: usize) -> usize {
        match self {
            Self::Node => size.points,
            Self::Cell => size.cells,
            Self::NodeOfCell => size.connectivity,
            Self::StartOfCell => size.cells + subdomains,
        }
    }
}

/// The group of lists that a list belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Of {
    /// The mesh, the same in every load step.
    Mesh,
    Solution,
    /// Lists of stresses, omitted together with these.
    Stress,
    /// Lists of present bodies, omitted unless a load step adds or removes bodies or contacts.
    Presence,
    /// Lists of quantities, omitted without stresses or quantities.
    Quantity,
}

/// A list as stored in the file.
pub(super) struct ListField {
    /// Name of the rows in messages.
    pub(super) what: &'static str,
    /// Path below `/VTKHDF`.
    pub(super) place: &'static str,
    pub(super) per: Per,
    pub(super) of: Of,
}

/// Defines the lists of [`SubdomainResults`], each with its [`ListField`].
macro_rules! lists {
    ($($(#[$doc:meta])* $list:ident: $row:ty, $what:literal, $place:literal, $per:ident, $of:ident;)*) => {
        /// The solution on consecutive subdomains: each list contains the rows of the first one, then those of the
        /// next, and so on, in the types of the file.
        ///
        /// Stresses are in Pa, in the order XX, YY, ZZ, XY, YZ, XZ; their lists are empty if stresses are left out.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        pub struct SubdomainResults {
            /// Number of the first subdomain.
            pub first: usize,
            /// Size of each.
            pub sizes: Vec<PartitionSize>,
            $($(#[$doc])* #[serde(with = "crate::bytes")] pub $list: Vec<$row>,)*
        }

        impl SubdomainResults {
            /// Empties all lists for subdomains from `first` on, but keeps their memory: touching new pages costs as
            /// much as writing the data.
            pub fn restart(&mut self, first: usize) {
                self.first = first;
                self.sizes.clear();
                $(self.$list.clear();)*
            }

            /// Appends the rows of the next subdomains.
            pub fn append(&mut self, next: Self) {
                self.sizes.extend(next.sizes);
                $(self.$list.extend(next.$list);)*
            }

            /// All lists, in a fixed order.
            pub(super) fn lists(&self) -> Vec<(ListField, &dyn List)> {
                vec![$((
                    ListField { what: $what, place: $place, per: Per::$per, of: Of::$of },
                    &self.$list,
                ),)*]
            }
        }
    };
}

lists! {
    /// Undeformed coordinates of the nodes (m).
    points: [f64; 3], "points", "Points", Node, Mesh;
    /// Tag of each node in the mesh file.
    node_tags: i64, "node tags", "PointData/GlobalNodeId", Node, Mesh;
    /// Displacement of the nodes (m).
    displacement: [f64; 3], "displacements", "PointData/Displacement", Node, Solution;
    /// Stress recovered at the nodes.
    nodal_stress: [f64; 6], "nodal stresses", "PointData/Stress", Node, Stress;
    /// Von Mises stress of the stress recovered at the nodes (Pa).
    nodal_von_mises: f64, "nodal von Mises stresses", "PointData/VonMises", Node, Stress;
    /// Nodes of the cells, numbered within their subdomain.
    connectivity: i64, "connectivity", "Connectivity", NodeOfCell, Mesh;
    /// Start of each cell of every subdomain in its part of `connectivity`, and the end: one more than cells.
    offsets: i64, "offsets", "Offsets", StartOfCell, Mesh;
    /// VTK's number of the type of every cell.
    types: u8, "cell types", "Types", Cell, Mesh;
    /// Index of the material of every cell.
    materials: i32, "materials", "CellData/Material", Cell, Mesh;
    /// Flags of the cells whose body is present.
    present: u8, "presences", "CellData/Present", Cell, Presence;
    /// Stress of the cells.
    cell_stress: [f64; 6], "cell stresses", "CellData/Stress", Cell, Stress;
    /// Principal stresses of the cells, descending (Pa).
    principal: [f64; 3], "principal stresses", "CellData/PrincipalStress", Cell, Stress;
    /// Von Mises stress of the cells (Pa).
    von_mises: f64, "von Mises stresses", "CellData/VonMises", Cell, Stress;
    /// Estimated error of the cells in the energy norm (√N, per metre of thickness).
    energy_error: f64, "errors", "CellData/EnergyError", Cell, Stress;
    /// Contributions of the cells to the estimated error of the first quantity, in its unit; NaN in cells without one.
    quantity_error: f64, "errors of a quantity", "CellData/QuantityError", Cell, Quantity;
}
