//! The sections of MSH 4.1.

use super::content::{Content, groups};
use super::cursor::Cursor;
use super::element_type;
use crate::error::InputError;

/// Reads the body of `$Entities`, or that of `$PartitionedEntities`, which accompanies it.
pub(super) fn entities(
    cursor: &mut Cursor,
    content: &mut Content,
    are_partitioned: bool,
) -> Result<(), InputError> {
    if are_partitioned {
        cursor.size("the number of partitions")?;
        for _ in 0..cursor.count("the number of ghost entities", 2)? {
            cursor.int("the tag of a ghost entity")?;
            cursor.int("a partition")?;
        }
    }
    let counts = [
        cursor.count("the number of points", 5)?,
        cursor.count("the number of curves", 9)?,
        cursor.count("the number of surfaces", 9)?,
        cursor.count("the number of volumes", 9)?,
    ];
    for (dim, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            let tag = cursor.int("the tag of an entity")?;
            if are_partitioned {
                cursor.int("the dimension of the parent entity")?;
                cursor.int("the tag of the parent entity")?;
                for _ in 0..cursor.count("the number of partitions", 1)? {
                    cursor.int("a partition")?;
                }
            }
            entity(cursor, content, dim, tag)?;
        }
    }
    Ok(())
}

/// Reads an entity from its coordinates on.
fn entity(
    cursor: &mut Cursor,
    content: &mut Content,
    dim: usize,
    tag: i64,
) -> Result<(), InputError> {
    let box_coordinates = if dim == 0 { 3 } else { 6 };
    for _ in 0..box_coordinates {
        cursor.real("a coordinate of an entity")?;
    }
    let count = cursor.count("the number of physical groups of an entity", 1)?;
    let listed: Result<Vec<i64>, InputError> =
        (0..count).map(|_| cursor.int("a physical group")).collect();
    content.entities.insert((dim, tag), groups(listed?));
    if dim > 0 {
        for _ in 0..cursor.count("the number of bounding entities", 1)? {
            cursor.int("a bounding entity")?;
        }
    }
    Ok(())
}

/// Reads the body of `$Nodes`.
pub(super) fn nodes(cursor: &mut Cursor, content: &mut Content) -> Result<(), InputError> {
    let blocks = cursor.count("the number of blocks", 4)?;
    let declared = cursor.count("the number of nodes", 4)?;
    content.nodes.reserve(declared);
    cursor.size("the smallest node tag")?;
    cursor.size("the largest node tag")?;
    for _ in 0..blocks {
        let dim = dimension(cursor)?;
        cursor.int("the tag of an entity")?;
        let parameters = match cursor.int("the flag of parametric nodes")? {
            0 => 0,
            1 => dim,
            other => {
                return Err(cursor.error(format!(
                    "expected 0 or 1 for parametric nodes, found {other}"
                )));
            }
        };
        let count = cursor.count("the number of nodes of a block", 4)?;
        let tags: Result<Vec<i64>, InputError> =
            (0..count).map(|_| cursor.size("a node tag")).collect();
        for tag in tags? {
            let point = cursor.point()?;
            for _ in 0..parameters {
                cursor.real("a parametric coordinate")?;
            }
            content.nodes.push(cursor, tag, point)?;
        }
    }
    if content.nodes.tags.len() != declared {
        return Err(cursor.error(format!(
            "expected {declared} nodes as declared, found {}",
            content.nodes.tags.len()
        )));
    }
    Ok(())
}

/// Reads the body of `$Elements`.
pub(super) fn elements(cursor: &mut Cursor, content: &mut Content) -> Result<(), InputError> {
    let blocks = cursor.count("the number of blocks", 4)?;
    let declared = cursor.count("the number of elements", 2)?;
    cursor.size("the smallest element tag")?;
    cursor.size("the largest element tag")?;
    let mut found = 0;
    let mut nodes = Vec::new();
    for _ in 0..blocks {
        let dim = dimension(cursor)?;
        let entity = cursor.int("the tag of an entity")?;
        let code = cursor.int("an element type")?;
        let count = cursor.count("the number of elements of a block", 2)?;
        if count == 0 {
            continue;
        }
        found += count;
        let first = cursor.clone().size("an element tag")?;
        let kind = element_type::kind(first, code).map_err(|why| cursor.error(why))?;
        if kind.dim() != dim {
            return Err(cursor.error(format!(
                "expected elements of dimension {dim}, as their entity {entity} has, found \
                 type {code} of dimension {}",
                kind.dim()
            )));
        }
        let groups = content.entities.get(&(dim, entity));
        let groups = groups.cloned().unwrap_or_default();
        for _ in 0..count {
            let tag = cursor.size("an element tag")?;
            nodes.clear();
            for _ in 0..kind.nodes() {
                let node = cursor.size("a node tag")?;
                nodes.push(content.nodes.find(cursor, tag, node)?);
            }
            content.push(kind, &groups, tag, &nodes);
        }
    }
    if found != declared {
        return Err(cursor.error(format!(
            "expected {declared} elements as declared, found {found}"
        )));
    }
    Ok(())
}

fn dimension(cursor: &mut Cursor) -> Result<usize, InputError> {
    let dim = cursor.int("the dimension of an entity")?;
    usize::try_from(dim)
        .ok()
        .filter(|&dim| dim <= 3)
        .ok_or_else(|| cursor.error(format!("expected a dimension from 0 to 3, found {dim}")))
}
