//! Nodes and elements of a part, or of a deck without parts, and their errors.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use super::blocks::{Block, LinePlace, Source};
use super::element_type::{self, ElementType};
use super::notes::Notes;
use super::sets::Sets;
use crate::element::Elements;
use crate::element::geometry::{advance, cross, difference, dot};
use crate::error::InputError;
use crate::name;

/// The types of elements that are read with a keyword: springs and distributing couplings.
const BY_KEYWORD: [&str; 4] = ["SPRING1", "SPRING2", "SPRINGA", "DCOUP3D"];

/// A part of a surface.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Face {
    /// The face of an element, with Abaqus's number.
    Of(u32, usize),
    /// The faces of an element that no other element shares.
    Free(u32),
}

/// Nodes, elements, sets and surfaces.
#[derive(Clone, Default)]
pub(crate) struct Deck {
    pub(crate) node_tags: Vec<i64>,
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) node_of: HashMap<i64, u32>,
    pub(crate) elements: Elements,
    pub(crate) element_tags: Vec<i64>,
    /// Flags of the elements that can only be sides.
    pub(crate) is_side: Vec<bool>,
    /// Flags of the elements with incompatible modes.
    pub(crate) has_modes: Vec<bool>,
    /// Flags of the elements with reduced integration.
    pub(crate) is_reduced: Vec<bool>,
    pub(crate) element_of: HashMap<i64, u32>,
    /// The tags of elements that are left out, as they are neither cells nor sides.
    left_out: HashSet<i64>,
    pub(crate) node_sets: Sets<u32>,
    /// The names of sets that become groups of points even if they have all nodes of faces.
    pub(crate) point_sets: BTreeSet<String>,
    pub(crate) element_sets: Sets<u32>,
    pub(crate) surfaces: Sets<Face>,
    /// Node-based surfaces.
    pub(crate) node_surfaces: Sets<u32>,
    /// Offsets of the tags of an instance, by its name in capitals; the assembly itself has the empty name.
    pub(crate) instances: BTreeMap<String, Offsets>,
    /// The highest tags.
    pub(crate) highest: Offsets,
    /// Descriptions of types that are replaced by others of the same shape.
    pub(crate) taken_as: BTreeSet<String>,
    pub(crate) notes: Notes,
}

/// Tags of a node and an element, or offsets that make the tags of an instance unique in the deck.
#[derive(Clone, Copy, Default)]
pub(crate) struct Offsets {
    pub(crate) nodes: i64,
    pub(crate) elements: i64,
}

/// An element being read.
struct Listed {
    place: LinePlace,
    tag: i64,
    nodes: Vec<u32>,
}

impl Deck {
    /// `*NODE`: tag and coordinates, one node per line.
    pub(crate) fn add_nodes(&mut self, source: &Source, block: &Block) -> Result<(), InputError> {
        if let Some(system) = block
            .parameter("SYSTEM")
            .filter(|s| !s.eq_ignore_ascii_case("R"))
        {
            let message = format!(
                "*NODE has SYSTEM={}; expected Cartesian coordinates",
                name::shown(system)
            );
            return Err(source.error(block.place, message));
        }
        let offset = self.own_offsets().nodes;
        let mut listed = Vec::new();
        for data in &block.data {
            let mut items = source.items(data);
            let item = items.next().unwrap_or_default();
            let tag = offset + source.tag(data.place, item, "the number of a node")?;
            let mut point = [0.0; 3];
            for (coordinate, axis) in point.iter_mut().zip("xyz".chars()) {
                let item = items.next().unwrap_or_default();
                *coordinate = source.real(data.place, item, &format!("the {axis} coordinate"))?;
            }
            match self.node_of.get(&tag) {
                Some(&node) if self.points[node as usize] == point => {
                    let item = format!("{tag} ({})", source.place(data.place));
                    (self.notes).add("nodes are given twice, at the same place", item);
                    listed.push(node);
                }
                Some(&node) => {
                    let [there, here] = [self.points[node as usize], point]
                        .map(|[x, y, z]| format!("({x}, {y}, {z})"));
                    let message = format!(
                        "the node {tag} occurs twice, at {there} and at {here}; expected one place"
                    );
                    return Err(source.error(data.place, message));
                }
                None => listed.push(self.push_node(tag, point)),
            }
        }
        if let Some(set) = block.parameter("NSET") {
            check_name(source, block.place, set)?;
            self.node_sets.extend(set, false, listed);
        }
        Ok(())
    }

    /// Appends a node.
    pub(crate) fn push_node(&mut self, tag: i64, point: [f64; 3]) -> u32 {
        let node = self.points.len() as u32;
        self.node_of.insert(tag, node);
        self.node_tags.push(tag);
        self.points.push(point);
        self.highest.nodes = self.highest.nodes.max(tag);
        node
    }

    /// `*ELEMENT`: tag and nodes of each element, on one or more lines.
    pub(crate) fn add_elements(
        &mut self,
        source: &Source,
        block: &Block,
    ) -> Result<(), InputError> {
        let name = source.required(block, "TYPE")?;
        let set = block.parameter("ELSET");
        if let Some(set) = set {
            check_name(source, block.place, set)?;
        }
        let Some(found) = element_type::find(name) else {
            let name = name::shown(name);
            if element_type::has_no_volume(&name) {
                return self.leave_out(source, block, &name);
            }
            let known = element_type::known();
            let message = format!(
                "elements of type {name} aren't supported; expected one of {known}, also with another \
                 integration or formulation, such as C3D8R"
            );
            return Err(source.error(block.place, message));
        };
        match (found.is_side, found.plain) {
            (true, _) => self
                .taken_as
                .insert(format!("{} as sides", name.to_uppercase())),
            (_, Some(plain)) if !found.has_modes && !found.has_reduced_points() => self
                .taken_as
                .insert(format!("{} as {plain}", name.to_uppercase())),
            _ => false,
        };
        let mut members = Vec::new();
        for element in self.listed(source, block, &found, name)? {
            members.push(self.add_element(source, &found, &element)?);
        }
        if let Some(set) = set {
            self.element_sets.extend(set, false, members);
        }
        Ok(())
    }

    /// The elements of a block.
    fn listed(
        &mut self,
        source: &Source,
        block: &Block,
        found: &ElementType,
        name: &str,
    ) -> Result<Vec<Listed>, InputError> {
        let offsets = self.own_offsets();
        let mut elements = Vec::new();
        let mut pending: Option<Listed> = None;
        for data in &block.data {
            for item in source.items(data).filter(|item| !item.is_empty()) {
                let Some(element) = &mut pending else {
                    let tag = source.tag(data.place, item, "the number of an element")?;
                    pending = Some(Listed {
                        place: data.place,
                        tag: offsets.elements + tag,
                        nodes: Vec::new(),
                    });
                    continue;
                };
                if element.nodes.len() == found.kind.nodes() {
                    // Other programs ignore these elements, too.
                    let item = format!(
                        "element {} of {name} ({})",
                        element.tag,
                        source.place(data.place)
                    );
                    (self.notes).add("entries behind the nodes of an element are left out", item);
                    break;
                }
                let tag = source.tag(data.place, item, "the number of a node")?;
                let Some(&node) = self.node_of.get(&(offsets.nodes + tag)) else {
                    let message = format!(
                        "element {} has the node {tag}, which the deck doesn't define",
                        element.tag
                    );
                    return Err(source.error(data.place, message));
                };
                element.nodes.push(node);
            }
            let is_whole = |element: &mut Listed| element.nodes.len() == found.kind.nodes();
            elements.extend(pending.take_if(is_whole));
        }
        match pending {
            None => Ok(elements),
            Some(element) => {
                let message = format!(
                    "element {} has {} nodes; expected {}, as it is of type {name}",
                    element.tag,
                    element.nodes.len(),
                    found.kind.nodes()
                );
                Err(source.error(element.place, message))
            }
        }
    }

    /// Ignores elements that neither have a volume nor can be sides; sets may contain them.
    fn leave_out(&mut self, source: &Source, block: &Block, name: &str) -> Result<(), InputError> {
        let offset = self.own_offsets().elements;
        for data in &block.data {
            let item = source.items(data).next().unwrap_or_default();
            if let Ok(tag) = source.tag(data.place, item, "the number of an element") {
                self.left_out.insert(offset + tag);
            }
        }
        if !BY_KEYWORD.contains(&&name.to_uppercase()[..]) {
            self.notes.add(
                "elements that are no cells of a body are left out",
                name.to_uppercase(),
            );
        }
        if let Some(set) = block.parameter("ELSET") {
            self.element_sets.extend(set, false, []);
        }
        Ok(())
    }

    /// True if the element with this tag is left out.
    pub(crate) fn leaves_out(&self, tag: i64) -> bool {
        self.left_out.contains(&tag)
    }

    /// Offsets for tags outside of instances, which have separate tags.
    fn own_offsets(&mut self) -> Offsets {
        if self.instances.is_empty() {
            return Offsets::default();
        }
        let highest = self.highest;
        *(self.instances.entry(String::new())).or_insert(highest)
    }

    /// Adds an element with a new tag; returns its index.
    fn add_element(
        &mut self,
        source: &Source,
        found: &ElementType,
        Listed { place, tag, nodes }: &Listed,
    ) -> Result<u32, InputError> {
        if let Some(twice) = (1..nodes.len()).find(|&i| nodes[..i].contains(&nodes[i])) {
            let node = self.node_tags[nodes[twice] as usize];
            let message = format!(
                "element {tag} has the node {node} twice; expected a {} whose nodes all differ",
                found.kind.name()
            );
            return Err(source.error(*place, message));
        }
        if let Some(&other) = self.element_of.get(tag) {
            let at = other as usize;
            if self.elements.kind(at) != found.kind || self.elements.nodes_of(at) != nodes {
                let message = format!("the element {tag} occurs twice, with different nodes");
                return Err(source.error(*place, message));
            }
            let item = format!("{tag} ({})", source.place(*place));
            (self.notes).add("elements are given twice, with the same nodes", item);
            return Ok(other);
        }
        self.elements.push(found.kind, nodes);
        Ok(self.push_tag(*tag, found.is_side, (found.has_modes, found.is_reduced)))
    }

    /// The outward normal of a surface of faces, times its area.
    pub(crate) fn outward(&self, surface: &str) -> [f64; 3] {
        let middle = |nodes: &[u32]| {
            let points = nodes.iter().map(|&node| self.points[node as usize]);
            points.fold([0.0; 3], |sum, x| advance(sum, 1.0 / nodes.len() as f64, x))
        };
        let faces = self.surfaces.get(surface).map(|set| set.members.list());
        let direction = |face: &Face| {
            let Face::Of(element, number) = *face else {
                return None;
            };
            let (kind, nodes) = (
                self.elements.kind(element as usize),
                self.elements.nodes_of(element as usize),
            );
            let corners = element_type::face(kind, number)?.iter().map(|&i| nodes[i]);
            let corners: Vec<u32> = corners.collect();
            let out = difference(middle(&corners), middle(&nodes[..kind.corners()]));
            let at = |k: usize| self.points[corners[k] as usize];
            let normal = match corners.len() {
                2 => cross(difference(at(1), at(0)), [0.0, 0.0, 1.0]),
                3 => cross(difference(at(1), at(0)), difference(at(2), at(0))),
                _ => cross(difference(at(2), at(0)), difference(at(3), at(1))),
            };
            // Half the product is the area; edges of plane cells have their length.
            let size = if corners.len() == 2 { 1.0 } else { 0.5 };
            Some(normal.map(|c| c * size * dot(normal, out).signum()))
        };
        let directions = faces.into_iter().flatten().filter_map(direction);
        directions.fold([0.0; 3], |sum, direction| advance(sum, 1.0, direction))
    }

    /// Records the tag of the last element, whether it is a side, and whether it has incompatible modes and reduced
    /// integration.
    pub(crate) fn push_tag(
        &mut self,
        tag: i64,
        is_side: bool,
        (has_modes, is_reduced): (bool, bool),
    ) -> u32 {
        let element = self.element_tags.len() as u32;
        self.element_of.insert(tag, element);
        self.element_tags.push(tag);
        self.is_side.push(is_side);
        self.has_modes.push(has_modes);
        self.is_reduced.push(is_reduced);
        self.highest.elements = self.highest.elements.max(tag);
        element
    }
}

/// Checks the name of a set.
///
/// # Errors
/// An invalid name, with the line.
pub(crate) fn check_name(source: &Source, at: LinePlace, name: &str) -> Result<(), InputError> {
    name::check_text(name)
        .map_err(|reason| source.error(at, format!("'{}' {reason}", name::shown(name))))
}
