//! A block: the subdomains that are assembled and factorized together.

use std::collections::HashMap;

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::ElementKind;
use contact_dd_partition::problem::{Subdomain, SubdomainNode};

/// One linear subdomain, or all subdomains of a group in contact, with their nodes numbered
/// together: a node that two members share is one node of the block.
#[derive(Clone, Debug)]
pub struct Block {
    /// The subdomains.
    pub members: Vec<Subdomain>,
    /// Node of the block for every node of every member.
    pub node_of: Vec<Vec<u32>>,
    /// Coordinates of the block's nodes (m).
    pub points: Vec<[f64; 3]>,
    /// The mesh file's tag of each node.
    pub tags: Vec<i64>,
    /// Index of the body of each node.
    pub bodies: Vec<u32>,
    /// Its nodes on Γ that it shares with other blocks: node and number on Γ, ascending.
    pub interface: Vec<(u32, u32)>,
    /// Number of dofs of a node.
    pub dim: usize,
}

impl Block {
    /// Numbers the nodes of `members`; `shared(number on Γ)` tells whether another block has the
    /// node too.
    pub fn new(members: Vec<Subdomain>, dim: usize, shared: impl Fn(u32) -> bool) -> Self {
        let mut block = Self {
            node_of: Vec::with_capacity(members.len()),
            points: Vec::new(),
            tags: Vec::new(),
            bodies: Vec::new(),
            interface: Vec::new(),
            members: Vec::new(),
            dim,
        };
        let mut on_interface: HashMap<u32, u32> = HashMap::new();
        for member in &members {
            let mut number = vec![None; member.points.len()];
            for shared_node in &member.interface {
                number[shared_node.node as usize] = Some(shared_node.interface);
            }
            let nodes = (0..member.points.len())
                .map(|local| {
                    let next = block.points.len() as u32;
                    let node =
                        number[local].map_or(next, |id| *on_interface.entry(id).or_insert(next));
                    if node == next {
                        block.points.push(member.points[local]);
                        block.tags.push(member.node_tags[local]);
                        block.bodies.push(member.body as u32);
                    }
                    node
                })
                .collect();
            block.node_of.push(nodes);
        }
        block.interface = on_interface
            .into_iter()
            .filter(|&(id, _)| shared(id))
            .map(|(id, node)| (node, id))
            .collect();
        block.interface.sort_unstable_by_key(|&(_, id)| id);
        block.members = members;
        block
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.points.len()
    }

    /// Whether other blocks have a node too, node by node.
    pub fn is_on_interface(&self) -> Vec<bool> {
        let mut on_interface = vec![false; self.nodes()];
        for &(node, _) in &self.interface {
            on_interface[node as usize] = true;
        }
        on_interface
    }

    /// The place of member subdomain `index` among the members.
    pub fn member(&self, index: usize) -> Option<usize> {
        self.members.iter().position(|m| m.index == index)
    }

    /// The block's node for a node of subdomain `index`, if that is a member.
    pub fn node(&self, index: usize, node: u32) -> Option<u32> {
        Some(self.node_of[self.member(index)?][node as usize])
    }

    /// Its cells, member by member: kind, nodes of the block, material.
    pub fn cells(&self) -> impl Iterator<Item = BlockCell<'_>> {
        self.members
            .iter()
            .zip(&self.node_of)
            .flat_map(|(member, node_of)| {
                member.cells.iter().zip(&member.cell_material).map(
                    move |((kind, local), &material)| BlockCell {
                        kind,
                        local,
                        node_of,
                        material: material as usize,
                    },
                )
            })
    }
}

/// A cell of a block.
#[derive(Clone, Copy, Debug)]
pub struct BlockCell<'a> {
    /// Kind.
    pub kind: ElementKind,
    local: &'a [u32],
    node_of: &'a [u32],
    /// Index of its material.
    pub material: usize,
}

impl BlockCell<'_> {
    /// Its nodes of the block.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = u32> + Clone {
        self.local.iter().map(|&i| self.node_of[i as usize])
    }
}

/// A block as it was read.
#[derive(Clone, Debug)]
pub struct OwnedBlock {
    /// Its subdomains.
    pub block: Block,
    /// Its contact points, over the nodes of the block.
    pub points: Vec<ContactPoint<u32>>,
}

impl OwnedBlock {
    /// A block and the contact `points` of its group.
    pub fn new(block: Block, points: &[ContactPoint<SubdomainNode>]) -> Self {
        let of_block = |at: SubdomainNode| block.node(at.subdomain as usize, at.node);
        let points = points.iter().map(|point| point.rename(of_block)).collect();
        Self { block, points }
    }
}
