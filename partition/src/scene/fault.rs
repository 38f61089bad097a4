//! What is wrong between the keys of a scene, each of which is right by itself.

use std::collections::HashMap;

use super::condition::{Displacement, Partner, Traction};
use super::place::Step;
use super::{Scene, suggest};
use crate::name;

impl Scene {
    /// The first thing wrong between keys, and the key at which to say so.
    pub(super) fn fault(&self) -> Option<(Vec<Step>, String)> {
        if self.mesh.as_os_str().is_empty() {
            return Some((vec!["mesh".into()], "expected the name of a file".into()));
        }
        if self.bodies.is_empty() {
            return Some((vec!["bodies".into()], "expected at least one body".into()));
        }
        self.wrong_name()
            .or_else(|| self.unknown_material())
            .or_else(|| self.repeated_contact())
            .or_else(|| self.wrong_dimension())
            .or_else(|| self.wrong_step())
    }

    fn wrong_name(&self) -> Option<(Vec<Step>, String)> {
        let wrong = |path: Vec<Step>, name: &str, reason| {
            Some((path, format!("'{}' {reason}", name::shown(name))))
        };
        if let Err(reason) = name::check_text(&self.title) {
            return wrong(vec!["title".into()], &self.title, reason);
        }
        let materials = self.materials.keys().map(|name| ("materials", name));
        let bodies = self.bodies.keys().map(|name| ("bodies", name));
        for (table, name) in materials.chain(bodies) {
            if let Err(reason) = name::check(name) {
                return wrong(vec![table.into(), name.as_str().into()], name, reason);
            }
        }
        None
    }

    fn unknown_material(&self) -> Option<(Vec<Step>, String)> {
        let known = || self.materials.keys().map(String::as_str);
        for (name, body) in &self.bodies {
            if !self.materials.contains_key(&body.material) {
                let hint = suggest::hint(&body.material, known());
                return Some((
                    vec!["bodies".into(), name.as_str().into(), "material".into()],
                    format!("there is no material '{}'{hint}", body.material),
                ));
            }
        }
        None
    }

    fn repeated_contact(&self) -> Option<(Vec<Step>, String)> {
        let mut seen = HashMap::new();
        for (index, contact) in self.contact.iter().enumerate() {
            if let Some(first) = seen.insert(contact.name.as_str(), index) {
                return Some((
                    vec!["contact".into(), index.into(), "name".into()],
                    format!(
                        "contact[{}] has the name '{}' already",
                        first + 1,
                        contact.name
                    ),
                ));
            }
        }
        None
    }

    /// A vector that isn't of the plane, where the scene says that it has one.
    fn wrong_dimension(&self) -> Option<(Vec<Step>, String)> {
        self.plane?;
        for (name, body) in &self.bodies {
            if body.body_force.as_ref().is_some_and(|v| v.dim() != 2) {
                let path = ["bodies", name, "body_force"].map(Step::from);
                return Some((path.to_vec(), TWO.into()));
            }
        }
        if let Some(wrong) = not_plane(&self.displacement, &self.traction) {
            return Some(wrong);
        }
        for (index, step) in self.step.iter().enumerate() {
            let within = |path: Vec<Step>| [vec!["step".into(), index.into()], path].concat();
            for (name, force) in &step.body_force {
                if force.dim() != 2 {
                    let path = ["body_force", name].map(Step::from).to_vec();
                    return Some((within(path), TWO.into()));
                }
            }
            let displacement = step.displacement.as_deref().unwrap_or_default();
            let traction = step.traction.as_deref().unwrap_or_default();
            if let Some((path, message)) = not_plane(displacement, traction) {
                return Some((within(path), message));
            }
        }
        for (index, contact) in self.contact.iter().enumerate() {
            if matches!(&contact.partner, Partner::Obstacle(o) if o.dim() != 2) {
                let path = vec!["contact".into(), index.into(), "obstacle".into()];
                return Some((path, TWO.into()));
            }
        }
        None
    }

    /// A step with a wrong name, a time before that of the step before, or a body that isn't there.
    fn wrong_step(&self) -> Option<(Vec<Step>, String)> {
        let at = |index: usize, key: &str| vec!["step".into(), index.into(), key.into()];
        let mut before = None;
        for (index, step) in self.step.iter().enumerate() {
            if let Some(name) = &step.name
                && let Err(reason) = name::check(name)
            {
                let message = format!("'{}' {reason}", name::shown(name));
                return Some((at(index, "name"), message));
            }
            if step.time.is_some() != self.step[0].time.is_some() {
                let wrong = match step.time {
                    Some(_) => at(index, "time"),
                    None => at(index, "time")[..2].to_vec(),
                };
                return Some((wrong, "expected a 'time' in every step or in none".into()));
            }
            if let (Some(before), Some(time)) = (before, step.time)
                && time <= before
            {
                let message = format!("{time} comes after {before}; expected times that ascend");
                return Some((at(index, "time"), message));
            }
            before = step.time;
            let known = || self.bodies.keys().map(String::as_str);
            for body in step.body_force.keys() {
                if !self.bodies.contains_key(body) {
                    let hint = suggest::hint(body, known());
                    let path = [at(index, "body_force"), vec![body.as_str().into()]].concat();
                    let message = format!("there is no body '{body}'{hint}");
                    return Some((path, message));
                }
            }
        }
        None
    }
}

/// What was expected of a vector.
const TWO: &str = "a plane scene has vectors of two components";

/// The first vector that isn't of the plane.
fn not_plane(displacement: &[Displacement], traction: &[Traction]) -> Option<(Vec<Step>, String)> {
    let mut displacement = displacement.iter();
    if let Some(index) = displacement.position(|d| d.components[2].is_some()) {
        let path = vec!["displacement".into(), index.into(), "z".into()];
        return Some((path, "a plane scene has no 'z'".into()));
    }
    let index = traction.iter().position(|t| t.value.dim() != 2)?;
    let path = vec!["traction".into(), index.into(), "value".into()];
    Some((path, TWO.into()))
}
