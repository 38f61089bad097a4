//! Linear equations between displacements: points with one constraint, in which every node has its own direction.

use std::collections::BTreeMap;

use super::couplings::CoupledFrame;
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
/// Groups that don't exist, components of reference points without coupling, terms that cancel, equations and springs of
/// one name.
pub(super) fn equations(
    scene: &Scene,
    (mesh, couplings): (&Mesh, &[CoupledFrame]),
    first: usize,
) -> Result<Vec<Contact>, InputError> {
    let mut all: Vec<Contact> = Vec::new();
    for (index, equation) in scene.equation.iter().enumerate() {
        let what = format!("equation[{}]", index + 1);
        let name = &equation.name;
        let point = point((equation, &scene.step), (mesh, couplings), &what)?;
        let place = match all.iter().position(|of| of.name == *name) {
            Some(place) => place,
            None => {
                all.push(Contact {
                    name: name.clone(),
                    points: Vec::new(),
                    probes: Vec::new(),
                    prescribed: Vec::new(),
                });
                all.len() - 1
            }
        };
        let of_name = &mut all[place].points;
        if (of_name.first()).is_some_and(|other| other.is_compliant() != point.is_compliant()) {
            return Err(InputError::new(format!(
                "{what}: another equation '{name}' has no stiffness, or only that one has; expected another name for those \
                 with a stiffness"
            )));
        }
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
    (mesh, couplings): (&Mesh, &[CoupledFrame]),
    what: &str,
) -> Result<ContactPoint<u32>, InputError> {
    let mut nodes = Vec::new();
    let mut factors: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
    let mut scale = 0.0;
    let mut position = None;
    for term in &equation.terms {
        let component = term.component as usize;
        let of_coupling = term.coupling.as_ref();
        let coupling = couplings
            .iter()
            .find(|of| Some(&of.contact.name) == of_coupling);
        let form = match (coupling, &term.at) {
            (Some(coupling), _) => {
                position.get_or_insert(coupling.point());
                let form = coupling.component(component);
                form.map_err(InputError::about(what))?
            }
            (None, at) => {
                let of_term = match at {
                    Some(at) => groups::nodes(mesh, at, what)?,
                    None => Vec::new(),
                };
                let part = 1.0 / of_term.len() as f64;
                let axis = std::array::from_fn(|k| part * f64::from(u8::from(k == component)));
                of_term.into_iter().map(|node| (node, axis)).collect()
            }
        };
        for (node, vector) in form {
            scale = f64::max(scale, (term.factor * length(vector)).abs());
            let of_node = factors.entry(node).or_insert_with(|| {
                nodes.push(node);
                [0.0; 3]
            });
            *of_node = advance(*of_node, term.factor, vector);
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
    let at_first = mesh.points.get(node as usize).copied();
    let position = at_first.or(position).unwrap_or_default();
    // Reference points follow the nodes of the mesh.
    let tag = mesh.node_tags.get(node as usize).copied();
    let tag = tag.unwrap_or_else(|| {
        let last = mesh.node_tags.iter().max().copied().unwrap_or_default();
        last + 1 + i64::from(node) - mesh.points.len() as i64
    });
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
        stiffness: [equation.stiffness.as_ref().map_or(0.0, |k| k.0), 0.0],
        ..ContactPoint::new(entries, axes[0], position, tag)
    })
}
