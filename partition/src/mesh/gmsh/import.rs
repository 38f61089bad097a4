//! Import of a file: cells, facets, groups, and the nodes of cells.

use std::collections::{BTreeMap, HashMap};

use super::content::{Block, Content, Nodes};
use super::names;
use crate::element::{ElementKind, Elements};
use crate::error::InputError;
use crate::lists::Lists;
use crate::mesh::{Group, Mesh};

/// An element of a file.
#[derive(Clone, Copy)]
struct Listed<'a> {
    tag: i64,
    kind: ElementKind,
    groups: &'a [i64],
    nodes: &'a [u32],
}

/// The elements of one dimension, without repetition, in ascending order of tags.
struct Distinct<'a> {
    elements: Vec<Listed<'a>>,
    /// Elements of every physical group, ascending.
    groups: BTreeMap<i64, Vec<u32>>,
}

/// The mesh that `content` describes.
pub(super) fn mesh(content: Content) -> Result<Mesh, InputError> {
    let dim = content.blocks.iter().map(|b| b.kind.dim()).max();
    let dim = dim.unwrap_or_default();
    if dim < ElementKind::Triangle3.dim() {
        return Err(InputError::new(
            "the mesh has no cells: expected triangles or quadrilaterals (gmsh -2), or tetrahedra or hexahedra in space (gmsh -3); \
             a file of Gmsh holds only what is in a physical group, a Physical Surface or Physical Volume, unless \
             Mesh.SaveAll is set",
        ));
    }
    let mut cells = listed(&content.blocks, dim);
    if cells.iter().any(|cell| !cell.groups.is_empty()) {
        cells.retain(|cell| !cell.groups.is_empty());
    }
    let cells = distinct(cells)?;
    let mut mesh = Mesh {
        dim,
        ..Mesh::default()
    };
    let index = keep_nodes(&content.nodes, &cells, &mut mesh)?;
    (mesh.flatten())
        .map_err(|error| InputError::new(format!("{error}{}", without_volumes(&content))))?;
    let mut of_cell = Vec::new();
    for cell in &cells.elements {
        of_cell.clear();
        of_cell.extend(cell.nodes.iter().filter_map(|&node| index[node as usize]));
        mesh.cells.push(cell.kind, &of_cell);
        mesh.cell_tags.push(cell.tag);
    }
    mesh.orient_cells()?;

    let mut groups: BTreeMap<(usize, i64), Vec<u32>> = BTreeMap::new();
    for dim in 0..=dim {
        let named = content.names.keys().filter(|key| key.0 == dim);
        groups.extend(named.map(|&key| (key, Vec::new())));
    }
    let mut add = |dim, found: BTreeMap<i64, Vec<u32>>| {
        for (number, members) in found {
            groups.insert((dim, number), members);
        }
    };
    add(dim, cells.groups);
    let (facets, found) = facets(&content, dim, &index)?;
    mesh.facets = facets;
    add(dim - 1, found);
    for low in 0..dim - 1 {
        add(low, nodes(&content, low, &index));
    }
    mesh.groups = names::by_name(groups, &content.names)?
        .into_iter()
        .map(|(name, (dim, members))| (name, Group { dim, members }))
        .collect();
    Ok(mesh)
}

fn listed(blocks: &[Block], dim: usize) -> Vec<Listed<'_>> {
    let mut all = Vec::new();
    for block in blocks.iter().filter(|b| b.kind.dim() == dim) {
        let nodes = block.nodes.chunks_exact(block.kind.nodes());
        all.extend(block.tags.iter().zip(nodes).map(|(&tag, nodes)| Listed {
            tag,
            kind: block.kind,
            groups: &block.groups,
            nodes,
        }));
    }
    all
}

/// Merges elements that are listed once for each of their groups: those with the same nodes.
fn distinct(mut listed: Vec<Listed<'_>>) -> Result<Distinct<'_>, InputError> {
    if !listed.is_sorted_by_key(|e| e.tag) {
        listed.sort_by_key(|e| e.tag);
    }
    let first = first_of_same(&listed);
    let mut places: Vec<u32> = Vec::with_capacity(listed.len());
    let mut count = 0;
    for (number, &first) in first.iter().enumerate() {
        places.push(match first as usize == number {
            true => count,
            false => places[first as usize],
        });
        count += u32::from(first as usize == number);
    }
    let mut groups: BTreeMap<i64, Vec<u32>> = BTreeMap::new();
    let mut rest = &places[..];
    for alike in listed.chunk_by(|a, b| a.groups == b.groups) {
        let (of_these, others) = rest.split_at(alike.len());
        rest = others;
        for &group in alike[0].groups {
            groups.entry(group).or_default().extend(of_these);
        }
    }
    let mut number = 0..;
    let is_first = |at: Option<usize>| at.is_some_and(|at| first[at] as usize == at);
    listed.retain(|_| is_first(number.next()));
    let elements = listed;
    if let Some(twice) = elements.windows(2).find(|w| w[0].tag == w[1].tag) {
        return Err(InputError::new(format!(
            "the element tag {} occurs twice, with different nodes",
            twice[0].tag
        )));
    }
    for (group, members) in &mut groups {
        members.sort_unstable();
        if let Some(twice) = members.windows(2).find(|w| w[0] == w[1]) {
            return Err(InputError::new(format!(
                "the element {} is listed twice in physical group {group}, be it under another \
                 tag; expected every element once in a group",
                elements[twice[0] as usize].tag
            )));
        }
    }
    Ok(Distinct { elements, groups })
}

/// The first element with the same nodes, in any order, for each element.
fn first_of_same(listed: &[Listed]) -> Vec<u32> {
    let nodes = listed.iter().flat_map(|e| e.nodes).max();
    let nodes = nodes.map_or(0, |&n| n as usize + 1);
    let by_lowest = (0..).zip(listed).filter_map(|(number, element)| {
        let lowest = element.nodes.iter().min()?;
        Some((*lowest, (number, sum(element.nodes))))
    });
    let mut first: Vec<u32> = (0..listed.len() as u32).collect();
    let mut alike = Vec::new();
    for list in Lists::new(nodes, by_lowest).iter() {
        alike.clear();
        // Only elements with the same sum of nodes can have the same nodes.
        alike.extend(list.iter().map(|&(number, sum)| (sum, number)));
        alike.sort_unstable();
        for same in alike.chunk_by(|a, b| a.0 == b.0).filter(|c| c.len() > 1) {
            let mut known: HashMap<Box<[u32]>, u32> = HashMap::new();
            for &(_, number) in same {
                let mut key: Box<[u32]> = listed[number as usize].nodes.into();
                key.sort_unstable();
                first[number as usize] = *known.entry(key).or_insert(number);
            }
        }
    }
    first
}

fn sum(nodes: &[u32]) -> u64 {
    nodes.iter().map(|&node| u64::from(node)).sum()
}

/// Adds the nodes of `cells` to `mesh`, in ascending order of tags, and returns the index there of every node of the
/// file.
fn keep_nodes(
    nodes: &Nodes,
    cells: &Distinct,
    mesh: &mut Mesh,
) -> Result<Vec<Option<u32>>, InputError> {
    let mut used = vec![false; nodes.tags.len()];
    for &node in cells.elements.iter().flat_map(|cell| cell.nodes) {
        used[node as usize] = true;
    }
    let mut kept: Vec<usize> = (0..used.len()).filter(|&node| used[node]).collect();
    if !kept.is_sorted_by_key(|&node| nodes.tags[node]) {
        kept.sort_by_key(|&node| nodes.tags[node]);
    }
    let mut index = vec![None; used.len()];
    for &node in &kept {
        index[node] = Some(mesh.points.len() as u32);
        mesh.points.push(nodes.points[node]);
        mesh.node_tags.push(nodes.tags[node]);
    }
    Ok(index)
}

/// Advice for a mesh in space without volume cells.
fn without_volumes(content: &Content) -> String {
    let volume = content.names.keys().find(|(dim, _)| *dim == 3);
    let name = volume.and_then(|key| content.names.get(key));
    let how = match name {
        Some(name) => {
            format!("the group '{name}' of volumes is empty: gmsh -3, not gmsh -2, makes its cells")
        }
        None => {
            "gmsh -3, not gmsh -2, makes them, and a file holds those of a Physical Volume".into()
        }
    };
    format!("; if the bodies are those of space, it has no cells with a volume: {how}")
}

fn renumbered(nodes: &[u32], index: &[Option<u32>]) -> Vec<u32> {
    nodes
        .iter()
        .filter_map(|&node| index[node as usize])
        .collect()
}

type Members = BTreeMap<i64, Vec<u32>>;

/// The listed facets all of whose nodes belong to cells, and their groups.
fn facets(
    content: &Content,
    dim: usize,
    index: &[Option<u32>],
) -> Result<(Elements, Members), InputError> {
    let mut listed = listed(&content.blocks, dim - 1);
    listed.retain(|facet| facet.nodes.iter().all(|&n| index[n as usize].is_some()));
    let distinct = distinct(listed)?;
    let mut facets = Elements::default();
    for facet in &distinct.elements {
        facets.push(facet.kind, &renumbered(facet.nodes, index));
    }
    Ok((facets, distinct.groups))
}

/// The nodes of groups of a dimension that belong to cells.
fn nodes(content: &Content, dim: usize, index: &[Option<u32>]) -> Members {
    let mut groups = Members::new();
    for element in listed(&content.blocks, dim) {
        for &group in element.groups {
            let members = groups.entry(group).or_default();
            members.extend(renumbered(element.nodes, index));
        }
    }
    for members in groups.values_mut() {
        members.sort_unstable();
        members.dedup();
    }
    groups
}
