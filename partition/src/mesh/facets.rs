//! The facets of cells, identified by their nodes.

use std::collections::HashMap;

use crate::element::{ElementKind, Elements};
use crate::lists::Lists;

/// The smallest nodes of a facet, ascending.
pub(super) type Key = [u32; CORNERS];

/// Largest number of corners of a facet. Three of four don't identify it: at the front of a crack the two facets on its
/// sides may share them.
const CORNERS: usize = 4;

/// A key without the smallest node.
pub(super) type Rest = [u32; CORNERS - 1];

/// A facet of a cell: the cell and the facet's index in [`crate::element::reference::ReferenceElement::facets`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CellFacet {
    /// Cell.
    pub cell: u32,
    /// Local number of the facet.
    pub facet: u8,
}

impl CellFacet {
    /// Nodes, ends or corners first, then those between.
    pub fn nodes(self, cells: &Elements) -> Vec<u32> {
        let cell = self.cell as usize;
        let (_, local) = cells.kind(cell).facets()[self.facet as usize];
        let nodes = cells.nodes_of(cell);
        local.iter().map(|&i| nodes[i]).collect()
    }
}

/// The identifying nodes of a facet: in the plane its corners and the middle node, in space only its corners, as all
/// nodes of an edge are shared with its neighbours.
pub(super) fn identifying_nodes(facet: &[u32]) -> &[u32] {
    match facet.len() {
        6 => &facet[..3],
        8 | 9 => &facet[..4],
        _ => facet,
    }
}

/// A facet in the list of facets with the same smallest node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Entry {
    rest: Rest,
    /// Number, from 0, among facets with the same corners and different further nodes: the two sides of a crack may
    /// share all corners of a facet, but not the middle node of an edge.
    sheet: u32,
    pub facet: CellFacet,
}

impl Entry {
    /// True if two facets are identical.
    fn is_same(&self, other: &Self) -> bool {
        self.rest == other.rest && self.sheet == other.sheet
    }
}

/// A line or a face shared by cells that differ in its inner nodes.
#[derive(Debug)]
pub struct NonconformingFacet {
    /// Two cells at the facet.
    pub cells: [u32; 2],
    /// Corners.
    pub corners: Vec<u32>,
    /// True if one of the cells has a middle node and the other has none; otherwise each has a separate one, like the
    /// two sides of a crack.
    pub hangs: bool,
}

/// A line or a face of a kind of cells: its local corners and inner nodes.
struct Seam {
    corners: Vec<usize>,
    within: Vec<usize>,
}

impl Seam {
    /// The edges and faces of a kind.
    fn of(kind: ElementKind) -> Vec<Self> {
        let mut seams = Vec::new();
        for (facet, local) in kind.facets() {
            let corners = local[..facet.corners()].to_vec();
            let within = match facet.dim() {
                1 => local[2..].to_vec(),
                _ => local.get(8).copied().into_iter().collect(),
            };
            seams.push(Self { corners, within });
            if kind.dim() == 3 {
                seams.extend(facet.facets().iter().map(|(_, edge)| Self {
                    corners: edge[..2].iter().map(|&i| local[i]).collect(),
                    within: edge[2..].iter().map(|&i| local[i]).collect(),
                }));
            }
        }
        seams
    }
}

/// The facets of cells, with coincident facets adjacent.
#[derive(Clone, Debug, PartialEq)]
pub struct Facets {
    /// The facets by their smallest node.
    by_node: Lists<Entry>,
    /// The nodes of those facets that share all corners, but not all nodes, with others.
    pub(super) nodes: HashMap<CellFacet, Vec<u32>>,
}

impl Facets {
    /// Finds all facets of all cells over `nodes` nodes.
    pub fn new(cells: &Elements, nodes: usize) -> Self {
        let all = cells.iter().enumerate().flat_map(|(cell, (kind, nodes))| {
            let facets = kind.facets().iter().enumerate();
            facets.map(move |(facet, (facet_kind, local))| {
                let count = match facet_kind.dim() {
                    2 => facet_kind.corners(),
                    _ => local.len(),
                };
                let [first, rest @ ..] = key(local[..count].iter().map(|&i| nodes[i]));
                let facet = CellFacet {
                    cell: cell as u32,
                    facet: facet as u8,
                };
                let sheet = 0;
                (first, Entry { rest, sheet, facet })
            })
        });
        let mut by_node = Lists::new(nodes, all);
        by_node.sort();
        let mut facets = Self {
            by_node,
            nodes: HashMap::new(),
        };
        if cells
            .iter()
            .any(|(kind, _)| kind.dim() == 3 && !kind.is_linear())
        {
            facets.distinguish_sheets(cells);
        }
        facets
    }

    /// Distinguishes facets with the same corners but different inner nodes.
    fn distinguish_sheets(&mut self, cells: &Elements) {
        let sorted = |entry: &Entry| {
            let mut nodes = entry.facet.nodes(cells);
            nodes.sort_unstable();
            nodes
        };
        for list in 0..self.by_node.len() {
            let list = self.by_node.of_mut(list);
            for same in list.chunk_by_mut(|a, b| a.rest == b.rest) {
                // Few facets have the same corners.
                for at in 1..same.len() {
                    let nodes = sorted(&same[at]);
                    let first = same[..at].iter().position(|other| sorted(other) == nodes);
                    same[at].sheet = first.map_or(at as u32, |first| same[first].sheet);
                }
                if same.iter().any(|entry| entry.sheet > 0) {
                    same.sort_unstable();
                    let nodes = |entry: &Entry| (entry.facet, entry.facet.nodes(cells));
                    self.nodes.extend(same.iter().map(nodes));
                }
            }
        }
    }

    /// Groups of coincident facets.
    pub(super) fn places(&self) -> impl Iterator<Item = &[Entry]> + Clone {
        let lists = self.by_node.iter();
        lists.flat_map(|list| list.chunk_by(Entry::is_same))
    }

    /// True if two facets lead from one node to the same other node; several times faster than finding all facets. If
    /// not, no two cells lie on the same side of an edge. Always true in space.
    pub fn repeat_edges(cells: &Elements, nodes: usize) -> bool {
        if cells.iter().next().is_some_and(|(kind, _)| kind.dim() == 3) {
            return true;
        }
        let ends = cells.iter().flat_map(|(kind, nodes)| {
            let facets = kind.facets().iter();
            facets.map(move |(_, local)| (nodes[local[0]], nodes[local[1]]))
        });
        let from = Lists::new(nodes, ends);
        // Few facets begin at a node.
        from.iter()
            .any(|to| (1..to.len()).any(|i| to[..i].contains(&to[i])))
    }

    /// Two cells on the same side of a common facet, if any: one of them is inverted, or they overlap.
    pub fn overlap(&self, cells: &Elements) -> Option<[CellFacet; 2]> {
        // The beginning of the node order: seen from the other side, a line starts at the other end, and the corners of
        // a face have the opposite order.
        let start = |of: &CellFacet| {
            let cell = of.cell as usize;
            let (facet, local) = cells.kind(cell).facets()[of.facet as usize];
            let node = |i: usize| cells.nodes_of(cell)[local[i]];
            let corners = facet.corners();
            match facet.dim() {
                2 => {
                    let least = (0..corners).min_by_key(|&i| node(i)).unwrap_or_default();
                    node((least + 1) % corners)
                }
                _ => node(0),
            }
        };
        self.places().find_map(|same| {
            // Of three cells two are on the same side.
            let count = same.len().min(3);
            let mut pairs =
                (1..count).flat_map(|i| (0..i).map(move |j| [same[j].facet, same[i].facet]));
            pairs.find(|[a, b]| start(a) == start(b))
        })
    }

    /// A face of four corners, three of which form a face of another cell.
    pub(super) fn halved(&self, cells: &Elements) -> Option<[CellFacet; 2]> {
        let corners = |of: &CellFacet| {
            let kind = cells.kind(of.cell as usize);
            kind.facets()[of.facet as usize].0.corners()
        };
        let kinds = ElementKind::ALL.map(|kind| cells.iter().any(|(of_cell, _)| of_cell == kind));
        let has = |corners| {
            let solid = |kind: &ElementKind| kind.dim() == 3 && kind.corners() == corners;
            (ElementKind::ALL.iter().zip(kinds)).any(|(kind, is_there)| is_there && solid(kind))
        };
        if !(has(4) && has(8)) {
            return None;
        }
        let all = self.by_node.iter().flatten().map(|entry| entry.facet);
        all.filter(|facet| corners(facet) == 4).find_map(|face| {
            let nodes = face.nodes(cells);
            let threes = (0..4).map(|out| (0..4).filter(move |&i| i != out));
            threes.into_iter().find_map(|three| {
                let half = self.of(key(three.map(|i| nodes[i])));
                let half = half.iter().find(|half| corners(&half.facet) == 3)?;
                Some([face, half.facet])
            })
        })
    }

    /// The facets with this key.
    pub(super) fn of(&self, [first, rest @ ..]: Key) -> &[Entry] {
        let list = match first as usize {
            node if node < self.by_node.len() => self.by_node.of(node),
            _ => &[],
        };
        let start = list.partition_point(|other| other.rest < rest);
        let same = list[start..].partition_point(|other| other.rest == rest);
        &list[start..start + same]
    }

    /// A line or a face whose corners cells share, but not its inner nodes, if any; preferably one with a hanging
    /// middle node, which one of the cells lacks.
    pub fn nonconforming(cells: &Elements, nodes: usize) -> Option<NonconformingFacet> {
        if cells.iter().all(|(kind, _)| kind.is_linear()) {
            return None;
        }
        let seams = ElementKind::ALL.map(Seam::of);
        let all = cells.iter().enumerate().flat_map(|(cell, (kind, nodes))| {
            let seams = seams[kind as usize].iter();
            seams.map(move |seam| {
                let corners = key(seam.corners.iter().map(|&i| nodes[i]));
                let within = key(seam.within.iter().map(|&i| nodes[i]));
                (corners[0], (corners, within, cell as u32))
            })
        });
        let mut by_node = Lists::new(nodes, all);
        by_node.sort();
        let nonconforming = |pair: &[(Key, Key, u32)]| {
            let (a, b) = (pair[0], pair[1]);
            let is_empty = |within: Key| within[0] == u32::MAX;
            (a.0 == b.0 && a.1 != b.1).then(|| NonconformingFacet {
                cells: [a.2, b.2],
                corners: a.0.into_iter().filter(|&node| node != u32::MAX).collect(),
                hangs: is_empty(a.1) != is_empty(b.1),
            })
        };
        let found = || (by_node.iter()).flat_map(|list| list.windows(2).filter_map(nonconforming));
        found().find(|facet| facet.hangs).or_else(|| found().next())
    }
}

pub(super) fn key(nodes: impl Iterator<Item = u32>) -> Key {
    let mut key = [u32::MAX; CORNERS];
    for mut node in nodes {
        // Insertion sort: each node is inserted and shifts the larger ones.
        for place in &mut key {
            if node < *place {
                std::mem::swap(place, &mut node);
            }
        }
    }
    key
}
