//! Sizes of all parts of the result file.

use contact_dd_partition::model::PlaneState;
use contact_dd_partition::problem::{Catalog, ContactSummary};
use contact_dd_partition::scene::units::Units;

use super::super::result::{Of, PartitionSize};

/// Sizes of all parts of a result file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// Sizes of the subdomains.
    pub partitions: Vec<PartitionSize>,
    /// Sizes of the tables of contacts.
    pub contacts: Vec<ContactSummary>,
    /// Time of every load step; empty if the problem has no steps.
    pub times: Vec<f64>,
    /// True if there are stresses.
    pub stress: bool,
    /// True if load steps add or remove bodies or contacts.
    pub presence: bool,
    /// True if there are stresses and quantities.
    pub quantities: bool,
    /// The scene's title, which may be empty.
    pub title: String,
    /// The units of its numbers.
    pub units: Units,
    /// Plane state; `None` in space.
    pub plane: Option<PlaneState>,
}

impl Layout {
    /// The layout for `catalog`; `connectivity` is, for every subdomain, the sum of the number of nodes over its cells.
    pub fn new(catalog: &Catalog, connectivity: &[usize], stress: bool) -> Self {
        let sizes = catalog.subdomains.iter().zip(connectivity);
        let partitions = sizes.map(|(subdomain, &connectivity)| PartitionSize {
            points: subdomain.nodes,
            cells: subdomain.cells,
            connectivity,
        });
        Self {
            partitions: partitions.collect(),
            contacts: catalog.contacts.clone(),
            times: catalog.steps.iter().map(|step| step.time).collect(),
            stress,
            presence: catalog.has_stages(),
            quantities: stress && !catalog.quantities.is_empty(),
            title: catalog.title.clone(),
            units: catalog.units,
            plane: catalog.plane,
        }
    }
}

impl Layout {
    /// The groups of lists that the file doesn't contain.
    pub(super) fn left_out(&self) -> Vec<Of> {
        let kinds = [
            (Of::Stress, self.stress),
            (Of::Presence, self.presence),
            (Of::Quantity, self.quantities),
        ];
        let left_out = kinds.into_iter().filter(|(_, is_there)| !is_there);
        left_out.map(|(kind, _)| kind).collect()
    }
}
