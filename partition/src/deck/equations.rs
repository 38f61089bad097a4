//! `*EQUATION` and `*DISTRIBUTING COUPLING`.

use std::collections::BTreeMap;

use super::loads::item;
use super::place::Places;
use super::reference::NodeAxis;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace, Of};
use crate::name;

/// A linear equation between displacements with the right-hand side 0.
pub(super) struct Equation {
    pub(super) place: LinePlace,
    /// Nodes and axes, possibly local ones, with nonzero coefficients.
    pub(super) terms: Vec<(NodeAxis, f64)>,
}

/// The type of elements that define a set of one node for `*DISTRIBUTING COUPLING`.
const OF_POINTS: &str = "DCOUP3D";

/// All equations of a deck.
#[derive(Default)]
pub(super) struct Equations {
    pub(super) all: Vec<Equation>,
    /// Nodes of point elements by their set, whose name is in capitals.
    points: BTreeMap<String, Vec<u32>>,
}

impl Equations {
    /// Reads the nodes of a block of elements if these are point elements.
    pub(super) fn elements(
        &mut self,
        places: &mut Places,
        block: &Block,
    ) -> Result<(), InputError> {
        let source = places.source;
        if !source
            .required(block, "TYPE")?
            .eq_ignore_ascii_case(OF_POINTS)
        {
            return Ok(());
        }
        let set = block.parameter("ELSET").unwrap_or_default().to_uppercase();
        for data in &block.data {
            let nodes = places.members(data.place, Of::Nodes, item(source, data, 1))?;
            self.points.entry(set.clone()).or_default().extend(nodes);
        }
        Ok(())
    }

    /// `*EQUATION`.
    pub(super) fn read(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        let mut lines = block.data.iter();
        while let Some(head) = lines.next() {
            let count = source.real(head.place, item(source, head, 0), "the number of terms")?;
            let count = count as usize;
            let mut terms: Vec<(Vec<u32>, usize, f64)> = Vec::new();
            while terms.len() < count {
                let Some(line) = lines.next() else {
                    let message = format!("the equation has {} of its {count} terms", terms.len());
                    return Err(source.error(head.place, message));
                };
                for at in (0..).step_by(3) {
                    if item(source, line, at).is_empty() || terms.len() == count {
                        break;
                    }
                    let nodes = places.members(line.place, Of::Nodes, item(source, line, at))?;
                    let freedom = item(source, line, at + 1);
                    let axis = match freedom.parse::<usize>() {
                        Ok(freedom @ 1..=6) => freedom - 1,
                        _ => {
                            let freedom = name::shown(freedom);
                            let message = format!(
                                "the degree of freedom {freedom} is no displacement; expected 1 to {}, of reference nodes to 6",
                                places.dim()
                            );
                            return Err(source.error(line.place, message));
                        }
                    };
                    let factor = source.real(line.place, item(source, line, at + 2), "a factor")?;
                    terms.push((nodes, axis, factor));
                }
            }
            self.spread(places, head.place, &terms)?;
        }
        Ok(())
    }

    /// Adds an equation for every node of the single term that refers to a set.
    fn spread(
        &mut self,
        places: &Places,
        place: LinePlace,
        terms: &[(Vec<u32>, usize, f64)],
    ) -> Result<(), InputError> {
        let mut sets = terms.iter().filter(|(nodes, ..)| nodes.len() > 1);
        let set = sets.next();
        if sets.next().is_some() {
            let message =
                "an equation between several sets isn't read; expected nodes, and one set at most";
            return Err(places.source.error(place, message));
        }
        for i in 0..set.map_or(1, |(nodes, ..)| nodes.len()) {
            let of_term = |(nodes, axis, factor): &(Vec<u32>, usize, f64)| {
                let node = nodes.get(i).or(nodes.first()).copied();
                Some(((node?, *axis), *factor)).filter(|(_, factor)| *factor != 0.0)
            };
            self.all.push(Equation {
                place,
                terms: terms.iter().filter_map(of_term).collect(),
            });
        }
        Ok(())
    }

    /// `*DISTRIBUTING COUPLING`: the displacement of an element's node is the weighted average of those of others.
    pub(super) fn mean(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        let elements = source.required(block, "ELSET")?;
        let points = self.points.get(&elements.to_uppercase());
        let Some(&[reference]) = points.map(Vec::as_slice) else {
            let message = format!(
                "*DISTRIBUTING COUPLING: the set {} has {} elements of type {OF_POINTS}; expected one",
                name::shown(elements),
                points.map_or(0, Vec::len)
            );
            return Err(source.error(block.place, message));
        };
        let mut weights = Vec::new();
        for data in &block.data {
            let weight = source.real(data.place, item(source, data, 1), "a weight")?;
            let nodes = places.members(data.place, Of::Nodes, item(source, data, 0))?;
            weights.extend(nodes.into_iter().map(|node| (node, weight)));
        }
        let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
        if sum <= 0.0 {
            let message = "*DISTRIBUTING COUPLING: the sum of the weights is 0; expected nodes with positive weights";
            return Err(source.error(block.place, message));
        }
        for axis in 0..places.dim() {
            let of_nodes = weights.iter().filter(|(_, weight)| *weight != 0.0);
            let of_nodes = of_nodes.map(|&(node, weight)| ((node, axis), weight / sum));
            self.all.push(Equation {
                place: block.place,
                terms: of_nodes.chain([((reference, axis), -1.0)]).collect(),
            });
        }
        Ok(())
    }
}
