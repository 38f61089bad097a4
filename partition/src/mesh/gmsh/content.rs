//! The content of an MSH file, independent of version and encoding.

use std::collections::{BTreeMap, HashMap};

use super::cursor::Cursor;
use super::element_type;
use crate::element::ElementKind;
use crate::error::InputError;

/// The content of an MSH file.
#[derive(Default)]
pub(super) struct Content {
    /// Names of physical groups, by dimension and number.
    pub(super) names: BTreeMap<(usize, i64), String>,
    /// Physical groups of entities, by dimension and tag of the entity; version 4.1.
    pub(super) entities: HashMap<(usize, i64), Vec<i64>>,
    /// Nodes.
    pub(super) nodes: Nodes,
    /// Elements.
    pub(super) blocks: Vec<Block>,
}

impl Content {
    /// Appends an element to the last block of its kind and groups, otherwise to a new one. `nodes` are in Gmsh's
    /// order.
    pub(super) fn push(&mut self, kind: ElementKind, groups: &[i64], tag: i64, nodes: &[u32]) {
        let ordered: Vec<u32>;
        let nodes = match element_type::order(kind) {
            Some(order) => {
                ordered = order.iter().map(|&place| nodes[place]).collect();
                &ordered
            }
            None => nodes,
        };
        let last = self.blocks.last_mut();
        match last.filter(|last| last.kind == kind && last.groups == groups) {
            Some(last) => {
                last.tags.push(tag);
                last.nodes.extend_from_slice(nodes);
            }
            None => self.blocks.push(Block {
                kind,
                groups: groups.to_vec(),
                tags: vec![tag],
                nodes: nodes.to_vec(),
            }),
        }
    }
}

/// Elements of one kind in the same physical groups.
pub(super) struct Block {
    /// Kind of all of them.
    pub(super) kind: ElementKind,
    /// Numbers of the physical groups, ascending, without repetition.
    pub(super) groups: Vec<i64>,
    /// Tag of each element.
    pub(super) tags: Vec<i64>,
    /// Indices of the nodes of each element, one element after the other.
    pub(super) nodes: Vec<u32>,
}

/// Valid numbers of physical groups from those in a file, whose sign is a direction and where 0 means no group.
pub(super) fn groups(mut listed: Vec<i64>) -> Vec<i64> {
    for number in &mut listed {
        *number = number.saturating_abs();
    }
    listed.retain(|&number| number != 0);
    listed.sort_unstable();
    listed.dedup();
    listed
}

/// The nodes of a file, with an index by tag.
#[derive(Default)]
pub(super) struct Nodes {
    pub(super) tags: Vec<i64>,
    pub(super) points: Vec<[f64; 3]>,
    /// Index of every tag from 0 up to a multiple of the number of nodes, `NONE` for unused tags.
    dense: Vec<u32>,
    /// Index of the other tags.
    sparse: HashMap<i64, u32>,
}

/// Marks a tag without a node.
const NONE: u32 = u32::MAX;

/// Largest number of entries of the table of tags per declared node.
const SPREAD: usize = 4;

impl Nodes {
    pub(super) fn is_empty(&self) -> bool {
        self.tags.is_empty()
    }

    pub(super) fn reserve(&mut self, count: usize) {
        self.tags.reserve(count);
        self.points.reserve(count);
        // Tags are looked up in one table only, so that this one never grows.
        if self.is_empty() && self.dense.is_empty() {
            self.dense.resize(SPREAD * (count + 1), NONE);
        }
    }

    /// Appends a node.
    pub(super) fn push(
        &mut self,
        cursor: &Cursor,
        tag: i64,
        point: [f64; 3],
    ) -> Result<(), InputError> {
        let index = u32::try_from(self.tags.len()).ok();
        let Some(index) = index.filter(|&index| index != NONE) else {
            return Err(cursor.error("more than 4 294 967 295 nodes aren't supported"));
        };
        let before = match usize::try_from(tag)
            .ok()
            .and_then(|t| self.dense.get_mut(t))
        {
            Some(entry) => std::mem::replace(entry, index) != NONE,
            None => self.sparse.insert(tag, index).is_some(),
        };
        if before {
            return Err(cursor.error(format!("the node tag {tag} occurs twice")));
        }
        self.tags.push(tag);
        self.points.push(point);
        Ok(())
    }

    /// The index of the node `tag`, which `element` uses.
    pub(super) fn find(&self, cursor: &Cursor, element: i64, tag: i64) -> Result<u32, InputError> {
        let dense = usize::try_from(tag).ok().and_then(|t| self.dense.get(t));
        let found = dense.or_else(|| self.sparse.get(&tag)).copied();
        found.filter(|&index| index != NONE).ok_or_else(|| {
            let reason = match self.is_empty() {
                true => "expected $Nodes before $Elements".into(),
                false => format!("element {element} names node {tag}, which isn't among $Nodes"),
            };
            cursor.error(reason)
        })
    }
}
