//! The scene as a user writes it: `scene.toml`.

mod activation;
pub mod compliance;
pub mod condition;
pub mod contact;
pub mod coupling;
pub mod cyclic;
pub mod equation;
pub mod expression;
mod fault;
pub mod friction;
pub mod initial;
mod joints;
pub mod loading;
pub mod material;
mod motion;
pub mod number;
pub mod place;
pub mod pretension;
pub mod quantity;
pub mod spring;
pub mod step;
pub mod suggest;
mod syntax;
pub mod tie;
pub mod units;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::error::InputError;
use crate::mesh::foreign;
use crate::solver::SolverSettings;
use crate::source;
use condition::{Bilateral, Body, Displacement, Force, Names, Pressure, Traction};
use contact::Declaration;
use coupling::Coupling;
use cyclic::Cyclic;
use equation::Equation;
use material::{Elasticity, PlaneState};
use pretension::Pretension;
use quantity::Quantity;
use spring::{AnySpring, Spring, SpringBetween};
use step::LoadStep;
use tie::Tie;
use units::Units;

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
    /// The units that messages and pictures name.
    #[serde(default)]
    pub units: Units,
    /// True if loads far beyond the stiffness are meant.
    #[serde(default)]
    pub large_strains: bool,
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
    /// Forces on nodes.
    #[serde(default, deserialize_with = "place::list")]
    pub force: Vec<Force>,
    /// Springs to the ground and between points.
    #[serde(default, deserialize_with = "place::list")]
    pub spring: Vec<AnySpring>,
    /// Γ_c: contacts, and bodies between which they are to be found.
    #[serde(default, deserialize_with = "place::list")]
    pub contact: Vec<Declaration>,
    /// Sides that are tied to each other.
    #[serde(default, deserialize_with = "place::list")]
    pub tie: Vec<Tie>,
    /// Linear equations between displacements.
    #[serde(default, deserialize_with = "place::list")]
    pub equation: Vec<Equation>,
    /// Quantities of the solution.
    #[serde(default, deserialize_with = "place::list")]
    pub quantity: Vec<Quantity>,
    /// Nodes that follow reference points.
    #[serde(default, deserialize_with = "place::list")]
    pub coupling: Vec<Coupling>,
    /// Sectors of rings.
    #[serde(default, deserialize_with = "place::list")]
    pub cyclic: Vec<Cyclic>,
    /// Bolts that are tightened.
    #[serde(default, deserialize_with = "place::list")]
    pub pretension: Vec<Pretension>,
    /// Load steps, one after the other; without any the loads of the scene are there at once.
    #[serde(default, deserialize_with = "place::list")]
    pub step: Vec<LoadStep>,
    /// Groups of cells that are the subdomains; `None` to leave the partition to METIS.
    pub subdomains: Option<Names>,
    /// Settings of the solver, where the command line doesn't say otherwise.
    #[serde(default)]
    pub solver: SolverSettings,
}

impl Scene {
    /// The springs to the ground, each with its place in the scene's list.
    pub fn springs_to_ground(&self) -> impl Iterator<Item = (usize, &Spring)> + Clone {
        let all = self.spring.iter().enumerate();
        all.filter_map(|(index, spring)| match spring {
            AnySpring::ToGround(spring) => Some((index, spring)),
            AnySpring::Between(_) => None,
        })
    }

    /// The springs between points, each with its place in the scene's list.
    pub fn springs_between(&self) -> impl Iterator<Item = (usize, &SpringBetween)> {
        let all = self.spring.iter().enumerate();
        all.filter_map(|(index, spring)| match spring {
            AnySpring::ToGround(_) => None,
            AnySpring::Between(spring) => Some((index, spring)),
        })
    }

    /// Reads a scene. Its mesh is looked for beside it.
    ///
    /// # Errors
    /// A fault of the scene, with line and key.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let parsed = source::text(path, "a scene in TOML").and_then(|text| Self::parse(&text));
        let parsed =
            parsed.map_err(
                |error| match foreign::instead_of_scene(path, &source::head(path)) {
                    Some(what) if path.is_file() => InputError::new(format!(
                        "is {what}; expected a scene in TOML, whose key 'mesh' names the mesh"
                    )),
                    _ => error,
                },
            );
        let mut scene = parsed.map_err(|error| error.in_file(path))?;
        if let Some(folder) = path.parent() {
            scene.mesh = folder.join(&scene.mesh);
        }
        Ok(scene)
    }

    /// Parses a scene.
    ///
    /// # Errors
    /// A fault of the scene, with line and key.
    pub fn parse(text: &str) -> Result<Self, InputError> {
        let scene: Self = toml::from_str(text).map_err(|error| place::located(text, &error))?;
        match scene.fault() {
            None => Ok(scene),
            Some((path, message)) => Err(place::error_at(text, &path, &message)),
        }
    }
}
