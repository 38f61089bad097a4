//! A partition that the user prescribes.

use super::Decomposition;
use crate::error::InputError;
use crate::mesh::topology::Topology;
use crate::model::Model;

/// Takes the user's partition as it is.
///
/// # Errors
/// A wrong number of subdomains, an empty one, or one that lies in two pieces of the mesh.
pub(super) fn take(
    model: &Model,
    topology: &Topology,
    subdomain: &[u32],
    count: Option<usize>,
) -> Result<Decomposition, InputError> {
    let cells = model.mesh.cells.len();
    if subdomain.len() != cells {
        return Err(InputError::new(format!(
            "the prescribed partition has {} entries; expected one for each of {cells} cells",
            subdomain.len()
        )));
    }
    let found = subdomain.iter().max().map_or(0, |&s| s as usize + 1);
    if let Some(count) = count.filter(|&count| count != found) {
        return Err(InputError::new(format!(
            "{count} subdomains were asked for, but the partition that the scene prescribes has {found}; expected {found}, or no number"
        )));
    }
    let piece = topology.pieces();
    let mut first: Vec<Option<usize>> = vec![None; found.min(cells)];
    for (cell, &s) in subdomain.iter().enumerate() {
        let Some(seen) = first.get_mut(s as usize) else {
            return Err(InputError::new(format!(
                "the prescribed partition names subdomain {s} (element {}), but there are only {cells} cells",
                model.mesh.cell_tags[cell]
            )));
        };
        let seen = *seen.get_or_insert(cell);
        if piece[seen] != piece[cell] {
            return Err(InputError::new(format!(
                "the prescribed subdomain {s} holds the elements {} and {}, which lie in different pieces of the mesh; expected subdomains of one piece",
                model.mesh.cell_tags[seen], model.mesh.cell_tags[cell]
            )));
        }
    }
    match first.iter().position(Option::is_none) {
        Some(empty) => Err(InputError::new(format!(
            "the prescribed subdomain {empty} has no cells"
        ))),
        None => Ok(Decomposition {
            count: found,
            subdomain: subdomain.to_vec(),
        }),
    }
}
