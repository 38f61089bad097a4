//! Contact-aware partition: METIS on a graph in which Γ can't meet Γ_c.

mod atoms;
mod build;
mod graph;
mod growth;
pub mod hierarchy;
mod multilevel;
mod order;
mod prescribed;
mod regions;
mod share;
pub mod summary;
mod unit;
mod units;

use self::atoms::Atoms;
use self::units::Units;
use crate::error::InputError;
use crate::mesh::topology::Topology;
use crate::model::Model;

/// Dofs of a subdomain where the user doesn't say how many subdomains there should be: many small
/// ones, merged along the hierarchy, take less time than few large ones.
const DOFS: usize = 2_000;

/// Dofs up to which a mesh is split no further than contact and materials ask for.
const SMALL: usize = 20_000;

/// Cells for every subdomain that stay outside of those in contact, where the user says how many
/// there should be.
const CELLS: usize = 8;

/// Subdomains without contact that there are beside those in contact, at least.
const LINEAR: usize = 4;

/// Regions of one material up to which each gets its own subdomain where the user doesn't say how
/// many subdomains there should be; more are grains of a composite.
const MATERIALS: usize = 32;

/// A partition of the cells into subdomains.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decomposition {
    /// Number of subdomains.
    pub count: usize,
    /// The subdomain of every cell.
    pub subdomain: Vec<u32>,
}

impl Decomposition {
    /// Splits `model` into exactly `count` subdomains, or into a number that suits its size.
    ///
    /// Every subdomain is connected across facets. All cells around a node with a contact
    /// condition are in one subdomain, and each side of a contact has its own wherever `count`
    /// allows, so that contacts lie within pairs. Where `count` allows, every subdomain is of one
    /// material but for the cells around a contact surface that ends at another one. Equal models
    /// give equal partitions. A partition that the scene prescribes is taken as it is.
    ///
    /// # Errors
    /// A count that can't be, with the range that can; a prescribed partition that doesn't fit.
    pub fn new(model: &Model, count: Option<usize>) -> Result<Self, InputError> {
        if model.mesh.cells.is_empty() {
            return Err(InputError::new("the mesh has no cells"));
        }
        let topology = Topology::new(&model.mesh);
        if let Some(subdomain) = &model.prescribed_subdomains {
            return prescribed::take(model, &topology, subdomain, count);
        }
        let atoms = Atoms::new(model, &topology, count.map_or(0, |count| CELLS * count));
        let cells = atoms.graph.cell_weights();
        let units = Units::new(&atoms.graph, &cells);
        let (least, most) = (units.pieces(), atoms.graph.len());
        let count = count.unwrap_or_else(|| suitable(model, &atoms, &units).clamp(least, most));
        if !(least..=most).contains(&count) {
            return Err(InputError::new(format!(
                "{count} subdomains can't be; expected {least} (the separate pieces of the mesh) to {most} (the cells, those around a contact surface counted as one)"
            )));
        }
        let units = units.for_count(count);
        let graphs = atoms.graph.split(&units);
        let parts: Vec<Vec<u32>> = graphs
            .iter()
            .zip(share::share(&graphs, count))
            .map(|(graph, share)| unit::split(graph, share))
            .collect();
        Ok(Self {
            count,
            subdomain: atoms.subdomains(&units, &parts),
        })
    }
}

/// A number of subdomains that suits the size and gives every contact patch, and every material where
/// there are few, its own.
fn suitable(model: &Model, atoms: &Atoms, units: &Units) -> usize {
    let dofs = model.mesh.dim * model.mesh.points.len();
    let with_contact = match atoms.graph.contact_patches() {
        0 => 1,
        contact_patches => contact_patches + LINEAR,
    };
    let with_materials = match units.of_one_material() {
        many if many > MATERIALS => 1,
        few => few,
    };
    let outside = dofs * atoms.outside() / model.mesh.cells.len();
    let for_speed = match dofs > SMALL {
        true => outside.div_ceil(DOFS) + atoms.graph.contact_patches(),
        false => 1,
    };
    for_speed.max(with_contact).max(with_materials)
}
