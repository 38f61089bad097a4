//! The graph that is partitioned: cells that have to stay in one subdomain are contracted to a vertex.

use super::graph::Graph;
use super::growth::grow;
use crate::disjoint_sets::DisjointSets;
use crate::mesh::topology::Topology;
use crate::model::Model;

/// Weight of a facet between two cells of one material; between two materials it is 1, so that
/// subdomains of one material are preferred.
const SAME_MATERIAL: u32 = 4;

/// The cells of a mesh, contracted to contact patches wherever a cut would let Γ meet Γ_c.
///
/// All cells around a node with a contact condition are one contact patch, with the layers of cells behind
/// it that make it cheaper; every other cell is a vertex of its own. Where the mesh is pinched at such
/// a node, the fans on both sides of it stay apart, so that every vertex is connected across facets.
pub(super) struct Contraction {
    /// The vertex of every cell, numbered by first cell.
    pub of_cell: Vec<u32>,
    /// The vertices, and the facets between them.
    pub graph: Graph,
}

impl Contraction {
    /// Contracts the cells of a model; contact patches grow as long as `spared` cells stay outside.
    pub fn new(model: &Model, topology: &Topology, spared: usize) -> Self {
        let around = Around::new(model);
        let (of_cell, count) = contract(model, topology, &around, spared);
        let mut cells = vec![0; count];
        for &vertex in &of_cell {
            cells[vertex as usize] += 1;
        }
        let vertex_of = &of_cell;
        let edges = of_cell.iter().enumerate().flat_map(|(cell, &a)| {
            let others = topology.neighbours(cell).iter().map(|&next| next as usize);
            let others = others.filter(move |&next| vertex_of[next] != a);
            others.map(move |next| {
                let same = model.cell_material[cell] == model.cell_material[next];
                (a, (vertex_of[next], if same { SAME_MATERIAL } else { 1 }))
            })
        });
        let mut contacts: Vec<Vec<u32>> = vec![Vec::new(); count];
        for &(node, cell) in &around.cells {
            let list = &mut contacts[of_cell[cell as usize] as usize];
            for &contact in &around.contacts[node as usize] {
                if let Err(at) = list.binary_search(&contact) {
                    list.insert(at, contact);
                }
            }
        }
        let material = materials(model, &of_cell, count);
        Self {
            graph: Graph::new(cells, material, contacts, edges),
            of_cell,
        }
    }
}

/// The surroundings of the nodes that have contact conditions.
pub(super) struct Around {
    /// The contacts that have a condition at each node, ascending.
    pub contacts: Vec<Vec<u32>>,
    /// Each such node with each cell around it, ascending.
    pub cells: Vec<(u32, u32)>,
}

impl Around {
    fn new(model: &Model) -> Self {
        let mut contacts: Vec<Vec<u32>> = vec![Vec::new(); model.mesh.points.len()];
        for (number, contact) in model.contacts.iter().enumerate() {
            for &(node, _) in contact.points.iter().flat_map(|point| &point.entries) {
                let list = &mut contacts[node as usize];
                if list.last() != Some(&(number as u32)) {
                    list.push(number as u32);
                }
            }
        }
        let mut cells = Vec::new();
        for (cell, (_, nodes)) in model.mesh.cells.iter().enumerate() {
            let in_contact = nodes.iter().filter(|&&n| !contacts[n as usize].is_empty());
            cells.extend(in_contact.map(|&node| (node, cell as u32)));
        }
        cells.sort_unstable();
        Self { contacts, cells }
    }
}

/// The vertex of every cell, and how many vertices there are.
fn contract(
    model: &Model,
    topology: &Topology,
    around: &Around,
    spared: usize,
) -> (Vec<u32>, usize) {
    let cells = &model.mesh.cells;
    let mut sets = DisjointSets::new(cells.len());
    for &(node, a) in &around.cells {
        for &b in topology.neighbours(a as usize) {
            if cells.nodes_of(b as usize).contains(&node) {
                sets.unite(a, b);
            }
        }
    }
    grow(model, topology, around, spared, &mut sets);
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
    (of_cell, count as usize)
}

/// The material of most cells of every vertex; the first in the scene where two have as many.
fn materials(model: &Model, of_cell: &[u32], count: usize) -> Vec<u32> {
    let mut of_vertex: Vec<(u32, u32)> = of_cell
        .iter()
        .copied()
        .zip(model.cell_material.iter().copied())
        .collect();
    of_vertex.sort_unstable();
    let mut most = vec![(0, 0); count];
    for cells in of_vertex.chunk_by(|a, b| a == b) {
        let (vertex, material) = cells[0];
        let best = &mut most[vertex as usize];
        if cells.len() > best.0 {
            *best = (cells.len(), material);
        }
    }
    most.into_iter().map(|(_, material)| material).collect()
}
