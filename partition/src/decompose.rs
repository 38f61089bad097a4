//! Contact-aware partition: METIS on a graph in which Γ can't meet Γ_c.

mod build;
mod contraction;
mod graph;
mod growth;
pub mod hierarchy;
mod multilevel;
mod order;
mod regions;
mod share;
mod split;
pub mod summary;

use self::contraction::Contraction;
use self::regions::Regions;
use std::collections::HashMap;

use self::graph::Graph;
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
    /// A count that can't be, with the range that can; a mesh without cells.
    pub fn new(model: &Model, count: Option<usize>) -> Result<Self, InputError> {
        if model.mesh.cells.is_empty() {
            return Err(InputError::new("the mesh has no cells"));
        }
        if let Some(subdomain) = &model.prescribed_subdomains {
            return Self::prescribed(subdomain, count);
        }
        let topology = Topology::new(&model.mesh);
        let spared = count.map_or(0, |count| CELLS * count);
        let Contraction { graph, of_cell } = &Contraction::new(model, &topology, spared);
        let weights = graph.cell_weights();
        let mut regions = Regions::of_parts(graph, &weights, &graph.material);
        let (least, most) = (regions.pieces(), graph.len());
        let suitable = || suitable(model, graph, regions.members().len());
        let count = count.unwrap_or_else(|| suitable().clamp(least, most));
        if !(least..=most).contains(&count) {
            return Err(InputError::new(format!(
                "{count} subdomains can't be; expected {least} (the separate pieces of the mesh) to {most} (the cells, those around a contact surface counted as one)"
            )));
        }
        // More regions than subdomains are merged, and those smaller than one half of a mean
        // subdomain with them, so that grains don't unbalance a partition that mixes materials
        // anyway.
        if regions.members().len() > count {
            regions.merge_below(count, graph.size() / (2 * count as u64));
        }
        let graphs = graph.split(regions.members());
        let shares = share::share(&graphs, count);
        let mut label = vec![(0, 0); graph.len()];
        for (region, (part, share)) in graphs.iter().zip(shares).enumerate() {
            let parts = split::split(part, share);
            for (&vertex, part) in regions.members()[region].iter().zip(parts) {
                label[vertex as usize] = (region, part);
            }
        }
        // Subdomains are numbered by first cell.
        let mut numbers = HashMap::new();
        let mut number = |&vertex: &u32| {
            let next = numbers.len() as u32;
            *numbers.entry(label[vertex as usize]).or_insert(next)
        };
        Ok(Self {
            count,
            subdomain: of_cell.iter().map(&mut number).collect(),
        })
    }

    /// The partition that the scene prescribes, as it is.
    fn prescribed(subdomain: &[u32], count: Option<usize>) -> Result<Self, InputError> {
        let found = subdomain.iter().max().map_or(0, |&s| s as usize + 1);
        match count {
            Some(count) if count != found => Err(InputError::new(format!(
                "{count} subdomains were asked for, but the partition that the scene prescribes has {found}; expected {found}, or no number"
            ))),
            _ => Ok(Self {
                count: found,
                subdomain: subdomain.to_vec(),
            }),
        }
    }
}

/// A number of subdomains that suits the size and gives every contact patch, and every one of the
/// regions of one material where there are few, its own.
fn suitable(model: &Model, graph: &Graph, regions: usize) -> usize {
    let dofs = model.mesh.dim * model.mesh.points.len();
    let contact_patches = graph.contact_patches();
    let with_contact = match contact_patches {
        0 => 1,
        _ => contact_patches + LINEAR,
    };
    let with_materials = match regions {
        many if many > MATERIALS => 1,
        few => few,
    };
    let outside = dofs * (graph.len() - contact_patches) / model.mesh.cells.len();
    let for_speed = match dofs > SMALL {
        true => outside.div_ceil(DOFS) + contact_patches,
        false => 1,
    };
    for_speed.max(with_contact).max(with_materials)
}
