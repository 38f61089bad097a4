//! What a user writes: `scene.toml`.

pub mod condition;
pub mod expression;
pub mod material;
pub mod number;
pub mod place;
pub mod suggest;

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::error::InputError;
use crate::file_kind::FileKind;
use crate::model::PlaneState;
use crate::solver::SolverSettings;
use crate::{name, source};
use condition::{Bilateral, Body, Contact, Displacement, Names, Partner, Pressure, Traction};
use material::Elasticity;
use place::Step;

/// A scene as it was written, with every value checked that can be without the mesh.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Title.
    #[serde(default)]
    pub title: String,
    /// The mesh file: as written after [`Scene::parse`], beside the scene's file after
    /// [`Scene::read`].
    pub mesh: PathBuf,
    /// Plane state; `None` for three dimensions.
    pub plane: Option<PlaneState>,
    /// Materials by name.
    pub materials: BTreeMap<String, Elasticity>,
    /// Bodies by the name of their group of cells.
    pub bodies: BTreeMap<String, Body>,
    /// Γ_u.
    #[serde(default, deserialize_with = "place::list")]
    pub displacement: Vec<Displacement>,
    /// Γ_o.
    #[serde(default, deserialize_with = "place::list")]
    pub bilateral: Vec<Bilateral>,
    /// Γ_τ, tractions.
    #[serde(default, deserialize_with = "place::list")]
    pub traction: Vec<Traction>,
    /// Γ_τ, pressures.
    #[serde(default, deserialize_with = "place::list")]
    pub pressure: Vec<Pressure>,
    /// Γ_c.
    #[serde(default, deserialize_with = "place::list")]
    pub contact: Vec<Contact>,
    /// Groups of cells that are the subdomains; `None` to leave the partition to METIS.
    pub subdomains: Option<Names>,
    /// How it is to be solved, where the command line doesn't say otherwise.
    #[serde(default)]
    pub solver: SolverSettings,
}

impl Scene {
    /// Reads a scene. Its mesh is looked for beside it.
    ///
    /// # Errors
    /// What is wrong with it, with line and key.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let parsed = source::text(path, "a scene in TOML").and_then(|text| Self::parse(&text));
        let mut scene = parsed
            .map_err(|error| FileKind::explain(FileKind::Scene, path, error).in_file(path))?;
        if let Some(folder) = path.parent() {
            scene.mesh = folder.join(&scene.mesh);
        }
        Ok(scene)
    }

    /// Parses a scene.
    ///
    /// # Errors
    /// What is wrong with it, with line and key.
    pub fn parse(text: &str) -> Result<Self, InputError> {
        let scene: Self = toml::from_str(text).map_err(|error| place::located(text, &error))?;
        match scene.fault() {
            None => Ok(scene),
            Some((path, message)) => Err(place::error_at(text, &path, &message)),
        }
    }

    /// The first thing wrong between keys, and the key at which to say so.
    fn fault(&self) -> Option<(Vec<Step>, String)> {
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
                let hint = suggest::nearest(&body.material, known())
                    .map(|near| format!("; did you mean '{near}'?"))
                    .unwrap_or_default();
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
        let expected = "a plane scene has vectors of two components";
        let wrong = |path: Vec<Step>| Some((path, expected.to_owned()));
        for (name, body) in &self.bodies {
            if body.body_force.as_ref().is_some_and(|v| v.dim() != 2) {
                return wrong(vec![
                    "bodies".into(),
                    name.as_str().into(),
                    "body_force".into(),
                ]);
            }
        }
        for (index, displacement) in self.displacement.iter().enumerate() {
            if displacement.components[2].is_some() {
                return Some((
                    vec!["displacement".into(), index.into(), "z".into()],
                    "a plane scene has no 'z'".into(),
                ));
            }
        }
        for (index, traction) in self.traction.iter().enumerate() {
            if traction.value.dim() != 2 {
                return wrong(vec!["traction".into(), index.into(), "value".into()]);
            }
        }
        for (index, contact) in self.contact.iter().enumerate() {
            if matches!(&contact.partner, Partner::Obstacle(o) if o.dim() != 2) {
                return wrong(vec!["contact".into(), index.into(), "obstacle".into()]);
            }
        }
        None
    }
}
