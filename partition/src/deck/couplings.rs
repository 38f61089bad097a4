//! `*COUPLING` with `*KINEMATIC` or `*DISTRIBUTING`, and `*RIGID BODY`: nodes that follow a reference node.

use std::collections::{BTreeMap, BTreeSet};

use super::axes::System;
use super::document::{Document, Names, quoted, vector};
use super::groups::Groups;
use super::loads::{NodeAxis, item};
use super::place::Places;
use super::steps::LoadStep;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace, Of};
use crate::scene::coupling::COMPONENTS;

/// Translations and rotations of a reference node.
const FREEDOMS: usize = COMPONENTS.len();

/// The degrees of freedom of a reference node in the plane: along x and y, and about z.
const IN_THE_PLANE: [usize; 3] = [0, 1, 5];

/// Parameters of `*RIGID BODY` that name its nodes, by themselves or by elements.
const OF_RIGID_BODIES: [(&str, Of); 4] = [
    ("NSET", Of::Nodes),
    ("PIN NSET", Of::Nodes),
    ("TIE NSET", Of::Nodes),
    ("ELSET", Of::Elements),
];

/// The nodes of a coupling.
enum Coupled {
    /// Those of a surface, by name in capitals.
    Surface(String),
    Nodes(Vec<u32>),
}

/// The way in which nodes follow.
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
    /// `None` before the keyword that says it.
    kind: Option<Kind>,
}

/// The meaning of a degree of freedom of a node that stands for a reference point.
#[derive(Clone, Copy)]
pub(super) struct Reference {
    /// The reference node.
    node: u32,
    /// Its component that is the node's first degree of freedom: 3 of a node for rotations.
    first: usize,
    /// The components that are coupled.
    coupled: [bool; FREEDOMS],
}

/// What acts on a reference node at the end of a step, and what is prescribed there.
#[derive(Clone, Default)]
pub(super) struct AtReference {
    load: [f64; FREEDOMS],
    held: [Option<f64>; FREEDOMS],
}

/// All couplings of a deck.
#[derive(Default)]
pub(super) struct Couplings {
    all: Vec<Coupling>,
    references: BTreeMap<u32, Reference>,
}

/// A coupling in the words of the scene.
pub(super) struct SceneCoupling {
    name: String,
    on: String,
    point: [f64; 3],
    is_rigid: bool,
    dim: usize,
    /// By step.
    acting: Vec<AtReference>,
}

impl Reference {
    /// The reference node and its component that is a degree of freedom, from 0 on; `None` where it isn't one in `dim`
    /// dimensions or isn't coupled.
    pub(super) fn component(&self, freedom: usize, dim: usize) -> Option<NodeAxis> {
        let component = self.first + freedom;
        let is_coupled = self.coupled.get(component) == Some(&true);
        let is_here = dim == 3 || IN_THE_PLANE.contains(&component);
        (is_coupled && is_here).then_some((self.node, component))
    }
}

impl Couplings {
    /// Reads a block.
    pub(super) fn read(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        match block.keyword.as_str() {
            "COUPLING" => self.coupling(places, block),
            "RIGID BODY" => self.rigid_body(places, block),
            "KINEMATIC" => self.follow(places, block, Kind::Rigid),
            _ => self.follow(places, block, Kind::Distributing),
        }
    }

    /// The nodes that stand for reference points.
    ///
    /// # Errors
    /// A coupling of which it isn't said how nodes follow.
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

    fn coupling(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        if block.parameter("ORIENTATION").is_some() {
            let message = "*COUPLING with ORIENTATION isn't read; expected degrees of freedom along x, y and z";
            return Err(source.error(block.place, message));
        }
        let surface = source.required(block, "SURFACE")?.to_uppercase();
        places.check_surface(block.place, &surface)?;
        let name = block.parameter("CONSTRAINT NAME").unwrap_or("coupling");
        self.push(places, block, (name, Coupled::Surface(surface)), None)
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
            let node = node(places, block, "ROT NODE")?;
            let own = self.all.last().map_or(node, |coupling| coupling.node);
            let rotations = Reference {
                node: own,
                first: 3,
                coupled: [true; FREEDOMS],
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
        let node = node(places, block, "REF NODE")?;
        let own = Reference {
            node,
            first: 0,
            coupled: [true; FREEDOMS],
        };
        self.refer(places, block, node, own)?;
        self.all.push(Coupling {
            place: block.place,
            name: name.to_owned(),
            coupled,
            node,
            kind,
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
                    "the node {} is a reference node already; expected one for each coupling",
                    places.deck.node_tags[node as usize]
                );
                Err(places.source.error(block.place, message))
            }
        }
    }

    /// `*KINEMATIC` and `*DISTRIBUTING`: the first and the last of degrees of freedom, all without a line.
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
            Kind::Rigid if !coupled[..places.dim()].iter().all(|&coupled| coupled) => {
                let message = format!(
                    "*KINEMATIC of some displacements isn't supported; instead couple all, 1 to {}, or hold the others of the \
                     nodes together by *EQUATION",
                    places.dim()
                );
                return Err(source.error(block.place, message));
            }
            // Nodes follow as the point turns, whether their own rotations are named or not: they have none.
            Kind::Rigid => coupled = [true; FREEDOMS],
            // Forces are always distributed; a rotation that isn't named takes no moment.
            Kind::Distributing => coupled[..3].fill(true),
        }
        if let Some(reference) = self.references.get_mut(&open.node) {
            reference.coupled = coupled;
        }
        Ok(())
    }

    /// The couplings with the groups of their nodes and what the `steps` say of their points, under names that are
    /// none of `names`.
    ///
    /// # Errors
    /// A reference node that is one of a body or turned by one of `systems`, nodes of no body, supports that come or go.
    pub(super) fn in_scene(
        &self,
        groups: &mut Groups,
        (steps, thickness): (&[LoadStep], f64),
        systems: &BTreeMap<u32, System>,
        names: &mut Names,
    ) -> Result<Vec<SceneCoupling>, InputError> {
        let coupling = |coupling: &Coupling| {
            let tag = groups.tag(coupling.node);
            let refuse =
                |groups: &Groups, message: String| Err(groups.error(coupling.place, &message));
            if systems.contains_key(&coupling.node) {
                let message = format!(
                    "the reference node {tag} with *TRANSFORM isn't read; expected x, y and z there"
                );
                return refuse(groups, message);
            }
            let on = match &coupling.coupled {
                Coupled::Surface(_) if groups.is_of_body(coupling.node) => {
                    let message = format!(
                        "the reference node {tag} is one of a body, which isn't supported; expected a node of its own, \
                         perhaps at the same place"
                    );
                    return refuse(groups, message);
                }
                Coupled::Surface(surface) => groups.of_surface(surface),
                Coupled::Nodes(nodes) => {
                    let others =
                        |node: &&u32| **node != coupling.node && self.references.contains_key(node);
                    if let Some(&other) = nodes.iter().find(others) {
                        let message = format!(
                            "the reference node {} of another coupling is one of the nodes, which isn't supported; expected \
                             nodes of bodies",
                            groups.tag(other)
                        );
                        return refuse(groups, message);
                    }
                    let all: Vec<u32> = nodes.iter().copied().chain([coupling.node]).collect();
                    match groups.of_nodes(&all, "rigid") {
                        Some(on) => on,
                        None => {
                            return refuse(
                                groups,
                                "its nodes are none of a body; expected nodes of solids".into(),
                            );
                        }
                    }
                }
            };
            let mut acting = Vec::new();
            for step in steps {
                let mut at = step
                    .references
                    .get(&coupling.node)
                    .cloned()
                    .unwrap_or_default();
                at.load = at.load.map(|load| load / thickness);
                let held = |at: &AtReference| at.held.map(|value| value.is_some());
                if acting.first().is_some_and(|first| held(first) != held(&at)) {
                    let message = format!(
                        "supports of the reference node {tag} come or go in this step, which isn't supported yet; expected \
                         the same degrees of freedom in every step"
                    );
                    return Err(groups.error(step.place, &message));
                }
                acting.push(at);
            }
            Ok(SceneCoupling {
                name: names.unique(&coupling.name),
                on,
                point: groups.position(coupling.node),
                is_rigid: coupling.kind == Some(Kind::Rigid),
                dim: groups.dim(),
                acting,
            })
        };
        self.all.iter().map(coupling).collect()
    }

    /// Refuses couplings where there can be none, around an axis.
    pub(super) fn check_plane(
        &self,
        places: &Places,
        axisymmetric: bool,
    ) -> Result<(), InputError> {
        match self.all.first().filter(|_| axisymmetric) {
            None => Ok(()),
            Some(coupling) => Err(places.source.error(
                coupling.place,
                "couplings around an axis aren't supported; instead move the nodes by *BOUNDARY, or load their faces by \
                 *DSLOAD",
            )),
        }
    }
}

impl AtReference {
    /// Those of all reference nodes, from what acts and what is prescribed by node and component.
    pub(super) fn all(
        loads: Vec<(NodeAxis, f64)>,
        held: Vec<(NodeAxis, f64)>,
    ) -> BTreeMap<u32, Self> {
        let mut all: BTreeMap<u32, Self> = BTreeMap::new();
        for ((node, k), load) in loads {
            all.entry(node).or_default().load[k] = load;
        }
        for ((node, k), value) in held {
            all.entry(node).or_default().held[k] = Some(value);
        }
        all
    }
}

impl SceneCoupling {
    /// Writes the coupling, with what acts on its point in the first step.
    pub(super) fn write(&self, document: &mut Document) {
        document.table("[[coupling]]");
        document.key("name", quoted(&self.name));
        document.key("on", quoted(&self.on));
        document.key("point", vector(&self.point, self.dim));
        if !self.is_rigid {
            document.key("kind", quoted("distributing"));
        }
        self.acts(0, document);
    }

    /// Writes what acts on its point in a step.
    pub(super) fn write_step(&self, step: usize, document: &mut Document) {
        let acts = |at: &AtReference| at.load != [0.0; FREEDOMS] || at.held != [None; FREEDOMS];
        if self.acting.iter().any(acts) {
            document.table(&format!("[step.coupling.{}]", quoted(&self.name)));
            self.acts(step, document);
        }
    }

    fn acts(&self, step: usize, document: &mut Document) {
        let at = &self.acting[step];
        let part = |from: usize| std::array::from_fn(|k| at.load[from + k] + 0.0);
        let in_some = |range: std::ops::Range<usize>| {
            (self.acting.iter()).any(|at| at.load[range.clone()].iter().any(|&load| load != 0.0))
        };
        if in_some(0..3) {
            document.key("force", vector(&part(0), self.dim));
        }
        if in_some(3..6) {
            match self.dim {
                2 => document.key("moment", format!("{:?}", at.load[5] + 0.0)),
                _ => document.key("moment", vector(&part(3), 3)),
            }
        }
        let held = COMPONENTS.iter().zip(at.held);
        for (key, value) in held.filter_map(|(key, value)| Some((key, value?))) {
            document.key(key, format!("{:?}", value + 0.0));
        }
    }
}

/// The one node that a parameter names.
fn node(places: &mut Places, block: &Block, key: &str) -> Result<u32, InputError> {
    let source = places.source;
    let item = source.required(block, key)?;
    match places.members(block.place, Of::Nodes, item)?[..] {
        [node] => Ok(node),
        ref all => {
            let message = format!("{key} is {} nodes; expected one", all.len());
            Err(source.error(block.place, message))
        }
    }
}
