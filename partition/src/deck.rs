//! Decks of Abaqus and CalculiX as whole models: each is translated into the text of a scene and its mesh, behind which
//! nothing knows of decks.
//!
//! What isn't linear, static and of small strains, and what isn't known, is refused by keyword and line.

mod amplitude;
mod axes;
mod contacts;
mod document;
mod elastic;
mod groups;
mod keyword;
mod loads;
mod material;
mod place;
mod scene;
mod sections;
mod steps;
mod supports;
mod table;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use self::amplitude::Amplitude;
use self::axes::{Axes, System};
use self::contacts::Contacts;
use self::keyword::Meaning;
use self::loads::item;
use self::material::Material;
use self::place::Places;
use self::sections::Section;
use self::steps::Steps;
use crate::destination;
use crate::error::{InputError, OutputError};
use crate::mesh::abaqus::{self, Block, LinePlace, Of, Source, Whole};
use crate::mesh::{Mesh, gmsh};
use crate::name;

/// Name of the mesh file of a scene that is written.
const MESH: &str = "mesh.msh";

/// A deck as a scene.
pub struct Translation {
    /// The scene, whose mesh is `mesh.msh`.
    pub scene: String,
    /// Its mesh.
    pub mesh: Mesh,
    /// The deck and the files that it includes.
    pub files: Vec<PathBuf>,
}

impl Translation {
    /// Writes `scene.toml` and `mesh.msh` into `directory`, which is made where it isn't there, and returns the path of the
    /// scene. Other files of these names stay.
    ///
    /// # Errors
    /// The files can't be written, or there are others of their names.
    pub fn write(&self, directory: &Path) -> Result<PathBuf, OutputError> {
        fs::create_dir_all(directory).map_err(|error| destination::failure(directory, error))?;
        let scene = directory.join("scene.toml");
        let mut mesh = Vec::new();
        gmsh::write_to(&mut mesh, &self.mesh)
            .map_err(|error| destination::failure(&scene, error))?;
        let files = [
            (directory.join(MESH), mesh),
            (scene.clone(), self.scene.clone().into_bytes()),
        ];
        for (path, bytes) in &files {
            if path.exists() && fs::read(path).ok().as_ref() != Some(bytes) {
                let why = "another file is there, with changes of yours perhaps; expected another folder behind \
                           --write-scene, or that file moved away";
                return Err(destination::failure(path, why));
            }
        }
        for (path, bytes) in &files {
            destination::write_bytes(path, |out| out.write_all(bytes))?;
        }
        Ok(scene)
    }
}

/// Whether a file is a deck by its name.
pub fn is_one(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("inp"))
}

/// Reads a deck.
///
/// # Errors
/// What is wrong with the deck or can't be computed, with file and line.
pub fn read(path: &Path) -> Result<Translation, InputError> {
    translate(path).map_err(|error| error.in_file(path))
}

fn translate(path: &Path) -> Result<Translation, InputError> {
    let mut source = Source::read(path)?;
    keyword::spell(&mut source.blocks);
    // What can't be computed is said before what is wrong with the mesh.
    let mut not_needed = BTreeSet::new();
    for block in &source.blocks {
        if keyword::meaning(&source, block)? == Meaning::NotNeeded {
            not_needed.insert(format!("*{}", block.keyword));
        }
    }
    let Whole {
        deck, mut warnings, ..
    } = Whole::read(&source)?;
    let mut places = Places::new(&source, deck);
    let mut content = Content::default();
    // Amplitudes may stand behind what names them.
    for block in source
        .blocks
        .iter()
        .filter(|block| block.keyword == "AMPLITUDE")
    {
        let name = source.required(block, "NAME")?.to_uppercase();
        (content.steps.amplitudes).insert(name, Amplitude::read(&source, block)?);
    }
    for block in &source.blocks {
        content.read(&mut places, block)?;
    }
    content.steps.end(&places)?;
    content.check_path(&places)?;
    if content.steps.done.is_empty() {
        return Err(InputError::new(
            "the deck has no step; expected *STEP with *STATIC, or a scene in TOML whose key 'mesh' names the deck",
        ));
    }
    not_needed.extend(content.steps.loads.notes.iter().cloned());
    if !not_needed.is_empty() {
        let list = not_needed.into_iter().collect::<Vec<_>>().join(", ");
        warnings.push(format!("not needed, and left out: {list}"));
    }
    if let Some(place) = content.nlgeom {
        let place = source.place(place);
        warnings.push(format!(
            "{place}: NLGEOM is left out: displacements and strains are taken as small, and nodes keep what they face"
        ));
    }
    let scene = scene::text(&mut places, &content, &mut warnings)?;
    let files = source.paths().map(Path::to_path_buf).collect();
    let mesh = abaqus::mesh(&places.deck, warnings)?;
    Ok(Translation { scene, mesh, files })
}

/// What a deck says beside its mesh.
#[derive(Default)]
struct Content {
    title: Option<String>,
    /// By name in capitals.
    materials: BTreeMap<String, Material>,
    /// The material that is read.
    open: Option<String>,
    orientations: BTreeMap<String, System>,
    sections: Vec<Section>,
    /// Temperatures of nodes at the beginning.
    temperatures: BTreeMap<u32, f64>,
    contacts: Contacts,
    steps: Steps,
    /// The first step that asks for large displacements.
    nlgeom: Option<LinePlace>,
}

impl Content {
    /// Reads a block.
    fn read(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        match block.keyword.as_str() {
            "HEADING" => {
                let line = block
                    .data
                    .first()
                    .map(|data| source.items(data).collect::<Vec<_>>().join(", "));
                self.title = self
                    .title
                    .take()
                    .or(line.map(|line| name::in_a_line(&line)));
            }
            "PART" | "INSTANCE" | "END PART" | "END INSTANCE" => places.enter(block),
            "MATERIAL" => {
                let material = Material::new(source, block)?;
                let key = material.name.to_uppercase();
                self.materials.insert(key.clone(), material);
                self.open = Some(key);
            }
            "ELASTIC" | "EXPANSION" | "DENSITY" => {
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
                material.take(source, block)?;
            }
            "ORIENTATION" => {
                let name = source.required(block, "NAME")?.to_uppercase();
                self.orientations
                    .insert(name, System::of_material(source, block)?);
            }
            "TRANSFORM" => {
                let system = System::of_nodes(source, block)?;
                let set = source.required(block, "NSET")?;
                let nodes = places.members(block.place, Of::Nodes, set)?;
                nodes
                    .into_iter()
                    .for_each(|node| _ = self.steps.systems.insert(node, system));
            }
            "SOLID SECTION" => self.sections.push(Section::read(places, block)?),
            "INITIAL CONDITIONS" => self.initial(places, block)?,
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
            _ => self.contacts.read(places, block)?,
        }
        Ok(())
    }

    /// Refuses loads that come on a path which one load step for each step doesn't follow, where friction makes it matter.
    fn check_path(&self, places: &Places) -> Result<(), InputError> {
        match self.steps.bend.filter(|_| self.contacts.have_friction()) {
            None => Ok(()),
            Some(place) => Err(places.source.error(
                place,
                "the amplitude isn't linear within the step, which with friction changes the answer; expected a step that \
                 ends at each of its points",
            )),
        }
    }

    /// `*INITIAL CONDITIONS`: temperatures of nodes.
    fn initial(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        let kind = source.required(block, "TYPE")?;
        if !kind.eq_ignore_ascii_case("TEMPERATURE") {
            let message = format!(
                "*INITIAL CONDITIONS of TYPE={} isn't supported yet; instead convert the deck, and give a body's \
                 initial_stress in the scene",
                name::shown(kind)
            );
            return Err(source.error(block.place, message));
        }
        for data in &block.data {
            let value = source.real(data.place, item(source, data, 1), "a temperature")?;
            for node in places.members(data.place, Of::Nodes, item(source, data, 0))? {
                self.temperatures.insert(node, value);
            }
        }
        Ok(())
    }

    /// The axes of an anisotropic section.
    fn orientation(
        &self,
        source: &Source,
        section: &Section,
        name: &str,
    ) -> Result<Axes, InputError> {
        match self.orientations.get(name) {
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
