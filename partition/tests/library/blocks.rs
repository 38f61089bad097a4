//! Meshes of rectangular blocks for the tests, and scenes on them.

use std::collections::BTreeMap;

use contact_dd_partition::element::ElementKind::{Line2, Line3, Triangle3, Triangle6};
use contact_dd_partition::element::Elements;
use contact_dd_partition::mesh::{Group, Mesh};
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

pub const STEEL: &str =
    "mesh = 'a.msh'\nplane = 'strain'\nmaterials.steel = {young = 200, poisson = 0.25}\n";

/// A mesh of blocks, each with its own nodes.
#[derive(Clone, Default)]
pub struct Blocks {
    pub mesh: Mesh,
}

impl Blocks {
    pub fn new() -> Self {
        let mesh = Mesh {
            dim: 2,
            ..Mesh::default()
        };
        Self { mesh }
    }

    /// Adds the block [x0, x1] × [y0, y1] of n × m rectangles, the group of cells `name` and the
    /// groups of facets `name bottom`, `name right`, `name top`, `name left`.
    pub fn block(mut self, name: &str, x: [f64; 2], y: [f64; 2], n: [usize; 2]) -> Self {
        let mesh = &mut self.mesh;
        let first = mesh.points.len() as u32;
        let node = |i: usize, j: usize| first + (j * (n[0] + 1) + i) as u32;
        for j in 0..=n[1] {
            for i in 0..=n[0] {
                let at =
                    |c: [f64; 2], k: usize, n: usize| c[0] + (c[1] - c[0]) * k as f64 / n as f64;
                mesh.points.push([at(x, i, n[0]), at(y, j, n[1]), 0.0]);
                mesh.node_tags.push(1000 + 3 * mesh.points.len() as i64);
            }
        }
        let start = mesh.cells.len() as u32;
        for j in 0..n[1] {
            for i in 0..n[0] {
                let (a, b, c, d) = (
                    node(i, j),
                    node(i + 1, j),
                    node(i + 1, j + 1),
                    node(i, j + 1),
                );
                mesh.cells.push(Triangle3, &[a, b, c]);
                mesh.cells.push(Triangle3, &[a, c, d]);
                mesh.cell_tags.push(5000 + mesh.cell_tags.len() as i64);
                mesh.cell_tags.push(5000 + mesh.cell_tags.len() as i64);
            }
        }
        self.group(name, 2, (start..self.mesh.cells.len() as u32).collect());
        let [n, m] = n;
        self.facets(&format!("{name} bottom"), (0..=n).map(|i| node(i, 0)));
        self.facets(&format!("{name} right"), (0..=m).map(|j| node(n, j)));
        self.facets(&format!("{name} top"), (0..=n).map(|i| node(n - i, m)));
        self.facets(&format!("{name} left"), (0..=m).map(|j| node(0, m - j)));
        self
    }

    fn group(&mut self, name: &str, dim: usize, members: Vec<u32>) {
        self.mesh.groups.insert(name.into(), Group { dim, members });
    }

    /// Adds a group of the facets along a line of nodes.
    pub fn facets(&mut self, name: &str, nodes: impl Iterator<Item = u32>) {
        let nodes: Vec<u32> = nodes.collect();
        let start = self.mesh.facets.len() as u32;
        for pair in nodes.windows(2) {
            self.mesh.facets.push(Line2, pair);
        }
        self.group(name, 1, (start..self.mesh.facets.len() as u32).collect());
    }

    /// Adds a group of the one node at (x, y).
    pub fn point(mut self, name: &str, x: f64, y: f64) -> Self {
        let node = self.node(x, y);
        self.group(name, 0, vec![node]);
        self
    }

    /// The node at (x, y), the first of several.
    pub fn node(&self, x: f64, y: f64) -> u32 {
        let near = |p: &[f64; 3]| (p[0] - x).abs() + (p[1] - y).abs() < 1e-12;
        self.mesh.points.iter().position(near).unwrap() as u32
    }

    /// Moves every point.
    pub fn moved(mut self, to: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        self.mesh.points = self.mesh.points.into_iter().map(to).collect();
        self
    }

    /// The same mesh with a node in the middle of every edge.
    pub fn quadratic(mut self) -> Self {
        let mut middles = BTreeMap::new();
        let linear = std::mem::take(&mut self.mesh.cells);
        for (_, corners) in linear.iter() {
            let edges = [[0, 1], [1, 2], [2, 0]].map(|edge| edge.map(|i| corners[i]));
            let on_edges = edges.map(|ends| self.middle(&mut middles, ends));
            let nodes = [corners, &on_edges].concat();
            self.mesh.cells.push(Triangle6, &nodes);
        }
        let linear = std::mem::take(&mut self.mesh.facets);
        for (_, ends) in linear.iter() {
            let ends = [ends[0], ends[1]];
            let middle = self.middle(&mut middles, ends);
            self.mesh.facets.push(Line3, &[ends[0], ends[1], middle]);
        }
        self
    }

    fn middle(&mut self, known: &mut BTreeMap<[u32; 2], u32>, [a, b]: [u32; 2]) -> u32 {
        *known.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let points = &mut self.mesh.points;
            let (p, q) = (points[a as usize], points[b as usize]);
            points.push([0, 1, 2].map(|i| 0.5 * (p[i] + q[i])));
            self.mesh.node_tags.push(1000 + 3 * points.len() as i64);
            points.len() as u32 - 1
        })
    }

    /// The same mesh with nodes, cells and facets numbered from the other end, and every other
    /// cell and facet turned round.
    pub fn disguised(&self) -> Self {
        let mesh = &self.mesh;
        let n = mesh.points.len() as u32;
        let backwards = |elements: &Elements| {
            let mut list = Elements::default();
            for e in (0..elements.len()).rev() {
                let kind = elements.kind(e);
                let nodes: Vec<u32> = elements.nodes_of(e).iter().map(|v| n - 1 - v).collect();
                if e % 2 == 0 {
                    list.push(kind, &nodes);
                } else {
                    let turned: Vec<u32> = kind.reversed().iter().map(|&i| nodes[i]).collect();
                    list.push(kind, &turned);
                }
            }
            list
        };
        let count = [n, mesh.facets.len() as u32, mesh.cells.len() as u32];
        let groups: BTreeMap<String, Group> = (mesh.groups.iter())
            .map(|(name, group)| {
                let last = count[group.dim] - 1;
                let members = group.members.iter().rev().map(|m| last - m).collect();
                let dim = group.dim;
                (name.clone(), Group { dim, members })
            })
            .collect();
        Self {
            mesh: Mesh {
                dim: 2,
                points: mesh.points.iter().rev().copied().collect(),
                node_tags: mesh.node_tags.iter().rev().copied().collect(),
                cells: backwards(&mesh.cells),
                cell_tags: mesh.cell_tags.iter().rev().copied().collect(),
                facets: backwards(&mesh.facets),
                groups,
                ..Mesh::default()
            },
        }
    }

    /// The model of the scene that `text` adds to [`STEEL`], every group of cells a body of steel
    /// unless the text speaks of bodies.
    pub fn model(&self, text: &str) -> Result<Model, String> {
        let mut whole = STEEL.to_owned();
        if !text.contains("bodies") {
            for (name, _) in self.mesh.groups.iter().filter(|(_, g)| g.dim == 2) {
                whole += &format!("bodies.'{name}'.material = 'steel'\n");
            }
        }
        let scene = Scene::parse(&format!("{whole}{text}")).unwrap();
        Model::new(&scene, self.mesh.clone()).map_err(|error| error.to_string())
    }
}
