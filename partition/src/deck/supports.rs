//! `*BOUNDARY`, and the concentrated forces that are written alike, `*CLOAD`.

use super::loads::{Loads, item};
use super::place::Places;
use super::table::Origin;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Data, Of};
use crate::name;

/// Words for supports, and the axes that they hold.
const WORDS: [(&str, &[usize]); 8] = [
    ("ENCASTRE", &[0, 1, 2]),
    ("PINNED", &[0, 1, 2]),
    ("XSYMM", &[0]),
    ("YSYMM", &[1]),
    ("ZSYMM", &[2]),
    ("XASYMM", &[1, 2]),
    ("YASYMM", &[0, 2]),
    ("ZASYMM", &[0, 1]),
];

/// Parameters of `*BOUNDARY` that say something else than displacements of nodes.
const REFUSED: [&str; 7] = [
    "FIXED",
    "USER",
    "SUBMODEL",
    "LOAD CASE",
    "STEP",
    "DATA SET",
    "REGION TYPE",
];

/// Degrees of freedom that are displacements, and the last that is a rotation.
const DISPLACEMENTS: i64 = 3;
const ROTATIONS: i64 = 6;

impl Loads {
    /// `*BOUNDARY`: a node or set, the first and the last degree of freedom, and a displacement.
    pub(super) fn boundary(
        &mut self,
        places: &mut Places,
        block: &Block,
        origin: &Origin,
    ) -> Result<(), InputError> {
        let source = places.source;
        let kind = block.parameter("TYPE").unwrap_or("DISPLACEMENT");
        let refused = REFUSED.iter().find(|key| block.parameter(key).is_some());
        if refused.is_some() || !kind.eq_ignore_ascii_case("DISPLACEMENT") {
            let what = refused.map_or(name::shown(kind), |key| (*key).to_owned());
            let message =
                format!("*BOUNDARY with {what} isn't read; expected displacements of nodes");
            return Err(source.error(block.place, message));
        }
        for data in &block.data {
            let origin = Origin {
                place: data.place,
                ..origin.clone()
            };
            let nodes = places.members(data.place, Of::Nodes, item(source, data, 0))?;
            let second = item(source, data, 1).to_uppercase();
            let value = source.real(data.place, item(source, data, 3), "a displacement")?;
            let axes: Vec<usize> = match WORDS.iter().find(|(word, _)| *word == second) {
                Some((_, axes)) => axes.to_vec(),
                None => self.axes(places, data, block)?,
            };
            for axis in axes.into_iter().filter(|&axis| axis < places.dim()) {
                nodes
                    .iter()
                    .for_each(|&node| self.supports.set((node, axis), value, &origin));
            }
        }
        Ok(())
    }

    /// The axes from the first degree of freedom of a line to its last.
    fn axes(
        &mut self,
        places: &Places,
        data: &Data,
        block: &Block,
    ) -> Result<Vec<usize>, InputError> {
        let source = places.source;
        let first = source.tag(data.place, item(source, data, 1), "a degree of freedom")?;
        let last = match item(source, data, 2) {
            "" => first,
            last => source.tag(data.place, last, "a degree of freedom")?,
        };
        if first > last || last > ROTATIONS {
            let message = format!(
                "*{} of the degrees of freedom {first} to {last}; expected displacements, 1 to {DISPLACEMENTS}",
                block.keyword
            );
            return Err(source.error(data.place, message));
        }
        if last > DISPLACEMENTS {
            let what = format!("*{}", block.keyword);
            self.notes.insert(format!(
                "{what} (degrees of freedom 4 to 6, which nodes of solids haven't)"
            ));
        }
        Ok((first..=last.min(DISPLACEMENTS))
            .map(|dof| dof as usize - 1)
            .collect())
    }

    /// `*CLOAD`: a node or set, a degree of freedom, and the force on each node.
    pub(super) fn concentrated(
        &mut self,
        places: &mut Places,
        block: &Block,
        origin: &Origin,
    ) -> Result<(), InputError> {
        let source = places.source;
        for data in &block.data {
            let origin = Origin {
                place: data.place,
                ..origin.clone()
            };
            let nodes = places.members(data.place, Of::Nodes, item(source, data, 0))?;
            let dof = source.tag(data.place, item(source, data, 1), "a degree of freedom")?;
            let force = source.real(data.place, item(source, data, 2), "a force")?;
            let axis = dof as usize - 1;
            if axis >= places.dim() && force != 0.0 {
                let message = format!(
                    "*CLOAD on the degree of freedom {dof}; expected forces along 1 to {}: nodes of solids take no moments",
                    places.dim()
                );
                return Err(source.error(data.place, message));
            }
            nodes
                .iter()
                .for_each(|&node| self.forces.add((node, axis), force, &origin));
        }
        Ok(())
    }
}
