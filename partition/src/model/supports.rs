//! Γ_u and Γ_o: prescribed displacements of each node, as orthonormal rows.

use std::collections::{BTreeMap, BTreeSet};

use super::surface::Surface;
use super::{Support, groups};
use crate::element::geometry::{advance, dot, length};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;
use crate::scene::Scene;
use crate::scene::loading::Loading;
use crate::scene::material::PlaneState;

/// Relative difference up to which two prescribed values of one component agree.
const AGREE: f64 = 1e-12;
/// Sine of the angle up to which a direction counts as prescribed already.
pub(super) const PARALLEL: f64 = 1e-6;
/// Cosine of 40°: facets of one bilateral boundary condition with a larger angle form a corner, at which both
/// directions are held.
const CORNER: f64 = 0.766_044_443_118_978;

/// A direction prescribed at a node by a boundary condition.
struct Row {
    direction: [f64; 3],
    value: f64,
    /// Index of the boundary condition among the names.
    condition: usize,
}

/// The names of the boundary conditions that prescribe displacements in a loading of `scene`, displacements before
/// bilateral ones.
pub(super) fn names(scene: &Scene, loading: &Loading, mesh: &Mesh) -> Vec<String> {
    let displacement = (loading.displacement.iter().enumerate())
        .map(|(i, condition)| loading.displacement_label(i, &condition.on));
    let bilateral = (scene.bilateral.iter().enumerate())
        .map(|(i, condition)| format!("bilateral[{}] on {}", i + 1, condition.on));
    let axis = on_axis(scene, mesh)
        .next()
        .map(|_| "axis of symmetry".into());
    displacement.chain(bilateral).chain(axis).collect()
}

/// The nodes on the axis of an axisymmetric scene, which have no radial displacement.
fn on_axis(scene: &Scene, mesh: &Mesh) -> impl Iterator<Item = u32> {
    let is_ring = scene.plane == Some(PlaneState::Axisymmetric);
    let nodes = (0..).zip(&mesh.points);
    nodes.filter_map(move |(node, x)| (is_ring && x[0] == 0.0).then_some(node))
}

/// The supports of a loading.
pub(super) struct Supports {
    /// Ascending by node, the rows of one node orthonormal.
    pub rows: Vec<Support>,
    /// The earlier boundary conditions that share prescribed displacements with each one: at common nodes, the force
    /// along the direction of the earlier one is assigned to that one.
    holders: Vec<BTreeSet<usize>>,
}

impl Supports {
    /// Names of the boundary conditions with a note on the part that others hold.
    pub fn names(&self, names: Vec<String>) -> Vec<String> {
        let short = |holder: &usize| names[*holder].split(" on ").next().unwrap_or_default();
        let named = names.iter().zip(&self.holders).map(|(name, holders)| {
            let holders: Vec<&str> = holders.iter().map(short).collect();
            match holders.is_empty() {
                true => name.clone(),
                false => format!("{name}, except the part of {}", holders.join(" or ")),
            }
        });
        named.collect()
    }
}

impl Supports {
    /// Flags of the boundary conditions that share prescribed displacements with one after the first `displacements`.
    pub fn decide(&self, displacements: usize) -> Vec<bool> {
        let others = self.holders.iter().skip(displacements);
        let held: BTreeSet<usize> = others.flatten().copied().collect();
        let conditions = 0..self.holders.len();
        conditions.map(|holder| held.contains(&holder)).collect()
    }
}

/// The supports of a loading of `scene`.
pub(super) fn supports(
    scene: &Scene,
    loading: &Loading,
    mesh: &Mesh,
    topology: &Topology,
) -> Result<Supports, InputError> {
    let names = names(scene, loading, mesh);
    let mut numbered = names.iter().enumerate();
    let mut rows: BTreeMap<u32, Vec<Row>> = BTreeMap::new();
    let mut add = |node, direction, value, condition| {
        rows.entry(node).or_default().push(Row {
            direction,
            value,
            condition,
        });
    };
    for (keys, (condition, label)) in loading.displacement.iter().zip(&mut numbered) {
        for node in groups::nodes(mesh, &keys.on, label)? {
            for (axis, number) in keys.components.iter().enumerate() {
                let Some(number) = number else { continue };
                let value = number
                    .at(mesh.points[node as usize])
                    .map_err(InputError::about(label))?
                    * loading.scale.displacement;
                let mut direction = [0.0; 3];
                direction[axis] = 1.0;
                add(node, direction, value, condition);
            }
        }
    }
    for (keys, (condition, label)) in scene.bilateral.iter().zip(&mut numbered) {
        let facets = groups::facets(mesh, &keys.on, label)?;
        let surface = Surface::new(mesh, topology, scene.plane, &facets, label)?;
        for (node, facets) in surface.around() {
            for direction in corner_normals(&surface, node, facets) {
                add(node, direction, 0.0, condition);
            }
        }
    }
    if let Some((axis, _)) = numbered.next() {
        on_axis(scene, mesh).for_each(|node| add(node, [1.0, 0.0, 0.0], 0.0, axis));
    }
    let mut supports = Supports {
        rows: Vec::new(),
        holders: vec![BTreeSet::new(); names.len()],
    };
    for (node, rows) in rows {
        orthonormal(node, mesh, &names, &rows, &mut supports)?;
    }
    Ok(supports)
}

/// The normals at a node of the facets around it: averages, weighted by measure, of those that form no corner.
fn corner_normals(surface: &Surface, node: u32, mut facets: Vec<usize>) -> Vec<[f64; 3]> {
    let measure = |f: &usize| surface.facets[*f].measure;
    facets.sort_by(|a, b| measure(b).total_cmp(&measure(a)));
    let mut sums: Vec<[f64; 3]> = Vec::new();
    for facet in facets.iter().map(|&f| &surface.facets[f]) {
        let normal = facet.normal_at(node);
        let same = |sum: &&mut [f64; 3]| dot(**sum, normal) >= CORNER * length(**sum);
        match sums.iter_mut().find(same) {
            Some(sum) => *sum = advance(*sum, facet.measure, normal),
            None => sums.push(normal.map(|c| c * facet.measure)),
        }
    }
    sums.into_iter()
        .map(|sum| sum.map(|c| c / length(sum)))
        .collect()
}

/// Appends orthonormal rows equivalent to `rows`: the part of each that is independent of the earlier ones; records
/// earlier ones that hold a part of it.
fn orthonormal(
    node: u32,
    mesh: &Mesh,
    names: &[String],
    rows: &[Row],
    supports: &mut Supports,
) -> Result<(), InputError> {
    let Supports {
        rows: supports,
        holders,
    } = supports;
    let start = supports.len();
    let scale = rows.iter().map(|row| row.value.abs()).fold(0.0, f64::max);
    for (index, row) in rows.iter().enumerate() {
        let (mut direction, mut value) = (row.direction, row.value);
        // Repeating Gram-Schmidt twice gives orthogonality to round-off.
        for _ in 0..2 {
            for before in &supports[start..] {
                let overlap = dot(direction, before.direction);
                let holder = before.condition as usize;
                if overlap.abs() > PARALLEL && holder != row.condition {
                    holders[row.condition].insert(holder);
                }
                direction = advance(direction, -overlap, before.direction);
                value -= overlap * before.value;
            }
        }
        let left = length(direction);
        if left > PARALLEL {
            supports.push(Support {
                node,
                direction: direction.map(|c| c / left),
                value: value / left,
                condition: row.condition as u32,
            });
            continue;
        }
        let exact = rows[..index]
            .iter()
            .find(|other| other.direction == row.direction);
        let agreed = if exact.is_some() { AGREE } else { PARALLEL };
        if value.abs() > agreed * scale {
            let others = match exact {
                Some(other) => format!("{} prescribes {}", names[other.condition], other.value),
                None => {
                    let before = rows[..index].iter().map(|r| names[r.condition].as_str());
                    format!(
                        "{} prescribe another one",
                        before.collect::<Vec<_>>().join(" and ")
                    )
                }
            };
            let [x, y, z] = row.direction;
            return Err(InputError::new(format!(
                "node {}: {} prescribes {} for the displacement along ({x}, {y}, {z}), {others}; \
                 expected conditions that agree",
                mesh.node_tags[node as usize], names[row.condition], row.value
            )));
        }
    }
    Ok(())
}
