//! Which cells meet at a facet, and what hangs together.

use super::Mesh;
use crate::element::{ElementKind, Elements};
use crate::error::InputError;
use crate::lists::Lists;

/// Nodes that tell facets apart: one of four corners has no others with three of them.
const CORNERS: usize = 3;

/// The smallest nodes of a facet, ascending.
type Key = [u32; CORNERS];

/// A key without the smallest node.
type Rest = [u32; CORNERS - 1];

/// A facet of a cell: the cell and the facet's place in [`crate::element::reference::ReferenceElement::facets`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CellFacet {
    /// Cell.
    pub cell: u32,
    /// Local number of the facet.
    pub facet: u8,
}

impl CellFacet {
    /// Its nodes, from its start to its end and then those between.
    pub fn nodes(self, cells: &Elements) -> Vec<u32> {
        let cell = self.cell as usize;
        let (_, local) = cells.kind(cell).facets()[self.facet as usize];
        let nodes = cells.nodes_of(cell);
        local.iter().map(|&i| nodes[i]).collect()
    }
}

/// The nodes that tell a facet of these nodes apart: of a face its corners, as it shares all nodes of an edge with
/// its neighbours.
fn telling(facet: &[u32]) -> &[u32] {
    match facet.len() {
        6 => &facet[..3],
        8 | 9 => &facet[..4],
        _ => facet,
    }
}

/// A line or a face where cells meet that differ in what lies within it.
#[derive(Debug)]
pub struct Tear {
    /// Two of these cells.
    pub cells: [u32; 2],
    /// Its corners, those with the smallest numbers.
    pub corners: Vec<u32>,
}

/// A line or a face of a kind of cells: its local corners and what lies within it.
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

/// The facets of cells, those of the same nodes beside each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Facets {
    /// By their smallest node, with the other nodes of their keys.
    by_node: Lists<(Rest, CellFacet)>,
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
                let cell = cell as u32;
                let facet = facet as u8;
                (first, (rest, CellFacet { cell, facet }))
            })
        });
        let mut by_node = Lists::new(nodes, all);
        by_node.sort();
        Self { by_node }
    }

    /// The facets of the same nodes, those of a place after the other.
    fn places(&self) -> impl Iterator<Item = &[(Rest, CellFacet)]> + Clone {
        let lists = self.by_node.iter();
        lists.flat_map(|list| list.chunk_by(|a, b| a.0 == b.0))
    }

    /// Whether two facets lead from one node to the same other one, several times faster than finding
    /// all facets: where none do, no two cells lie on the same side of an edge. In space it always may be.
    pub fn repeat_themselves(cells: &Elements, nodes: usize) -> bool {
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

    /// Two cells on the same side of a facet that they share, if there are any: one of them is
    /// turned over, or they overlap.
    pub fn overlap(&self, cells: &Elements) -> Option<[CellFacet; 2]> {
        // What the order of its nodes begins with: seen from the other side a line starts at the other end, and
        // the corners of a face follow each other the other way round.
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
            // Of three cells two are on one side.
            let count = same.len().min(3);
            let mut pairs = (1..count).flat_map(|i| (0..i).map(move |j| [same[j].1, same[i].1]));
            pairs.find(|[a, b]| start(a) == start(b))
        })
    }

    /// A face of four corners, three of which are a face of another cell.
    fn halved(&self, cells: &Elements) -> Option<[CellFacet; 2]> {
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
        let all = self.by_node.iter().flatten().map(|(_, facet)| *facet);
        all.filter(|facet| corners(facet) == 4).find_map(|face| {
            let nodes = face.nodes(cells);
            let threes = (0..4).map(|out| (0..4).filter(move |&i| i != out));
            threes.into_iter().find_map(|three| {
                let half = self.of(key(three.map(|i| nodes[i])));
                let half = half.iter().find(|(_, half)| corners(half) == 3)?;
                Some([face, half.1])
            })
        })
    }

    /// Those with this key.
    fn of(&self, [first, rest @ ..]: Key) -> &[(Rest, CellFacet)] {
        let list = match first as usize {
            node if node < self.by_node.len() => self.by_node.of(node),
            _ => &[],
        };
        let start = list.partition_point(|(other, _)| *other < rest);
        let same = list[start..].partition_point(|(other, _)| *other == rest);
        &list[start..start + same]
    }

    /// A line or a face whose corners cells share, but not what lies between them, if there is any: a node in
    /// its middle would hang.
    pub fn torn(cells: &Elements, nodes: usize) -> Option<Tear> {
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
        let torn = |pair: &[(Key, Key, u32)]| {
            let (a, b) = (pair[0], pair[1]);
            (a.0 == b.0 && a.1 != b.1).then(|| Tear {
                cells: [a.2, b.2],
                corners: a.0.into_iter().filter(|&node| node != u32::MAX).collect(),
            })
        };
        by_node
            .iter()
            .find_map(|list| list.windows(2).find_map(torn))
    }
}

impl Mesh {
    /// Checks that cells which share the ends of an edge share the node between them as well.
    ///
    /// # Errors
    /// Two that don't, by their tags: such as a linear cell beside a quadratic one, whose node in the
    /// middle would hang.
    pub(crate) fn check_edges(&self) -> Result<(), InputError> {
        let Some(tear) = Facets::torn(&self.cells, self.points.len()) else {
            return Ok(());
        };
        let [a, b] = tear.cells.map(|cell| cell as usize);
        let [a_name, b_name] = [a, b].map(|cell| self.cells.kind(cell).name());
        let what = match tear.corners.len() {
            2 => "an edge between",
            _ => "a face of",
        };
        Err(InputError::new(format!(
            "elements {} ({a_name}) and {} ({b_name}) share {what} the nodes {}, but not the \
             node in its middle; expected linear or quadratic elements on both of its sides, of the same \
             nodes",
            self.cell_tags[a],
            self.cell_tags[b],
            self.tags_of(&tear.corners)
        )))
    }
}

/// The adjacency of a mesh's cells across facets.
#[derive(Clone, Debug, PartialEq)]
pub struct Topology {
    facets: Facets,
    neighbours: Lists<u32>,
}

impl Topology {
    /// Finds all facets of all cells.
    pub fn new(mesh: &Mesh) -> Self {
        let facets = Facets::new(&mesh.cells, mesh.points.len());
        let pairs = facets.places().flat_map(|same| {
            let others = move |a: u32| same.iter().map(move |(_, b)| (a, b.cell));
            same.iter().flat_map(move |(_, a)| others(a.cell))
        });
        let mut neighbours = Lists::new(mesh.cells.len(), pairs.filter(|(a, b)| a != b));
        neighbours.sort();
        neighbours.dedup();
        Self { facets, neighbours }
    }

    /// Checks that cells share whole facets, no two of them on the same side.
    ///
    /// # Errors
    /// Two cells that don't, by their tags.
    pub fn check_sides(&self, mesh: &Mesh) -> Result<(), InputError> {
        if let Some([a, b]) = self.facets.halved(&mesh.cells) {
            return Err(InputError::new(format!(
                "element {} has the nodes {} of a face of element {} for a face of its own; expected cells of one \
                 body to share whole faces: tetrahedra and hexahedra of different bodies meet in a contact, with \
                 nodes of their own",
                mesh.cell_tags[b.cell as usize],
                mesh.tags_of(&b.nodes(&mesh.cells)),
                mesh.cell_tags[a.cell as usize],
            )));
        }
        let Some([a, b]) = self.facets.overlap(&mesh.cells) else {
            return Ok(());
        };
        Err(InputError::new(format!(
            "elements {} and {} lie on the same side of the {} of nodes {} that they share; \
             expected cells that don't overlap (is one of them inside out?)",
            mesh.cell_tags[a.cell as usize],
            mesh.cell_tags[b.cell as usize],
            if mesh.dim == 3 { "face" } else { "edge" },
            mesh.tags_of(&a.nodes(&mesh.cells))
        )))
    }

    /// The facets of cells that have exactly these nodes, in any order, in space these corners.
    pub fn cells_at(&self, facet_nodes: &[u32]) -> Vec<CellFacet> {
        let found = self.facets.of(key(telling(facet_nodes).iter().copied()));
        found.iter().map(|&(_, facet)| facet).collect()
    }

    /// The facets of one cell only, in the order of their nodes.
    pub fn boundary(&self) -> impl Iterator<Item = CellFacet> {
        self.facets.places().filter_map(|same| match same {
            [(_, one)] => Some(*one),
            _ => None,
        })
    }

    /// The cells that share a facet with `cell`, ascending.
    pub fn neighbours(&self, cell: usize) -> &[u32] {
        self.neighbours.of(cell)
    }

    /// Number of cells that share a facet with another, counted for every facet.
    pub fn pairs(&self) -> usize {
        self.neighbours.items()
    }

    /// For every cell the piece of the mesh that it hangs together with across facets; pieces are
    /// numbered in the order of their first cell.
    pub fn pieces(&self) -> Vec<u32> {
        let mut piece = vec![u32::MAX; self.neighbours.len()];
        let mut count = 0;
        for seed in 0..piece.len() {
            if piece[seed] != u32::MAX {
                continue;
            }
            let mut stack = vec![seed];
            piece[seed] = count;
            while let Some(cell) = stack.pop() {
                for &next in self.neighbours(cell) {
                    if piece[next as usize] == u32::MAX {
                        piece[next as usize] = count;
                        stack.push(next as usize);
                    }
                }
            }
            count += 1;
        }
        piece
    }
}

fn key(nodes: impl Iterator<Item = u32>) -> Key {
    let mut key = [u32::MAX; CORNERS];
    for mut node in nodes {
        // Each node goes where it belongs and pushes the larger ones on.
        for place in &mut key {
            if node < *place {
                std::mem::swap(place, &mut node);
            }
        }
    }
    key
}
