//! Atoms: what a partition can't divide.

use super::disjoint_sets::DisjointSets;
use super::graph::Graph;
use crate::mesh::topology::Topology;
use crate::model::Model;

/// Weight of a facet between two cells of one material; between two materials it is 1, so that
/// subdomains of one material are preferred.
const SAME_MATERIAL: u32 = 4;

/// The cells of a mesh, contracted to clusters wherever a cut would let Γ meet Γ_c.
///
/// All cells around a node with a contact condition are one cluster; every other cell is an atom
/// of its own. Where the mesh is pinched at such a node, the fans on both sides of it stay apart,
/// so that every atom is connected across facets.
pub(super) struct Atoms {
    /// The atom of every cell, numbered by first cell.
    of_cell: Vec<u32>,
    /// The pieces of the mesh that hang together across facets.
    pub pieces: Vec<Piece>,
}

/// A piece of the mesh.
pub(super) struct Piece {
    /// Its atoms' global numbers.
    atoms: Vec<u32>,
    /// How they hang together.
    pub graph: Graph,
}

impl Atoms {
    /// Contracts the cells of a model.
    pub fn new(model: &Model, topology: &Topology) -> Self {
        let cells = &model.mesh.cells;
        let around = cells_around(model);
        let mut sets = DisjointSets::new(cells.len());
        for (node, fan) in around.iter() {
            for &a in fan {
                for &b in topology.neighbours(a as usize) {
                    if cells.nodes_of(b as usize).contains(node) {
                        sets.unite(a, b);
                    }
                }
            }
        }
        let mut of_cell = vec![u32::MAX; cells.len()];
        let mut count = 0;
        for cell in 0..cells.len() {
            let root = sets.find(cell as u32) as usize;
            if root == cell {
                of_cell[cell] = count;
                count += 1;
            } else {
                of_cell[cell] = of_cell[root];
            }
        }
        let mut atoms = Self {
            of_cell,
            pieces: Vec::new(),
        };
        atoms.pieces = atoms.find_pieces(model, topology, count as usize, &around);
        atoms
    }

    /// Number of atoms.
    pub fn count(&self) -> usize {
        self.pieces.iter().map(|piece| piece.atoms.len()).sum()
    }

    /// The subdomain of every cell, from the part of every atom of every piece; subdomains are
    /// numbered by first cell.
    pub fn subdomains(&self, parts: &[Vec<u32>]) -> Vec<u32> {
        let mut label = vec![(0, 0); self.count()];
        for (number, (piece, parts)) in self.pieces.iter().zip(parts).enumerate() {
            for (&atom, &part) in piece.atoms.iter().zip(parts) {
                label[atom as usize] = (number, part);
            }
        }
        let mut numbers = std::collections::HashMap::new();
        self.of_cell
            .iter()
            .map(|&atom| {
                let next = numbers.len() as u32;
                *numbers.entry(label[atom as usize]).or_insert(next)
            })
            .collect()
    }

    fn find_pieces(
        &self,
        model: &Model,
        topology: &Topology,
        count: usize,
        around: &[(u32, Vec<u32>)],
    ) -> Vec<Piece> {
        let piece_of_cell = topology.pieces();
        let pieces = piece_of_cell.iter().max().map_or(0, |&p| p as usize + 1);
        let mut place = vec![(0u32, u32::MAX); count];
        let mut atoms: Vec<Vec<u32>> = vec![Vec::new(); pieces];
        for (cell, &atom) in self.of_cell.iter().enumerate() {
            let place = &mut place[atom as usize];
            if place.1 == u32::MAX {
                let list = &mut atoms[piece_of_cell[cell] as usize];
                *place = (piece_of_cell[cell], list.len() as u32);
                list.push(atom);
            }
        }
        let mut cells: Vec<Vec<u32>> = atoms.iter().map(|a| vec![0; a.len()]).collect();
        let mut edges: Vec<Vec<(u32, u32, u32)>> = vec![Vec::new(); pieces];
        for (cell, &atom) in self.of_cell.iter().enumerate() {
            let (piece, a) = place[atom as usize];
            cells[piece as usize][a as usize] += 1;
            for &next in topology.neighbours(cell) {
                let (_, b) = place[self.of_cell[next as usize] as usize];
                if a != b {
                    let same = model.cell_material[cell] == model.cell_material[next as usize];
                    let weight = if same { SAME_MATERIAL } else { 1 };
                    edges[piece as usize].push((a, b, weight));
                }
            }
        }
        let mut contacts: Vec<Vec<Vec<u32>>> =
            atoms.iter().map(|a| vec![Vec::new(); a.len()]).collect();
        let contact_of_node = contacts_of_nodes(model);
        for (node, fan) in around {
            for &cell in fan {
                let (piece, a) = place[self.of_cell[cell as usize] as usize];
                let list = &mut contacts[piece as usize][a as usize];
                for &contact in &contact_of_node[*node as usize] {
                    if let Err(at) = list.binary_search(&contact) {
                        list.insert(at, contact);
                    }
                }
            }
        }
        atoms
            .into_iter()
            .zip(cells)
            .zip(edges)
            .zip(contacts)
            .map(|(((atoms, cells), edges), contacts)| Piece {
                atoms,
                graph: Graph::new(cells, edges, contacts),
            })
            .collect()
    }
}

/// The contacts that have a condition at each node.
fn contacts_of_nodes(model: &Model) -> Vec<Vec<u32>> {
    let mut contacts: Vec<Vec<u32>> = vec![Vec::new(); model.mesh.points.len()];
    for (number, contact) in model.contacts.iter().enumerate() {
        for &(node, _) in contact.conditions.iter().flat_map(|c| &c.entries) {
            let list = &mut contacts[node as usize];
            if list.last() != Some(&(number as u32)) {
                list.push(number as u32);
            }
        }
    }
    contacts
}

/// The nodes that have contact conditions, each with the cells around it.
fn cells_around(model: &Model) -> Vec<(u32, Vec<u32>)> {
    let in_contact: Vec<bool> = contacts_of_nodes(model)
        .iter()
        .map(|list| !list.is_empty())
        .collect();
    let mut around: std::collections::BTreeMap<u32, Vec<u32>> = Default::default();
    for (cell, (_, nodes)) in model.mesh.cells.iter().enumerate() {
        for &node in nodes.iter().filter(|&&n| in_contact[n as usize]) {
            around.entry(node).or_default().push(cell as u32);
        }
    }
    around.into_iter().collect()
}
