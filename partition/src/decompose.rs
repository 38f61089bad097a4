//! Contact-aware partition: METIS on a graph in which Γ can't meet Γ_c.

mod atoms;
pub(crate) mod disjoint_sets;
mod graph;
mod multilevel;
mod piece;
mod prescribed;
mod regions;
mod share;

use self::atoms::Atoms;
use self::graph::Graph;
use crate::error::InputError;
use crate::mesh::topology::Topology;
use crate::model::Model;

/// Dofs of a subdomain where the user doesn't say how many subdomains there should be.
const DOFS: usize = 20_000;

/// Subdomains without contact that there are beside those in contact, at least.
const LINEAR: usize = 4;

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
    /// allows, so that contacts lie within pairs. Equal models give equal partitions. A partition
    /// that the scene prescribes is taken as it is.
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
        let atoms = Atoms::new(model, &topology);
        let graphs: Vec<&Graph> = atoms.pieces.iter().map(|piece| &piece.graph).collect();
        let (least, most) = (graphs.len(), atoms.count());
        let count = count.unwrap_or_else(|| suitable(model, &graphs).clamp(least, most));
        if !(least..=most).contains(&count) {
            return Err(InputError::new(format!(
                "{count} subdomains can't be; expected {least} (the separate pieces of the mesh) to {most} (the cells, those around a contact surface counted as one)"
            )));
        }
        let parts: Vec<Vec<u32>> = graphs
            .iter()
            .zip(share::share(&graphs, count))
            .map(|(graph, share)| piece::split(graph, share))
            .collect();
        Ok(Self {
            count,
            subdomain: atoms.subdomains(&parts),
        })
    }
}

/// A number of subdomains that suits the size and gives every cluster its own.
fn suitable(model: &Model, graphs: &[&Graph]) -> usize {
    let dofs = model.mesh.dim * model.mesh.points.len();
    let clusters: usize = graphs.iter().map(|graph| graph.clusters()).sum();
    let with_contact = match clusters {
        0 => 1,
        _ => clusters + LINEAR,
    };
    dofs.div_ceil(DOFS).max(with_contact)
}
