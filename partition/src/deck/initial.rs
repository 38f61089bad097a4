//! `*INITIAL CONDITIONS`: temperatures of nodes, stresses of elements.

use std::collections::BTreeMap;

use super::loads::item;
use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Data, Of};
use crate::name;
use crate::scene::material::PlaneState;

/// A stress xx, yy, zz, xy, xz, yz.
type Stress = [f64; 6];

/// Initial stresses and temperatures.
#[derive(Default)]
pub(super) struct Initial {
    /// Temperatures of nodes.
    pub(super) temperatures: BTreeMap<u32, f64>,
    /// Stresses of elements.
    stresses: BTreeMap<u32, Stress>,
}

impl Initial {
    /// Reads a block.
    pub(super) fn read(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        let kind = source.required(block, "TYPE")?;
        let is_stress = kind.eq_ignore_ascii_case("STRESS");
        if !is_stress && !kind.eq_ignore_ascii_case("TEMPERATURE") {
            let message = format!(
                "*INITIAL CONDITIONS of TYPE={} isn't read; expected TEMPERATURE or STRESS",
                name::shown(kind)
            );
            return Err(source.error(block.place, message));
        }
        for data in &block.data {
            if is_stress {
                self.stress(places, data)?;
                continue;
            }
            let value = source.real(data.place, item(source, data, 1), "a temperature")?;
            for node in places.members(data.place, Of::Nodes, item(source, data, 0))? {
                self.temperatures.insert(node, value);
            }
        }
        Ok(())
    }

    /// Reads a line of stresses: elements, in CalculiX with an integration point, and the components.
    fn stress(&mut self, places: &mut Places, data: &Data) -> Result<(), InputError> {
        let source = places.source;
        let from = source.items(data).count().saturating_sub(6).max(1);
        let mut stress = [0.0; 6];
        for (place, component) in (from..).zip(&mut stress) {
            *component = source.real(data.place, item(source, data, place), "a stress")?;
        }
        for element in places.members(data.place, Of::Elements, item(source, data, 0))? {
            let known = *self.stresses.entry(element).or_insert(stress);
            if from > 1 && known != stress {
                let message = format!(
                    "the stress isn't the same at all points of element {}, which isn't supported; instead give the mean, or \
                     convert the deck and give expressions of x, y and z as initial_stress",
                    places.deck.element_tags[element as usize]
                );
                return Err(source.error(data.place, message));
            }
            self.stresses.insert(element, stress);
        }
        Ok(())
    }

    /// The stress of an element.
    pub(super) fn stress_of(&self, element: u32) -> Stress {
        self.stresses.get(&element).copied().unwrap_or_default()
    }
}

/// The components of a stress in a scene.
pub(super) fn in_scene(stress: Stress, plane: Option<PlaneState>) -> Vec<f64> {
    let [xx, yy, zz, xy, xz, yz] = stress;
    match plane {
        None => vec![xx, yy, zz, yz, xz, xy],
        Some(PlaneState::Stress) => vec![xx, yy, xy],
        Some(PlaneState::Strain | PlaneState::Axisymmetric) => vec![xx, yy, zz, xy],
    }
}
