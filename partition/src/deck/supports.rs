//! `*BOUNDARY`, and concentrated forces, `*CLOAD`, which have the same syntax.

use super::loads::{Loads, NodeLine, item};
use super::parameters;
use super::place::Places;
use super::reference::{NodeAxis, Reference};
use super::table::Origin;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Data, Of};
use crate::name;

/// Names of supports, and the axes along and about which they hold.
const WORDS: [(&str, &[usize]); 8] = [
    ("ENCASTRE", &[0, 1, 2, 3, 4, 5]),
    ("PINNED", &[0, 1, 2]),
    ("XSYMM", &[0, 4, 5]),
    ("YSYMM", &[1, 3, 5]),
    ("ZSYMM", &[2, 3, 4]),
    ("XASYMM", &[1, 2, 3]),
    ("YASYMM", &[0, 2, 4]),
    ("ZASYMM", &[0, 1, 5]),
];

/// Number of the degrees of freedom that are displacements, and the last that is a rotation.
const SPACE: usize = 3;
const ROTATIONS: i64 = 6;

/// Description of the irrelevant part of a support.
const NO_ROTATIONS: &str = "*BOUNDARY (degrees of freedom 4 to 6, which nodes of solids haven't)";

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
        let refused = parameters::refused(block);
        if refused.is_some() || !kind.eq_ignore_ascii_case("DISPLACEMENT") {
            let what = refused.map_or(name::shown(kind), str::to_owned);
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
            let word = WORDS.iter().find(|(word, _)| *word == second);
            let axes: Vec<usize> = match word {
                Some((_, axes)) => axes.to_vec(),
                None => axes(places, data, block)?,
            };
            let is_fixed = block.parameter("FIXED").is_some();
            for (&node, &axis) in nodes
                .iter()
                .flat_map(|node| axes.iter().map(move |axis| (node, axis)))
            {
                match self.component(places, (block, data), (node, axis))? {
                    Some(key) if is_fixed => self.fix(places, block, key, &origin)?,
                    Some(key) => self.prescribe(places, key, value, &origin)?,
                    None if word.is_none() && axis >= SPACE => {
                        _ = self.notes.insert(NO_ROTATIONS.into())
                    }
                    None => {}
                }
            }
            self.lines.push(NodeLine {
                place: data.place,
                nodes,
                axes,
                value,
                is_force: false,
            });
        }
        Ok(())
    }

    /// `*BOUNDARY, FIXED`: a node is held at its current displacement, a pretension at its current shortening.
    ///
    /// # Errors
    /// Displacements that the same block ends.
    fn fix(
        &mut self,
        places: &Places,
        block: &Block,
        key: NodeAxis,
        origin: &Origin,
    ) -> Result<(), InputError> {
        let is_bolt = (self.references.get(&key.0)).is_some_and(Reference::is_of_pretension);
        let op = block.parameter("OP").unwrap_or_default();
        if !is_bolt && op.eq_ignore_ascii_case("NEW") {
            let message =
                "*BOUNDARY with FIXED and OP=NEW isn't read; expected displacements of nodes";
            return Err(places.source.error(origin.place, message));
        }
        // Supports that are active already don't change.
        if is_bolt || self.supports.place(&key).is_none() {
            self.fixed.insert(key);
            self.supports.set(key, 0.0, origin);
        }
        Ok(())
    }

    /// Prescribes a displacement.
    ///
    /// # Errors
    /// A displacement of a fixed node.
    fn prescribe(
        &mut self,
        places: &Places,
        key: NodeAxis,
        value: f64,
        origin: &Origin,
    ) -> Result<(), InputError> {
        let is_free = (self.references.get(&key.0)).is_some_and(Reference::is_of_pretension);
        if self.fixed.remove(&key) && !is_free {
            let message = format!(
                "the node {} has been FIXED in a step before; expected that alone, or displacements in all steps",
                places.deck.node_tags[key.0 as usize]
            );
            return Err(places.source.error(origin.place, message));
        }
        self.supports.set(key, value, origin);
        Ok(())
    }

    /// The component of a node's degree of freedom, from 0 on; `None` for a rotation of a solid's node, and for
    /// displacements out of a plane model.
    ///
    /// # Errors
    /// A reference node without this coupled component.
    fn component(
        &self,
        places: &Places,
        (block, data): (&Block, &Data),
        (node, axis): NodeAxis,
    ) -> Result<Option<NodeAxis>, InputError> {
        let Some(reference) = self.references.get(&node) else {
            return Ok((axis < places.dim()).then_some((node, axis)));
        };
        let component = reference.component(axis, places.dim());
        if component.is_none() && places.dim() == SPACE {
            let message = format!(
                "*{} on the degree of freedom {} of the reference node {}, which isn't coupled; expected it in the \
                 lines of *DISTRIBUTING, of a ROT NODE 1 to {SPACE}, of a *PRE-TENSION SECTION 1",
                block.keyword,
                axis + 1,
                places.deck.node_tags[node as usize]
            );
            return Err(places.source.error(data.place, message));
        }
        Ok(component)
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
            for &node in &nodes {
                match self.component(places, (block, data), (node, axis))? {
                    Some(key) => self.forces.add(key, force, &origin),
                    None if force == 0.0 => {}
                    None => {
                        let message = format!(
                            "*CLOAD on the degree of freedom {dof}; expected forces along 1 to {}: nodes of solids take no \
                             moments, but the reference node of a *COUPLING does",
                            places.dim()
                        );
                        return Err(source.error(data.place, message));
                    }
                }
            }
            self.lines.push(NodeLine {
                place: data.place,
                nodes,
                axes: vec![axis],
                value: force,
                is_force: true,
            });
        }
        Ok(())
    }
}

/// The axes from the first degree of freedom of a line to its last.
fn axes(places: &Places, data: &Data, block: &Block) -> Result<Vec<usize>, InputError> {
    let source = places.source;
    let first = source.tag(data.place, item(source, data, 1), "a degree of freedom")?;
    let last = match item(source, data, 2) {
        "" => first,
        last => source.tag(data.place, last, "a degree of freedom")?,
    };
    if first > last || last > ROTATIONS {
        let message = format!(
            "*{} of the degrees of freedom {first} to {last}; expected displacements, 1 to {SPACE}, or of reference nodes also \
             rotations, to {ROTATIONS}",
            block.keyword
        );
        return Err(source.error(data.place, message));
    }
    Ok((first..=last).map(|dof| dof as usize - 1).collect())
}
