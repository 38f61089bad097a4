//! The order of a mesh in memory: along a space-filling curve, so that neighbours in space are close in memory,
//! whatever the mesher's order.

use super::Mesh;
use crate::element::Elements;

/// Bits of a coordinate on the grid that orders points: three coordinates fill a key.
const BITS: u32 = 21;

impl Mesh {
    /// The mesh with its cells along Morton's curve, and its nodes in the order of their first cell: loops over a large
    /// mesh take half the time.
    #[must_use]
    pub fn along_curve(mut self) -> Self {
        let order = self.cells_along_curve();
        let mut new_node = vec![u32::MAX; self.points.len()];
        let mut nodes: Vec<u32> = Vec::with_capacity(self.points.len());
        let mut cells = Elements::default();
        let mut of_cell = Vec::new();
        for &cell in &order {
            of_cell.clear();
            for &node in self.cells.nodes_of(cell as usize) {
                let new = &mut new_node[node as usize];
                if *new == u32::MAX {
                    *new = nodes.len() as u32;
                    nodes.push(node);
                }
                of_cell.push(*new);
            }
            cells.push(self.cells.kind(cell as usize), &of_cell);
        }
        for facet in 0..self.facets.len() {
            for node in self.facets.nodes_of_mut(facet) {
                *node = new_node[*node as usize];
            }
        }
        let mut new_cell = vec![0; order.len()];
        for (new, &cell) in (0..).zip(&order) {
            new_cell[cell as usize] = new;
        }
        for group in self.groups.values_mut() {
            let new = match group.dim {
                dim if dim == self.dim => &new_cell,
                dim if dim + 1 == self.dim => continue,
                _ => &new_node,
            };
            let members = group.members.iter_mut();
            members.for_each(|member| *member = new[*member as usize]);
            group.members.sort_unstable();
        }
        self.points = picked(&self.points, &nodes);
        self.node_tags = picked(&self.node_tags, &nodes);
        self.cell_tags = picked(&self.cell_tags, &order);
        self.cells = cells;
        self
    }

    fn cells_along_curve(&self) -> Vec<u32> {
        let mut low = [f64::INFINITY; 3];
        let mut extent: f64 = 0.0;
        for point in &self.points {
            low = [0, 1, 2].map(|k| low[k].min(point[k]));
        }
        for point in &self.points {
            extent = [0, 1, 2]
                .map(|k| point[k] - low[k])
                .into_iter()
                .fold(extent, f64::max);
        }
        let scale = f64::from((1u32 << BITS) - 1) / extent;
        let key = move |nodes: &[u32]| {
            let mut centre = [0.0; 3];
            for &node in nodes {
                let point = self.points[node as usize];
                centre = [0, 1, 2].map(|k| centre[k] + (point[k] - low[k]) / nodes.len() as f64);
            }
            let [x, y, z] = centre.map(|x| spread((x * scale) as u64));
            x << 2 | y << 1 | z
        };
        let mut keys = vec![(0, 0); self.cells.len()];
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let size = keys.len().div_ceil(threads).max(1);
        std::thread::scope(|scope| {
            for (part, keys) in keys.chunks_mut(size).enumerate() {
                scope.spawn(move || {
                    for (at, entry) in keys.iter_mut().enumerate() {
                        let cell = part * size + at;
                        *entry = (key(self.cells.nodes_of(cell)), cell as u32);
                    }
                    keys.sort_unstable();
                });
            }
        });
        // The stable sort is fast on parts that are sorted already.
        keys.sort();
        keys.into_iter().map(|(_, cell)| cell).collect()
    }
}

/// Inserts two zeros between any two of the lowest [`BITS`] bits.
fn spread(mut bits: u64) -> u64 {
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}

fn picked<T: Copy>(all: &[T], order: &[u32]) -> Vec<T> {
    order.iter().map(|&at| all[at as usize]).collect()
}
