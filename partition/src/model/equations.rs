//! Linear equations between displacements: points with one constraint, in which every node has its own direction.

use std::collections::BTreeMap;

use super::{Contact, groups};
use crate::contact_point::{ContactPoint, Law};
use crate::element::geometry::{advance, length};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::scene::equation::Equation;
use crate::scene::step::LoadStep;

/// Coefficient of a node, relative to the largest, that is zero.
const NOTHING: f64 = 1e-14;

/// The equations of a scene, grouped by name, numbered from `first` on.
///
/// # Errors
/// Groups that don't exist, terms that cancel.
pub(super) fn equations(
    scene: &Scene,
    mesh: &Mesh,
    first: usize,
) -> Result<Vec<Contact>, InputError> {
    let mut all: Vec<Contact> = Vec::new();
    for (index, equation) in scene.equation.iter().enumerate() {
        let what = format!("equation[{}]", index + 1);
        let name = &equation.name;
        let point = point((equation, &scene.step), mesh, &what)?;
        let place = match all.iter().position(|of| of.name == *name) {
            Some(place) => place,
            None => {
                all.push(Contact {
                    name: name.clone(),
                    points: Vec::new(),
                    probes: Vec::new(),
                });
                all.len() - 1
            }
        };
        let of_name = &mut all[place].points;
        of_name.push(ContactPoint {
            contact: (first + place) as u32,
            place: of_name.len() as u32,
            ..point
        });
    }
    Ok(all)
}

/// The point of an equation.
fn point(
    (equation, steps): (&Equation, &[LoadStep]),
    mesh: &Mesh,
    what: &str,
) -> Result<ContactPoint<u32>, InputError> {
    let mut nodes = Vec::new();
    let mut factors: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
    let mut scale = 0.0;
    for term in &equation.terms {
        let of_term = groups::nodes(mesh, &term.at, what)?;
        let axis = std::array::from_fn(|k| f64::from(k == term.component as usize));
        let factor = term.factor / of_term.len() as f64;
        scale = f64::max(scale, factor.abs());
        for node in of_term {
            let of_node = factors.entry(node).or_insert_with(|| {
                nodes.push(node);
                [0.0; 3]
            });
            *of_node = advance(*of_node, factor, axis);
        }
    }
    nodes.retain(|node| length(factors[node]) > NOTHING * scale);
    let Some(&node) = nodes.first() else {
        return Err(InputError::new(format!(
            "{what}: its terms cancel; expected factors that don't"
        )));
    };
    let size = |node: &u32| length(factors[node]);
    let axes: Vec<[f64; 3]> = (nodes.iter())
        .map(|node| factors[node].map(|c| c / size(node)))
        .collect();
    let entries = nodes.iter().map(|node| (*node, size(node))).collect();
    let position = mesh.points[node as usize];
    let values: Vec<f64> = (steps.iter())
        .map(|step| {
            step.equation
                .get(&equation.name)
                .copied()
                .unwrap_or(equation.value)
        })
        .collect();
    let gap = values.first().copied().unwrap_or(equation.value);
    let motion = match values.iter().all(|&value| value == gap) {
        true => Vec::new(),
        false => (values
            .iter()
            .map(|value| axes[0].map(|c| (value - gap) * c)))
        .collect(),
    };
    Ok(ContactPoint {
        gap,
        motion,
        area: 1.0,
        law: Law::Tied,
        is_absolute: equation.absolute,
        axes: axes.clone(),
        ..ContactPoint::new(entries, axes[0], position, mesh.node_tags[node as usize])
    })
}
