//! Connected bodies, which may share nodes, and disconnected subdomains.

use std::collections::{BTreeMap, BTreeSet};

use crate::decompose::Decomposition;
use crate::disjoint_sets::DisjointSets;
use crate::element::geometry::{advance, difference, length};
use crate::magnitude::short;
use crate::mesh::bounding_box::BoundingBox;
use crate::model::Model;

/// The connected bodies of a mesh, in the order of their first cell.
pub(super) struct Bodies {
    /// Name of every body.
    pub names: Vec<String>,
    /// Body of every cell.
    pub of_cell: Vec<usize>,
}

impl Bodies {
    /// Finds the connected bodies and names each after the scene's body. The names of several scene bodies in one
    /// connected body are joined by "+"; the parts of a disconnected scene body are numbered "#1", "#2" ... and
    /// identified by a point inside.
    pub fn new(model: &Model) -> Self {
        let cells = &model.mesh.cells;
        let mut sets = DisjointSets::new(model.mesh.points.len());
        for (_, nodes) in cells.iter() {
            for pair in nodes.windows(2) {
                sets.unite(pair[0], pair[1]);
            }
        }
        let mut body_of_root = vec![usize::MAX; model.mesh.points.len()];
        let mut of_cell = Vec::with_capacity(cells.len());
        let mut scene_bodies: Vec<BTreeSet<u32>> = Vec::new();
        for (cell, (_, nodes)) in cells.iter().enumerate() {
            let body = &mut body_of_root[sets.find(nodes[0]) as usize];
            if *body == usize::MAX {
                *body = scene_bodies.len();
                scene_bodies.push(BTreeSet::new());
            }
            if !scene_bodies[*body].contains(&model.cell_body[cell]) {
                scene_bodies[*body].insert(model.cell_body[cell]);
            }
            of_cell.push(*body);
        }
        let names = scene_bodies.iter().map(|set| {
            let names: Vec<&str> = set
                .iter()
                .map(|&b| model.bodies[b as usize].as_str())
                .collect();
            names.join("+")
        });
        Self {
            names: numbered(
                &names.collect::<Vec<_>>(),
                &points_inside(model, &of_cell),
                model.mesh.dim,
            ),
            of_cell,
        }
    }
}

/// A point inside every body: the middle of the cell nearest to the middle of the body's bounding box.
fn points_inside(model: &Model, of_cell: &[usize]) -> Vec<[f64; 3]> {
    let mesh = &model.mesh;
    let points = |cell: usize| {
        mesh.cells
            .nodes_of(cell)
            .iter()
            .map(|&node| mesh.points[node as usize])
    };
    let count = of_cell.iter().max().map_or(0, |last| last + 1);
    let mut boxes = vec![BoundingBox::EMPTY; count];
    for (cell, &body) in of_cell.iter().enumerate() {
        let around = BoundingBox::around(
            mesh.cells
                .nodes_of(cell)
                .iter()
                .map(|&node| &mesh.points[node as usize]),
        );
        boxes[body].include(&around);
    }
    let mut nearest = vec![(f64::INFINITY, [0.0; 3]); count];
    for (cell, &body) in of_cell.iter().enumerate() {
        let share = 1.0 / mesh.cells.nodes_of(cell).len() as f64;
        let middle = points(cell).fold([0.0; 3], |sum, x| advance(sum, share, x));
        let BoundingBox { low, high } = boxes[body];
        let distance = length(difference(
            middle,
            [0, 1, 2].map(|k| 0.5 * (low[k] + high[k])),
        ));
        if distance < nearest[body].0 {
            nearest[body] = (distance, middle);
        }
    }
    nearest.into_iter().map(|(_, x)| x).collect()
}

impl Bodies {
    /// The connected bodies that consist of these scene bodies only, ascending.
    pub fn among(&self, model: &Model, of_scene: &[u32]) -> Vec<u32> {
        let cells = self.of_cell.iter().zip(&model.cell_body);
        let among = cells.filter(|(_, body)| of_scene.contains(body));
        let bodies: BTreeSet<u32> = among.map(|(&body, _)| body as u32).collect();
        bodies.into_iter().collect()
    }
}

/// Numbers the names that occur more than once, and adds a point inside each body.
fn numbered(names: &[String], points: &[[f64; 3]], dim: usize) -> Vec<String> {
    let mut total: BTreeMap<&str, usize> = BTreeMap::new();
    for name in names {
        *total.entry(name).or_default() += 1;
    }
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    (names.iter().zip(points))
        .map(|(name, x)| {
            let number = seen.entry(name).or_default();
            *number += 1;
            match total[name.as_str()] {
                1 => name.clone(),
                _ => format!("{name} #{number} at ({})", x.map(short)[..dim].join(", ")),
            }
        })
        .collect()
}

/// The warning of subdomains prescribed by the user that aren't connected across facets.
pub(super) fn scattered(model: &Model, decomposition: &Decomposition) -> Option<String> {
    model.prescribed_subdomains.as_ref()?;
    let of = &decomposition.subdomain;
    let mut sets = DisjointSets::new(of.len());
    for cell in 0..of.len() {
        for &next in model.topology.neighbours(cell) {
            if of[cell] == of[next as usize] {
                sets.unite(cell as u32, next);
            }
        }
    }
    let mut components = vec![0; decomposition.count];
    for cell in 0..of.len() as u32 {
        if sets.find(cell) == cell {
            components[of[cell as usize] as usize] += 1;
        }
    }
    let scattered: Vec<String> = components
        .iter()
        .enumerate()
        .filter(|&(_, &count)| count > 1)
        .map(|(subdomain, _)| subdomain.to_string())
        .collect();
    (!scattered.is_empty()).then(|| {
        format!(
            "the scene's partition has disconnected subdomains: {}",
            scattered.join(", ")
        )
    })
}
