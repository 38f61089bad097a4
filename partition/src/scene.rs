//! The scene: the user's file `scene.toml`.

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

/// A parsed scene, with all checks that don't need the mesh.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Title.
    #[serde(default)]
    pub title: String,
    /// The mesh file: as written after [`Scene::parse`], relative to the scene's file after [`Scene::read`].
    pub mesh: PathBuf,
    /// The units in messages and pictures.
    #[serde(default)]
    pub units: Units,
    /// True if loads far beyond the stiffness are intended.
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
    /// Γ_c: contacts, and bodies between which contacts are detected.
    #[serde(default, deserialize_with = "place::list")]
    pub contact: Vec<Declaration>,
    /// Ties of sides.
    #[serde(default, deserialize_with = "place::list")]
    pub tie: Vec<Tie>,
    /// Linear equations between displacements.
    #[serde(default, deserialize_with = "place::list")]
    pub equation: Vec<Equation>,
    /// Quantities of the solution.
    #[serde(default, deserialize_with = "place::list")]
    pub quantity: Vec<Quantity>,
    /// Couplings of nodes to reference points.
    #[serde(default, deserialize_with = "place::list")]
    pub coupling: Vec<Coupling>,
    /// Cyclic symmetries.
    #[serde(default, deserialize_with = "place::list")]
    pub cyclic: Vec<Cyclic>,
    /// Pretensions of bolts.
    #[serde(default, deserialize_with = "place::list")]
    pub pretension: Vec<Pretension>,
    /// Load steps in their order; without steps all loads of the scene are applied at once.
    #[serde(default, deserialize_with = "place::list")]
    pub step: Vec<LoadStep>,
    /// Groups of cells that are the subdomains; `None` for an automatic partition.
    pub subdomains: Option<Names>,
    /// Settings of the solver, which the command line overrides.
    #[serde(default)]
    pub solver: SolverSettings,
}

impl Scene {
    /// The springs to the ground, each with its index in the scene's list.
    pub fn springs_to_ground(&self) -> impl Iterator<Item = (usize, &Spring)> + Clone {
        let all = self.spring.iter().enumerate();
        all.filter_map(|(index, spring)| match spring {
            AnySpring::ToGround(spring) => Some((index, spring)),
            AnySpring::Between(_) => None,
        })
    }

    /// The springs between points, each with its index in the scene's list.
    pub fn springs_between(&self) -> impl Iterator<Item = (usize, &SpringBetween)> {
        let all = self.spring.iter().enumerate();
        all.filter_map(|(index, spring)| match spring {
            AnySpring::ToGround(_) => None,
            AnySpring::Between(spring) => Some((index, spring)),
        })
    }

    /// Reads a scene. The path of its mesh is relative to it.
    ///
    /// # Errors
    /// An error in the scene, with line and key.
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
    /// An error in the scene, with line and key.
    pub fn parse(text: &str) -> Result<Self, InputError> {
        let scene: Self = toml::from_str(text).map_err(|error| place::located(text, &error))?;
        match scene.fault() {
            None => Ok(scene),
            Some((path, message)) => Err(place::error_at(text, &path, &message)),
        }
    }
}
