//! The cut of a mesh along facets between its cells: the nodes of the facets are duplicated, and the cells behind them
//! get the duplicates.

use std::collections::{BTreeMap, BTreeSet};

use crate::disjoint_sets::DisjointSets;
use crate::element::geometry::{advance, difference, dot};
use crate::error::InputError;
use crate::mesh::topology::Topology;
use crate::mesh::{Group, Mesh};
use crate::model::bodies::Bodies;
use crate::model::groups;
use crate::scene::Scene;
use crate::scene::pretension::Pretension;

/// The name of the group of facets behind the cut of a pretension.
pub(in crate::model) fn other_side(pretension: &Pretension) -> String {
    format!("other side of pretension '{}'", pretension.name)
}

/// Cuts the bodies at all pretensions of a scene; returns for each the pairs of nodes and duplicates.
///
/// # Errors
/// Facets that don't separate the cells around them into two sets, a group with forces on nodes of the cut.
pub(in crate::model) fn cut(
    scene: &Scene,
    bodies: &mut Bodies,
) -> Result<Vec<Vec<[u32; 2]>>, InputError> {
    let mut all = Vec::new();
    for pretension in &scene.pretension {
        let what = format!("pretension '{}'", pretension.name);
        let facets = groups::facets(&bodies.mesh, &pretension.on, &what)?;
        let direction = pretension.direction.as_ref();
        let direction = direction.map_or([0.0; 3], |direction| direction.value);
        let cut = Cut::new(&bodies.mesh, &facets, direction, &what)?;
        cut.check_groups(scene, &bodies.mesh)?;
        all.push(cut.open(scene, &mut bodies.mesh, other_side(pretension)));
    }
    Ok(all)
}

/// A cut that isn't opened yet.
struct Cut<'a> {
    facets: &'a [u32],
    what: &'a str,
    topology: Topology,
    nodes: BTreeSet<u32>,
    /// The cells behind the cut that contain nodes of it.
    behind: BTreeSet<u32>,
}

impl<'a> Cut<'a> {
    /// The cut along `facets` of a mesh; a `direction` that isn't zero points away from the cells behind it.
    ///
    /// # Errors
    /// A facet that isn't between two cells, cells that stay connected around the facets.
    fn new(
        mesh: &Mesh,
        facets: &'a [u32],
        direction: [f64; 3],
        what: &'a str,
    ) -> Result<Self, InputError> {
        let topology = Topology::new(mesh);
        let listed = |facet: &u32| mesh.facets.nodes_of(*facet as usize);
        let mut pairs = Vec::with_capacity(facets.len());
        for nodes in facets.iter().map(listed) {
            let [a, b] = topology.cells_at(nodes)[..] else {
                return Err(InputError::new(format!(
                    "{what}: the facet of nodes {} isn't between two cells; expected facets inside the bolt, across all of it",
                    mesh.tags_of(nodes)
                )));
            };
            pairs.push([a.cell, b.cell]);
        }
        if let Some([a, b]) = pairs.first_mut()
            && dot(direction, difference(middle(mesh, *b), middle(mesh, *a))) > 0.0
        {
            std::mem::swap(a, b);
        }
        let nodes: BTreeSet<u32> = facets.iter().flat_map(listed).copied().collect();
        let around: Vec<u32> = (0..mesh.cells.len() as u32)
            .filter(|&cell| {
                let of_cell = mesh.cells.nodes_of(cell as usize);
                of_cell.iter().any(|node| nodes.contains(node))
            })
            .collect();
        let behind = behind(&topology, &pairs, &around).ok_or_else(|| {
            InputError::new(format!(
                "{what}: its facets don't part the cells around them into two; expected one cut across all of the bolt"
            ))
        })?;
        Ok(Self {
            facets,
            what,
            topology,
            nodes,
            behind,
        })
    }

    /// Refuses groups of points on the cut with forces or springs, as these would act on both sides.
    fn check_groups(&self, scene: &Scene, mesh: &Mesh) -> Result<(), InputError> {
        let loadings = scene.loadings();
        let forces = loadings.iter().flat_map(|loading| loading.force);
        let springs = scene.spring.iter().flat_map(|spring| spring.groups());
        let couplings = scene.coupling.iter().map(|coupling| &coupling.on);
        let terms = scene.equation.iter().flat_map(|equation| &equation.terms);
        let on = (forces.map(|force| &force.on).chain(springs))
            .chain(couplings)
            .chain(terms.flat_map(|term| &term.at));
        for name in on.flat_map(|names| names.iter()) {
            let points = mesh
                .groups
                .get(name)
                .filter(|group| is_of_points(group, mesh));
            let mut members = points.into_iter().flat_map(|group| &group.members);
            if let Some(&node) = members.find(|node| self.nodes.contains(node)) {
                return Err(InputError::new(format!(
                    "{}: node {} of the group '{name}' lies on the cut, where it has two sides; expected forces, springs, \
                     couplings and equations elsewhere",
                    self.what, mesh.node_tags[node as usize]
                )));
            }
        }
        Ok(())
    }

    /// Opens the cut; `name` is that of the group of facets behind it. Returns the pairs of nodes and duplicates.
    fn open(&self, scene: &Scene, mesh: &mut Mesh, name: String) -> Vec<[u32; 2]> {
        let on_cut: BTreeSet<u32> = self.facets.iter().copied().collect();
        let listed = 0..mesh.facets.len() as u32;
        let moving: Vec<u32> = listed
            .filter(|facet| !on_cut.contains(facet))
            .filter(|&facet| {
                let cells = self.topology.cells_at(mesh.facets.nodes_of(facet as usize));
                let [one] = cells[..] else {
                    return cells.iter().all(|at| self.behind.contains(&at.cell));
                };
                self.behind.contains(&one.cell)
            })
            .collect();
        let mut double = BTreeMap::new();
        let mut tag = mesh.node_tags.iter().copied().max().unwrap_or_default();
        for &node in &self.nodes {
            double.insert(node, mesh.points.len() as u32);
            tag += 1;
            mesh.points.push(mesh.points[node as usize]);
            mesh.node_tags.push(tag);
        }
        let rename = |node: &mut u32| *node = double.get(node).copied().unwrap_or(*node);
        for &cell in &self.behind {
            mesh.cells
                .nodes_of_mut(cell as usize)
                .iter_mut()
                .for_each(rename);
        }
        for facet in moving {
            mesh.facets
                .nodes_of_mut(facet as usize)
                .iter_mut()
                .for_each(rename);
        }
        let first = mesh.facets.len() as u32;
        for &facet in self.facets {
            let mut nodes = mesh.facets.nodes_of(facet as usize).to_vec();
            nodes.iter_mut().for_each(rename);
            mesh.facets.push(mesh.facets.kind(facet as usize), &nodes);
        }
        let group = Group {
            dim: mesh.dim - 1,
            members: (first..mesh.facets.len() as u32).collect(),
        };
        mesh.groups.insert(name, group);
        hold_doubles(scene, mesh, &double);
        double
            .into_iter()
            .map(|(node, double)| [node, double])
            .collect()
    }
}

/// Adds the duplicates of nodes to the groups of points with prescribed displacements.
fn hold_doubles(scene: &Scene, mesh: &mut Mesh, double: &BTreeMap<u32, u32>) {
    let loadings = scene.loadings();
    let held = loadings.iter().flat_map(|loading| loading.displacement);
    let names: BTreeSet<&str> = held.flat_map(|held| held.on.iter()).collect();
    let dim = mesh.dim;
    for (_, group) in (mesh.groups.iter_mut()).filter(|(name, _)| names.contains(&name[..])) {
        if group.dim + 1 < dim {
            let doubles = group.members.iter().filter_map(|node| double.get(node));
            let doubles: Vec<u32> = doubles.copied().collect();
            group.members.extend(doubles);
        }
    }
}

/// The middle of a cell's nodes.
fn middle(mesh: &Mesh, cell: u32) -> [f64; 3] {
    let nodes = mesh.cells.nodes_of(cell as usize);
    let part = 1.0 / nodes.len() as f64;
    let sum = |sum, &node: &u32| advance(sum, part, mesh.points[node as usize]);
    nodes.iter().fold([0.0; 3], sum)
}

/// True if the members of a group are nodes.
fn is_of_points(group: &Group, mesh: &Mesh) -> bool {
    group.dim + 1 < mesh.dim
}

/// Cells `around` a cut on the side of the second cell of the first of `pairs`. `None` where the facets don't separate
/// the cells into two sets.
fn behind(topology: &Topology, pairs: &[[u32; 2]], around: &[u32]) -> Option<BTreeSet<u32>> {
    let place: BTreeMap<u32, u32> = around.iter().copied().zip(0..).collect();
    let parted: BTreeSet<[u32; 2]> = pairs.iter().map(|[a, b]| [*a.min(b), *a.max(b)]).collect();
    let mut pieces = DisjointSets::new(around.len());
    for (&cell, &own) in &place {
        for &other in topology.neighbours(cell as usize) {
            let Some(&of_other) = place.get(&other) else {
                continue;
            };
            if !parted.contains(&[cell.min(other), cell.max(other)]) {
                pieces.unite(own, of_other);
            }
        }
    }
    let [a, b] = pairs.first()?.map(|cell| pieces.find(place[&cell]));
    let mut is_parted = |pair: &[u32; 2]| {
        let of_pair = pair.map(|cell| pieces.find(place[&cell]));
        of_pair == [a, b] || of_pair == [b, a]
    };
    if a == b || !pairs.iter().all(&mut is_parted) {
        return None;
    }
    let of_b = around.iter().copied();
    Some(of_b.filter(|cell| pieces.find(place[cell]) == b).collect())
}
