//! Body and material of each cell.

use std::collections::BTreeSet;

use super::parts::Formulation;
use super::{Material, PlaneState, groups, locking};
use crate::element::{ElementKind, Elements};
use crate::error::InputError;
use crate::mesh::bounding_box::BoundingBox;
use crate::mesh::{Group, Mesh};
use crate::scene::Scene;
use crate::scene::condition::{Body, Integration, Names};
use crate::scene::contact::{Contact, Declaration};
use crate::scene::material::Elasticity;
use crate::stiffness::Stiffness;

/// Distance from the axis, relative to the bodies' extent, that is round-off.
const AXIS: f64 = 1e-10;

/// Warning that incompatible modes aren't available around an axis.
const WITHOUT_MODES: &str = "elements with incompatible modes are solved without them where plane = \"axisymmetric\", too \
                             stiff in bending; quadratic ones, such as CAX8, aren't";

/// The mesh of the bodies only, with body and material of its cells.
pub(super) struct Bodies {
    pub mesh: Mesh,
    pub cell_body: Vec<u32>,
    pub cell_material: Vec<u32>,
    /// The materials, from index `first_variant` on, that are copies of others for cells of another formulation.
    pub variants: Vec<(u32, Formulation)>,
    first_variant: u32,
}

impl Bodies {
    /// Assigns every cell to its body; cells in no body are removed, with a warning.
    pub fn new(scene: &Scene, mesh: Mesh, warnings: &mut Vec<String>) -> Result<Self, InputError> {
        let names: Vec<&str> = scene.bodies.keys().map(String::as_str).collect();
        let owner = groups::owners(&mesh, &names, "bodies")?;
        let left_out = owner.iter().filter(|owner| owner.is_none()).count();
        let kept: Vec<bool> = owner.iter().map(Option::is_some).collect();
        let unnamed = unnamed(&mesh, &kept);
        if left_out > 0 {
            warnings.push(format!(
                "{left_out} of {} cells of the mesh belong to no body and are left out{unnamed}",
                owner.len()
            ));
        }
        let mut mesh = restrict(mesh, &kept, &used_groups(scene))
            .map_err(|lost| InputError::new(format!("{lost} belongs to no body{unnamed}")))?;
        let checked = mesh.orient_cells().and_then(|()| mesh.check_edges());
        warnings.extend(checked.map_err(|error| error.in_file(&scene.mesh))?);
        let cell_body: Vec<u32> = owner.into_iter().flatten().collect();
        let number = |body: &Body| {
            let before = |name: &&String| name.as_str() < body.material.as_str();
            scene.materials.keys().filter(before).count() as u32
        };
        let material_of_body: Vec<u32> = scene.bodies.values().map(number).collect();
        // A separate material keeps the recovery of stresses from averaging across bodies: stresses jump where initial
        // stress does.
        let mut own = scene.materials.len() as u32..;
        let material_of_body: Vec<u32> = (scene.bodies.values().zip(material_of_body))
            .map(|(body, material)| match body.has_initial_stress() {
                true => own.next().unwrap_or(material),
                false => material,
            })
            .collect();
        if scene.plane == Some(PlaneState::Axisymmetric) {
            take_radii(&mut mesh, &cell_body, &names)?;
        }
        warnings.extend(locking::warnings(scene, &mesh, &cell_body));
        let cell_material = cell_body.iter();
        let cell_material = cell_material.map(|&body| material_of_body[body as usize]);
        let mut bodies = Self {
            cell_material: cell_material.collect(),
            mesh,
            cell_body,
            variants: Vec::new(),
            first_variant: own.start,
        };
        let is_around_axis = scene.plane == Some(PlaneState::Axisymmetric);
        if is_around_axis && bodies.mesh.has_modes.contains(&true) {
            warnings.push(WITHOUT_MODES.into());
        }
        bodies.name_variants(scene, is_around_axis)?;
        Ok(bodies)
    }
}

impl Bodies {
    /// Gives cells of another formulation separate materials, after all others.
    ///
    /// # Errors
    /// A body of reduced integration without a cell that supports it.
    fn name_variants(&mut self, scene: &Scene, is_around_axis: bool) -> Result<(), InputError> {
        let mut reduced: Vec<Option<bool>> = (scene.bodies.values())
            .map(|body| (body.integration == Integration::Reduced).then_some(false))
            .collect();
        for (cell, (kind, _)) in self.mesh.cells.iter().enumerate() {
            let is_linear = matches!(kind, ElementKind::Quad4 | ElementKind::Hexahedron8);
            let has_modes = self.mesh.has_modes.get(cell) == Some(&true);
            let reduced = &mut reduced[self.cell_body[cell] as usize];
            let formulation = if has_modes && is_linear && !is_around_axis {
                Formulation::IncompatibleModes
            } else if reduced.is_some() && kind.reduced_points().is_some() {
                *reduced = Some(true);
                Formulation::Reduced
            } else {
                continue;
            };
            let variant = (self.cell_material[cell], formulation);
            let known = self.variants.iter().position(|other| *other == variant);
            let place = known.unwrap_or_else(|| {
                self.variants.push(variant);
                self.variants.len() - 1
            });
            self.cell_material[cell] = self.first_variant + place as u32;
        }
        match (reduced.iter().zip(scene.bodies.keys())).find(|(found, _)| **found == Some(false)) {
            None => Ok(()),
            Some((_, name)) => Err(InputError::new(format!(
                "bodies.{name}.integration: no cell of it has a reduced integration; expected quadrilaterals of 8 nodes or \
                 hexahedra of 20"
            ))),
        }
    }

    /// The formulation of a cell.
    pub fn formulation(&self, cell: usize) -> Formulation {
        let variant = self.cell_material[cell].checked_sub(self.first_variant);
        variant.map_or(Formulation::Full, |variant| {
            self.variants[variant as usize].1
        })
    }

    /// All materials: the given ones, followed by those of cells of another formulation.
    pub fn with_variants(&self, mut materials: Vec<Material>) -> Vec<Material> {
        for &(material, formulation) in &self.variants {
            let plain = materials[material as usize].clone();
            materials.push(Material {
                name: format!("{}{}", plain.name, formulation.words()),
                formulation,
                ..plain
            });
        }
        materials
    }
}

/// The subdomain of every cell, given one group of cells for each subdomain.
pub(super) fn prescribed_subdomains(mesh: &Mesh, names: &Names) -> Result<Vec<u32>, InputError> {
    let list: Vec<&str> = names.iter().collect();
    let owner = groups::owners(mesh, &list, "subdomains")?;
    if let Some(cell) = owner.iter().position(Option::is_none) {
        return Err(InputError::new(format!(
            "subdomains: cell {} of the mesh (nodes {}) is in none of them; \
             expected each cell of the bodies in exactly one",
            mesh.cell_tags[cell],
            mesh.tags_of(mesh.cells.nodes_of(cell))
        )));
    }
    Ok(owner.into_iter().flatten().collect())
}

/// Uses x as the radius: points within round-off of the axis are moved onto it.
///
/// # Errors
/// A node with a negative radius, with its body.
fn take_radii(mesh: &mut Mesh, cell_body: &[u32], names: &[&str]) -> Result<(), InputError> {
    let axis = AXIS * BoundingBox::around(&mesh.points).extent();
    for ((_, nodes), &body) in mesh.cells.iter().zip(cell_body) {
        for &node in nodes {
            let x = mesh.points[node as usize][0];
            if x < -axis {
                return Err(InputError::new(format!(
                    "body '{}': node {} lies at x = {x}; expected x ≥ 0, as x is the radius where plane = \
                     \"axisymmetric\"",
                    names[body as usize], mesh.node_tags[node as usize]
                )));
            }
        }
    }
    let near = mesh.points.iter_mut().filter(|x| x[0].abs() <= axis);
    near.for_each(|x| x[0] = 0.0);
    Ok(())
}

/// Materials in the order of their names, followed by those of bodies with initial stress, with C for the plane state,
/// or for space.
pub(super) fn materials(scene: &Scene, plane: Option<PlaneState>) -> Vec<Material> {
    let materials = scene.materials.iter();
    let materials = materials.map(|(name, elasticity)| material(name, elasticity, plane));
    let own = scene
        .bodies
        .iter()
        .filter(|(_, body)| body.has_initial_stress());
    let own = own.filter_map(|(name, body)| {
        let elasticity = scene.materials.get(&body.material)?;
        let name = format!("{} of {name}", body.material);
        Some(material(&name, elasticity, plane))
    });
    materials.chain(own).collect()
}

fn material(name: &str, elasticity: &Elasticity, plane: Option<PlaneState>) -> Material {
    let (stiffness, out_of_plane, poisson) = match elasticity {
        Elasticity::Isotropic { young, poisson } => {
            let (stiffness, out_of_plane) = isotropic(*young, *poisson, plane);
            (stiffness, Some(out_of_plane), Some(*poisson))
        }
        Elasticity::Anisotropic {
            stiffness,
            out_of_plane,
        } => (stiffness.clone(), *out_of_plane, None),
    };
    Material {
        name: name.to_owned(),
        stiffness,
        out_of_plane: match plane {
            Some(PlaneState::Strain) => out_of_plane,
            Some(PlaneState::Stress) => Some([0.0; 3]),
            Some(PlaneState::Axisymmetric) | None => None,
        },
        poisson,
        formulation: Formulation::Full,
    }
}

/// C by Hooke's law, and in plane strain its row for σ_zz.
fn isotropic(young: f64, poisson: f64, plane: Option<PlaneState>) -> (Stiffness, [f64; 3]) {
    let shear = young / (2.0 * (1.0 + poisson));
    let lambda = match plane {
        Some(PlaneState::Stress) => 2.0 * shear * poisson / (1.0 - poisson),
        _ => 2.0 * shear * poisson / (1.0 - 2.0 * poisson),
    };
    let axial = lambda + 2.0 * shear;
    let size = PlaneState::components(plane);
    // Normal components come first.
    let axes = if size == 3 { 2 } else { 3 };
    let entry = |i: usize, j: usize| match (i < axes, j < axes) {
        (true, true) if i == j => axial,
        (true, true) => lambda,
        _ if i == j => shear,
        _ => 0.0,
    };
    let values: Vec<f64> = (0..size * size)
        .map(|k| entry(k / size, k % size))
        .collect();
    (Stiffness::new(size, &values), [lambda, lambda, 0.0])
}

/// Groups of cells that belong to no body, for the end of a message; empty if there is none.
fn unnamed(mesh: &Mesh, kept: &[bool]) -> String {
    let is_left_out = |group: &Group| {
        group.dim == mesh.dim && group.members.iter().any(|&cell| !kept[cell as usize])
    };
    let names: Vec<String> = (mesh.groups.iter())
        .filter(|(_, group)| is_left_out(group))
        .map(|(name, _)| format!("'{name}'"))
        .collect();
    match names.as_slice() {
        [] => String::new(),
        [one] => format!("; the group {one} isn't among [bodies]"),
        several => format!("; the groups {} aren't among [bodies]", several.join(", ")),
    }
}

/// The groups of facets or points used in any load step.
fn used_groups(scene: &Scene) -> BTreeSet<&str> {
    let loaded = scene.loadings().into_iter().flat_map(|loading| {
        (loading.displacement.iter().map(|c| &c.on))
            .chain(loading.traction.iter().map(|c| &c.on))
            .chain(loading.pressure.iter().map(|c| &c.on))
            .chain(loading.force.iter().map(|c| &c.on))
    });
    let explicit = scene.contact.iter().filter_map(Declaration::contact);
    (loaded.chain(scene.bilateral.iter().map(|c| &c.on)))
        .chain(scene.spring.iter().flat_map(|spring| spring.groups()))
        .chain(explicit.flat_map(Contact::sides))
        .chain(scene.tie.iter().flat_map(|tie| &tie.sides))
        .chain(
            scene
                .equation
                .iter()
                .flat_map(|e| &e.terms)
                .flat_map(|t| &t.at),
        )
        .chain(scene.pretension.iter().map(|bolt| &bolt.on))
        .chain(scene.cyclic.iter().flat_map(|sector| &sector.sides))
        .flat_map(Names::iter)
        .collect()
}

/// The mesh of the cells that are `kept`, with their nodes and the facets all of whose nodes are among these. A used
/// group has to keep all its members.
///
/// # Errors
/// The member that would be lost.
fn restrict(mesh: Mesh, kept: &[bool], used: &BTreeSet<&str>) -> Result<Mesh, String> {
    let mut held = vec![false; mesh.points.len()];
    for ((_, nodes), _) in mesh.cells.iter().zip(kept).filter(|(_, kept)| **kept) {
        nodes.iter().for_each(|&node| held[node as usize] = true);
    }
    if kept.iter().chain(&held).all(|&kept| kept) {
        return Ok(mesh);
    }
    let facets = mesh.facets.iter();
    let facet_held: Vec<bool> = facets
        .map(|(_, nodes)| nodes.iter().all(|&node| held[node as usize]))
        .collect();
    let [new_node, new_cell, new_facet] = [&held[..], kept, &facet_held].map(renumbered);
    let mut groups = mesh.groups.clone();
    for (name, Group { dim, members }) in &mut groups {
        let (new, word) = match mesh.dim.checked_sub(*dim) {
            Some(0) => (&new_cell, "cell"),
            Some(1) => (&new_facet, "facet"),
            _ => (&new_node, "point"),
        };
        let lost = members.iter().find(|&&m| new[m as usize].is_none());
        if let Some(&lost) = lost.filter(|_| used.contains(name.as_str())) {
            let nodes = match word {
                "cell" => mesh.cells.nodes_of(lost as usize),
                "facet" => mesh.facets.nodes_of(lost as usize),
                _ => &[lost],
            };
            let tags = mesh.tags_of(nodes);
            return Err(format!("group '{name}': the {word} of nodes {tags}"));
        }
        *members = members.iter().filter_map(|&m| new[m as usize]).collect();
    }
    let pick = |elements: &Elements, kept: &[bool]| {
        let mut picked = Elements::default();
        for ((kind, nodes), _) in elements.iter().zip(kept).filter(|(_, kept)| **kept) {
            let nodes: Vec<u32> = nodes.iter().filter_map(|&n| new_node[n as usize]).collect();
            picked.push(kind, &nodes);
        }
        picked
    };
    Ok(Mesh {
        dim: mesh.dim,
        points: chosen(&mesh.points, &held),
        node_tags: chosen(&mesh.node_tags, &held),
        cells: pick(&mesh.cells, kept),
        cell_tags: chosen(&mesh.cell_tags, kept),
        has_modes: chosen(&mesh.has_modes, kept),
        facets: pick(&mesh.facets, &facet_held),
        groups,
        warnings: mesh.warnings,
    })
}

fn chosen<T: Copy>(all: &[T], kept: &[bool]) -> Vec<T> {
    let pairs = all.iter().zip(kept).filter(|(_, kept)| **kept);
    pairs.map(|(&item, _)| item).collect()
}

fn renumbered(kept: &[bool]) -> Vec<Option<u32>> {
    let mut numbers = 0..;
    let number = |&kept: &bool| kept.then(|| numbers.next()).flatten();
    kept.iter().map(number).collect()
}
