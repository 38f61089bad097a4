//! Quantities of a scene, resolved on its mesh.

mod places;
mod shared_nodes;

use super::bodies::Bodies;
use super::crack_tips::CrackTips;
use super::initial_stress::{InitialStress, mean_weights};
use super::{Contact, Material, PlaneState, groups};
use crate::contact_point::ContactPoint;
use crate::error::InputError;
use crate::mesh::topology::Topology;
use crate::quantity::{NodeWeight, Quantity, QuantityKind};
use crate::scene::Scene;
use crate::scene::number::ConstantVector;
use crate::scene::quantity::{self, Target};
use crate::scene::suggest::hint_and_known;

/// Scene and mesh on which quantities are resolved.
#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    pub scene: &'a Scene,
    pub bodies: &'a Bodies,
    pub topology: &'a Topology,
    pub materials: &'a [Material],
    pub contacts: &'a [Contact],
    /// The crack tips.
    pub tips: &'a CrackTips,
    /// The names of supports, followed by those of springs.
    pub supports: &'a [String],
    /// The initial stress in every load step.
    pub initial: &'a [&'a InitialStress],
}

/// The quantities of a scene, and the nodal weights of displacements in them.
///
/// # Errors
/// An unknown name, with the existing ones; a node that isn't unique at its position.
pub(super) fn quantities(known: Known<'_>) -> Result<(Vec<Quantity>, Vec<NodeWeight>), InputError> {
    let (mut all, mut weights) = (Vec::new(), Vec::new());
    for (number, asked) in (0..).zip(&known.scene.quantity) {
        let what = format!("quantity '{}'", asked.name);
        let (quantity, of_nodes) = known.quantity(asked).map_err(InputError::about(&what))?;
        let of_nodes = of_nodes.into_iter().filter(|(_, value)| *value != [0.0; 3]);
        weights.extend(of_nodes.map(|(node, value)| NodeWeight {
            quantity: number,
            node,
            value,
        }));
        all.push(quantity);
    }
    Ok((all, weights))
}

/// Nodes and the weights of their displacements.
type Weights = Vec<(u32, [f64; 3])>;

impl Known<'_> {
    fn quantity(&self, asked: &quantity::Quantity) -> Result<(Quantity, Weights), String> {
        let mut quantity = Quantity {
            name: asked.name.clone(),
            kind: QuantityKind::Energy,
            direction: [0.0; 3],
            point: [0.0; 3],
            length: 0.0,
            constants: vec![0.0; self.initial.len()],
            of: Vec::new(),
            node: -1,
        };
        let mut weights = Vec::new();
        match &asked.of {
            Target::Displacement { at, along } => {
                quantity.kind = QuantityKind::Displacement;
                let node = self.node(at)?;
                quantity.node = self.bodies.mesh.node_tags[node as usize];
                quantity.direction = along.value;
                weights.push((node, along.value));
            }
            Target::MeanStress { body, component } => {
                quantity.kind = QuantityKind::MeanStress;
                weights = self.mean_stress(body, *component as usize, &mut quantity)?;
            }
            Target::Reaction { on, along } => {
                quantity.kind = QuantityKind::Reaction;
                quantity.direction = self.of_force(along)?;
                let is_part;
                (quantity.of, is_part) = self.conditions(on)?;
                if is_part {
                    let nodes = groups::nodes(&self.bodies.mesh, &on.clone().into(), "on");
                    let nodes = nodes.map_err(|error| error.to_string())?;
                    weights.extend(nodes.into_iter().map(|node| (node, along.value)));
                }
            }
            Target::CrackTip { tip, kind } => {
                quantity.kind = *kind;
                let (number, tag) = self.tip(tip)?;
                (quantity.of, quantity.node) = (vec![number], tag);
            }
            Target::Energy => {}
            of_contact => self.of_contact(of_contact, &mut quantity)?,
        }
        Ok((quantity, weights))
    }

    /// Sets the kind, the directions and the contact of a quantity of a contact.
    fn of_contact(&self, target: &Target, quantity: &mut Quantity) -> Result<(), String> {
        match target {
            Target::ContactForce { contact, along } => {
                quantity.kind = QuantityKind::ContactForce;
                let along = along.as_ref().map(|along| self.of_force(along));
                quantity.direction = along.transpose()?.unwrap_or_default();
                self.set_forces(contact, true, quantity)?;
            }
            Target::ContactMoment {
                contact,
                about,
                axis,
            } => {
                if self.is_ring() {
                    return Err("around an axis forces have no moment about a point".into());
                }
                quantity.kind = QuantityKind::ContactMoment;
                quantity.direction = axis.as_ref().map_or([0.0; 3], |axis| axis.value);
                quantity.point = about.value;
                self.set_forces(contact, true, quantity)?;
            }
            Target::Pressure {
                contact,
                kind,
                over,
            } => {
                (quantity.kind, quantity.length) = (*kind, *over);
                match kind {
                    QuantityKind::MeanPressure => self.set_forces(contact, false, quantity)?,
                    _ => quantity.of = vec![self.contact(contact, false)?.0],
                }
            }
            Target::Opening { contact, at } => {
                quantity.kind = QuantityKind::Opening;
                let (number, points) = self.contact(contact, false)?;
                let point = self.point(points, at)?;
                quantity.node = point.tag();
                quantity.of = vec![number, point.place];
            }
            _ => {}
        }
        Ok(())
    }

    /// Sets the contact whose forces a quantity adds up, and what of it belongs to nodes that both sides share.
    fn set_forces(&self, name: &str, or_tie: bool, quantity: &mut Quantity) -> Result<(), String> {
        let (number, points) = self.contact(name, or_tie)?;
        let mut shared = self.shared_nodes(points);
        shared.add_prescribed(&self.contacts[number as usize].prescribed, points);
        quantity.of = vec![number];
        if !shared.beside.is_empty() {
            quantity.length = shared.area;
            quantity.of.extend(shared.beside);
        }
        Ok(())
    }

    /// True if forces are those of whole rings (axisymmetry).
    fn is_ring(&self) -> bool {
        self.scene.plane == Some(PlaneState::Axisymmetric)
    }

    /// The number and the node of a crack tip.
    fn tip(&self, name: &str) -> Result<(u32, i64), String> {
        let CrackTips { tips, coarse } = self.tips;
        let mut numbered = (0..).zip(tips);
        if let Some((number, (_, tip))) = numbered.find(|(_, (_, tip))| tip.name == name) {
            return Ok((number, tip.tag));
        }
        if coarse.iter().any(|(of, _)| of == name) {
            return Err(format!(
                "the crack tip '{name}' is one without stress intensity factors: fewer than three facets of its faces lie \
                 between it and the next kink, end, boundary or other material; expected smaller cells there"
            ));
        }
        let known = tips.iter().map(|(_, tip)| tip.name.as_str());
        Err(match tips.is_empty() {
            true => format!(
                "there is no crack tip '{name}'; the scene has none with stress intensity factors, which are of straight \
                 cracks in the plane, three facets of whose faces or more lie between the tip and the next kink, end, boundary \
                 or other material"
            ),
            false => format!(
                "there is no crack tip '{name}'{}",
                hint_and_known(name, known)
            ),
        })
    }

    /// The direction of a force; around an axis only the axial one.
    fn of_force(&self, along: &ConstantVector) -> Result<[f64; 3], String> {
        match self.is_ring() && along.value[0] != 0.0 {
            true => Err(
                "around an axis the sum of forces is one along it; expected direction = \"y\""
                    .into(),
            ),
            false => Ok(along.value),
        }
    }

    /// The number and the points of a contact, or, if allowed, of a tie.
    fn contact(&self, name: &str, or_tie: bool) -> Result<(u32, &[ContactPoint<u32>]), String> {
        let fits = |contact: &Contact| {
            let first = contact.points.first();
            first.is_some_and(|point| or_tie || !point.law.is_tied())
        };
        let mut fitting = (0..)
            .zip(self.contacts)
            .filter(|(_, contact)| fits(contact));
        if let Some((number, contact)) = fitting.clone().find(|(_, of)| of.name == name) {
            return Ok((number, &contact.points));
        }
        let known = fitting.by_ref().map(|(_, contact)| contact.name.as_str());
        let known: Vec<&str> = known.collect();
        Err(match known.is_empty() {
            true => format!("there is no contact '{name}'; the scene has none with conditions"),
            false => format!(
                "there is no contact '{name}'{}",
                hint_and_known(name, known)
            ),
        })
    }

    /// The numbers of the supports and springs on a group, and whether any of them is on other groups, too.
    fn conditions(&self, on: &str) -> Result<(Vec<u32>, bool), String> {
        let scene = self.scene;
        let loadings = scene.loadings();
        let displacements = loadings.first().map_or(&[][..], |of| of.displacement);
        let rest = self.supports.len() - displacements.len() - scene.bilateral.len();
        let rest = rest - scene.springs_to_ground().count();
        let names = (displacements.iter().map(|of| Some(&of.on)))
            .chain(scene.bilateral.iter().map(|of| Some(&of.on)))
            .chain(std::iter::repeat_n(None, rest))
            .chain(scene.springs_to_ground().map(|(_, of)| Some(&of.on)));
        let groups = || {
            names
                .clone()
                .map(|of| of.into_iter().flat_map(|of| of.iter()))
        };
        let (mut found, mut is_part) = (Vec::new(), false);
        for (number, groups) in (0..).zip(groups()) {
            let groups: Vec<&str> = groups.collect();
            if groups.contains(&on) {
                found.push(number);
                is_part |= groups.len() > 1;
            }
        }
        if !found.is_empty() {
            return Ok((found, is_part));
        }
        let mut known: Vec<&str> = groups().flatten().collect();
        known.sort_unstable();
        known.dedup();
        Err(match known.is_empty() {
            true => format!("nothing holds '{on}': the scene has no supports"),
            false => format!("no support is on '{on}'{}", hint_and_known(on, known)),
        })
    }

    /// The nodal weights in the average of a component of a body's stress.
    fn mean_stress(
        &self,
        name: &str,
        component: usize,
        quantity: &mut Quantity,
    ) -> Result<Weights, String> {
        let bodies = self.bodies;
        let mut keys = (0..).zip(self.scene.bodies.keys());
        let Some((body, _)) = keys.find(|(_, of)| *of == name) else {
            let known = self.scene.bodies.keys().map(String::as_str);
            return Err(format!(
                "there is no body '{name}'{}",
                hint_and_known(name, known)
            ));
        };
        let of_cells = bodies.cell_body.iter().zip(&bodies.cell_material);
        let of_body = of_cells
            .filter(|(of, _)| **of == body)
            .map(|(_, material)| *material);
        quantity.of = of_body.collect();
        quantity.of.sort_unstable();
        quantity.of.dedup();
        let Some(&material) = quantity.of.first() else {
            return Err(format!("the body '{name}' has no cells"));
        };
        let stress = row(&self.materials[material as usize], component).ok_or(
            "σ_zz isn't known; expected a material of 'young' and 'poisson', or with 'out_of_plane'",
        )?;
        let initial = self.initial.iter();
        quantity.constants = initial.map(|of| of.mean(bodies, body)[component]).collect();
        let weights = mean_weights(self.scene.plane, bodies, body, stress)?;
        Ok((0..).zip(weights).collect())
    }
}

/// The row of C for a component of the stress, in the order of results: a stress whose work on strains is that
/// component of their stress.
fn row(material: &Material, component: usize) -> Option<[f64; 6]> {
    let c = &material.stiffness;
    let of_row = |row: &[f64]| match *row {
        [xx, yy, xy] => [xx, yy, 0.0, xy, 0.0, 0.0],
        [xx, yy, zz, xy] => [xx, yy, zz, xy, 0.0, 0.0],
        [xx, yy, zz, yz, xz, xy] => [xx, yy, zz, xy, yz, xz],
        _ => [0.0; 6],
    };
    let places: &[usize] = match c.size() {
        3 => &[0, 1, usize::MAX, 2],
        4 => &[0, 1, 2, 3],
        _ => &[0, 1, 2, 5, 3, 4],
    };
    match places.get(component) {
        Some(&usize::MAX) => material.out_of_plane.map(|row| of_row(&row)),
        Some(&place) => Some(of_row(&c[place])),
        None => Some([0.0; 6]),
    }
}
