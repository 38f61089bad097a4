//! `*MODEL CHANGE`: contact pairs and elements that steps add and remove.

use super::contacts::Pair;
use super::loads::item;
use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Of};
use crate::name;

/// Pairs or elements that are added or removed.
struct Change {
    /// The step, counted from 0.
    step: usize,
    of: Changed,
    /// True if they are added.
    comes: bool,
}

/// A pair or a set of elements that is added or removed.
enum Changed {
    /// A contact pair, by its index.
    Pair(usize),
    /// Elements, ascending.
    Elements(Vec<u32>),
}

/// All changes of a deck.
#[derive(Default)]
pub(super) struct Changes(Vec<Change>);

impl Changes {
    /// Reads a block in a `step`, `None` outside of steps.
    ///
    /// # Errors
    /// Types other than pairs and elements, or a missing pair; elements that are added with strain.
    pub(super) fn read(
        &mut self,
        places: &mut Places,
        block: &Block,
        pairs: &[Pair],
        step: Option<usize>,
    ) -> Result<(), InputError> {
        let source = places.source;
        let refuse = |message: String| Err(source.error(block.place, message));
        let Some(step) = step else {
            return refuse("*MODEL CHANGE stands in no step; expected it behind *STEP".into());
        };
        let kind = source.required(block, "TYPE")?.to_uppercase();
        let is_pair = kind == "CONTACT PAIR";
        if !is_pair && kind != "ELEMENT" {
            let kind = name::shown(&kind);
            return refuse(format!(
                "*MODEL CHANGE of TYPE={kind} isn't read; expected CONTACT PAIR or ELEMENT"
            ));
        }
        let comes = match [block.parameter("ADD"), block.parameter("REMOVE")] {
            [Some(how), None] if !how.eq_ignore_ascii_case("WITH STRAIN") => true,
            [None, Some(_)] => false,
            [Some(_), None] => {
                return refuse(
                    "*MODEL CHANGE with ADD=WITH STRAIN isn't read; expected ADD: added elements are free of stress".into(),
                );
            }
            _ => {
                return refuse(
                    "*MODEL CHANGE with neither or both of ADD and REMOVE; expected one of them"
                        .into(),
                );
            }
        };
        let mut elements = Vec::new();
        for data in &block.data {
            if !is_pair {
                for set in source.items(data) {
                    elements.extend(places.members(data.place, Of::Elements, set)?);
                }
                continue;
            }
            let [slave, master] = [0, 1].map(|place| item(source, data, place).to_uppercase());
            let is_it = |pair: &Pair| pair.slave == slave && pair.master == master;
            let pair = pairs.iter().position(is_it).ok_or_else(|| {
                let message = "there is no *CONTACT PAIR of this slave and master before this line";
                source.error(data.place, message)
            })?;
            let of = Changed::Pair(pair);
            self.0.push(Change { step, of, comes });
        }
        elements.sort_unstable();
        if !elements.is_empty() {
            let of = Changed::Elements(elements);
            self.0.push(Change { step, of, comes });
        }
        Ok(())
    }

    /// True if elements are added or removed.
    pub(super) fn have_elements(&self) -> bool {
        self.0
            .iter()
            .any(|change| matches!(change.of, Changed::Elements(_)))
    }

    /// Activation of a pair in each step.
    pub(super) fn of_pair(&self, pair: usize, steps: usize) -> Vec<bool> {
        self.course(
            steps,
            |of| matches!(of, Changed::Pair(other) if *other == pair),
        )
    }

    /// Activation of an element in each step.
    pub(super) fn of_element(&self, element: u32, steps: usize) -> Vec<bool> {
        self.course(steps, |of| match of {
            Changed::Elements(all) => all.binary_search(&element).is_ok(),
            Changed::Pair(_) => false,
        })
    }

    /// Activation in each step according to the changes for which `concerns` is true: active at first unless the first
    /// change is an addition.
    fn course(&self, steps: usize, concerns: impl Fn(&Changed) -> bool) -> Vec<bool> {
        let own: Vec<&Change> = self
            .0
            .iter()
            .filter(|change| concerns(&change.of))
            .collect();
        let at_first = own.first().is_none_or(|change| !change.comes);
        let before = |step: usize| own.iter().rfind(|change| change.step <= step);
        (0..steps)
            .map(|step| before(step).map_or(at_first, |change| change.comes))
            .collect()
    }
}
