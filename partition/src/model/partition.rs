//! The partition that a scene asks for.

use super::groups;
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::scene::condition::Names;

/// The subdomain of every cell, from one group of cells for each.
pub(super) fn prescribed(mesh: &Mesh, names: &Names) -> Result<Vec<u32>, InputError> {
    let list: Vec<&str> = names.iter().collect();
    let mut owner: Vec<Option<u32>> = vec![None; mesh.cells.len()];
    for (subdomain, name) in list.iter().enumerate() {
        for &cell in &groups::cells(mesh, name, "subdomains")?.members {
            if let Some(other) = owner[cell as usize].replace(subdomain as u32) {
                return Err(InputError::new(format!(
                    "subdomains: cell {} of the mesh is in two of them, '{}' and '{name}'",
                    mesh.cell_tags[cell as usize], list[other as usize]
                )));
            }
        }
    }
    if let Some(cell) = owner.iter().position(Option::is_none) {
        return Err(InputError::new(format!(
            "subdomains: cell {} of the mesh (nodes {}) is in none of them; \
             expected each cell of the bodies in exactly one",
            mesh.cell_tags[cell],
            mesh.tags_of(mesh.cells.nodes_of(cell))
        )));
    }
    Ok(owner.into_iter().flatten().collect())
}
