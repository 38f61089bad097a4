//! Activation and deactivation of bodies and contacts in load steps. An absent body stays in the mesh, without loads.

use std::collections::BTreeSet;

use super::bodies::Bodies;
use super::initial_stress::InitialStress;
use super::{Contact, Support};
use crate::error::InputError;
use crate::scene::Scene;

/// The numbers of the absent bodies, step by step.
pub(super) fn bodies(scene: &Scene) -> Vec<Vec<u32>> {
    let of_step = |names: BTreeSet<&str>| {
        let bodies = (0..).zip(scene.bodies.keys());
        let absent = bodies.filter(|(_, name)| names.contains(name.as_str()));
        absent.map(|(body, _)| body).collect()
    };
    scene.absent().into_iter().map(of_step).collect()
}

/// The numbers of the contacts that are switched off, step by step; `tables` are their names in the scene.
pub(super) fn contacts(scene: &Scene, tables: &[&str]) -> Vec<Vec<u32>> {
    let of_step = |names: BTreeSet<&str>| {
        let contacts = (0..).zip(tables);
        let absent = contacts.filter(|(_, name)| names.contains(*name));
        absent.map(|(contact, _)| contact).collect()
    };
    scene.absent().into_iter().map(of_step).collect()
}

/// Removes all loads from the bodies that are `absent`: forces, prescribed displacements, initial stress.
pub(super) fn unload(
    bodies: &Bodies,
    absent: &[u32],
    (supports, forces, initial): &mut (Vec<Support>, Vec<[f64; 3]>, InitialStress),
) {
    let cells = bodies.mesh.cells.iter().zip(&bodies.cell_body).enumerate();
    for (cell, ((_, nodes), body)) in cells {
        if absent.binary_search(body).is_err() {
            continue;
        }
        nodes
            .iter()
            .for_each(|&node| forces[node as usize] = [0.0; 3]);
        if let Some(stress) = initial.cells.get_mut(cell) {
            *stress = [0.0; 6];
        }
    }
    let is_absent = absent_nodes(bodies, absent);
    for support in supports {
        if is_absent[support.node as usize] {
            support.value = 0.0;
        }
    }
    initial
        .nodes
        .retain(|&(node, _), _| !is_absent[node as usize]);
}

/// Nodes of bodies that are `absent`.
pub(super) fn absent_nodes(bodies: &Bodies, absent: &[u32]) -> Vec<bool> {
    let mut is_absent = vec![false; bodies.mesh.points.len()];
    for ((_, nodes), body) in bodies.mesh.cells.iter().zip(&bodies.cell_body) {
        if absent.binary_search(body).is_ok() {
            nodes
                .iter()
                .for_each(|&node| is_absent[node as usize] = true);
        }
    }
    is_absent
}

/// Checks that a body that is added or removed shares no node with others, and that no contact point lies on a side
/// that is present only in part.
///
/// # Errors
/// The body, or the contact, with the expectation.
pub(super) fn check(
    scene: &Scene,
    bodies: &Bodies,
    contacts: &[Contact],
) -> Result<(), InputError> {
    let steps = self::bodies(scene);
    let names: Vec<&String> = scene.bodies.keys().collect();
    let mut body_of = vec![None; bodies.mesh.points.len()];
    for ((_, nodes), &body) in bodies.mesh.cells.iter().zip(&bodies.cell_body) {
        for &node in nodes {
            let other = *body_of[node as usize].get_or_insert(body);
            let apart = |absent: &Vec<u32>| absent.contains(&body) != absent.contains(&other);
            let Some(k) = steps.iter().position(apart) else {
                continue;
            };
            let [first, second] = [body, other].map(|body| names[body as usize]);
            return Err(InputError::new(format!(
                "step[{}]: the bodies '{first}' and '{second}' share nodes, such as {}, and one is there without the other; \
                 expected nodes of its own for what is added or removed, and a contact",
                k + 1,
                bodies.mesh.node_tags[node as usize]
            )));
        }
    }
    for (k, absent) in steps.iter().enumerate() {
        for contact in contacts {
            let is_torn = contact.points.iter().any(|point| {
                let nodes = point.entries.iter().map(|&(node, _)| node as usize);
                let of_point: BTreeSet<u32> = nodes.filter_map(|node| body_of[node]).collect();
                let there = of_point
                    .iter()
                    .filter(|body| !absent.contains(body))
                    .count();
                there > 1 && there < of_point.len()
            });
            if is_torn {
                return Err(InputError::new(format!(
                    "step[{}]: of a side of contact '{}' one body is there and another one isn't; expected a contact \
                     for each",
                    k + 1,
                    contact.name
                )));
            }
        }
    }
    Ok(())
}
