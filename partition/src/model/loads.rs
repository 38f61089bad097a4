//! Γ_τ and body forces as consistent nodal forces: f_i = ∫ N_i b dx + ∫ N_i τ dS, (3).

use std::collections::BTreeMap;

use super::bodies::Bodies;
use super::initial_stress::InitialStress;
use super::rules::{around, rule_of_cells};
use super::surface::Surface;
use super::{Material, groups};
use crate::element::geometry::{advance, length};
use crate::error::InputError;
use crate::magnitude;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;
use crate::scene::Scene;
use crate::scene::condition::{Force, ForceAmount, Names, Pressure, Traction};
use crate::scene::loading::Loading;
use crate::scene::material::PlaneState;
use crate::scene::number::Vector;
use crate::scene::step::Scale;

/// Degree of exactness on lines and faces: a cubic pressure along a curved quadratic facet times a shape function and n
/// dS needs 9 and 11.
const FACET_DEGREES: [usize; 2] = [9, 11];
/// A single load of a loading.
pub(super) enum Load<'a> {
    /// A load on a body, given by its number.
    Body(u32, &'a Vector),
    /// A traction.
    Traction(&'a Traction),
    /// A pressure.
    Pressure(&'a Pressure),
    /// A force on nodes.
    Force(&'a Force),
}

/// A scene and its mesh, on which loads act.
#[derive(Clone, Copy)]
pub(super) struct Loaded<'a> {
    pub scene: &'a Scene,
    pub bodies: &'a Bodies,
    pub topology: &'a Topology,
}

/// The loads of a loading of `scene`, each with its name in messages.
pub(super) fn loads<'a>(scene: &Scene, loading: &Loading<'a>) -> Vec<(String, Load<'a>)> {
    let bodies = (0..).zip(scene.bodies.keys()).zip(&loading.body_force);
    let bodies = bodies.filter_map(|((body, name), &force)| {
        Some((loading.body_force_label(name), Load::Body(body, force?)))
    });
    let tractions = loading.traction.iter().enumerate();
    let tractions =
        tractions.map(|(i, load)| (loading.traction_label(i, &load.on), Load::Traction(load)));
    let pressures = loading.pressure.iter().enumerate();
    let pressures =
        pressures.map(|(i, load)| (loading.pressure_label(i, &load.on), Load::Pressure(load)));
    let forces = loading.force.iter().enumerate();
    let forces = forces.map(|(i, load)| (loading.force_label(i, &load.on), Load::Force(load)));
    bodies
        .chain(tractions)
        .chain(pressures)
        .chain(forces)
        .collect()
}

impl Loaded<'_> {
    /// Adds the nodal forces of a load, whose name in messages is `what`.
    pub fn add(
        &self,
        (what, load): &(String, Load<'_>),
        scale: &Scale,
        forces: &mut [[f64; 3]],
    ) -> Result<(), InputError> {
        let (mesh, plane) = (&self.bodies.mesh, self.scene.plane);
        let surface = |on: &Names| -> Result<Surface, InputError> {
            let facets = groups::facets(mesh, on, what)?;
            Surface::new(mesh, self.topology, plane, &facets, what)
        };
        let added = match load {
            Load::Body(body, force) => {
                let factor = scale.body_force;
                body_force(self.bodies, *body, force, factor, plane, forces)
            }
            Load::Traction(traction) => surface_load(&surface(&traction.on)?, forces, |x, area| {
                let traction = traction.value.at(x)?;
                Ok(traction.map(|c| scale.traction * c * length(area)))
            }),
            Load::Pressure(pressure) => surface_load(&surface(&pressure.on)?, forces, |x, area| {
                let pressure = scale.pressure * pressure.value.at(x)?;
                Ok(area.map(|c| -pressure * c))
            }),
            Load::Force(force) => {
                let surface = match groups::are_of_facets(mesh, &force.on) {
                    true => Some(surface(&force.on)?),
                    false => None,
                };
                let nodes = groups::boundary_nodes(mesh, &force.on, what)?;
                nodal_forces(mesh, force, scale.force, (nodes, surface), forces)
            }
        };
        added.map_err(InputError::about(what))
    }
}

/// The nodal forces of a loading of a scene at all nodes, and the initial stress, whose forces are included.
pub(super) fn forces(
    on: Loaded<'_>,
    loading: &Loading,
    materials: &[Material],
) -> Result<(Vec<[f64; 3]>, InitialStress), InputError> {
    let Loaded { scene, bodies, .. } = on;
    let mesh = &bodies.mesh;
    let mut forces = vec![[0.0; 3]; mesh.points.len()];
    for load in loads(scene, loading) {
        on.add(&load, &loading.scale, &mut forces)?;
    }
    let initial = InitialStress::new(scene, loading, bodies, materials, &mut forces)?;
    for (force, tag) in forces.iter().zip(&mesh.node_tags) {
        for &component in force {
            magnitude::check(component).map_err(|expected| {
                InputError::new(format!(
                    "the load on node {tag} is {component:e}; expected {expected}"
                ))
            })?;
        }
    }
    Ok((forces, initial))
}

/// Adds ∫ N_i b dx over the cells of a body, where b is `factor` times the force.
fn body_force(
    bodies: &Bodies,
    body: u32,
    force: &Vector,
    factor: f64,
    plane: Option<PlaneState>,
    forces: &mut [[f64; 3]],
) -> Result<(), String> {
    let mesh = &bodies.mesh;
    let mut rules = BTreeMap::new();
    for (cell, (kind, nodes)) in mesh.cells.iter().enumerate() {
        if bodies.cell_body[cell] != body {
            continue;
        }
        let formulation = bodies.formulation(cell);
        let rule = rules
            .entry(kind)
            .or_insert_with(|| rule_of_cells(kind, formulation, plane, force.is_constant()));
        let at: Vec<_> = nodes.iter().map(|&n| mesh.points[n as usize]).collect();
        for point in rule.iter() {
            let shape = point.shape.iter();
            let x = (shape.clone().zip(&at)).fold([0.0; 3], |sum, (&n, &p)| advance(sum, n, p));
            let load = force.at(x)?;
            let weight = factor
                * point.weight
                * kind.determinant(&point.gradients, &at)
                * PlaneState::thickness(plane, x);
            for (&node, value) in nodes.iter().zip(shape) {
                let sum = &mut forces[node as usize];
                *sum = advance(*sum, weight * value, load);
            }
        }
    }
    Ok(())
}

/// Adds `factor` times a force on `nodes`: a total is distributed like a uniform traction on their `surface`, or
/// equally without a surface.
fn nodal_forces(
    mesh: &Mesh,
    force: &Force,
    factor: f64,
    (nodes, surface): (Vec<u32>, Option<Surface>),
    forces: &mut [[f64; 3]],
) -> Result<(), String> {
    let total = match &force.amount {
        ForceAmount::Each(each) => {
            for node in nodes.into_iter().map(|node| node as usize) {
                forces[node] = advance(forces[node], factor, each.at(mesh.points[node])?);
            }
            return Ok(());
        }
        ForceAmount::Total(total) => total.value,
    };
    let mut shares = vec![[0.0; 3]; forces.len()];
    match &surface {
        Some(surface) => {
            surface_load(surface, &mut shares, |_, area| Ok([length(area), 0.0, 0.0]))?
        }
        None => nodes
            .iter()
            .for_each(|&node| shares[node as usize][0] = 1.0),
    }
    let sum: f64 = nodes.iter().map(|&node| shares[node as usize][0]).sum();
    for node in nodes.into_iter().map(|node| node as usize) {
        forces[node] = advance(forces[node], factor * shares[node][0] / sum, total);
    }
    Ok(())
}

/// Adds ∫ N_i τ dS, where `load` returns τ dS from the position and n dS.
pub(super) fn surface_load(
    surface: &Surface,
    forces: &mut [[f64; 3]],
    load: impl Fn([f64; 3], [f64; 3]) -> Result<[f64; 3], String>,
) -> Result<(), String> {
    for facet in &surface.facets {
        let degree = FACET_DEGREES[facet.kind.dim() - 1];
        for (xi, weight) in
            (facet.kind).quadrature(around(facet.plane, degree, facet.kind.is_linear()))
        {
            let x = facet.kind.position(&facet.at, xi);
            let weight = weight * PlaneState::thickness(facet.plane, x);
            let load = load(x, facet.kind.area_vector(&facet.at, xi))?;
            for (&node, value) in facet.nodes.iter().zip(facet.kind.shape(xi)) {
                let sum = &mut forces[node as usize];
                *sum = advance(*sum, weight * value, load);
            }
        }
    }
    Ok(())
}
