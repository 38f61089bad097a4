//! Meshes of quadrilateral blocks, and changes to a mesh that leave the body unchanged.

use std::collections::{BTreeMap, HashMap};

use contact_dd_partition::element::ElementKind::{Line2, Triangle3};
use contact_dd_partition::element::Elements;
use contact_dd_partition::mesh::topology::Topology;
use contact_dd_partition::mesh::{Group, Mesh};

use super::random::Random;

/// A mesh under construction; blocks share no nodes unless they are glued.
#[derive(Clone)]
pub struct Blocks {
    pub mesh: Mesh,
}

impl Blocks {
    pub fn new() -> Self {
        Self {
            mesh: Mesh {
                dim: 2,
                ..Mesh::default()
            },
        }
    }

    /// Adds the rectangle [x0, x1] × [y0, y1] of n[0] × n[1] cells, each cut in two.
    pub fn rectangle(self, name: &str, x: [f64; 2], y: [f64; 2], n: [usize; 2]) -> Self {
        let corners = [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
        self.quadrilateral(name, corners, n)
    }

    /// Adds the quadrilateral with `corners`, counter-clockwise from the lower left, as the group of cells `name` with
    /// the groups of facets `name bottom`, `right`, `top`, `left`. An existing group grows.
    pub fn quadrilateral(self, name: &str, corners: [[f64; 2]; 4], n: [usize; 2]) -> Self {
        let [a, b, c, d] = corners;
        self.mapped(name, n, |[s, t]| {
            let between = |p: f64, q: f64, w: f64| p * (1.0 - w) + q * w;
            [0, 1].map(|i| between(between(a[i], b[i], s), between(d[i], c[i], s), t))
        })
    }

    /// Adds the image of the unit square under `map`.
    pub fn mapped(mut self, name: &str, n: [usize; 2], map: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        let mesh = &mut self.mesh;
        let first = mesh.points.len() as u32;
        let node = |i: usize, j: usize| first + (j * (n[0] + 1) + i) as u32;
        for j in 0..=n[1] {
            for i in 0..=n[0] {
                let [x, y] = map([i as f64 / n[0] as f64, j as f64 / n[1] as f64]);
                mesh.points.push([x, y, 0.0]);
                mesh.node_tags.push(mesh.points.len() as i64);
            }
        }
        let start = mesh.cells.len() as u32;
        for j in 0..n[1] {
            for i in 0..n[0] {
                let corners = [
                    node(i, j),
                    node(i + 1, j),
                    node(i + 1, j + 1),
                    node(i, j + 1),
                ];
                let [a, b, c, d] = corners;
                let halves = if (i + j) % 2 == 0 {
                    [[a, b, c], [a, c, d]]
                } else {
                    [[a, b, d], [b, c, d]]
                };
                for triangle in halves {
                    mesh.cells.push(Triangle3, &triangle);
                    mesh.cell_tags.push(mesh.cells.len() as i64);
                }
            }
        }
        let cells = start..self.mesh.cells.len() as u32;
        self.members(name, 2).extend(cells);
        let [n, m] = n;
        self.facets(&format!("{name} bottom"), (0..=n).map(|i| node(i, 0)));
        self.facets(&format!("{name} right"), (0..=m).map(|j| node(n, j)));
        self.facets(&format!("{name} top"), (0..=n).map(|i| node(n - i, m)));
        self.facets(&format!("{name} left"), (0..=m).map(|j| node(0, m - j)));
        self
    }

    fn members(&mut self, name: &str, dim: usize) -> &mut Vec<u32> {
        let group = self.mesh.groups.entry(name.into()).or_default();
        group.dim = dim;
        &mut group.members
    }

    fn facets(&mut self, name: &str, nodes: impl Iterator<Item = u32>) {
        let nodes: Vec<u32> = nodes.collect();
        let start = self.mesh.facets.len() as u32;
        for pair in nodes.windows(2) {
            self.mesh.facets.push(Line2, pair);
        }
        let facets = start..self.mesh.facets.len() as u32;
        self.members(name, 1).extend(facets);
    }

    /// Merges nodes with the same position, where `at(x, y)` is true.
    pub fn glued(self, at: impl Fn(f64, f64) -> bool) -> Self {
        let mesh = glued(self.mesh, |[x, y, _]| at(x, y));
        Self { mesh }
    }
}

/// The mesh with nodes of the same position merged, where `at` is true.
pub fn glued(old: Mesh, at: impl Fn([f64; 3]) -> bool) -> Mesh {
    let mut known: HashMap<[i64; 3], u32> = HashMap::new();
    let mut mesh = Mesh {
        points: Vec::new(),
        node_tags: Vec::new(),
        ..old.clone()
    };
    let number: Vec<u32> = (old.points.iter())
        .map(|&point| {
            let next = mesh.points.len() as u32;
            let key = point.map(|c| (c * 1e7).round() as i64);
            let node = match at(point) {
                true => *known.entry(key).or_insert(next),
                false => next,
            };
            if node == next {
                mesh.points.push(point);
                mesh.node_tags.push(i64::from(next) + 1);
            }
            node
        })
        .collect();
    mesh.cells = renumbered(&old.cells, &number);
    mesh.facets = renumbered(&old.facets, &number);
    mesh
}

fn renumbered(elements: &Elements, number: &[u32]) -> Elements {
    let mut list = Elements::default();
    for (kind, nodes) in elements.iter() {
        let nodes: Vec<u32> = nodes.iter().map(|&n| number[n as usize]).collect();
        list.push(kind, &nodes);
    }
    list
}

/// The mesh with every point moved.
pub fn moved(mut mesh: Mesh, to: impl Fn([f64; 2]) -> [f64; 2]) -> Mesh {
    for point in &mut mesh.points {
        let [x, y] = to([point[0], point[1]]);
        *point = [x, y, 0.0];
    }
    // A reflection inverts all cells.
    if mesh.measure(0) < 0.0 {
        for cell in 0..mesh.cells.len() {
            let old = mesh.cells.nodes_of(cell).to_vec();
            let order = mesh.cells.kind(cell).reversed();
            for (node, &from) in mesh.cells.nodes_of_mut(cell).iter_mut().zip(order) {
                *node = old[from];
            }
        }
    }
    mesh
}

/// The mesh with its inner nodes moved by up to `amount` in each direction.
pub fn jittered(mut mesh: Mesh, amount: f64, seed: u64) -> Mesh {
    let topology = Topology::new(&mesh);
    let mut inner = vec![true; mesh.points.len()];
    for (kind, nodes) in mesh.cells.iter() {
        for (_, local) in kind.facets() {
            let facet: Vec<u32> = local.iter().map(|&i| nodes[i]).collect();
            if topology.cells_at(&facet).len() == 1 {
                facet.iter().for_each(|&n| inner[n as usize] = false);
            }
        }
    }
    let mut random = Random::new(seed);
    for (point, _) in (mesh.points.iter_mut().zip(&inner)).filter(|(_, inner)| **inner) {
        point[0] += amount * random.signed();
        point[1] += amount * random.signed();
    }
    mesh
}

/// The mesh with nodes, cells and facets in another order, elements rotated, and gaps in tags. The second result is the
/// old tag of every new one.
pub fn shuffled(mesh: &Mesh, seed: u64) -> (Mesh, BTreeMap<i64, i64>) {
    let mut random = Random::new(seed);
    let node_order = random.permutation(mesh.points.len());
    let mut number = vec![0; node_order.len()];
    for (new, &old) in node_order.iter().enumerate() {
        number[old as usize] = new as u32;
    }
    let cell_order = random.permutation(mesh.cells.len());
    let facet_order = random.permutation(mesh.facets.len());
    let mut reordered = |elements: &Elements, order: &[u32]| {
        let mut list = Elements::default();
        for &old in order {
            let mut nodes = elements.nodes_of(old as usize).to_vec();
            let corners = elements.kind(old as usize).corners();
            let turn = random.below(corners);
            match elements.kind(old as usize).dim() {
                1 => nodes[..corners].rotate_left(turn),
                2 => {
                    let (at_corners, on_edges) = nodes.split_at_mut(corners);
                    at_corners.rotate_left(turn);
                    if let Some(on_edges) = on_edges.get_mut(..corners) {
                        on_edges.rotate_left(turn);
                    }
                }
                // Every other one is inverted.
                _ if turn.is_multiple_of(2) => {
                    let order = elements.kind(old as usize).reversed();
                    nodes = order.iter().map(|&from| nodes[from]).collect();
                }
                _ => {}
            }
            let nodes: Vec<u32> = nodes.iter().map(|&n| number[n as usize]).collect();
            list.push(elements.kind(old as usize), &nodes);
        }
        list
    };
    let (cells, facets) = (
        reordered(&mesh.cells, &cell_order),
        reordered(&mesh.facets, &facet_order),
    );
    let tags = random.permutation(mesh.points.len());
    let node_tags: Vec<i64> = tags.iter().map(|&t| 17 + 3 * i64::from(t)).collect();
    let old_tags = (node_tags.iter().zip(&node_order))
        .map(|(&new, &old)| (new, mesh.node_tags[old as usize]))
        .collect();
    let groups = (mesh.groups.iter())
        .map(|(name, group)| {
            let order: &[u32] = match group.dim {
                0 => &node_order,
                dim if dim == mesh.dim => &cell_order,
                _ => &facet_order,
            };
            let is_member = |old: &u32| group.members.contains(old);
            let members = (0..order.len() as u32)
                .filter(|&new| is_member(&order[new as usize]))
                .collect();
            let dim = group.dim;
            (name.clone(), Group { dim, members })
        })
        .collect();
    let shuffled = Mesh {
        dim: mesh.dim,
        points: node_order
            .iter()
            .map(|&n| mesh.points[n as usize])
            .collect(),
        node_tags,
        cell_tags: (1..=cells.len() as i64).collect(),
        cells,
        facets,
        groups,
        ..Mesh::default()
    };
    (shuffled, old_tags)
}

/// The mesh with a name prefixed to those of its groups.
pub fn named(mut mesh: Mesh, name: &str) -> Mesh {
    let groups = std::mem::take(&mut mesh.groups).into_iter();
    mesh.groups = groups
        .map(|(group, members)| (format!("{name} {group}"), members))
        .collect();
    mesh
}

/// Union of two meshes without common nodes.
pub fn joined(mut first: Mesh, second: Mesh) -> Mesh {
    let nodes = first.points.len() as u32;
    let number: Vec<u32> = (nodes..nodes + second.points.len() as u32).collect();
    let [facets_before, cells_before] = [&first.facets, &first.cells].map(|e| e.len() as u32);
    first.points.extend(&second.points);
    let cells = renumbered(&second.cells, &number);
    let facets = renumbered(&second.facets, &number);
    cells.iter().for_each(|(k, n)| first.cells.push(k, n));
    facets.iter().for_each(|(k, n)| first.facets.push(k, n));
    first.node_tags = (1..=first.points.len() as i64).collect();
    first.cell_tags = (1..=first.cells.len() as i64).collect();
    for (name, mut group) in second.groups {
        let before = match first.dim - group.dim {
            0 => cells_before,
            1 => facets_before,
            _ => nodes,
        };
        group
            .members
            .iter_mut()
            .for_each(|member| *member += before);
        first.groups.insert(name, group);
    }
    first
}
