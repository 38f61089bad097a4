//! The tables of a deck's scene: its content on named groups of the mesh, before it is written.

use std::collections::{BTreeMap, BTreeSet};

use super::activation::Activation;
use super::conditions::{self, SceneEquation, Translator};
use super::content::Content;
use super::couplings::SceneCoupling;
use super::cyclic::SceneCyclic;
use super::document::{Document, Names};
use super::group_load::{OnGroup, OnGroups};
use super::groups::Groups;
use super::place::Places;
use super::pretensions::{self, ScenePretension};
use super::sections::Body;
use super::springs::SceneSpring;
use super::ties::SceneTie;
use crate::error::InputError;

/// The tables of a scene, except materials.
pub(super) struct SceneTables {
    pub(super) bodies: Vec<Body>,
    /// The name of each body, equal to that of its group.
    pub(super) names: Vec<String>,
    pub(super) loads: Vec<OnGroup>,
    /// The sides of each pair of surfaces.
    pub(super) sides: Vec<[String; 2]>,
    /// The name of the contact of each pair.
    pub(super) pairs: Vec<String>,
    pub(super) ties: Vec<SceneTie>,
    equations: Vec<SceneEquation>,
    springs: Vec<SceneSpring>,
    couplings: Vec<SceneCoupling>,
    sectors: Vec<SceneCyclic>,
    bolts: Vec<ScenePretension>,
    /// Names in use.
    pub(super) taken: Names,
}

impl SceneTables {
    /// The tables of a deck's content, with forces per `thickness` in the plane; required sets are added to the deck.
    ///
    /// # Errors
    /// Constraints that a scene can't express.
    pub(super) fn new(
        places: &mut Places,
        content: &Content,
        bodies: Vec<Body>,
        thickness: f64,
    ) -> Result<Self, InputError> {
        let source = places.source;
        let mut on_groups = OnGroups {
            steps: &content.steps,
            dim: places.dim(),
            thickness,
            groups: Groups::new(places),
        };
        let names: Vec<String> = (bodies.iter())
            .map(|body| {
                on_groups
                    .groups
                    .of_cells(&body.cells, &content.sections[body.section].set)
            })
            .collect();
        let loads = on_groups.all(source)?;
        let mut groups = on_groups.groups;
        let sides: Vec<[String; 2]> = (content.contacts.pairs.iter())
            .map(|pair| [&pair.slave, &pair.master].map(|side| groups.of_surface(side)))
            .collect();
        let ties = content.ties.in_scene(&mut groups);
        let mut taken = Names::default();
        let pairs: Vec<String> = (sides.iter())
            .map(|[slave, master]| taken.unique(&format!("{slave} on {master}")))
            .collect();
        let (steps, systems) = (&content.steps, &content.steps.systems);
        let couplings = content.couplings.in_scene(
            &mut groups,
            (&steps.done, thickness),
            (systems, content.orientations()),
            &mut taken,
        )?;
        let mut translator = Translator {
            couplings: (couplings.iter().map(|of| (of.node, of.name.clone()))).collect(),
            groups: &mut groups,
        };
        let mut equations = conditions::in_scene(&content.conditions, &mut translator, &mut taken);
        let references = &steps.loads.references;
        let (springs, others) = (content.springs).in_scene(
            &mut translator,
            thickness,
            (systems, references),
            &mut taken,
        )?;
        equations.extend(others);
        Ok(Self {
            equations,
            springs,
            couplings,
            // The names depend on the order of these fields.
            sectors: content.sectors.in_scene(&mut groups, &mut taken)?,
            bolts: (content.pretensions).in_scene(&mut groups, steps, thickness, &mut taken)?,
            bodies,
            names,
            loads,
            sides,
            pairs,
            ties,
            taken,
        })
    }

    /// The steps of equations and bodies that aren't active in all.
    pub(super) fn activations(&self) -> impl Iterator<Item = Activation> {
        let equations = self.equations.iter().filter_map(SceneEquation::activation);
        let bodies = self.bodies.iter().zip(&self.names);
        equations.chain(bodies.filter_map(|(body, name)| body.activation(name)))
    }

    /// The names of equations that are supports.
    pub(super) fn supports(&self) -> BTreeSet<String> {
        let supports = self.equations.iter().filter_map(SceneEquation::support);
        supports.map(str::to_owned).collect()
    }

    /// The pretensions by the numbers of their nodes.
    pub(super) fn bolts(&self) -> BTreeMap<i64, (String, f64)> {
        self.bolts.iter().map(ScenePretension::printed).collect()
    }

    /// Appends the constraints between groups, except contacts and ties.
    pub(super) fn write_conditions(&self, document: &mut Document) {
        for coupling in &self.couplings {
            coupling.write(document);
        }
        for sector in &self.sectors {
            sector.write(document);
        }
        for bolt in &self.bolts {
            bolt.write(document);
        }
        for spring in &self.springs {
            spring.write(document);
        }
        for equation in &self.equations {
            equation.write(document);
        }
    }

    /// Appends the values of these constraints in a step.
    pub(super) fn write_step(&self, number: usize, document: &mut Document) {
        conditions::write_step(&self.equations, number, document);
        for coupling in &self.couplings {
            coupling.write_step(number, document);
        }
        pretensions::write_step(&self.bolts, number, document);
    }
}
