//! Pairs of surfaces on their way to contacts and ties of the scene.

use super::connections::SceneTie;
use super::contacts::Adjust;
use super::content::Content;
use super::document::{Document, Names, quoted};
use super::place::Places;
use crate::error::InputError;

impl Content {
    /// Writes the contacts and ties, of which those of pairs have names.
    pub(super) fn contact(
        &self,
        places: &Places,
        (sides, names, ties): (&[[String; 2]], &[String], Vec<SceneTie>),
        taken: &mut Names,
        (document, warnings): (&mut Document, &mut Vec<String>),
    ) -> Result<(), InputError> {
        let mut tied = Vec::new();
        let pairs = self.contacts.pairs.iter().zip(sides).zip(names);
        for ((pair, [slave, master]), name) in pairs {
            if self.contacts.is_tied(pair) {
                self.contacts.law_of(places, pair, warnings)?;
                tied.push(SceneTie {
                    name: name.clone(),
                    sides: [slave.clone(), master.clone()],
                    tolerance: None,
                    adjust: pair.adjust.is_some(),
                });
                continue;
            }
            let law = self.contacts.law_of(places, pair, warnings)?;
            document.table("[[contact]]");
            document.key("name", quoted(name));
            document.key("sides", format!("[{}, {}]", quoted(slave), quoted(master)));
            match (pair.gap, pair.adjust) {
                (Some(gap), _) => document.key("gap", format!("{gap:?}")),
                (None, Some(Adjust::Within(distance))) => {
                    document.key("adjust", format!("{distance:?}"));
                }
                (None, Some(Adjust::Set)) => {
                    let place = places.source.place(pair.place);
                    warnings.push(format!(
                        "{place}: ADJUST is left out: no node is moved, and gaps are those of the mesh"
                    ));
                }
                (None, None) => {}
            }
            law.write(document);
        }
        for tie in &ties {
            tie.write(&taken.unique(&tie.name), document);
        }
        for tie in &tied {
            tie.write(&tie.name, document);
        }
        if let Some(law) = self.contacts.general(places, warnings)? {
            document.table("[[contact]]");
            document.key("name", quoted("contact"));
            document.key("between", quoted("all"));
            law.write(document);
        }
        Ok(())
    }
}
