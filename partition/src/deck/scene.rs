//! The scene equivalent to a deck.

use std::collections::BTreeMap;

use super::activation::{self, Activation};
use super::content::Content;
use super::document::{Document, Linear, quoted};
use super::elastic::Elastic;
use super::initial;
use super::loads::{BodyKind, BodyLoad};
use super::material::Material;
use super::place::Places;
use super::prints::Prints;
use super::scene_tables::SceneTables;
use super::sections::{self, Body, Section};
use super::steps::LoadStep;
use crate::error::InputError;
use crate::mesh::abaqus::Source;
use crate::name;
use crate::scene::material::PlaneState;

/// Name of the mesh file of the written scene.
pub(super) const MESH: &str = "mesh.msh";

/// A modulus below which lengths are assumed to be in millimetres: it only determines the units named in messages and
/// pictures.
const OF_MILLIMETRES: f64 = 1e8;

/// The text of the scene, and what tables need to know of it; required sets are added to the deck.
pub(super) fn text(
    places: &mut Places,
    content: &Content,
    warnings: &mut Vec<String>,
) -> Result<(String, Prints), InputError> {
    let source = places.source;
    let plane = plane(places)?;
    (content.couplings).check_plane(places, plane == Some(PlaneState::Axisymmetric))?;
    let bodies = content.bodies(places)?;
    let thickness = match plane {
        Some(PlaneState::Strain | PlaneState::Stress) => {
            sections::thickness(places, &content.sections)?
        }
        _ => 1.0,
    };
    let mut tables = SceneTables::new(places, content, bodies, thickness)?;
    let dim = places.dim();
    let mut document = Document::default();
    if let Some(title) = &content.title {
        document.key("title", quoted(title));
    }
    document.key("mesh", quoted(MESH));
    if let Some(plane) = plane {
        document.key("plane", quoted(plane.name()));
    }
    let materials = content.materials(source, &tables.bodies, &mut document, plane)?;
    let bodies = tables.bodies.iter().zip(&tables.names);
    for ((body, name), material) in bodies.zip(&materials) {
        content.body(source, body, (name, material), (dim, plane), &mut document)?;
    }
    for load in &tables.loads {
        load.write(0, "", &mut document);
    }
    let mut passing = content.contact(
        places,
        (&tables.sides, &tables.pairs, &tables.ties),
        &mut tables.taken,
        (&mut document, warnings),
    )?;
    passing.extend(tables.activations());
    tables.write_conditions(&mut document);
    if content.steps.done.len() > 1 || !passing.is_empty() {
        for number in 0..content.steps.done.len() {
            content.step(source, number, (&tables, &passing), dim, &mut document)?;
            tables.write_step(number, &mut document);
        }
    }
    let of_scene = Prints {
        thickness,
        supports: tables.supports(),
        bolts: tables.bolts(),
        ..Prints::default()
    };
    Ok((document.text(), of_scene))
}

/// The plane state, from the types of elements; `None` in space.
fn plane(places: &Places) -> Result<Option<PlaneState>, InputError> {
    if places.dim() != 2 {
        return Ok(None);
    }
    let mut found: Option<PlaneState> = None;
    for block in places
        .source
        .blocks
        .iter()
        .filter(|block| block.keyword == "ELEMENT")
    {
        let kind = block.parameter("TYPE").unwrap_or_default().to_uppercase();
        let plane = match kind.get(..3) {
            Some("CPE") => PlaneState::Strain,
            Some("CPS") => PlaneState::Stress,
            Some("CAX") => PlaneState::Axisymmetric,
            _ => continue,
        };
        if found.is_some_and(|found| found != plane) {
            let message = format!(
                "elements of type {} stand beside others of another plane state; expected one of CPE, CPS and CAX",
                name::shown(&kind)
            );
            return Err(places.source.error(block.place, message));
        }
        found = Some(plane);
    }
    Ok(found)
}

impl Content {
    fn bodies(&self, places: &Places) -> Result<Vec<Body>, InputError> {
        let expands = |section: &Section| {
            (self.materials.get(&section.material))
                .is_some_and(|material| material.expansion != 0.0)
        };
        let steps = (&self.steps.loads, &self.steps.done[..], &self.changes);
        sections::bodies(places, &self.sections, expands, steps, &self.initial)
    }

    fn material(&self, source: &Source, section: &Section) -> Result<&Material, InputError> {
        self.materials.get(&section.material).ok_or_else(|| {
            let message = format!("there is no *MATERIAL '{}'", name::shown(&section.material));
            source.error(section.place, message)
        })
    }

    /// Writes the units and the materials; returns the name of each body's material.
    fn materials(
        &self,
        source: &Source,
        bodies: &[Body],
        document: &mut Document,
        plane: Option<PlaneState>,
    ) -> Result<Vec<String>, InputError> {
        let mut found: BTreeMap<String, Elastic> = BTreeMap::new();
        let mut names = Vec::new();
        for body in bodies {
            let section = &self.sections[body.section];
            let material = self.material(source, section)?;
            let elastic = material.elastic(source)?;
            let (name, elastic) = match (&section.orientation, elastic) {
                (Some(orientation), Elastic::Anisotropic(_)) => {
                    let axes = self.orientation(source, section, orientation)?;
                    (
                        format!("{}, {orientation}", material.name),
                        elastic.along(&axes),
                    )
                }
                _ => (material.name.clone(), elastic.clone()),
            };
            found.insert(name.clone(), elastic);
            names.push(name);
        }
        let stiffest = found.values().map(Elastic::modulus).fold(0.0, f64::max);
        if stiffest < OF_MILLIMETRES {
            document.key("units", quoted("mm"));
        }
        for (name, elastic) in found {
            document.table(&format!("[materials.{}]", quoted(&name)));
            elastic
                .keys(plane)
                .into_iter()
                .for_each(|(key, value)| document.key(key, value));
        }
        Ok(names)
    }

    /// Writes a body.
    fn body(
        &self,
        source: &Source,
        body: &Body,
        (name, material): (&str, &str),
        (dim, plane): (usize, Option<PlaneState>),
        document: &mut Document,
    ) -> Result<(), InputError> {
        document.table(&format!("[bodies.{}]", quoted(name)));
        document.key("material", quoted(material));
        if body.is_reduced {
            document.key("integration", quoted("reduced"));
        }
        if !body.loads.is_empty() {
            let force = self.body_force(source, body, &self.steps.done[0])?;
            document.key("body_force", force.shown(dim));
        }
        if body.initial != [0.0; 6] {
            let stress = initial::in_scene(body.initial, plane);
            document.key("initial_stress", format!("{stress:?}"));
        }
        if body.warmth.iter().any(|&warmth| warmth != 0.0) {
            let expansion = self
                .material(source, &self.sections[body.section])?
                .expansion;
            let warmth = body.warmth[0];
            document.key(
                "thermal",
                format!("{{ expansion = {expansion:?}, temperature = {warmth:?} }}"),
            );
        }
        Ok(())
    }

    /// The force per volume on a body in a step.
    fn body_force(
        &self,
        source: &Source,
        body: &Body,
        step: &LoadStep,
    ) -> Result<Linear, InputError> {
        let mut force = Linear::default();
        let loads = &self.steps.loads;
        for number in &body.loads {
            let Some(&magnitude) = step.bodies.get(number) else {
                continue;
            };
            let BodyLoad { kind, label, .. } = &loads.of_bodies[*number];
            let section = &self.sections[body.section];
            let place = loads.bodies.place(number).unwrap_or(step.place);
            let density = || {
                self.material(source, section)?
                    .density(source, place, label)
            };
            match *kind {
                BodyKind::Along(axis) => force.constant[axis] += magnitude,
                BodyKind::Gravity(direction) => {
                    let weight = magnitude * density()?;
                    (0..3).for_each(|i| force.constant[i] += weight * direction[i]);
                }
                BodyKind::Centrifugal(point, axis) => {
                    let factor = magnitude * density()?;
                    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                        let slope = factor * (f64::from(u8::from(i == j)) - axis[i] * axis[j]);
                        force.slope[i][j] += slope;
                        force.constant[i] -= slope * point[j];
                    }
                }
            }
        }
        Ok(force)
    }

    /// Writes a load step, whose lists replace those of the scene.
    fn step(
        &self,
        source: &Source,
        number: usize,
        (tables, passing): (&SceneTables, &[Activation]),
        dim: usize,
        document: &mut Document,
    ) -> Result<(), InputError> {
        let step = &self.steps.done[number];
        let loads = &tables.loads;
        document.table("[[step]]");
        if let Some(name) = &step.name {
            document.key("name", quoted(name));
        }
        document.key("time", format!("{:?}", step.time));
        activation::write(passing, number, document);
        for list in ["displacement", "pressure", "traction", "force"] {
            let mut of_list = loads.iter().filter(|load| load.list == list).peekable();
            let acts = loads
                .iter()
                .any(|load| load.list == list && load.values[number].is_some());
            if of_list.peek().is_some() && !acts {
                // Loads of the scene are replaced by an empty list.
                document.key(list, "[]");
            }
        }
        self.step_of_bodies(source, number, tables, dim, document)?;
        for load in loads {
            load.write(number, "step.", document);
        }
        Ok(())
    }

    /// Writes the forces and temperatures of bodies in a load step.
    fn step_of_bodies(
        &self,
        source: &Source,
        number: usize,
        SceneTables { bodies, names, .. }: &SceneTables,
        dim: usize,
        document: &mut Document,
    ) -> Result<(), InputError> {
        let step = &self.steps.done[number];
        let loaded: Vec<_> = bodies
            .iter()
            .zip(names)
            .filter(|(body, _)| !body.loads.is_empty())
            .collect();
        if !loaded.is_empty() {
            document.table("[step.body_force]");
        }
        for (body, name) in loaded {
            document.key(
                &quoted(name),
                self.body_force(source, body, step)?.shown(dim),
            );
        }
        let warm = |body: &Body| body.warmth.iter().any(|&warmth| warmth != 0.0);
        let warmed: Vec<_> = bodies
            .iter()
            .zip(names)
            .filter(|(body, _)| warm(body))
            .collect();
        if !warmed.is_empty() {
            document.table("[step.temperature]");
        }
        for (body, name) in warmed {
            document.key(&quoted(name), format!("{:?}", body.warmth[number]));
        }
        Ok(())
    }
}
