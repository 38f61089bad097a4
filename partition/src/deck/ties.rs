//! `*TIE`.

use super::document::{Document, quoted};
use super::groups::Groups;
use super::loads::item;
use super::parameters;
use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::Block;

/// A tie of two surfaces, by name in capitals.
struct Tie {
    name: String,
    slave: String,
    master: String,
    tolerance: Option<f64>,
    adjust: bool,
}

/// All ties of a deck.
#[derive(Default)]
pub(super) struct Ties(Vec<Tie>);

/// A tie in the syntax of the scene: its name, its sides, and further keys of its table.
pub(super) struct SceneTie {
    pub(super) name: String,
    pub(super) sides: [String; 2],
    pub(super) tolerance: Option<f64>,
    pub(super) adjust: bool,
}

impl Ties {
    /// Reads a block.
    pub(super) fn read(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        if let Some(key) = parameters::refused(block) {
            let message = format!("*TIE with {key} isn't read; expected a tie of two sides");
            return Err(source.error(block.place, message));
        }
        let tolerance = block.parameter("POSITION TOLERANCE");
        let tolerance = tolerance
            .map(|value| source.real(block.place, value, "a distance"))
            .transpose()?;
        let adjust = block.parameter("ADJUST").unwrap_or("YES");
        for data in &block.data {
            let slave = places.surface(data.place, item(source, data, 0))?;
            let master = places.surface(data.place, item(source, data, 1))?;
            let plain = format!("{slave} on {master}");
            self.0.push(Tie {
                name: block.parameter("NAME").map_or(plain, str::to_owned),
                slave,
                master,
                tolerance: tolerance.filter(|&tolerance| tolerance > 0.0),
                adjust: !adjust.eq_ignore_ascii_case("NO"),
            });
        }
        Ok(())
    }

    /// The ties, with the groups of their surfaces.
    pub(super) fn in_scene(&self, groups: &mut Groups) -> Vec<SceneTie> {
        let tie = |tie: &Tie| SceneTie {
            name: tie.name.clone(),
            sides: [&tie.slave, &tie.master].map(|side| groups.of_surface(side)),
            tolerance: tie.tolerance,
            adjust: tie.adjust,
        };
        self.0.iter().map(tie).collect()
    }
}

impl SceneTie {
    /// Writes the tie under a unique `name`.
    pub(super) fn write(&self, name: &str, document: &mut Document) {
        let [slave, master] = &self.sides;
        document.table("[[tie]]");
        document.key("name", quoted(name));
        document.key("sides", format!("[{}, {}]", quoted(slave), quoted(master)));
        if let Some(tolerance) = self.tolerance {
            document.key("tolerance", format!("{tolerance:?}"));
        }
        if self.adjust {
            document.key("adjust", "true");
        }
    }
}
