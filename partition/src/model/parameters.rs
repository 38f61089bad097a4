//! Parameters of the derivatives of quantities, and the nodal forces of those that are loads.

use super::activation;
use super::bodies::Bodies;
use super::loads::{Loaded, loads};
use super::{Contact, steps};
use crate::contact_point::Law;
use crate::error::InputError;
use crate::quantity::{LoadForce, Parameter, ParameterKind};
use crate::scene::Scene;
use crate::scene::material::Elasticity;

/// The parameters of a scene, and the nodal forces of those that are loads.
///
/// # Errors
/// The parameters of the scene's loads.
pub(super) fn parameters(
    on: Loaded<'_>,
    of_scene: &steps::Loads,
    contacts: &[Contact],
) -> Result<(Vec<Parameter>, Vec<LoadForce>), InputError> {
    let (mut all, forces) = of_loads(on)?;
    all.extend(stiffnesses(on.scene, on.bodies));
    let unilateral = (0..).zip(contacts).filter(|(_, contact)| {
        let first = contact.points.first();
        first.is_some_and(|point| !point.law.is_tied())
    });
    all.extend(unilateral.clone().map(|(number, contact)| Parameter {
        name: format!("contact '{}': gap", contact.name),
        kind: ParameterKind::Gap,
        value: 0.0,
        of: vec![number],
    }));
    all.extend(displacements(on.scene, of_scene));
    all.extend(unilateral.filter_map(|(number, contact)| friction(number, contact)));
    Ok((all, forces))
}

/// The loads of all load steps by name, and their nodal forces in each.
fn of_loads(on: Loaded<'_>) -> Result<(Vec<Parameter>, Vec<LoadForce>), InputError> {
    let loadings = on.scene.loadings();
    let absent = activation::bodies(on.scene);
    let mut names: Vec<String> = Vec::new();
    let mut fields: Vec<Vec<Option<Vec<[f64; 3]>>>> = Vec::new();
    for (k, loading) in loadings.iter().enumerate() {
        let is_absent = absent.get(k).filter(|absent| !absent.is_empty());
        let is_absent = is_absent.map(|absent| activation::absent_nodes(on.bodies, absent));
        for load in loads(on.scene, loading) {
            let mut forces = vec![[0.0; 3]; on.bodies.mesh.points.len()];
            on.add(&load, &loading.scale, &mut forces)?;
            for (force, _) in
                (forces.iter_mut().zip(is_absent.iter().flatten())).filter(|(_, is)| **is)
            {
                *force = [0.0; 3];
            }
            let place = names
                .iter()
                .position(|name| *name == load.0)
                .unwrap_or_else(|| {
                    names.push(load.0);
                    fields.push(vec![None; loadings.len()]);
                    names.len() - 1
                });
            fields[place][k] = Some(forces);
        }
    }
    let mut all = Vec::new();
    for (parameter, of_steps) in (0..).zip(fields) {
        for node in 0..on.bodies.mesh.points.len() {
            let of_step =
                |forces: &Option<Vec<[f64; 3]>>| forces.as_ref().map_or([0.0; 3], |f| f[node]);
            let forces: Vec<[f64; 3]> = of_steps.iter().map(of_step).collect();
            if forces.iter().any(|force| *force != [0.0; 3]) {
                let node = node as u32;
                all.push(LoadForce {
                    parameter,
                    node,
                    forces,
                });
            }
        }
    }
    let named = names.into_iter().map(|name| Parameter {
        name,
        kind: ParameterKind::Load,
        value: 1.0,
        of: Vec::new(),
    });
    Ok((named.collect(), all))
}

/// The stiffness of every material with cells, unless thermal loads are proportional to it.
fn stiffnesses(scene: &Scene, bodies: &Bodies) -> Vec<Parameter> {
    let mut used = bodies.cell_material.clone();
    used.sort_unstable();
    used.dedup();
    let number = |name: &str| scene.materials.keys().position(|of| of == name);
    // The material of the scene for each material of the model.
    let mut scene_materials: Vec<Option<usize>> = (0..scene.materials.len()).map(Some).collect();
    let own = scene.bodies.values().filter(|of| of.has_initial_stress());
    scene_materials.extend(own.map(|body| number(&body.material)));
    let variants = bodies.variants.iter();
    let variants = variants.map(|&(of, _)| scene_materials[of as usize]);
    let variants: Vec<Option<usize>> = variants.collect();
    scene_materials.extend(variants);
    let is_heated = |name: &str| {
        let mut bodies = scene.bodies.values();
        bodies.any(|body| body.material == name && body.thermal.is_some())
    };
    let parameter = |(m, (name, elasticity)): (usize, (&String, &Elasticity))| {
        let of = (0..)
            .zip(&scene_materials)
            .filter(|(_, of)| **of == Some(m));
        let of: Vec<u32> = of
            .map(|(number, _)| number)
            .filter(|of| used.contains(of))
            .collect();
        let (key, value) = match elasticity {
            Elasticity::Isotropic { young, .. } => ("young", *young),
            Elasticity::Anisotropic { .. } => ("stiffness", 1.0),
        };
        (!of.is_empty() && !is_heated(name)).then(|| Parameter {
            name: format!("materials.{name}.{key}"),
            kind: ParameterKind::Stiffness,
            value,
            of,
        })
    };
    let materials = scene.materials.iter().enumerate();
    materials.filter_map(parameter).collect()
}

/// Increments of prescribed displacements, axis by axis, for boundary conditions on which no others depend.
fn displacements(scene: &Scene, loads: &steps::Loads) -> Vec<Parameter> {
    let loadings = scene.loadings();
    let Some(first) = loadings.first() else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for (index, condition) in first.displacement.iter().enumerate() {
        if loads.decides[index] {
            continue;
        }
        let name = first.displacement_label(index, &condition.on);
        for (axis, word) in ["x", "y", "z"].into_iter().enumerate() {
            if condition.components[axis].is_some() {
                all.push(Parameter {
                    name: format!("{name}: {word}"),
                    kind: ParameterKind::Displacement,
                    value: 0.0,
                    of: vec![index as u32, axis as u32],
                });
            }
        }
    }
    all
}

/// The coefficient of friction of a contact.
fn friction(number: u32, contact: &Contact) -> Option<Parameter> {
    let mut all = contact.points.iter().filter_map(|point| match point.law {
        Law::Coulomb { coefficient, .. } => Some(coefficient),
        _ => None,
    });
    let first = all.next()?;
    Some(Parameter {
        name: format!("contact '{}': friction", contact.name),
        kind: ParameterKind::Friction,
        value: if all.all(|of| of == first) {
            first
        } else {
            f64::NAN
        },
        of: vec![number],
    })
}
