//! Decks of Abaqus and CalculiX as whole models: each is translated into the text of a scene and its mesh, so that the
//! later stages don't depend on decks.
//!
//! Decks that aren't linear, static and of small strains, and unknown keywords, are refused with keyword and line.

mod activation;
mod amplitude;
mod attachment;
mod axes;
mod behavior;
mod conditions;
mod contacts;
mod content;
mod couplings;
mod cyclic;
mod definitions;
mod document;
mod elastic;
mod entries;
mod equations;
mod friction;
mod group_load;
mod groups;
mod initial;
mod keyword;
mod loads;
mod material;
mod model_change;
mod mpc;
mod orientations;
mod pairs;
mod parameters;
mod place;
mod pretensions;
pub mod prints;
mod reference;
mod scene;
mod scene_tables;
mod sections;
mod solids;
mod springs;
mod steps;
mod supports;
mod table;
mod ties;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use self::content::Content;
use self::keyword::Meaning;
use self::place::Places;
use self::prints::Prints;
use crate::destination;
use crate::error::{InputError, OutputError};
use crate::mesh::abaqus::{self, Source, Whole};
use crate::mesh::{Mesh, gmsh};

/// A deck as a scene.
pub struct Translation {
    /// The scene, whose mesh is `mesh.msh`.
    pub scene: String,
    /// The mesh.
    pub mesh: Mesh,
    /// The deck and its included files.
    pub files: Vec<PathBuf>,
    /// The tables requested by the deck.
    pub prints: Prints,
}

impl Translation {
    /// Writes `scene.toml` and `mesh.msh` into `directory`, which is created if missing, and returns the path of the
    /// scene. Existing files of these names aren't overwritten.
    ///
    /// # Errors
    /// Files that can't be written, or that exist already.
    pub fn write(&self, directory: &Path) -> Result<PathBuf, OutputError> {
        fs::create_dir_all(directory).map_err(|error| destination::failure(directory, error))?;
        let scene = directory.join("scene.toml");
        let mut mesh = Vec::new();
        gmsh::write_to(&mut mesh, &self.mesh)
            .map_err(|error| destination::failure(&scene, error))?;
        let files = [
            (directory.join(scene::MESH), mesh),
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

/// True if a file is a deck by its name.
pub fn is_one(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("inp"))
}

/// Reads a deck.
///
/// # Errors
/// The part of the deck that is invalid or unsupported, with file and line.
pub fn read(path: &Path) -> Result<Translation, InputError> {
    translate(path).map_err(|error| error.in_file(path))
}

fn translate(path: &Path) -> Result<Translation, InputError> {
    let mut source = Source::read(path)?;
    keyword::spell(&mut source.blocks);
    // Unsupported keywords are reported before errors in the mesh.
    let mut not_needed = BTreeSet::new();
    for block in &source.blocks {
        if keyword::meaning(&source, block)? == Meaning::NotNeeded {
            not_needed.insert(format!("*{}", block.keyword));
        }
    }
    entries::check(&source)?;
    let Whole {
        deck, mut warnings, ..
    } = Whole::read(&source)?;
    let mut places = Places::new(&source, deck)?;
    solids::check(&places)?;
    let mut content = Content::default();
    content.read_amplitudes(&source)?;
    content.read_orientations(&mut places)?;
    content.read_couplings(&mut places)?;
    for block in &source.blocks {
        content.read(&mut places, block)?;
    }
    definitions::check(&source)?;
    content.steps.end(&places)?;
    content.check_path(&places)?;
    content.find_conditions(&places, &mut warnings)?;
    if content.steps.done.is_empty() {
        return Err(InputError::new(
            "the deck has no step; expected *STEP with *STATIC, or a scene in TOML whose key 'mesh' names the deck",
        ));
    }
    not_needed.extend(content.steps.loads.notes.iter().cloned());
    let has_axes = content
        .sections
        .iter()
        .any(|section| section.orientation.is_some());
    (content.prints).note_axes(!content.steps.systems.is_empty(), has_axes);
    not_needed.append(&mut content.prints.left_out);
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
    let (scene, of_scene) = scene::text(&mut places, &content, &mut warnings)?;
    let prints = content.prints.tables(
        &places,
        content.steps.done.len(),
        &content.couplings.nodes(),
        of_scene,
    );
    Ok(Translation {
        scene,
        mesh: abaqus::mesh(&places.deck, warnings)?,
        files: source.paths().map(Path::to_path_buf).collect(),
        prints,
    })
}
