//! Load steps, which scale or replace loads of a scene.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, IntoDeserializer, MapAccess, Visitor};

use super::condition::{Displacement, Force, Names, Pressure, Traction};
use super::coupling::CouplingLoads;
use super::number::{Constant, ConstantVector, Number, Vector};
use super::place;
use super::pretension::PretensionChange;

/// A load step in a scene.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    default,
    expecting = "a table of name, time, scale, add, remove, body_force, temperature, traction, pressure, force, displacement, \
                 motion, equation, coupling and pretension"
)]
pub struct LoadStep {
    /// Name, by default its number.
    pub name: Option<String>,
    /// Time on the load path, by default its number.
    #[serde(deserialize_with = "time")]
    pub time: Option<f64>,
    /// The factors of its loads.
    pub scale: Scale,
    /// Bodies and contacts that are active from this step on.
    pub add: Option<Names>,
    /// Bodies and contacts that are removed in this step.
    pub remove: Option<Names>,
    /// Forces per volume that replace those of these bodies (N/m³).
    pub body_force: BTreeMap<String, Vector>,
    /// Temperatures that replace those of these bodies (K).
    pub temperature: BTreeMap<String, Number>,
    /// Displacements that replace those of the obstacles of these contacts (m).
    pub motion: BTreeMap<String, ConstantVector>,
    /// Values that replace those of the equations of these names (m).
    #[serde(deserialize_with = "values")]
    pub equation: BTreeMap<String, f64>,
    /// Loads and prescribed motions of the reference points of the couplings of these names; the given ones replace
    /// those of the scene.
    pub coupling: BTreeMap<String, CouplingLoads>,
    /// The pretensions of these names from this step on.
    pub pretension: BTreeMap<String, PretensionChange>,
    /// Tractions that replace all those of the scene.
    #[serde(deserialize_with = "list")]
    pub traction: Option<Vec<Traction>>,
    /// Pressures that replace all those of the scene.
    #[serde(deserialize_with = "list")]
    pub pressure: Option<Vec<Pressure>>,
    /// Forces on nodes that replace all those of the scene.
    #[serde(deserialize_with = "list")]
    pub force: Option<Vec<Force>>,
    /// Displacements that replace all those of the scene, with other values at the same nodes along the same axes.
    #[serde(deserialize_with = "list")]
    pub displacement: Option<Vec<Displacement>>,
}

/// Factors of loads: one for all, or a table.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields, default)]
pub struct Scale {
    /// Scale of body forces.
    #[serde(deserialize_with = "number")]
    pub body_force: f64,
    /// Scale of tractions.
    #[serde(deserialize_with = "number")]
    pub traction: f64,
    /// Scale of pressures.
    #[serde(deserialize_with = "number")]
    pub pressure: f64,
    /// Scale of forces on nodes.
    #[serde(deserialize_with = "number")]
    pub force: f64,
    /// Scale of prescribed displacements, including those of obstacles.
    #[serde(deserialize_with = "number")]
    pub displacement: f64,
    /// Scale of initial stresses.
    #[serde(deserialize_with = "number")]
    pub initial_stress: f64,
    /// Scale of temperatures.
    #[serde(deserialize_with = "number")]
    pub thermal: f64,
}

impl Scale {
    fn all(factor: f64) -> Self {
        Self {
            body_force: factor,
            traction: factor,
            pressure: factor,
            force: factor,
            displacement: factor,
            initial_stress: factor,
            thermal: factor,
        }
    }
}

impl Default for Scale {
    fn default() -> Self {
        Self::all(1.0)
    }
}

impl<'de> Deserialize<'de> for Scale {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ScaleVisitor;
        impl<'de> Visitor<'de> for ScaleVisitor {
            type Value = Scale;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str(
                    "a number, or a table of body_force, traction, pressure, force, displacement, \
                     initial_stress and thermal",
                )
            }

            fn visit_i64<E: Error>(self, factor: i64) -> Result<Scale, E> {
                self.visit_f64(factor as f64)
            }

            fn visit_f64<E: Error>(self, factor: f64) -> Result<Scale, E> {
                number(factor.into_deserializer()).map(Scale::all)
            }

            fn visit_str<E: Error>(self, factor: &str) -> Result<Scale, E> {
                number(factor.into_deserializer()).map(Scale::all)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Scale, A::Error> {
                // The table, with the derived implementation.
                Scale::deserialize(MapAccessDeserializer::new(map))
            }
        }
        deserializer.deserialize_any(ScaleVisitor)
    }
}

fn number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Constant::deserialize(deserializer).map(|Constant(value)| value)
}

fn time<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    number(deserializer).map(Some)
}

fn values<'de, D: Deserializer<'de>>(deserializer: D) -> Result<BTreeMap<String, f64>, D::Error> {
    let values = BTreeMap::<String, Constant>::deserialize(deserializer)?;
    Ok(values
        .into_iter()
        .map(|(name, Constant(value))| (name, value))
        .collect())
}

fn list<'de, D, T>(deserializer: D) -> Result<Option<Vec<T>>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    place::list(deserializer).map(Some)
}

impl LoadStep {
    /// The name of the step with this `number`, counted from 0.
    pub fn name_or_number(&self, number: usize) -> String {
        let number = || (number + 1).to_string();
        self.name.clone().unwrap_or_else(number)
    }
}
