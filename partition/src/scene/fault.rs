//! Contradictions between keys of a scene that are valid individually.

use std::collections::HashMap;

use super::condition::{Displacement, Force, Pressure, Traction};
use super::contact::{Contact, Declaration, Partner};
use super::material::{Elasticity, PlaneState};
use super::number::OR_IN_SPACE;
use super::place::{self, Step};
use super::{Scene, suggest};
use crate::error::InputError;
use crate::name;

/// The key of an error, and its description.
pub(super) type Fault = (Vec<Step>, String);

/// The key given by these names of tables.
fn at<const N: usize>(keys: [&str; N]) -> Vec<Step> {
    keys.map(Step::from).to_vec()
}

/// The key of the entry `index` of a list.
pub(super) fn entry(list: &str, index: usize, key: &str) -> Vec<Step> {
    vec![list.into(), index.into(), key.into()]
}

impl Scene {
    /// The first contradiction, and its key.
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
            .or_else(|| self.unknown_body())
            .or_else(|| self.repeated_quantity())
            .or_else(|| self.plane.and_then(|_| self.wrong_dimension(2)))
            .or_else(|| self.wrong_step())
            .or_else(|| self.wrong_change())
            .or_else(|| self.wrong_motion())
            .or_else(|| self.wrong_coupling())
            .or_else(|| self.wrong_pretension())
            .or_else(|| self.wrong_cyclic())
            .or_else(|| self.wrong_spring())
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
        for (list, index, name) in self.connections() {
            if let Some((of, first)) = seen.insert(name, (list, index))
                && (of, list) != ("equation", "equation")
            {
                let message = format!("{of}[{}] has the name '{name}' already", first + 1);
                return Some((entry(list, index, "name"), message));
            }
        }
        None
    }

    /// A quantity with an invalid or repeated name.
    fn repeated_quantity(&self) -> Option<Fault> {
        let mut seen = HashMap::new();
        for (index, quantity) in self.quantity.iter().enumerate() {
            let wrong = match (
                name::check(&quantity.name),
                seen.insert(&quantity.name, index),
            ) {
                (Err(reason), _) => format!("'{}' {reason}", name::shown(&quantity.name)),
                (_, Some(first)) => {
                    let name = &quantity.name;
                    format!("quantity[{}] has the name '{name}' already", first + 1)
                }
                _ => continue,
            };
            return Some((entry("quantity", index, "name"), wrong));
        }
        None
    }

    /// The names of contacts, ties and equations, each with its list and its index there.
    pub(super) fn connections(&self) -> impl Iterator<Item = (&'static str, usize, &str)> {
        let contacts = self.contact.iter().map(Declaration::name).enumerate();
        let ties = self.tie.iter().map(|tie| &tie.name[..]).enumerate();
        let equations = self.equation.iter().map(|of| &of.name[..]).enumerate();
        (contacts.map(|(i, name)| ("contact", i, name)))
            .chain(ties.map(|(i, name)| ("tie", i, name)))
            .chain(equations.map(|(i, name)| ("equation", i, name)))
    }

    /// An unknown body in the detection of contacts.
    fn unknown_body(&self) -> Option<Fault> {
        for (index, declared) in self.contact.iter().enumerate() {
            let Declaration::Between(between) = declared else {
                continue;
            };
            let is_unknown = |name: &&str| !self.bodies.contains_key(*name);
            if let Some(name) = between.bodies.names().find(is_unknown) {
                let known = self.bodies.keys().map(String::as_str);
                let hint = suggest::hint_and_known(name, known);
                let message = format!("there is no body '{name}'{hint}");
                return Some((entry("contact", index, "between"), message));
            }
        }
        None
    }

    /// Checks that all values are valid in `dim` dimensions.
    ///
    /// # Errors
    /// The first invalid value, by its key.
    pub(crate) fn check_dimension(&self, dim: usize) -> Result<(), InputError> {
        match self.wrong_dimension(dim) {
            Some((path, message)) => Err(place::error_at("", &path, &message)),
            None => Ok(()),
        }
    }

    /// A value of the wrong dimension, and its key.
    fn wrong_dimension(&self, dim: usize) -> Option<Fault> {
        let mut found = Vec::new();
        let mut check = |path: Vec<Step>, fault: Option<String>| {
            found.extend(fault.map(|message| (path, message)));
        };
        self.wrong_materials(&mut check);
        self.wrong_bodies(dim, &mut check);
        let of_scene = OnGroups {
            displacement: &self.displacement,
            traction: &self.traction,
            pressure: &self.pressure,
            force: &self.force,
        };
        of_scene.check(dim, &[], &mut check);
        for (index, step) in self.step.iter().enumerate() {
            let within: Vec<Step> = vec!["step".into(), index.into()];
            for (name, force) in &step.body_force {
                check(
                    [within.clone(), at(["body_force", name])].concat(),
                    force.fault(dim),
                );
            }
            for (name, temperature) in &step.temperature {
                let path = [within.clone(), at(["temperature", name])].concat();
                check(path, temperature.fault(dim));
            }
            let of_step = OnGroups {
                displacement: step.displacement.as_deref().unwrap_or_default(),
                traction: step.traction.as_deref().unwrap_or_default(),
                pressure: step.pressure.as_deref().unwrap_or_default(),
                force: step.force.as_deref().unwrap_or_default(),
            };
            of_step.check(dim, &within, &mut check);
        }
        for (index, spring) in self.spring.iter().enumerate() {
            if let Some((key, fault)) = spring.fault(dim) {
                check(entry("spring", index, key), Some(fault));
            }
        }
        for (index, equation) in self.equation.iter().enumerate() {
            if let Some((key, fault)) = equation.fault(dim, &self.coupling) {
                check(entry("equation", index, key), Some(fault));
            }
        }
        for (index, quantity) in self.quantity.iter().enumerate() {
            if let Some((key, fault)) = quantity.fault(dim) {
                check(entry("quantity", index, key), Some(fault));
            }
        }
        self.wrong_contacts(dim, &mut check);
        self.motions_of_wrong_dimension(dim, &mut check);
        found.into_iter().next()
    }

    /// Checks the dimension of loads on bodies.
    fn wrong_bodies(&self, dim: usize, check: &mut impl FnMut(Vec<Step>, Option<String>)) {
        for (name, body) in &self.bodies {
            let fault = body.body_force.as_ref().and_then(|force| force.fault(dim));
            check(at(["bodies", name, "body_force"]), fault);
            let initial = body.initial_stress.as_ref();
            let fault = initial.and_then(|stress| stress.fault(dim, self.plane));
            check(at(["bodies", name, "initial_stress"]), fault);
            let thermal = body.thermal.as_ref();
            let fault = thermal.and_then(|thermal| thermal.temperature.fault(dim));
            check(at(["bodies", name, "thermal", "temperature"]), fault);
        }
    }

    /// Checks the size of stiffnesses.
    fn wrong_materials(&self, check: &mut impl FnMut(Vec<Step>, Option<String>)) {
        for (name, material) in &self.materials {
            let Elasticity::Anisotropic {
                stiffness,
                out_of_plane,
            } = material
            else {
                continue;
            };
            let (rows, place, others) = match self.plane {
                Some(PlaneState::Axisymmetric) => (
                    4,
                    "around an axis",
                    Some("around an axis it is row 3 of 'stiffness'"),
                ),
                Some(_) => (3, "in 2 dimensions", None),
                None => (6, "in 3 dimensions", Some("a scene in space has none")),
            };
            let fault = (stiffness.size() != rows).then(|| {
                let or_in_space = if rows < 6 { OR_IN_SPACE } else { "" };
                format!("expected {rows} rows of {rows} numbers {place}{or_in_space}")
            });
            check(at(["materials", name, "stiffness"]), fault);
            let fault = out_of_plane.and(others).map(String::from);
            check(at(["materials", name, "out_of_plane"]), fault);
        }
    }

    /// Checks the dimension of obstacles and laws of contacts.
    fn wrong_contacts(&self, dim: usize, check: &mut impl FnMut(Vec<Step>, Option<String>)) {
        for (index, contact) in self.contact.iter().enumerate() {
            if let Some(Contact {
                partner: Partner::Obstacle(obstacle),
                ..
            }) = contact.contact()
            {
                check(entry("contact", index, "obstacle"), obstacle.fault(dim));
            }
            let (gap, friction, stiffness) = contact.laws();
            let stiffness = stiffness.and_then(|stiffness| stiffness.fault(dim));
            check(entry("contact", index, "stiffness"), stiffness);
            let gap = gap.and_then(|gap| gap.fault(dim));
            check(entry("contact", index, "gap"), gap);
            if let Some((key, fault)) = friction.and_then(|law| law.fault(dim)) {
                check(entry("contact", index, key), Some(fault));
            }
        }
    }

    /// A step with an invalid name, a time before that of the previous step, or an unknown body.
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
            let forces = step.body_force.keys().map(|body| ("body_force", body));
            let temperatures = step.temperature.keys().map(|body| ("temperature", body));
            for (key, body) in forces.chain(temperatures) {
                let path = || [of_step(index, key), vec![body.as_str().into()]].concat();
                let Some(of_scene) = self.bodies.get(body) else {
                    let hint = suggest::hint(body, known());
                    return Some((path(), format!("there is no body '{body}'{hint}")));
                };
                if key == "temperature" && of_scene.thermal.is_none() {
                    let message = format!("the body '{body}' has no 'thermal', so no expansion");
                    return Some((path(), message));
                }
            }
        }
        None
    }
}

/// Boundary conditions and loads of a scene, or a step, on groups of its mesh.
struct OnGroups<'a> {
    displacement: &'a [Displacement],
    traction: &'a [Traction],
    pressure: &'a [Pressure],
    force: &'a [Force],
}

impl OnGroups<'_> {
    /// Checks all of them, under the keys `within`.
    fn check(
        &self,
        dim: usize,
        within: &[Step],
        check: &mut impl FnMut(Vec<Step>, Option<String>),
    ) {
        let path =
            |list: &str, index: usize, key: &str| [within, &entry(list, index, key)].concat();
        for (index, displacement) in self.displacement.iter().enumerate() {
            for (component, key) in displacement.components.iter().zip(["x", "y", "z"]) {
                let fault = component.as_ref().and_then(|number| match key {
                    "z" if dim == 2 => Some(format!("a plane scene has no 'z'{OR_IN_SPACE}")),
                    _ => number.fault(dim),
                });
                check(path("displacement", index, key), fault);
            }
        }
        for (index, traction) in self.traction.iter().enumerate() {
            check(path("traction", index, "value"), traction.value.fault(dim));
        }
        for (index, pressure) in self.pressure.iter().enumerate() {
            check(path("pressure", index, "value"), pressure.value.fault(dim));
        }
        for (index, force) in self.force.iter().enumerate() {
            let (key, fault) = force.amount.fault(dim);
            check(path("force", index, key), fault);
        }
    }
}
