//! Translation of pairs of surfaces to contacts and ties of the scene.

use super::activation::Activation;
use super::contacts::{Adjust, Pair};
use super::content::Content;
use super::document::{Document, Names, quoted};
use super::place::Places;
use super::ties::SceneTie;
use crate::error::InputError;

impl Content {
    /// Writes the contacts and ties, where those of pairs have `names`, and returns the ones that aren't active in all
    /// steps.
    pub(super) fn contact(
        &self,
        places: &Places,
        (sides, names, ties): (&[[String; 2]], &[String], &[SceneTie]),
        taken: &mut Names,
        (document, warnings): (&mut Document, &mut Vec<String>),
    ) -> Result<Vec<Activation>, InputError> {
        let count = self.steps.done.len();
        let (mut tied, mut passing) = (Vec::new(), Vec::new());
        let pairs = self.contacts.pairs.iter().zip(sides).zip(names);
        for (number, ((pair, sides), name)) in pairs.enumerate() {
            let is_there = self.changes.of_pair(number, count);
            let mut name = Some(name.clone());
            for of in self.contacts.laws_of(places, pair, count, warnings)? {
                let steps: Vec<bool> = (0..count)
                    .map(|k| of.steps.contains(&k) && is_there[k])
                    .collect();
                // A pair that is never active becomes a contact all the same.
                let is_last_chance = of.steps.end == count && name.is_some();
                if !(steps.contains(&true) || is_last_chance) {
                    continue;
                }
                let name = name
                    .take()
                    .unwrap_or_else(|| taken.unique(&pair.plain_name()));
                let comes = steps.windows(2).any(|pair| pair == [false, true]);
                if of.is_tied {
                    tied.push(SceneTie {
                        name: name.clone(),
                        sides: sides.clone(),
                        tolerance: None,
                        adjust: pair.adjust.is_some(),
                    });
                } else {
                    pair.write((&name, sides), places, (document, warnings));
                    of.law.write(document);
                    if comes {
                        document.key("absolute", "true");
                    }
                }
                if steps.contains(&false) {
                    passing.push(Activation { name, steps });
                }
            }
        }
        for tie in ties {
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
        Ok(passing)
    }
}

impl Pair {
    /// The name of its contact unless another one has it.
    pub(super) fn plain_name(&self) -> String {
        format!("{} on {}", self.slave, self.master)
    }

    /// Writes its contact without the law.
    fn write(
        &self,
        (name, [slave, master]): (&str, &[String; 2]),
        places: &Places,
        (document, warnings): (&mut Document, &mut Vec<String>),
    ) {
        document.table("[[contact]]");
        document.key("name", quoted(name));
        document.key("sides", format!("[{}, {}]", quoted(slave), quoted(master)));
        match (self.gap, self.adjust) {
            (Some(gap), _) => document.key("gap", format!("{gap:?}")),
            (None, Some(Adjust::Within(distance))) => {
                document.key("adjust", format!("{distance:?}"));
            }
            (None, Some(Adjust::Set)) => {
                let place = places.source.place(self.place);
                let warning = format!(
                    "{place}: ADJUST is left out: no node is moved, and gaps are those of the mesh"
                );
                if !warnings.contains(&warning) {
                    warnings.push(warning);
                }
            }
            (None, None) => {}
        }
    }
}
