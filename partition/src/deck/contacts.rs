//! `*CONTACT PAIR`, `*SURFACE INTERACTION` and what stands behind it, and general contact.

use std::collections::BTreeMap;

use super::document::Document;
use super::loads::item;
use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace};
use crate::name;

/// The law between two surfaces, in the words of a scene.
#[derive(Clone, Copy, Default)]
pub(super) struct ContactLaw {
    /// Coefficient of friction.
    friction: f64,
    /// Pressure over overclosure; `None` where nothing overlaps.
    stiffness: Option<f64>,
}

impl ContactLaw {
    /// Writes the keys of a contact with this law.
    pub(super) fn write(&self, document: &mut Document) {
        if self.friction != 0.0 {
            document.key("friction", format!("{:?}", self.friction));
        }
        if let Some(stiffness) = self.stiffness {
            document.key("stiffness", format!("{{ normal = {stiffness:?} }}"));
        }
    }
}

/// An interaction of two surfaces.
#[derive(Default)]
struct Interaction {
    law: ContactLaw,
    /// Softness that is taken as hard contact, in words.
    soft: Option<String>,
    /// Whether the sides hang together.
    is_tied: bool,
}

/// A pair of surfaces, by name in capitals.
pub(super) struct Pair {
    pub(super) slave: String,
    pub(super) master: String,
    interaction: String,
    pub(super) place: LinePlace,
    /// Which nodes of the slave should be moved onto the master.
    pub(super) adjust: Option<Adjust>,
    pub(super) gap: Option<f64>,
    /// Whether the pair says that its sides hang together.
    tied: bool,
}

/// The nodes of a slave that `ADJUST` moves.
#[derive(Clone, Copy)]
pub(super) enum Adjust {
    /// Those that are no farther from the master, and all that overlap it.
    Within(f64),
    /// Those of a set.
    Set,
}

/// Contact wherever bodies touch.
struct General {
    place: LinePlace,
    interaction: Option<String>,
}

/// All contacts of a deck.
#[derive(Default)]
pub(super) struct Contacts {
    interactions: BTreeMap<String, Interaction>,
    /// The interaction that is read, by name in capitals.
    open: Option<String>,
    pub(super) pairs: Vec<Pair>,
    general: Option<General>,
}

/// Parameters of `*FRICTION` that are another law than that of Coulomb.
const FRICTION: [&str; 6] = [
    "ROUGH",
    "TAUMAX",
    "EXPONENTIAL DECAY",
    "USER",
    "LAGRANGE",
    "ANISOTROPIC",
];

impl Contacts {
    /// Whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.pairs.is_empty() && self.general.is_none()
    }

    /// Whether friction acts somewhere.
    pub(super) fn have_friction(&self) -> bool {
        let general = self
            .general
            .iter()
            .filter_map(|general| general.interaction.as_ref());
        let named = self
            .pairs
            .iter()
            .map(|pair| &pair.interaction)
            .chain(general);
        let mut laws = named.filter_map(|name| self.interactions.get(name));
        laws.any(|interaction| interaction.law.friction != 0.0)
    }

    /// Reads a block of contacts.
    pub(super) fn read(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        match block.keyword.as_str() {
            "SURFACE INTERACTION" => {
                let name = source.required(block, "NAME")?.to_uppercase();
                self.interactions
                    .insert(name.clone(), Interaction::default());
                self.open = Some(name);
            }
            "SURFACE BEHAVIOR" => self.behavior(places, block)?,
            "FRICTION" => {
                let refused = FRICTION.iter().find(|key| block.parameter(key).is_some());
                if let Some(key) = refused {
                    let message = format!(
                        "*FRICTION with {key} isn't read; expected a coefficient of Coulomb's law"
                    );
                    return Err(source.error(block.place, message));
                }
                let friction = match block.data.first() {
                    Some(data) => source.real(
                        data.place,
                        item(source, data, 0),
                        "a coefficient of friction",
                    )?,
                    None => 0.0,
                };
                self.interaction(places, block)?.law.friction = friction;
            }
            "CONTACT PAIR" => self.pairs(places, block)?,
            "CLEARANCE" => self.clearance(places, block)?,
            "CONTACT" => {
                self.general = Some(General {
                    place: block.place,
                    interaction: None,
                })
            }
            "CONTACT INCLUSIONS" if block.parameter("ALL EXTERIOR").is_none() => {
                let message = "*CONTACT INCLUSIONS of surfaces isn't read; expected ALL EXTERIOR, or a *CONTACT PAIR";
                return Err(source.error(block.place, message));
            }
            "CONTACT PROPERTY ASSIGNMENT" => {
                let data = block.data.last();
                let interaction = data.map(|data| item(source, data, 2).to_uppercase());
                let surfaces = data.is_some_and(|data| !item(source, data, 0).is_empty());
                if surfaces || block.data.len() > 1 {
                    let message = "an interaction of certain surfaces isn't read; expected one for all: , , INTERACTION";
                    return Err(source.error(block.place, message));
                }
                if let Some(general) = &mut self.general {
                    general.interaction = interaction;
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// `*SURFACE BEHAVIOR`.
    fn behavior(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let law = block.parameter("PRESSURE-OVERCLOSURE").unwrap_or("HARD");
        let is_tied = law.eq_ignore_ascii_case("TIED");
        let stiffness = match law.eq_ignore_ascii_case("LINEAR") {
            true => Some(linear(places, block)?),
            false => None,
        };
        let soft = soft(places, block)?;
        let interaction = self.interaction(places, block)?;
        (interaction.soft, interaction.is_tied) = (soft, is_tied);
        interaction.law.stiffness = stiffness;
        Ok(())
    }

    /// The interaction to which a block belongs.
    fn interaction(
        &mut self,
        places: &Places,
        block: &Block,
    ) -> Result<&mut Interaction, InputError> {
        let open = self
            .open
            .as_ref()
            .and_then(|name| self.interactions.get_mut(name));
        open.ok_or_else(|| {
            let message = format!(
                "*{} belongs to nothing; expected *SURFACE INTERACTION before it",
                block.keyword
            );
            places.source.error(block.place, message)
        })
    }

    fn pairs(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        let interaction = source.required(block, "INTERACTION")?.to_uppercase();
        let adjust = adjust(places, block)?;
        for data in &block.data {
            let [slave, master] = [0, 1].map(|place| item(source, data, place).to_uppercase());
            if master.is_empty() || slave == master {
                let message = format!(
                    "the contact of '{}' with itself isn't read; expected two surfaces, the slave's first",
                    name::shown(&slave)
                );
                return Err(source.error(data.place, message));
            }
            places.check_surface(data.place, &slave)?;
            places.check_surface(data.place, &master)?;
            self.pairs.push(Pair {
                slave,
                master,
                interaction: interaction.clone(),
                place: data.place,
                adjust,
                gap: None,
                tied: block.parameter("TIED").is_some(),
            });
        }
        Ok(())
    }

    /// `*CLEARANCE`: the gap of a pair.
    fn clearance(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        let value = source.required(block, "VALUE")?;
        let gap = source.real(block.place, value, "the clearance")?;
        let [slave, master] =
            ["SLAVE", "MASTER"].map(|key| block.parameter(key).unwrap_or_default().to_uppercase());
        let pair = self
            .pairs
            .iter_mut()
            .find(|pair| pair.slave == slave && pair.master == master);
        match pair {
            Some(pair) => pair.gap = Some(gap),
            None => {
                let message = "there is no *CONTACT PAIR of this SLAVE and MASTER before this line";
                return Err(source.error(block.place, message));
            }
        }
        Ok(())
    }

    /// The law of a pair, and with `warnings` what it was taken for.
    pub(super) fn law_of(
        &self,
        places: &Places,
        pair: &Pair,
        warnings: &mut Vec<String>,
    ) -> Result<ContactLaw, InputError> {
        self.law(places, pair.place, &pair.interaction, warnings)
    }

    /// Whether the sides of a pair hang together.
    pub(super) fn is_tied(&self, pair: &Pair) -> bool {
        let interaction = self.interactions.get(&pair.interaction);
        pair.tied || interaction.is_some_and(|interaction| interaction.is_tied)
    }

    /// The law of general contact; `None` without any.
    pub(super) fn general(
        &self,
        places: &Places,
        warnings: &mut Vec<String>,
    ) -> Result<Option<ContactLaw>, InputError> {
        let Some(general) = &self.general else {
            return Ok(None);
        };
        match &general.interaction {
            Some(name) => self.law(places, general.place, name, warnings).map(Some),
            None => Ok(Some(ContactLaw::default())),
        }
    }

    fn law(
        &self,
        places: &Places,
        at: LinePlace,
        name: &str,
        warnings: &mut Vec<String>,
    ) -> Result<ContactLaw, InputError> {
        let Some(interaction) = self.interactions.get(name) else {
            let message = format!("there is no *SURFACE INTERACTION '{}'", name::shown(name));
            return Err(places.source.error(at, message));
        };
        if let Some(soft) = interaction
            .soft
            .as_ref()
            .filter(|soft| !warnings.contains(soft))
        {
            warnings.push(soft.clone());
        }
        Ok(interaction.law)
    }
}

/// What `ADJUST` says, a distance or a set of nodes.
fn adjust(places: &Places, block: &Block) -> Result<Option<Adjust>, InputError> {
    let source = places.source;
    let Some(item) = block.parameter("ADJUST") else {
        return Ok(None);
    };
    if item.starts_with(char::is_alphabetic) {
        return Ok(Some(Adjust::Set));
    }
    let distance = source.real(block.place, item, "a distance, or a set of nodes")?;
    match distance >= 0.0 {
        true => Ok(Some(Adjust::Within(distance))),
        false => {
            let message =
                format!("*CONTACT PAIR: ADJUST is {distance}; expected a distance of at least 0");
            Err(source.error(block.place, message))
        }
    }
}

/// The slope of a linear law of a `*SURFACE BEHAVIOR`.
fn linear(places: &Places, block: &Block) -> Result<f64, InputError> {
    let source = places.source;
    let given = block
        .data
        .first()
        .map(|data| (data.place, item(source, data, 0)));
    let (place, text) = given.unwrap_or((block.place, ""));
    let slope = source.real(place, text, "the slope of pressure over overclosure")?;
    match slope > 0.0 {
        true => Ok(slope),
        false => {
            let message =
                format!("the slope of pressure over overclosure is {slope}; expected more than 0");
            Err(source.error(place, message))
        }
    }
}

/// Softness of a `*SURFACE BEHAVIOR` that is taken as hard, in words.
fn soft(places: &Places, block: &Block) -> Result<Option<String>, InputError> {
    let source = places.source;
    let law = block
        .parameter("PRESSURE-OVERCLOSURE")
        .unwrap_or("HARD")
        .to_uppercase();
    let number = |place| {
        let data = block.data.first();
        data.map_or("", |data| item(source, data, place)).to_owned()
    };
    let softness = match law.as_str() {
        "HARD" | "LINEAR" => return Ok(None),
        "EXPONENTIAL" => format!("p0 = {} at no clearance, 0 at {}", number(1), number(0)),
        "TABULAR" => "a table of pressures over overclosures".into(),
        "TIED" => {
            return Ok(Some(format!(
                "{}: the stiffness {} of what is tied is left out: sides don't move against each other",
                source.place(block.place),
                number(0)
            )));
        }
        _ => {
            let message = format!(
                "PRESSURE-OVERCLOSURE={} isn't read; expected HARD or LINEAR",
                name::shown(&law)
            );
            return Err(source.error(block.place, message));
        }
    };
    Ok(Some(format!(
        "{}: the {} law of contact ({softness}) is taken as hard contact, whose sides don't overlap",
        source.place(block.place),
        law.to_lowercase()
    )))
}
