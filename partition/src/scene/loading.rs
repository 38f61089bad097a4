//! The loading of a scene in a load step: that of the step, by default that of the scene.

use super::Scene;
use super::condition::{Displacement, Force, Names, Pressure, Traction};
use super::number::{Number, Vector};
use super::step::{LoadStep, Scale};

/// All loads applied at the same time: the scene's loads, or those of one of its steps.
#[derive(Clone, Debug)]
pub struct Loading<'a> {
    /// The step and its number.
    step: Option<(usize, &'a LoadStep)>,
    /// Force per volume of every body.
    pub body_force: Vec<Option<&'a Vector>>,
    /// Temperature of every body, if the step replaces it.
    pub temperature: Vec<Option<&'a Number>>,
    /// Tractions.
    pub traction: &'a [Traction],
    /// Pressures.
    pub pressure: &'a [Pressure],
    /// Forces on nodes.
    pub force: &'a [Force],
    /// Displacements.
    pub displacement: &'a [Displacement],
    /// The factors of all loads.
    pub scale: Scale,
}

impl Scene {
    /// The loadings, one for each step; a single one without steps.
    pub fn loadings(&self) -> Vec<Loading<'_>> {
        match self.step.is_empty() {
            true => vec![self.loading(None)],
            false => (self.step.iter().enumerate())
                .map(|step| self.loading(Some(step)))
                .collect(),
        }
    }

    fn loading<'a>(&'a self, step: Option<(usize, &'a LoadStep)>) -> Loading<'a> {
        let own = step.map(|(_, step)| step);
        let body_force = self.bodies.iter().map(|(name, body)| {
            let replaced = own.and_then(|step| step.body_force.get(name));
            replaced.or(body.body_force.as_ref())
        });
        let temperature = self.bodies.keys();
        let temperature = temperature.map(|name| own.and_then(|step| step.temperature.get(name)));
        let traction = own.and_then(|step| step.traction.as_deref());
        let pressure = own.and_then(|step| step.pressure.as_deref());
        let force = own.and_then(|step| step.force.as_deref());
        let displacement = own.and_then(|step| step.displacement.as_deref());
        Loading {
            step,
            body_force: body_force.collect(),
            temperature: temperature.collect(),
            traction: traction.unwrap_or(&self.traction),
            pressure: pressure.unwrap_or(&self.pressure),
            force: force.unwrap_or(&self.force),
            displacement: displacement.unwrap_or(&self.displacement),
            scale: own.map_or_else(Scale::default, |step| step.scale),
        }
    }
}

impl Loading<'_> {
    /// The name of the force per volume of a body in messages.
    pub fn body_force_label(&self, body: &str) -> String {
        match self.step {
            Some((k, step)) if step.body_force.contains_key(body) => {
                format!("step[{}].body_force.{body}", k + 1)
            }
            _ => format!("bodies.{body}.body_force"),
        }
    }

    /// Name of entry `index` of its tractions in messages.
    pub fn traction_label(&self, index: usize, on: &Names) -> String {
        self.label("traction", |step| step.traction.is_some(), index, on)
    }

    /// Name of entry `index` of its pressures in messages.
    pub fn pressure_label(&self, index: usize, on: &Names) -> String {
        self.label("pressure", |step| step.pressure.is_some(), index, on)
    }

    /// The name of entry `index` of its forces on nodes in messages.
    pub fn force_label(&self, index: usize, on: &Names) -> String {
        self.label("force", |step| step.force.is_some(), index, on)
    }

    /// Name of entry `index` of its displacements in messages.
    pub fn displacement_label(&self, index: usize, on: &Names) -> String {
        self.label(
            "displacement",
            |step| step.displacement.is_some(),
            index,
            on,
        )
    }

    fn label(&self, kind: &str, is_own: fn(&LoadStep) -> bool, index: usize, on: &Names) -> String {
        let entry = format!("{kind}[{}] on {on}", index + 1);
        match self.step {
            Some((k, step)) if is_own(step) => format!("step[{}].{entry}", k + 1),
            _ => entry,
        }
    }
}
