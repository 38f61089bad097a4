//! The subdomains of each node.

use crate::decompose::Decomposition;
use crate::error::InputError;
use crate::lists::Lists;
use crate::model::Model;

/// The subdomains of each node.
pub(super) struct Owners {
    /// Number of subdomains.
    pub count: usize,
    /// Subdomains of every node, ascending, each with the node's local number there.
    pub of: Lists<(u32, u32)>,
    /// Number on Γ of every node.
    pub interface: Vec<Option<u32>>,
    /// Number of nodes of Γ.
    pub interface_nodes: usize,
}

impl Owners {
    /// The subdomains of a decomposition, node by node.
    ///
    /// # Errors
    /// A decomposition that doesn't belong to the model.
    pub fn new(model: &Model, decomposition: &Decomposition) -> Result<Self, InputError> {
        let Decomposition {
            count, subdomain, ..
        } = decomposition;
        if subdomain.len() != model.mesh.cells.len() {
            return Err(InputError::new(format!(
                "the partition names a subdomain for {} cells; expected {}",
                subdomain.len(),
                model.mesh.cells.len()
            )));
        }
        if let Some(s) = subdomain.iter().find(|&&s| s as usize >= *count) {
            return Err(InputError::new(format!(
                "the partition has {count} subdomains but names number {s}"
            )));
        }
        let corners = (model.mesh.cells.iter().zip(subdomain))
            .flat_map(|((_, nodes), &s)| nodes.iter().map(move |&node| (node, (s, 0))));
        let first = model.mesh.points.len() - model.reference_nodes.len();
        let reference = (first as u32..).zip(&model.reference_nodes);
        let reference = reference.map(|(node, &cell)| (node, (subdomain[cell as usize], 0)));
        let corners = corners.chain(reference);
        let mut of = Lists::new(model.mesh.points.len(), corners);
        of.sort();
        of.dedup();
        let mut sizes = vec![0u32; *count];
        let mut interface = vec![None; of.len()];
        let mut interface_nodes = 0;
        for (node, on) in interface.iter_mut().enumerate() {
            if of.of(node).len() > 1 {
                *on = Some(interface_nodes);
                interface_nodes += 1;
            }
        }
        for (owner, local) in of.items_mut() {
            let size = &mut sizes[*owner as usize];
            *local = *size;
            *size += 1;
        }
        if let Some(empty) = sizes.iter().position(|&size| size == 0) {
            return Err(InputError::new(format!("subdomain {empty} has no cells")));
        }
        Ok(Self {
            count: *count,
            of,
            interface,
            interface_nodes: interface_nodes as usize,
        })
    }

    /// Local number of a node in a subdomain that has it.
    pub fn local(&self, node: u32, subdomain: u32) -> u32 {
        let list = self.of.of(node as usize);
        list.iter()
            .find(|&&(owner, _)| owner == subdomain)
            .map_or(u32::MAX, |&(_, local)| local)
    }
}
