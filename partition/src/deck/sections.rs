//! `*SOLID SECTION`: bodies, sets of elements with one material and the same loads in all steps.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::activation::Activation;
use super::initial::Initial;
use super::loads::{Loads, item};
use super::model_change::Changes;
use super::place::Places;
use super::solids;
use super::steps::LoadStep;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace, Of};
use crate::name;

/// A section.
#[derive(Clone)]
pub(super) struct Section {
    elements: Vec<u32>,
    pub(super) set: String,
    /// Names in capitals.
    pub(super) material: String,
    pub(super) orientation: Option<String>,
    /// The orientation that the deck names; that of a part is another one in each instance.
    named: Option<String>,
    /// Thickness of plane elements; 1 by default.
    pub(super) thickness: f64,
    pub(super) place: LinePlace,
}

impl Section {
    pub(super) fn read(places: &mut Places, block: &Block) -> Result<Self, InputError> {
        let source = places.source;
        if block.parameter("COMPOSITE").is_some() {
            return Err(source.error(block.place, "a composite isn't read; expected MATERIAL=…"));
        }
        let set = source.required(block, "ELSET")?.to_owned();
        let elements = places.members(block.place, Of::Elements, &set)?;
        solids::check_section(places, block, &set, &elements)?;
        let thickness = match block.data.first() {
            Some(data) => source.real(data.place, item(source, data, 0), "the thickness")?,
            None => 0.0,
        };
        let orientation = block.parameter("ORIENTATION").map(str::to_uppercase);
        Ok(Self {
            elements,
            set,
            material: source.required(block, "MATERIAL")?.to_uppercase(),
            orientation: orientation.clone(),
            named: orientation,
            thickness: if thickness > 0.0 { thickness } else { 1.0 },
            place: block.place,
        })
    }

    /// True for a section of another block with other properties.
    fn contradicts(&self, other: &Self) -> bool {
        let differs = self.material != other.material
            || self.named != other.named
            || self.thickness != other.thickness;
        differs && self.place != other.place
    }

    /// The section restricted to `elements`, ascending, with another orientation.
    pub(super) fn turned(&self, elements: &[u32], orientation: &str) -> Self {
        let own = self.elements.iter().copied();
        Self {
            elements: own
                .filter(|element| elements.binary_search(element).is_ok())
                .collect(),
            orientation: Some(orientation.to_owned()),
            ..self.clone()
        }
    }
}

/// A body of the scene.
pub(super) struct Body {
    pub(super) cells: Vec<u32>,
    pub(super) section: usize,
    /// The loads that act on it in any step.
    pub(super) loads: BTreeSet<usize>,
    /// The temperature in every step, relative to the initial one.
    pub(super) warmth: Vec<f64>,
    /// True if its elements have a reduced integration.
    pub(super) is_reduced: bool,
    /// Their initial stress.
    pub(super) initial: [f64; 6],
    /// Activation of the elements in every step.
    steps: Vec<bool>,
}

impl Body {
    /// The steps in which a body is active; `None` if it is active in all.
    pub(super) fn activation(&self, name: &str) -> Option<Activation> {
        self.steps.contains(&false).then(|| Activation {
            name: name.to_owned(),
            steps: self.steps.clone(),
        })
    }
}

/// Classes of elements, refined by one property after the other.
struct Classes(Vec<Option<u32>>);

impl Classes {
    /// Splits classes into elements of equal `value`.
    fn refine(&mut self, mut value: impl FnMut(u32) -> u64) {
        let mut known: HashMap<(u32, u64), u32> = HashMap::new();
        for (element, class) in (0..).zip(&mut self.0) {
            if let Some(class) = class {
                let fresh = known.len() as u32;
                *class = *known.entry((*class, value(element))).or_insert(fresh);
            }
        }
    }

    /// Splits classes by the `loads` that act on each element in any of the steps.
    fn refine_by_loads(
        &mut self,
        loads: &Loads,
        steps: &[LoadStep],
    ) -> HashMap<u32, BTreeSet<usize>> {
        let numbers: BTreeSet<usize> = (steps.iter())
            .flat_map(|step| step.bodies.keys().copied())
            .collect();
        let mut acting: HashMap<u32, BTreeSet<usize>> = HashMap::new();
        for number in numbers {
            let members = loads.of_bodies[number].elements.iter().copied();
            let members: BTreeSet<u32> = members.collect();
            self.refine(|element| members.contains(&element).into());
            for element in members {
                acting.entry(element).or_default().insert(number);
            }
        }
        acting
    }

    /// The elements of every class.
    fn members(&self) -> BTreeMap<u32, Vec<u32>> {
        let mut members: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (element, class) in (0..).zip(&self.0) {
            if let Some(class) = class {
                members.entry(*class).or_default().push(element);
            }
        }
        members
    }
}

/// The bodies of a deck.
///
/// # Errors
/// An element without a section; temperatures that vary within an element with thermal expansion.
pub(super) fn bodies(
    places: &Places,
    sections: &[Section],
    expands: impl Fn(&Section) -> bool,
    (loads, steps, changes): (&Loads, &[LoadStep], &Changes),
    initial: &Initial,
) -> Result<Vec<Body>, InputError> {
    let section_of = sections_of_elements(places, sections)?;
    let mut classes = Classes(section_of.clone());
    let is_reduced = |element: u32| {
        let kind = places.deck.elements.kind(element as usize);
        places.deck.is_reduced[element as usize] && kind.reduced_points().is_some()
    };
    classes.refine(|element| is_reduced(element).into());
    (0..6).for_each(|k| classes.refine(|element| initial.stress_of(element)[k].to_bits()));
    let course = |element| changes.of_element(element, steps.len());
    let changing = (0..steps.len()).filter(|_| changes.have_elements());
    changing.for_each(|step| classes.refine(|element| course(element)[step].into()));
    let mut acting = classes.refine_by_loads(loads, steps);
    let mut warmth: HashMap<u32, Vec<f64>> = HashMap::new();
    for step in steps {
        let mut of_step = vec![0.0; section_of.len()];
        for (element, section) in (0..).zip(&section_of) {
            let Some(section) = section.map(|section| &sections[section as usize]) else {
                continue;
            };
            if expands(section) {
                of_step[element as usize] =
                    temperature_rise(places, element, step, &initial.temperatures)?;
            }
        }
        classes.refine(|element| of_step[element as usize].to_bits());
        for (element, value) in (0..)
            .zip(of_step)
            .filter(|(e, _)| section_of[*e as usize].is_some())
        {
            warmth.entry(element).or_default().push(value);
        }
    }
    let body = |cells: Vec<u32>| {
        let first = cells[0];
        Body {
            section: section_of[first as usize].unwrap_or_default() as usize,
            loads: acting.remove(&first).unwrap_or_default(),
            warmth: warmth.remove(&first).unwrap_or_default(),
            is_reduced: is_reduced(first),
            initial: initial.stress_of(first),
            steps: course(first),
            cells,
        }
    };
    Ok(classes.members().into_values().map(body).collect())
}

/// The section of every element that is a cell, by its number.
///
/// # Errors
/// A cell without a section, or with two that differ.
fn sections_of_elements(
    places: &Places,
    sections: &[Section],
) -> Result<Vec<Option<u32>>, InputError> {
    let dim = places.dim();
    let mut section_of: Vec<Option<u32>> = vec![None; places.deck.elements.len()];
    for (number, section) in (0..).zip(sections) {
        for &element in section
            .elements
            .iter()
            .filter(|&&element| places.is_cell(element, dim))
        {
            let before = section_of[element as usize].replace(number);
            let before = before.map(|before| &sections[before as usize]);
            if let Some(other) = before.filter(|before| section.contradicts(before)) {
                let message = format!(
                    "element {} has another *SOLID SECTION in {}; expected one for each element",
                    places.deck.element_tags[element as usize],
                    places.source.place(other.place)
                );
                return Err(places.source.error(section.place, message));
            }
        }
    }
    let mut elements = 0..section_of.len() as u32;
    if let Some(bare) =
        elements.find(|&e| places.is_cell(e, dim) && section_of[e as usize].is_none())
    {
        let tag = places.deck.element_tags[bare as usize];
        return Err(InputError::new(format!(
            "element {tag} has no *SOLID SECTION; expected one for each element"
        )));
    }
    Ok(section_of)
}

/// The temperature of an element relative to the initial one.
fn temperature_rise(
    places: &Places,
    element: u32,
    step: &LoadStep,
    initial: &BTreeMap<u32, f64>,
) -> Result<f64, InputError> {
    let warmth = |node: &u32| {
        let before = initial.get(node).copied().unwrap_or_default();
        step.temperatures.get(node).copied().unwrap_or(before) - before
    };
    let nodes = places.deck.elements.nodes_of(element as usize);
    let first = warmth(&nodes[0]);
    match nodes.iter().map(warmth).find(|&other| other != first) {
        None => Ok(first + 0.0),
        Some(other) => {
            let tag = places.deck.element_tags[element as usize];
            let message = format!(
                "the nodes of element {tag} are warmer than at the beginning by {first} and by {other} at the end of the \
                 step, which isn't supported yet; expected one temperature for each body, or the deck without it, converted, and \
                 an expression of x, y and z"
            );
            Err(places.source.error(step.place, message))
        }
    }
}

/// The thickness of the plane sections.
///
/// # Errors
/// Several thicknesses.
pub(super) fn thickness(places: &Places, sections: &[Section]) -> Result<f64, InputError> {
    let first = sections.first().map_or(1.0, |section| section.thickness);
    match sections.iter().find(|section| section.thickness != first) {
        None => Ok(first),
        Some(other) => {
            let message = format!(
                "the section of '{}' is {} thick, others {first}; expected one thickness, by which forces are divided",
                name::shown(&other.set),
                other.thickness
            );
            Err(places.source.error(other.place, message))
        }
    }
}
