//! Content of a deck except its mesh, block by block.

use std::collections::BTreeMap;

use super::amplitude::Amplitude;
use super::attachment;
use super::axes::{Axes, System};
use super::conditions::{self, Condition};
use super::contacts::Contacts;
use super::couplings::Couplings;
use super::cyclic::Sectors;
use super::equations::Equations;
use super::initial::Initial;
use super::material::Material;
use super::model_change::Changes;
use super::mpc;
use super::orientations::Orientations;
use super::place::Places;
use super::pretensions::Pretensions;
use super::prints::Requests;
use super::sections::Section;
use super::springs::Springs;
use super::steps::Steps;
use super::ties::Ties;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace, Of, Source};
use crate::name;

/// Content of a deck except its mesh.
#[derive(Default)]
pub(super) struct Content {
    pub(super) title: Option<String>,
    /// Materials by name in capitals.
    pub(super) materials: BTreeMap<String, Material>,
    /// The material being read.
    open: Option<String>,
    orientations: Orientations,
    pub(super) sections: Vec<Section>,
    pub(super) initial: Initial,
    pub(super) contacts: Contacts,
    pub(super) ties: Ties,
    equations: Equations,
    /// Constraints for equations, and for supports that aren't prescribed displacements of the scene.
    pub(super) conditions: Vec<Condition>,
    pub(super) couplings: Couplings,
    pub(super) springs: Springs,
    pub(super) pretensions: Pretensions,
    pub(super) sectors: Sectors,
    pub(super) prints: Requests,
    pub(super) steps: Steps,
    /// The sets added and removed by steps.
    pub(super) changes: Changes,
    /// The first step that requests large displacements.
    pub(super) nlgeom: Option<LinePlace>,
}

impl Content {
    /// Reads all amplitudes first, as a deck may refer to them before their definition.
    pub(super) fn read_amplitudes(&mut self, source: &Source) -> Result<(), InputError> {
        let blocks = source.blocks.iter();
        for block in blocks.filter(|block| block.keyword == "AMPLITUDE") {
            let name = source.required(block, "NAME")?.to_uppercase();
            let amplitude = Amplitude::read(source, block)?;
            self.steps.amplitudes.insert(name, amplitude);
        }
        Ok(())
    }

    /// Reads all orientations first, before sections and couplings refer to them.
    pub(super) fn read_orientations(&mut self, places: &mut Places) -> Result<(), InputError> {
        for block in &places.source.blocks {
            match block.keyword.as_str() {
                "PART" | "INSTANCE" | "END PART" | "END INSTANCE" => places.enter(block),
                "ORIENTATION" | "DISTRIBUTION" => self.orientations.read(places, block)?,
                _ => {}
            }
        }
        Ok(())
    }

    /// Reads all couplings and pretensions first, before loads and supports of their reference nodes.
    pub(super) fn read_couplings(&mut self, places: &mut Places) -> Result<(), InputError> {
        for block in &places.source.blocks {
            match block.keyword.as_str() {
                "PART" | "INSTANCE" | "END PART" | "END INSTANCE" => places.enter(block),
                "COUPLING" | "KINEMATIC" | "DISTRIBUTING" | "RIGID BODY" => {
                    self.couplings.read(places, &self.orientations, block)?;
                }
                "PRE-TENSION SECTION" => self.pretensions.read(places, block)?,
                _ => {}
            }
        }
        let references = self.couplings.references(places)?;
        self.steps.loads.references = self.pretensions.references(places, references)?;
        Ok(())
    }

    /// Reads a block.
    pub(super) fn read(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        match block.keyword.as_str() {
            "HEADING" => self.heading(source, block),
            "PART" | "INSTANCE" | "END PART" | "END INSTANCE" => places.enter(block),
            "MATERIAL" => {
                let material = Material::new(source, block)?;
                let key = material.name.to_uppercase();
                self.materials.insert(key.clone(), material);
                self.open = Some(key);
            }
            "ELASTIC" | "EXPANSION" | "DENSITY" => self.law(source, block)?,
            "TRANSFORM" => {
                let system = System::of_nodes(source, block)?;
                let set = source.required(block, "NSET")?;
                for (position, nodes) in places.in_instances(block.place, Of::Nodes, set)? {
                    let system = position.map_or(system, |position| system.placed(&position));
                    nodes
                        .into_iter()
                        .for_each(|node| _ = self.steps.systems.insert(node, system));
                }
            }
            "SOLID SECTION" => {
                let section = Section::read(places, block)?;
                let parts = self.orientations.parts(places, &section);
                self.sections.extend([section].into_iter().chain(parts));
            }
            "INITIAL CONDITIONS" => self.initial.read(places, block)?,
            "STEP" => {
                let nlgeom = block.parameter("NLGEOM");
                if nlgeom.is_some_and(|value| !value.eq_ignore_ascii_case("NO")) {
                    self.nlgeom.get_or_insert(block.place);
                }
                self.steps.begin(places, block, !self.contacts.is_empty())?;
            }
            "STATIC" => self.steps.statics(places, block)?,
            "END STEP" => self.steps.end(places)?,
            "BOUNDARY" | "CLOAD" | "DLOAD" | "DSLOAD" | "TEMPERATURE" => {
                self.steps.read(places, block)?
            }
            // They have been read first.
            "ORIENTATION"
            | "DISTRIBUTION"
            | "COUPLING"
            | "KINEMATIC"
            | "DISTRIBUTING"
            | "RIGID BODY"
            | "PRE-TENSION SECTION" => {}
            "ELEMENT" => {
                self.springs.elements(places, block)?;
                self.equations.elements(places, block)?;
            }
            "SPRING" => self.springs.property(places, block)?,
            "TIE" | "EQUATION" | "MPC" | "DISTRIBUTING COUPLING" | "CYCLIC SYMMETRY MODEL" => {
                self.connect(places, block)?;
            }
            _ => self.change_or_print(places, block)?,
        }
        Ok(())
    }

    /// The title, which is the first line of the first heading.
    fn heading(&mut self, source: &Source, block: &Block) {
        let line = block
            .data
            .first()
            .map(|data| source.items(data).collect::<Vec<_>>().join(", "));
        self.title = self
            .title
            .take()
            .or(line.map(|line| name::in_a_line(&line)));
    }

    /// Reads a block of contacts, of model changes or of output requests, which belong to the current step.
    fn change_or_print(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let step = self.steps.number();
        match block.keyword.as_str() {
            "NODE PRINT" | "EL PRINT" => {
                let mut references = self.couplings.nodes();
                references.extend(self.pretensions.nodes());
                self.prints.read(places, block, step, &references)
            }
            "MODEL CHANGE" => (self.changes).read(places, block, &self.contacts.pairs, step),
            _ => self.contacts.read(places, block, step),
        }
    }

    /// Reads a block of ties, equations or cyclic symmetry.
    fn connect(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        match block.keyword.as_str() {
            "CYCLIC SYMMETRY MODEL" => self.sectors.model(places, block),
            "TIE" if block.parameter("CYCLIC SYMMETRY").is_some() => {
                self.sectors.tie(places, block)
            }
            "TIE" => self.ties.read(places, block),
            "EQUATION" => self.equations.read(places, block),
            "MPC" => {
                self.equations.all.extend(mpc::read(places, block)?);
                Ok(())
            }
            _ => self.equations.mean(places, block),
        }
    }

    /// Reads a block of the current material.
    fn law(&mut self, source: &Source, block: &Block) -> Result<(), InputError> {
        let open = self
            .open
            .as_ref()
            .and_then(|name| self.materials.get_mut(name));
        let material = open.ok_or_else(|| {
            let message = format!(
                "*{} belongs to nothing; expected *MATERIAL before it",
                block.keyword
            );
            source.error(block.place, message)
        })?;
        material.take(source, block)
    }

    /// Determines the constraints between displacements, after the last block, with `warnings` for supports of nodes that
    /// belong to nothing.
    pub(super) fn find_conditions(
        &mut self,
        places: &Places,
        warnings: &mut Vec<String>,
    ) -> Result<(), InputError> {
        attachment::check(
            places,
            (&self.equations.all, &self.springs),
            &self.steps.loads,
            warnings,
        )?;
        for dof in self.couplings.without_effect(&self.orientations.all) {
            for held in self
                .steps
                .done
                .iter_mut()
                .filter_map(|step| step.support(dof))
            {
                *held = None;
            }
        }
        self.conditions = conditions::all(places, &self.equations.all, &mut self.steps)?;
        Ok(())
    }

    /// Refuses loads that aren't proportional to the time of their step if friction makes the solution depend on the
    /// load path, as each step becomes a single load step.
    pub(super) fn check_path(&self, places: &Places) -> Result<(), InputError> {
        match self.steps.bend.filter(|_| self.contacts.have_friction()) {
            None => Ok(()),
            Some(place) => Err(places.source.error(
                place,
                "the amplitude isn't linear within the step, which with friction changes the answer; expected a step that \
                 ends at each of its points",
            )),
        }
    }

    /// The orientations, by name in capitals.
    pub(super) fn orientations(&self) -> &BTreeMap<String, System> {
        &self.orientations.all
    }

    /// The axes of an anisotropic section.
    pub(super) fn orientation(
        &self,
        source: &Source,
        section: &Section,
        name: &str,
    ) -> Result<Axes, InputError> {
        match self.orientations.all.get(name) {
            Some(System::Rectangular(axes)) => Ok(*axes),
            Some(System::Cylindrical(..)) => Err(source.error(
                section.place,
                format!(
                    "the orientation {} turns around an axis, which isn't supported yet; expected a rectangular one, \
                     perhaps a section for each sector",
                    name::shown(name)
                ),
            )),
            None => {
                let message = format!("there is no *ORIENTATION '{}'", name::shown(name));
                Err(source.error(section.place, message))
            }
        }
    }
}
