//! Supports, forces and temperatures of a step: those of earlier steps, with the changes of the step.

use std::collections::{BTreeMap, BTreeSet};

use super::place::Places;
use super::reference::{NodeAxis, Reference};
use super::table::{Origin, Table};
use crate::element::geometry::{cross, difference, length, unit};
use crate::error::InputError;
use crate::mesh::abaqus::{Data, LinePlace, Of, Source};
use crate::name;

/// Difference of unit vectors, and relative one of points, that is round-off: CalculiX' bound.
const SAME: f64 = 1e-10;

/// A load of magnitude 1 on the volume of elements.
#[derive(Clone, PartialEq)]
pub(super) struct BodyLoad {
    /// Names of the elements and of the kind in the deck, in capitals: a load with the same names, direction and axis
    /// replaces it in a later step, any other is added.
    target: String,
    pub(super) label: String,
    pub(super) elements: Vec<u32>,
    pub(super) kind: BodyKind,
}

/// A field of forces of magnitude 1.
#[derive(Clone, PartialEq)]
pub(super) enum BodyKind {
    /// Per volume, along an axis.
    Along(usize),
    /// Per mass, in a direction.
    Gravity([f64; 3]),
    /// Per mass, away from an axis through a point in a direction.
    Centrifugal([f64; 3], [f64; 3]),
}

/// A line of `*CLOAD` or `*BOUNDARY`.
pub(super) struct NodeLine {
    pub(super) place: LinePlace,
    pub(super) nodes: Vec<u32>,
    /// The degrees of freedom, from 0.
    pub(super) axes: Vec<usize>,
    /// Force or displacement.
    pub(super) value: f64,
    pub(super) is_force: bool,
}

/// All loads and supports.
#[derive(Default)]
pub(super) struct Loads {
    pub(super) supports: Table<NodeAxis>,
    pub(super) forces: Table<NodeAxis>,
    /// Pressures on faces of elements.
    pub(super) faces: Table<(u32, usize)>,
    /// Pressures and tractions on surfaces, by name in capitals; tractions also by the number of their direction.
    pub(super) surfaces: Table<String>,
    pub(super) tractions: Table<(String, usize)>,
    pub(super) directions: Vec<[f64; 3]>,
    /// Magnitudes of body loads by their number.
    pub(super) bodies: Table<usize>,
    pub(super) of_bodies: Vec<BodyLoad>,
    pub(super) temperatures: Table<u32>,
    /// Nodes that represent reference points.
    pub(super) references: BTreeMap<u32, Reference>,
    /// Displacements fixed at their current value, of pretensions their shortening.
    pub(super) fixed: BTreeSet<NodeAxis>,
    /// The lines of `*CLOAD` and `*BOUNDARY`.
    pub(super) lines: Vec<NodeLine>,
    /// Descriptions of irrelevant parts of the input.
    pub(super) notes: BTreeSet<String>,
}

impl Loads {
    /// A line of `*DLOAD`: elements, the kind of the load, its magnitude.
    pub(super) fn distributed(
        &mut self,
        places: &mut Places,
        data: &Data,
        origin: &Origin,
    ) -> Result<(), InputError> {
        let source = places.source;
        let target = item(source, data, 0);
        let label = item(source, data, 1).to_uppercase();
        let elements = places.members(data.place, Of::Elements, target)?;
        let dim = places.dim();
        if !elements.iter().any(|&element| places.is_cell(element, dim)) {
            let message = format!(
                "the set {} has no solid elements, so its load acts on nothing; expected one of solids",
                name::shown(target)
            );
            return Err(source.error(data.place, message));
        }
        let value = source.real(data.place, item(source, data, 2), "the magnitude of a load")?;
        let origin = Origin {
            place: data.place,
            ..origin.clone()
        };
        if let Some(number) = label
            .strip_prefix('P')
            .and_then(|number| number.parse::<usize>().ok())
        {
            for &element in &elements {
                let faces = places.deck.elements.kind(element as usize).facets().len();
                if !places.is_cell(element, places.dim()) || !(1..=faces).contains(&number) {
                    let tag = places.deck.element_tags[element as usize];
                    let message = format!(
                        "element {tag} has no face {label}; expected P1 to P{faces} of a solid"
                    );
                    return Err(source.error(data.place, message));
                }
                self.faces.add((element, number), value, &origin);
            }
            return Ok(());
        }
        let kind = BodyKind::read(source, data, &label)?;
        let load = BodyLoad {
            target: target.to_uppercase(),
            label,
            elements,
            kind,
        };
        let replaces = |number: &usize| {
            let other = &self.of_bodies[*number];
            other.target == load.target && other.kind.is_along(&load.kind)
        };
        self.bodies.forget(origin.step, replaces);
        let number = (self.of_bodies.iter()).position(|known| *known == load);
        let number = number.unwrap_or_else(|| {
            self.of_bodies.push(load);
            self.of_bodies.len() - 1
        });
        self.bodies.add(number, value, &origin);
        Ok(())
    }

    /// A line of `*DSLOAD`: a surface, `P` or `TRVEC`, the magnitude, and the direction of a traction.
    pub(super) fn on_surface(
        &mut self,
        places: &mut Places,
        data: &Data,
        origin: &Origin,
    ) -> Result<(), InputError> {
        let source = places.source;
        let surface = places.surface(data.place, item(source, data, 0))?;
        let label = item(source, data, 1).to_uppercase();
        let value = source.real(data.place, item(source, data, 2), "the magnitude of a load")?;
        let origin = Origin {
            place: data.place,
            ..origin.clone()
        };
        match label.as_str() {
            "P" => self.surfaces.add(surface, value, &origin),
            "TRVEC" => {
                let direction = vector(source, data, 3, "a direction")?;
                let Some(direction) = unit(direction) else {
                    let message = "TRVEC has no direction; expected one that isn't zero";
                    return Err(source.error(data.place, message));
                };
                let number = self.directions.iter().position(|known| *known == direction);
                let number = number.unwrap_or_else(|| {
                    self.directions.push(direction);
                    self.directions.len() - 1
                });
                self.tractions
                    .forget(origin.step, |(other, _)| *other == surface);
                self.tractions.add((surface, number), value, &origin);
            }
            _ => {
                let message = format!(
                    "a load {} of *DSLOAD isn't read; expected P or TRVEC",
                    name::shown(&label)
                );
                return Err(source.error(data.place, message));
            }
        }
        Ok(())
    }

    /// A line of `*TEMPERATURE`: a node or set, and its temperature.
    pub(super) fn temperature(
        &mut self,
        places: &mut Places,
        data: &Data,
        origin: &Origin,
    ) -> Result<(), InputError> {
        let source = places.source;
        let nodes = places.members(data.place, Of::Nodes, item(source, data, 0))?;
        let value = source.real(data.place, item(source, data, 1), "a temperature")?;
        let origin = Origin {
            place: data.place,
            ..origin.clone()
        };
        nodes
            .into_iter()
            .for_each(|node| self.temperatures.set(node, value, &origin));
        Ok(())
    }
}

impl BodyKind {
    /// The kind of a load on elements, by its label.
    fn read(source: &Source, data: &Data, label: &str) -> Result<Self, InputError> {
        let kind = match label {
            "BX" | "BY" | "BZ" => Self::Along(usize::from(label.as_bytes()[1] - b'X')),
            "GRAV" => Self::Gravity(vector(source, data, 3, "a direction")?),
            "CENTRIF" => Self::Centrifugal(
                vector(source, data, 3, "a point on the axis")?,
                vector(source, data, 6, "the direction of the axis")?,
            ),
            _ => {
                let message = format!(
                    "a load {} of *DLOAD isn't read; expected P1 to P6, GRAV, CENTRIF, BX, BY or BZ",
                    name::shown(label)
                );
                return Err(source.error(data.place, message));
            }
        };
        kind.normalized().ok_or_else(|| {
            source.error(
                data.place,
                format!("{label} has no direction; expected one that isn't zero"),
            )
        })
    }

    /// True for a field along the same direction, or around the same axis, in whichever of its points it is given.
    fn is_along(&self, other: &Self) -> bool {
        let differs = |one, other| length(difference(one, other)) > SAME;
        match (self, other) {
            (Self::Along(one), Self::Along(other)) => one == other,
            (Self::Gravity(one), Self::Gravity(other)) => !differs(*one, *other),
            (Self::Centrifugal(one, axis), Self::Centrifugal(other, other_axis)) => {
                let apart = length(cross(difference(*one, *other), *axis));
                let is_one = apart <= SAME * length(*one).max(length(*other));
                is_one && length(cross(*axis, *other_axis)) <= SAME
            }
            _ => false,
        }
    }

    /// The load with unit vectors as directions; `None` if one has length zero.
    fn normalized(self) -> Option<Self> {
        Some(match self {
            Self::Along(axis) => Self::Along(axis),
            Self::Gravity(direction) => Self::Gravity(unit(direction)?),
            Self::Centrifugal(point, axis) => Self::Centrifugal(point, unit(axis)?),
        })
    }
}

/// An item of a line of data, empty if missing.
pub(super) fn item<'a>(source: &'a Source, data: &'a Data, place: usize) -> &'a str {
    source.items(data).nth(place).unwrap_or_default()
}

/// Three numbers of a line, from the item `from` on.
fn vector(source: &Source, data: &Data, from: usize, what: &str) -> Result<[f64; 3], InputError> {
    let mut vector = [0.0; 3];
    for (place, component) in (from..).zip(&mut vector) {
        *component = source.real(data.place, item(source, data, place), what)?;
    }
    Ok(vector)
}
