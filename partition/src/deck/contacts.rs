//! `*CONTACT PAIR`, `*SURFACE INTERACTION` with its subordinate keywords, and general contact.

use std::collections::BTreeMap;
use std::ops::Range;

use super::behavior::{linear, soft};
use super::document::Document;
use super::friction::Friction;
use super::loads::item;
use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace};
use crate::name;

/// The contact law between two surfaces, in the syntax of a scene.
#[derive(Clone, Copy, Default)]
pub(super) struct ContactLaw {
    /// Coefficient of friction.
    friction: f64,
    /// Pressure over overclosure; `None` for hard contact.
    stiffness: Option<f64>,
    /// Shear stress over tangential displacement of sticking points.
    stick_slope: Option<f64>,
}

impl ContactLaw {
    /// Writes the keys of a contact with this law.
    pub(super) fn write(&self, document: &mut Document) {
        if self.friction != 0.0 {
            document.key("friction", format!("{:?}", self.friction));
        }
        let stick_slope = self.stick_slope.filter(|_| self.friction != 0.0);
        match (self.stiffness, stick_slope) {
            (None, _) => {}
            (Some(normal), None) => document.key("stiffness", format!("{{ normal = {normal:?} }}")),
            (Some(normal), Some(slope)) => document.key(
                "stiffness",
                format!("{{ normal = {normal:?}, tangential = {slope:?} }}"),
            ),
        }
    }
}

/// A surface interaction, valid from a step on.
#[derive(Clone, Default)]
struct Interaction {
    /// The step, counted from 0.
    from: usize,
    law: ContactLaw,
    /// Description of a softened law replaced by hard contact.
    soft: Option<String>,
    /// True if the sides are tied.
    is_tied: bool,
}

/// The contact law of a pair in some steps.
pub(super) struct LawInSteps {
    pub(super) law: ContactLaw,
    /// True if its sides are tied.
    pub(super) is_tied: bool,
    pub(super) steps: Range<usize>,
}

/// A pair of surfaces, with names in capitals.
pub(super) struct Pair {
    pub(super) slave: String,
    pub(super) master: String,
    interaction: String,
    pub(super) place: LinePlace,
    /// Slave nodes to be moved onto the master.
    pub(super) adjust: Option<Adjust>,
    pub(super) gap: Option<f64>,
    /// True if the pair is declared as tied.
    tied: bool,
}

/// The slave nodes that `ADJUST` moves.
#[derive(Clone, Copy)]
pub(super) enum Adjust {
    /// The slave nodes within this distance of the master, and all that overlap it.
    Within(f64),
    /// The nodes of a set.
    Set,
}

/// General contact between all bodies.
struct General {
    place: LinePlace,
    interaction: Option<String>,
}

/// All contacts of a deck.
#[derive(Default)]
pub(super) struct Contacts {
    /// Interactions by name, for each name at least one, in the order of their steps.
    interactions: BTreeMap<String, Vec<Interaction>>,
    /// The interaction being read, by name in capitals.
    open: Option<String>,
    pub(super) pairs: Vec<Pair>,
    general: Option<General>,
}

impl Contacts {
    /// True if there is no contact.
    pub(super) fn is_empty(&self) -> bool {
        self.pairs.is_empty() && self.general.is_none()
    }

    /// True if any contact has friction.
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
        let mut laws = named
            .filter_map(|name| self.interactions.get(name))
            .flatten();
        laws.any(|interaction| interaction.law.friction != 0.0)
    }

    /// Reads a block on contacts.
    pub(super) fn read(
        &mut self,
        places: &Places,
        block: &Block,
        step: Option<usize>,
    ) -> Result<(), InputError> {
        let source = places.source;
        match block.keyword.as_str() {
            "SURFACE INTERACTION" => {
                let name = source.required(block, "NAME")?.to_uppercase();
                let first = vec![Interaction::default()];
                self.interactions.insert(name.clone(), first);
                self.open = Some(name);
            }
            "CHANGE FRICTION" | "CHANGE SURFACE BEHAVIOR" => self.change(places, block, step)?,
            "SURFACE BEHAVIOR" => self.behavior(places, block)?,
            "FRICTION" => self.friction(places, block)?,
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

    /// `*FRICTION`.
    fn friction(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let friction = Friction::read(places.source, block)?;
        let law = &mut self.interaction(places, block)?.law;
        law.friction = friction.coefficient;
        law.stick_slope = friction.stick_slope;
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

    /// `*CHANGE FRICTION` and `*CHANGE SURFACE BEHAVIOR`: the following blocks define the law from a `step` on.
    fn change(
        &mut self,
        places: &Places,
        block: &Block,
        step: Option<usize>,
    ) -> Result<(), InputError> {
        let source = places.source;
        let name = source.required(block, "INTERACTION")?.to_uppercase();
        let message = match (step, self.interactions.get_mut(&name)) {
            (None, _) => format!(
                "*{} stands in no step; expected it behind *STEP",
                block.keyword
            ),
            (_, None) => format!("there is no *SURFACE INTERACTION '{}'", name::shown(&name)),
            (Some(from), Some(all)) => {
                let before = all.last().cloned().unwrap_or_default();
                if before.from < from {
                    all.push(Interaction { from, ..before });
                }
                self.open = Some(name);
                return Ok(());
            }
        };
        Err(source.error(block.place, message))
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
            .and_then(|name| self.interactions.get_mut(name)?.last_mut());
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
            self.pairs.push(Pair {
                slave: places.surface(data.place, &slave)?,
                master: places.surface(data.place, &master)?,
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

    /// The laws of a pair in `steps` steps, with `warnings` for replaced laws.
    pub(super) fn laws_of(
        &self,
        places: &Places,
        pair: &Pair,
        steps: usize,
        warnings: &mut Vec<String>,
    ) -> Result<Vec<LawInSteps>, InputError> {
        let all = self.of_name(places, pair.place, &pair.interaction)?;
        let ends = all.iter().skip(1).map(|next| next.from).chain([steps]);
        let law = |(of, end): (&Interaction, usize)| LawInSteps {
            law: of.law_with(warnings),
            is_tied: pair.tied || of.is_tied,
            steps: of.from..end,
        };
        Ok(all.iter().zip(ends).map(law).collect())
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
        let Some(name) = &general.interaction else {
            return Ok(Some(ContactLaw::default()));
        };
        match self.of_name(places, general.place, name)? {
            [of] => Ok(Some(of.law_with(warnings))),
            _ => {
                let message = "the interaction of *CONTACT changes in a step, which isn't supported; expected one law, or a \
                               *CONTACT PAIR";
                Err(places.source.error(general.place, message))
            }
        }
    }

    /// The interactions of a name.
    fn of_name(
        &self,
        places: &Places,
        at: LinePlace,
        name: &str,
    ) -> Result<&[Interaction], InputError> {
        self.interactions
            .get(name)
            .map(Vec::as_slice)
            .ok_or_else(|| {
                let message = format!("there is no *SURFACE INTERACTION '{}'", name::shown(name));
                places.source.error(at, message)
            })
    }
}

impl Interaction {
    /// The contact law, with `warnings` for replaced laws.
    fn law_with(&self, warnings: &mut Vec<String>) -> ContactLaw {
        let soft = self.soft.iter().filter(|soft| !warnings.contains(soft));
        let soft: Vec<String> = soft.cloned().collect();
        warnings.extend(soft);
        self.law
    }
}

/// The value of `ADJUST`, a distance or a set of nodes.
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
