//! `*COUPLING` with `*KINEMATIC` or `*DISTRIBUTING`, and `*RIGID BODY`: nodes that follow a reference node.

mod scene_coupling;

use std::collections::{BTreeMap, BTreeSet};

pub(super) use self::scene_coupling::SceneCoupling;
use super::loads::item;
use super::orientations::Orientations;
use super::place::Places;
use super::reference::{FREEDOMS, Reference};
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace, Of};

/// Parameters of `*RIGID BODY` that select its nodes, directly or by elements.
const OF_RIGID_BODIES: [(&str, Of); 4] = [
    ("NSET", Of::Nodes),
    ("PIN NSET", Of::Nodes),
    ("TIE NSET", Of::Nodes),
    ("ELSET", Of::Elements),
];

/// The nodes of a coupling.
enum Coupled {
    /// The nodes of a surface, by name in capitals.
    Surface(String),
    Nodes(Vec<u32>),
}

/// The kind of coupling.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Rigid,
    Distributing,
}

/// Nodes that follow a reference node.
struct Coupling {
    place: LinePlace,
    name: String,
    coupled: Coupled,
    node: u32,
    /// The kind of coupling; `None` before the keyword that defines it.
    kind: Option<Kind>,
    /// Name of the local system of its displacements, in capitals.
    orientation: Option<String>,
    /// The displacements that follow rigidly.
    follows: [bool; 3],
}

/// All couplings of a deck.
#[derive(Default)]
pub(super) struct Couplings {
    all: Vec<Coupling>,
    references: BTreeMap<u32, Reference>,
}

impl Couplings {
    /// Reads a block.
    pub(super) fn read(
        &mut self,
        places: &mut Places,
        orientations: &Orientations,
        block: &Block,
    ) -> Result<(), InputError> {
        match block.keyword.as_str() {
            "COUPLING" => self.coupling(places, orientations, block),
            "RIGID BODY" => self.rigid_body(places, block),
            "KINEMATIC" => self.follow(places, block, Kind::Rigid),
            _ => self.follow(places, block, Kind::Distributing),
        }
    }

    /// The reference nodes and their coupled components.
    ///
    /// # Errors
    /// A coupling without its kind.
    pub(super) fn references(
        &self,
        places: &Places,
    ) -> Result<BTreeMap<u32, Reference>, InputError> {
        match self.all.iter().find(|coupling| coupling.kind.is_none()) {
            None => Ok(self.references.clone()),
            Some(coupling) => {
                let message = "*COUPLING doesn't say how nodes follow; expected *KINEMATIC or *DISTRIBUTING behind it";
                Err(places.source.error(coupling.place, message))
            }
        }
    }

    /// The reference nodes, in the order of the couplings.
    pub(super) fn nodes(&self) -> Vec<u32> {
        self.all.iter().map(|coupling| coupling.node).collect()
    }

    fn coupling(
        &mut self,
        places: &mut Places,
        orientations: &Orientations,
        block: &Block,
    ) -> Result<(), InputError> {
        let source = places.source;
        let surface = places.surface(block.place, source.required(block, "SURFACE")?)?;
        let name = block.parameter("CONSTRAINT NAME").unwrap_or("coupling");
        self.push(places, block, (name, Coupled::Surface(surface)), None)?;
        if let Some(open) = self.all.last_mut() {
            let name = block.parameter("ORIENTATION");
            open.orientation = name.map(|name| orientations.listed(places, name));
        }
        Ok(())
    }

    fn rigid_body(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let mut nodes = BTreeSet::new();
        for (key, of) in OF_RIGID_BODIES {
            let Some(set) = block.parameter(key) else {
                continue;
            };
            let members = places.members(block.place, of, set)?;
            match of {
                Of::Nodes => nodes.extend(members),
                Of::Elements => {
                    let elements = &places.deck.elements;
                    let of_elements = members
                        .iter()
                        .flat_map(|&element| elements.nodes_of(element as usize));
                    nodes.extend(of_elements.copied());
                }
            }
        }
        if nodes.is_empty() {
            let message = "*RIGID BODY has no nodes; expected NSET=… or ELSET=… of solids";
            return Err(places.source.error(block.place, message));
        }
        let nodes = Coupled::Nodes(nodes.into_iter().collect());
        self.push(places, block, ("rigid body", nodes), Some(Kind::Rigid))?;
        if block.parameter("ROT NODE").is_some() {
            let node = places.one_node(block, "ROT NODE")?;
            let own = self.all.last().map_or(node, |coupling| coupling.node);
            let rotations = Reference {
                node: own,
                first: 3,
                coupled: [true; FREEDOMS],
                is_local: false,
            };
            self.refer(places, block, node, rotations)?;
        }
        Ok(())
    }

    fn push(
        &mut self,
        places: &mut Places,
        block: &Block,
        (name, coupled): (&str, Coupled),
        kind: Option<Kind>,
    ) -> Result<(), InputError> {
        let node = places.one_node(block, "REF NODE")?;
        let own = Reference {
            node,
            first: 0,
            coupled: [true; FREEDOMS],
            is_local: false,
        };
        self.refer(places, block, node, own)?;
        self.all.push(Coupling {
            place: block.place,
            name: name.to_owned(),
            coupled,
            node,
            kind,
            orientation: None,
            follows: [true; 3],
        });
        Ok(())
    }

    fn refer(
        &mut self,
        places: &Places,
        block: &Block,
        node: u32,
        reference: Reference,
    ) -> Result<(), InputError> {
        match self.references.insert(node, reference) {
            None => Ok(()),
            Some(_) => {
                let message = format!(
                    "*{}: the node {} is a reference node already; expected one for each coupling",
                    block.keyword, places.deck.node_tags[node as usize]
                );
                Err(places.source.error(block.place, message))
            }
        }
    }

    /// `*KINEMATIC` and `*DISTRIBUTING`: the first and the last of degrees of freedom, by default all.
    fn follow(&mut self, places: &Places, block: &Block, kind: Kind) -> Result<(), InputError> {
        let source = places.source;
        let keyword = &block.keyword;
        let open = self.all.last_mut().filter(|open| open.kind.is_none());
        let Some(open) = open else {
            let message = format!("*{keyword} belongs to nothing; expected *COUPLING before it");
            return Err(source.error(block.place, message));
        };
        open.kind = Some(kind);
        for (key, expected) in [("COUPLING", "CONTINUUM"), ("WEIGHTING METHOD", "UNIFORM")] {
            let given = block.parameter(key).unwrap_or(expected);
            if !given.eq_ignore_ascii_case(expected) {
                let message = format!("*{keyword} with {key} isn't read but for {key}={expected}");
                return Err(source.error(block.place, message));
            }
        }
        let mut coupled = [block.data.is_empty(); FREEDOMS];
        for data in &block.data {
            let freedom =
                |at: usize| source.tag(data.place, item(source, data, at), "a degree of freedom");
            let first = freedom(0)?;
            let last = match item(source, data, 1) {
                "" => first,
                _ => freedom(1)?,
            };
            if first > last || last > FREEDOMS as i64 {
                let message = format!(
                    "*{keyword} of the degrees of freedom {first} to {last}; expected some of 1 to {FREEDOMS}"
                );
                return Err(source.error(data.place, message));
            }
            (first..=last).for_each(|freedom| coupled[freedom as usize - 1] = true);
        }
        match kind {
            Kind::Rigid if !coupled[..places.dim()].contains(&true) => {
                let message = format!(
                    "*KINEMATIC of no displacement; expected some of 1 to {}",
                    places.dim()
                );
                return Err(source.error(block.place, message));
            }
            // Nodes follow the rotation of the point whether their own rotations are listed or not, as nodes of solids
            // have none.
            Kind::Rigid => {
                open.follows.copy_from_slice(&coupled[..3]);
                coupled = [true; FREEDOMS];
            }
            // Forces are always distributed; a rotation that isn't listed has no moment.
            Kind::Distributing => coupled[..3].fill(true),
        }
        if let Some(reference) = self.references.get_mut(&open.node) {
            reference.coupled = coupled;
            reference.is_local = kind == Kind::Distributing && open.orientation.is_some();
        }
        Ok(())
    }
}
