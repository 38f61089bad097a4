//! Small models made by hand: blocks of triangles, on top of each other or cracked.
#![allow(
    dead_code,
    reason = "each test binary uses its own part of these scenes"
)]

use std::collections::HashMap;
use std::ops::Range;

use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::element::{ElementKind, Elements};
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::mesh::topology::Topology;
use contact_dd_partition::model::{
    Contact, Formulation, InitialStress, Material, Model, PlaneState, Support,
};
use contact_dd_partition::quantity::Goals;
use contact_dd_partition::scene::units::Units;
use contact_dd_partition::solver::SolverSettings;

/// A model under construction on the lattice of whole numbers; nodes are distinguished by
/// position and a layer, so that two sides of a contact can lie on each other.
#[derive(Default)]
pub struct Builder {
    nodes: HashMap<(usize, usize, usize), u32>,
    points: Vec<[f64; 3]>,
    cells: Elements,
    cell_body: Vec<u32>,
    contacts: Vec<Contact>,
}

impl Builder {
    fn node(&mut self, at: (usize, usize, usize)) -> u32 {
        let points = &mut self.points;
        *self.nodes.entry(at).or_insert_with(|| {
            points.push([at.0 as f64, at.1 as f64, 0.0]);
            points.len() as u32 - 1
        })
    }

    /// Adds a square of two triangles; `layer` returns the layer of each of its nodes.
    fn square(&mut self, i: usize, j: usize, body: u32, layer: impl Fn(usize, usize) -> usize) {
        let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
        let [a, b, c, d] = corners.map(|(x, y)| self.node((x, y, layer(x, y))));
        let triangles = match (i + j) % 2 {
            0 => [[a, b, c], [a, c, d]],
            _ => [[a, b, d], [b, c, d]],
        };
        for nodes in triangles {
            self.cells.push(ElementKind::Triangle3, &nodes);
            self.cell_body.push(body);
        }
    }

    /// Adds a contact along `y` between the layers below and above.
    fn contact(&mut self, name: &str, xs: Range<usize>, y: usize, below: usize, above: usize) {
        let number = self.contacts.len() as u32;
        let points = xs
            .enumerate()
            .map(|(place, x)| {
                let (a, b) = (self.nodes[&(x, y, below)], self.nodes[&(x, y, above)]);
                assert_ne!(a, b);
                let entries = vec![(a, 1.0), (b, -1.0)];
                let position = self.points[a as usize];
                ContactPoint {
                    contact: number,
                    place: place as u32,
                    gap: 1e-3 * x as f64,
                    area: 1.0,
                    tag_b: tag(b),
                    ..ContactPoint::new(entries, [0.0, 1.0, 0.0], position, tag(a))
                }
            })
            .collect();
        self.contacts.push(Contact {
            name: name.into(),
            points,
            probes: Vec::new(),
            prescribed: Vec::new(),
        });
    }

    fn model(self) -> Model {
        let bodies = self.cell_body.iter().max().map_or(0, |b| b + 1);
        let bottom: Vec<u32> = (0..self.points.len() as u32)
            .filter(|&n| self.points[n as usize][1] == 0.0)
            .collect();
        let top = self.points.iter().map(|p| p[1]).fold(0.0, f64::max);
        let mesh = Mesh {
            dim: 2,
            node_tags: (0..self.points.len() as u32).map(tag).collect(),
            points: self.points.clone(),
            cell_tags: (0..self.cells.len() as i64).map(|c| 1000 + c).collect(),
            cells: self.cells,
            ..Mesh::default()
        };
        Model {
            units: Units::default(),
            solver: SolverSettings::default(),
            title: "Löwe & Söhne".into(),
            plane: Some(PlaneState::Strain),
            materials: vec![
                material("steel", Some([0.3, 0.3, 0.0]), Some(0.3)),
                material("wood", None, None),
            ],
            bodies: (0..bodies).map(|b| format!("block {b}")).collect(),
            cell_material: self.cell_body.iter().map(|b| b % 2).collect(),
            support_names: vec!["along".into(), "across".into()],
            springs: Vec::new(),
            supports: bottom
                .iter()
                .flat_map(|&node| {
                    [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]].map(|direction| Support {
                        node,
                        direction,
                        value: f64::from(node),
                        condition: u32::from(direction[0] < 0.0),
                    })
                })
                .collect(),
            forces: (0..self.points.len() as u32)
                .filter(|&n| self.points[n as usize][1] == top)
                .map(|n| (n, [0.5, -1.0, 0.0]))
                .collect(),
            initial_stress: InitialStress::default(),
            topology: Topology::new(&mesh),
            mesh,
            cell_body: self.cell_body,
            steps: Vec::new(),
            contacts: self.contacts,
            tips: Vec::new(),
            goals: Goals::default(),
            found: Vec::new(),
            reference_nodes: Vec::new(),
            prescribed_subdomains: None,
            warnings: vec!["something".into()],
        }
    }
}

fn tag(node: u32) -> i64 {
    7 + 3 * i64::from(node)
}

fn material(name: &str, out_of_plane: Option<[f64; 3]>, poisson: Option<f64>) -> Material {
    Material {
        name: name.into(),
        stiffness: [[2.0, 0.5, 0.0], [0.5, 2.0, 0.1], [0.0, 0.1, 1.0]].into(),
        out_of_plane,
        poisson,
        formulation: Formulation::Full,
    }
}

/// `count` blocks of `nx` times `ny` squares on top of each other, in contact.
pub fn stacked(count: usize, nx: usize, ny: usize) -> Model {
    let mut builder = Builder::default();
    for block in 0..count {
        for j in 0..ny {
            for i in 0..nx {
                builder.square(i, block * ny + j, block as u32, |_, _| block);
            }
        }
    }
    for block in 1..count {
        let name = format!("joint {block}");
        builder.contact(&name, 0..nx + 1, block * ny, block - 1, block);
    }
    builder.model()
}

/// One block of `n` times `n` squares with cracks along its middle, each between two
/// columns; the nodes at the ends of a crack inside the block are tips.
pub fn cracked(n: usize, cracks: &[(usize, usize)]) -> Model {
    let mut builder = Builder::default();
    let middle = n / 2;
    let open = |&(from, to): &(usize, usize)| {
        let start = if from == 0 { 0 } else { from + 1 };
        let end = if to == n { n + 1 } else { to };
        start..end
    };
    for j in 0..n {
        for i in 0..n {
            builder.square(i, j, 0, |x, y| {
                let above = y == middle && j == middle;
                usize::from(above && cracks.iter().any(|c| open(c).contains(&x)))
            });
        }
    }
    for (number, crack) in cracks.iter().enumerate() {
        builder.contact(&format!("crack {number}"), open(crack), middle, 0, 1);
    }
    builder.model()
}

/// The same model with nodes and cells in another order, and the points moved a little.
pub fn shuffled(model: &Model, seed: u64) -> Model {
    let mut state = seed;
    let mut random = move || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as usize
    };
    let mut permutation = |n: usize| {
        let mut order: Vec<usize> = (0..n).collect();
        for i in (1..n).rev() {
            order.swap(i, random() % (i + 1));
        }
        order
    };
    let mesh = &model.mesh;
    let nodes = permutation(mesh.points.len());
    let cells = permutation(mesh.cells.len());
    let mut place = vec![0u32; nodes.len()];
    for (new, &old) in nodes.iter().enumerate() {
        place[old] = new as u32;
    }
    let mut out = model.clone();
    let moved = |[x, y, z]: [f64; 3]| [x + 0.1 * (3.0 * y).sin(), y + 0.1 * (2.0 * x).cos(), z];
    let old = nodes.iter().map(|&n| mesh.points[n]);
    out.mesh.points = old.map(moved).collect();
    out.mesh.node_tags = nodes.iter().map(|&n| mesh.node_tags[n]).collect();
    out.mesh.cell_tags = cells.iter().map(|&c| mesh.cell_tags[c]).collect();
    out.mesh.cells = Elements::default();
    for &c in &cells {
        let moved: Vec<u32> = mesh
            .cells
            .nodes_of(c)
            .iter()
            .map(|&n| place[n as usize])
            .collect();
        out.mesh.cells.push(mesh.cells.kind(c), &moved);
    }
    out.topology = Topology::new(&out.mesh);
    out.cell_body = cells.iter().map(|&c| model.cell_body[c]).collect();
    out.cell_material = cells.iter().map(|&c| model.cell_material[c]).collect();
    for support in &mut out.supports {
        support.node = place[support.node as usize];
    }
    out.supports.sort_by_key(|s| s.node);
    for force in &mut out.forces {
        force.0 = place[force.0 as usize];
    }
    out.forces.sort_by_key(|f| f.0);
    for point in out.contacts.iter_mut().flat_map(|c| &mut c.points) {
        point.position = moved(point.position);
        point.force_point = moved(point.force_point);
        for entry in &mut point.entries {
            entry.0 = place[entry.0 as usize];
        }
    }
    out
}
