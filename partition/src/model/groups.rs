//! Physical groups by their names in a scene.

use std::collections::BTreeSet;

use crate::error::InputError;
use crate::mesh::{Group, Mesh};
use crate::scene::condition::Names;
use crate::scene::suggest::hint;

/// The required kind of a group's members.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Members {
    Cells,
    Facets,
    FacetsOrPoints,
    Any,
}

impl Members {
    fn fit(self, group: &Group, mesh: &Mesh) -> bool {
        match self {
            Self::Cells => group.dim == mesh.dim,
            Self::Facets => group.dim + 1 == mesh.dim,
            Self::FacetsOrPoints => group.dim < mesh.dim,
            Self::Any => true,
        }
    }

    fn word(self) -> &'static str {
        match self {
            Self::Cells => "cells",
            Self::Facets => "facets",
            Self::FacetsOrPoints => "facets or points",
            Self::Any => "cells, facets or points",
        }
    }
}

/// The facets of the groups `names`, ascending.
pub(super) fn facets(mesh: &Mesh, names: &Names, what: &str) -> Result<Vec<u32>, InputError> {
    let mut facets = BTreeSet::new();
    for name in names.iter() {
        facets.extend(&find(mesh, name, Members::Facets, what)?.members);
    }
    Ok(facets.into_iter().collect())
}

/// True if all existing groups among `names` consist of facets.
pub(super) fn are_of_facets(mesh: &Mesh, names: &Names) -> bool {
    let mut groups = names.iter().filter_map(|name| mesh.groups.get(name));
    groups.all(|group| Members::Facets.fit(group, mesh))
}

/// True if all groups `names` consist of points or, in space, of curves.
pub(super) fn are_of_points(mesh: &Mesh, names: &Names) -> bool {
    let mut groups = names.iter().map(|name| mesh.groups.get(name));
    groups.all(|group| group.is_some_and(|group| group.dim + 1 < mesh.dim))
}

/// The nodes of the groups `names`, of any kind of members, ascending.
pub(super) fn nodes(mesh: &Mesh, names: &Names, what: &str) -> Result<Vec<u32>, InputError> {
    nodes_of(mesh, names, Members::Any, what)
}

/// The nodes of the groups `names` of facets or points, ascending.
pub(super) fn boundary_nodes(
    mesh: &Mesh,
    names: &Names,
    what: &str,
) -> Result<Vec<u32>, InputError> {
    nodes_of(mesh, names, Members::FacetsOrPoints, what)
}

fn nodes_of(
    mesh: &Mesh,
    names: &Names,
    members: Members,
    what: &str,
) -> Result<Vec<u32>, InputError> {
    let mut nodes = BTreeSet::new();
    for name in names.iter() {
        let group = find(mesh, name, members, what)?;
        for member in &group.members {
            nodes.extend(match mesh.dim.checked_sub(group.dim) {
                Some(0) => mesh.cells.nodes_of(*member as usize),
                Some(1) => mesh.facets.nodes_of(*member as usize),
                _ => std::slice::from_ref(member),
            });
        }
    }
    Ok(nodes.into_iter().collect())
}

/// The index in `names` of the group of cells that contains every cell. `what` is the key of the scene, for messages.
///
/// # Errors
/// A cell in two of the groups.
pub(super) fn owners(
    mesh: &Mesh,
    names: &[&str],
    what: &str,
) -> Result<Vec<Option<u32>>, InputError> {
    let mut owner: Vec<Option<u32>> = vec![None; mesh.cells.len()];
    for (number, name) in (0..).zip(names) {
        for &cell in &find(mesh, name, Members::Cells, what)?.members {
            if let Some(other) = owner[cell as usize].replace(number) {
                return Err(InputError::new(format!(
                    "{what}: cell {} of the mesh is in both '{}' and '{name}'",
                    mesh.cell_tags[cell as usize], names[other as usize]
                )));
            }
        }
    }
    Ok(owner)
}

fn find<'a>(
    mesh: &'a Mesh,
    name: &str,
    members: Members,
    what: &str,
) -> Result<&'a Group, InputError> {
    let word = members.word();
    let fitting = mesh
        .groups
        .iter()
        .filter(|(_, group)| members.fit(group, mesh));
    let fitting: Vec<&str> = fitting.map(|(name, _)| name.as_str()).collect();
    let list = match fitting.is_empty() {
        true => format!("the mesh has no group of {word}"),
        false => format!("groups of {word}: {}", fitting.join(", ")),
    };
    match mesh.groups.get(name) {
        Some(group) if !members.fit(group, mesh) => Err(InputError::new(format!(
            "{what}: '{name}' is a group of {}; expected one of {word} ({list})",
            match mesh.dim - group.dim {
                0 => Members::Cells.word(),
                1 => Members::Facets.word(),
                _ if group.dim == 1 => "curves",
                _ => "points",
            }
        ))),
        Some(group) if group.members.is_empty() => Err(InputError::new(format!(
            "{what}: the group '{name}' is empty"
        ))),
        Some(group) => Ok(group),
        None => {
            let hint = hint(name, fitting.iter().copied());
            Err(InputError::new(format!(
                "{what}: the mesh has no physical group '{name}'{hint} ({list})"
            )))
        }
    }
}
