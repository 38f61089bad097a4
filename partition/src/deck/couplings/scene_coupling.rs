//! Translation of couplings to the scene.

use std::collections::BTreeMap;

use super::{Coupled, Coupling, Couplings, Kind};
use crate::deck::axes::System;
use crate::deck::document::{Document, Names, quoted, vector};
use crate::deck::groups::Groups;
use crate::deck::place::Places;
use crate::deck::reference::{AtReference, FREEDOMS, NodeAxis};
use crate::deck::steps::LoadStep;
use crate::element::geometry::difference;
use crate::error::InputError;
use crate::name;
use crate::scene::coupling::COMPONENTS;

/// A coupling in the syntax of the scene.
pub(in crate::deck) struct SceneCoupling {
    /// The reference node.
    pub(in crate::deck) node: u32,
    pub(in crate::deck) name: String,
    on: String,
    point: [f64; 3],
    is_rigid: bool,
    /// The directions in which nodes follow; empty for all.
    directions: Vec<[f64; 3]>,
    /// A point of the axis, and its direction, of cylindrical directions.
    axis: Option<([f64; 3], [f64; 3])>,
    dim: usize,
    /// Loads and supports of the reference node by step.
    acting: Vec<AtReference>,
}

impl Couplings {
    /// The couplings with the groups of their nodes and the loads and supports of their points in `steps`, under names
    /// that aren't in `names`.
    ///
    /// # Errors
    /// A reference node that belongs to a body or has one of the local `systems`, nodes without cells, supports along
    /// local axes of a distributing coupling.
    pub(in crate::deck) fn in_scene(
        &self,
        groups: &mut Groups,
        (steps, thickness): (&[LoadStep], f64),
        (systems, orientations): (&BTreeMap<u32, System>, &BTreeMap<String, System>),
        names: &mut Names,
    ) -> Result<Vec<SceneCoupling>, InputError> {
        let coupling = |coupling: &Coupling| {
            let on = self.group(groups, coupling, systems)?;
            let system = coupling.system(groups, orientations)?;
            let acting = coupling.acting(groups, steps, (thickness, system))?;
            let directions = coupling.directions(groups, system);
            let axis = match system {
                Some(System::Cylindrical(from, to)) if !directions.is_empty() => {
                    Some((from, difference(to, from)))
                }
                _ => None,
            };
            Ok(SceneCoupling {
                node: coupling.node,
                name: names.unique(&coupling.name),
                on,
                point: groups.position(coupling.node),
                is_rigid: coupling.kind == Some(Kind::Rigid),
                directions,
                axis,
                dim: groups.dim(),
                acting,
            })
        };
        self.all.iter().map(coupling).collect()
    }

    /// The group of a coupling's nodes.
    fn group(
        &self,
        groups: &mut Groups,
        coupling: &Coupling,
        systems: &BTreeMap<u32, System>,
    ) -> Result<String, InputError> {
        let tag = groups.tag(coupling.node);
        let others = |node: &&u32| **node != coupling.node && self.references.contains_key(node);
        let message = match &coupling.coupled {
            _ if systems.contains_key(&coupling.node) => {
                format!(
                    "the reference node {tag} with *TRANSFORM isn't read; expected x, y and z there"
                )
            }
            Coupled::Surface(_) if groups.is_of_body(coupling.node) => format!(
                "the reference node {tag} is one of a body, which isn't supported; expected a node of its own, perhaps at the \
                 same place"
            ),
            Coupled::Surface(surface) => {
                // Nodes have equal shares unless faces determine them.
                let points = groups
                    .of_node_surface(surface)
                    .filter(|_| coupling.kind == Some(Kind::Distributing))
                    .and_then(|nodes| groups.of_points(&nodes, "coupled"));
                return Ok(points.unwrap_or_else(|| groups.of_surface(surface)));
            }
            Coupled::Nodes(nodes) => match nodes.iter().find(others) {
                Some(&other) => format!(
                    "the reference node {} of another coupling is one of the nodes, which isn't supported; expected nodes of \
                     bodies",
                    groups.tag(other)
                ),
                None => {
                    let all: Vec<u32> = nodes.iter().copied().chain([coupling.node]).collect();
                    match groups.of_nodes(&all, "rigid") {
                        Some(on) => return Ok(on),
                        None => "its nodes are none of a body; expected nodes of solids".into(),
                    }
                }
            },
        };
        let keyword = match coupling.coupled {
            Coupled::Surface(_) => "COUPLING",
            Coupled::Nodes(_) => "RIGID BODY",
        };
        Err(groups.error(coupling.place, &format!("*{keyword}: {message}")))
    }

    /// The translations of reference nodes that no node follows: supports along them have no effect.
    pub(in crate::deck) fn without_effect(
        &self,
        orientations: &BTreeMap<String, System>,
    ) -> Vec<NodeAxis> {
        let of_coupling = |coupling: &Coupling| {
            let name = coupling.orientation.as_ref();
            let axes = match name.and_then(|name| orientations.get(name)) {
                None => coupling.follows.map(|follows| !follows),
                Some(System::Rectangular(axes)) => std::array::from_fn(|k| {
                    let followed = axes
                        .iter()
                        .zip(coupling.follows)
                        .filter(|(_, follows)| *follows);
                    followed.into_iter().all(|(axis, _)| axis[k].abs() < 1e-12)
                }),
                Some(System::Cylindrical(..)) => [false; 3],
            };
            let free = (0..3).filter(|&k| axes[k]).map(|k| (coupling.node, k));
            free.collect::<Vec<_>>()
        };
        let rigid = self
            .all
            .iter()
            .filter(|coupling| coupling.kind == Some(Kind::Rigid));
        rigid.flat_map(of_coupling).collect()
    }

    /// Refuses couplings around an axis that are impossible there.
    pub(in crate::deck) fn check_plane(
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

impl Coupling {
    /// The orientation, from those of the deck.
    ///
    /// # Errors
    /// A missing orientation, or one of a distributing coupling whose axes vary in space.
    fn system(
        &self,
        groups: &Groups,
        orientations: &BTreeMap<String, System>,
    ) -> Result<Option<System>, InputError> {
        let Some(name) = &self.orientation else {
            return Ok(None);
        };
        let message = match orientations.get(name) {
            Some(System::Cylindrical(..)) if self.kind == Some(Kind::Distributing) => format!(
                "*COUPLING with *DISTRIBUTING: the orientation {} turns around an axis, which isn't supported; expected a \
                 rectangular one",
                name::shown(name)
            ),
            Some(system) => return Ok(Some(*system)),
            None => format!("there is no *ORIENTATION '{}'", name::shown(name)),
        };
        Err(groups.error(self.place, &message))
    }

    /// The directions in which its nodes follow; empty for all.
    fn directions(&self, groups: &Groups, system: Option<System>) -> Vec<[f64; 3]> {
        let axes = match system {
            Some(System::Rectangular(axes)) => axes,
            _ => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        };
        let dim = groups.dim();
        if self.follows[..dim].iter().all(|&follows| follows) {
            return Vec::new();
        }
        let followed = axes.into_iter().zip(self.follows).take(dim);
        followed
            .filter_map(|(axis, follows)| follows.then_some(axis))
            .collect()
    }

    /// The loads on its reference node in every step, per thickness of plane sections; for distributing couplings along
    /// their local axes.
    fn acting(
        &self,
        groups: &Groups,
        steps: &[LoadStep],
        (thickness, system): (f64, Option<System>),
    ) -> Result<Vec<AtReference>, InputError> {
        let mut acting: Vec<AtReference> = Vec::new();
        for step in steps {
            let mut at = step.references.get(&self.node).cloned().unwrap_or_default();
            at.load = at.load.map(|load| load / thickness);
            if let (Some(System::Rectangular(axes)), Some(Kind::Distributing)) = (system, self.kind)
            {
                if at.held != [None; FREEDOMS] {
                    let message = "*COUPLING with ORIENTATION and *DISTRIBUTING isn't read where its reference node is held; \
                                   expected loads on it, or no orientation";
                    return Err(groups.error(self.place, message));
                }
                let along =
                    |from: usize, i: usize| (0..3).map(|p| at.load[from + p] * axes[p][i]).sum();
                at.load = std::array::from_fn(|k| along(k / 3 * 3, k % 3));
            }
            acting.push(at);
        }
        Ok(acting)
    }
}

impl SceneCoupling {
    /// Writes the coupling, with the loads and supports of its point in the first step.
    pub(in crate::deck) fn write(&self, document: &mut Document) {
        document.table("[[coupling]]");
        document.key("name", quoted(&self.name));
        document.key("on", quoted(&self.on));
        document.key("point", vector(&self.point, self.dim));
        if !self.is_rigid {
            document.key("kind", quoted("distributing"));
        }
        if !self.directions.is_empty() {
            let all = self.directions.iter().map(|axis| vector(axis, self.dim));
            document.key(
                "directions",
                format!("[{}]", all.collect::<Vec<_>>().join(", ")),
            );
        }
        if let Some((point, direction)) = self.axis {
            document.key(
                "axis",
                format!("{{ point = {point:?}, direction = {direction:?} }}"),
            );
        }
        self.acts(0, document);
    }

    /// Writes the loads and supports of its point in a step.
    pub(in crate::deck) fn write_step(&self, step: usize, document: &mut Document) {
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
