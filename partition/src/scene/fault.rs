//! What is wrong between the keys of a scene, each of which is right by itself.

use std::collections::HashMap;

use super::condition::{Displacement, Partner, Traction};
use super::place::Step;
use super::{Scene, suggest};
use crate::name;

/// The key at which something is wrong, and what.
type Fault = (Vec<Step>, String);

/// The key to which these names of tables lead.
fn at<const N: usize>(keys: [&str; N]) -> Vec<Step> {
    keys.map(Step::from).to_vec()
}

/// The key of the entry `index` of a list.
fn entry(list: &str, index: usize, key: &str) -> Vec<Step> {
    vec![list.into(), index.into(), key.into()]
}

impl Scene {
    /// The first thing wrong between keys, and the key at which to say so.
    pub(super) fn fault(&self) -> Option<Fault> {
        if self.mesh.as_os_str().is_empty() {
            return Some((at(["mesh"]), "expected the name of a file".into()));
        }
        if self.bodies.is_empty() {
            return Some((at(["bodies"]), "expected at least one body".into()));
        }
        self.wrong_name()
            .or_else(|| self.unknown_material())
            .or_else(|| self.repeated_contact())
            .or_else(|| self.wrong_dimension())
            .or_else(|| self.wrong_step())
    }

    fn wrong_name(&self) -> Option<Fault> {
        let wrong = |path: Vec<Step>, name: &str, reason| {
            Some((path, format!("'{}' {reason}", name::shown(name))))
        };
        if let Err(reason) = name::check_text(&self.title) {
            return wrong(at(["title"]), &self.title, reason);
        }
        let materials = self.materials.keys().map(|name| ("materials", name));
        let bodies = self.bodies.keys().map(|name| ("bodies", name));
        for (table, name) in materials.chain(bodies) {
            if let Err(reason) = name::check(name) {
                return wrong(at([table, name]), name, reason);
            }
        }
        None
    }

    fn unknown_material(&self) -> Option<Fault> {
        let known = || self.materials.keys().map(String::as_str);
        for (name, body) in &self.bodies {
            if !self.materials.contains_key(&body.material) {
                let hint = suggest::hint(&body.material, known());
                let message = format!("there is no material '{}'{hint}", body.material);
                return Some((at(["bodies", name, "material"]), message));
            }
        }
        None
    }

    fn repeated_contact(&self) -> Option<Fault> {
        let mut seen = HashMap::new();
        for (index, contact) in self.contact.iter().enumerate() {
            if let Some(first) = seen.insert(contact.name.as_str(), index) {
                let (first, name) = (first + 1, &contact.name);
                let message = format!("contact[{first}] has the name '{name}' already");
                return Some((entry("contact", index, "name"), message));
            }
        }
        None
    }

    /// A vector that isn't of the plane, where the scene says that it has one.
    fn wrong_dimension(&self) -> Option<Fault> {
        self.plane?;
        for (name, body) in &self.bodies {
            if body.body_force.as_ref().is_some_and(|v| v.dim() != 2) {
                return Some((at(["bodies", name, "body_force"]), TWO.into()));
            }
        }
        if let Some(wrong) = not_plane(&self.displacement, &self.traction) {
            return Some(wrong);
        }
        for (index, step) in self.step.iter().enumerate() {
            let within = |path: Vec<Step>| [vec!["step".into(), index.into()], path].concat();
            for (name, force) in &step.body_force {
                if force.dim() != 2 {
                    return Some((within(at(["body_force", name])), TWO.into()));
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
                return Some((entry("contact", index, "obstacle"), TWO.into()));
            }
        }
        None
    }

    /// A step with a wrong name, a time before that of the step before, or a body that isn't there.
    fn wrong_step(&self) -> Option<Fault> {
        let of_step = |index: usize, key: &str| entry("step", index, key);
        let mut before = None;
        for (index, step) in self.step.iter().enumerate() {
            if let Some(name) = &step.name
                && let Err(reason) = name::check(name)
            {
                let message = format!("'{}' {reason}", name::shown(name));
                return Some((of_step(index, "name"), message));
            }
            if step.time.is_some() != self.step[0].time.is_some() {
                let wrong = match step.time {
                    Some(_) => of_step(index, "time"),
                    None => of_step(index, "time")[..2].to_vec(),
                };
                return Some((wrong, "expected a 'time' in every step or in none".into()));
            }
            if let (Some(before), Some(time)) = (before, step.time)
                && time <= before
            {
                let message = format!("{time} comes after {before}; expected times that ascend");
                return Some((of_step(index, "time"), message));
            }
            before = step.time;
            let known = || self.bodies.keys().map(String::as_str);
            for body in step.body_force.keys() {
                if !self.bodies.contains_key(body) {
                    let hint = suggest::hint(body, known());
                    let path = [of_step(index, "body_force"), vec![body.as_str().into()]].concat();
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
fn not_plane(displacement: &[Displacement], traction: &[Traction]) -> Option<Fault> {
    let mut displacement = displacement.iter();
    if let Some(index) = displacement.position(|d| d.components[2].is_some()) {
        let path = entry("displacement", index, "z");
        return Some((path, "a plane scene has no 'z'".into()));
    }
    let index = traction.iter().position(|t| t.value.dim() != 2)?;
    Some((entry("traction", index, "value"), TWO.into()))
}
