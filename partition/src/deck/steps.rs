//! `*STEP`: loads and supports at the end of each step, along the axes of the scene.

use std::collections::BTreeMap;

use super::amplitude::DeckTime;
use super::axes::{System, numbers};
use super::loads::Loads;
use super::place::Places;
use super::reference::{AtReference, NodeAxis};
use super::table::{Amplitudes, Origin};
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace};
use crate::name;

/// Prescribed displacements of nodes along the axes of the scene.
type Held = BTreeMap<u32, [Option<f64>; 3]>;

/// Loads and supports at the end of a step.
pub(super) struct LoadStep {
    pub(super) name: Option<String>,
    pub(super) place: LinePlace,
    /// Total time.
    pub(super) time: f64,
    pub(super) supports: Held,
    /// The displacements prescribed along local axes other than the scene's.
    pub(super) turned: BTreeMap<NodeAxis, f64>,
    pub(super) forces: BTreeMap<u32, [f64; 3]>,
    pub(super) faces: BTreeMap<(u32, usize), f64>,
    pub(super) surfaces: BTreeMap<String, f64>,
    pub(super) tractions: BTreeMap<(String, usize), f64>,
    pub(super) bodies: BTreeMap<usize, f64>,
    pub(super) temperatures: BTreeMap<u32, f64>,
    /// The loads on reference nodes.
    pub(super) references: BTreeMap<u32, AtReference>,
}

impl LoadStep {
    /// The components that are held, of nodes along the axes of the scene and of reference points.
    pub(super) fn held(&self) -> Vec<NodeAxis> {
        let of_nodes = self.supports.iter().map(|(node, held)| (*node, &held[..]));
        let of_points = self
            .references
            .iter()
            .map(|(node, at)| (*node, &at.held[..]));
        let of_one = |(node, held): (u32, &[Option<f64>])| {
            let held = (0..).zip(held).filter(|(_, value)| value.is_some());
            held.map(|(k, _)| (node, k)).collect::<Vec<_>>()
        };
        of_nodes.chain(of_points).flat_map(of_one).collect()
    }

    /// The prescribed displacement of a component.
    pub(super) fn support(&mut self, (node, k): NodeAxis) -> Option<&mut Option<f64>> {
        match self.references.get_mut(&node) {
            Some(at) => at.held.get_mut(k),
            None => self.supports.get_mut(&node)?.get_mut(k),
        }
    }
}

/// The steps of a deck, and the step being read.
#[derive(Default)]
pub(super) struct Steps {
    pub(super) loads: Loads,
    pub(super) done: Vec<LoadStep>,
    pub(super) amplitudes: Amplitudes,
    /// Local systems of nodes.
    pub(super) systems: BTreeMap<u32, System>,
    /// The first load that isn't proportional to the time of its step.
    pub(super) bend: Option<LinePlace>,
    /// The step with PERTURBATION.
    perturbation: Option<LinePlace>,
    open: Option<Open>,
    total_time: f64,
}

/// A step being read.
struct Open {
    name: Option<String>,
    place: LinePlace,
    is_static: bool,
    period: f64,
}

impl Steps {
    /// True while a step is read.
    pub(super) fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// The number of the step being read, from 0.
    pub(super) fn number(&self) -> Option<usize> {
        self.is_open().then_some(self.done.len())
    }

    /// `*STEP`.
    pub(super) fn begin(
        &mut self,
        places: &Places,
        block: &Block,
        has_contact: bool,
    ) -> Result<(), InputError> {
        let source = places.source;
        if self.is_open() {
            return Err(source.error(
                block.place,
                "*STEP within a step; expected *END STEP before it",
            ));
        }
        let is_perturbation = block.parameter("PERTURBATION").is_some();
        if is_perturbation && has_contact {
            let message = "a step with PERTURBATION keeps the contacts as they are, which isn't read; expected *STEP";
            return Err(source.error(block.place, message));
        }
        // The loads and results of a perturbation are changes of the state before it; alone it is any linear step.
        let beside = Some(block.place).filter(|_| is_perturbation && !self.done.is_empty());
        if let Some(place) = self.perturbation.or(beside) {
            let message = "*STEP with PERTURBATION beside other steps isn't read, as its loads and results are changes of \
                           their state; expected it in a deck of its own, or *STEP with all loads that act";
            return Err(source.error(place, message));
        }
        self.perturbation = is_perturbation.then_some(block.place);
        self.open = Some(Open {
            name: block
                .parameter("NAME")
                .filter(|name| !name.is_empty())
                .map(str::to_owned),
            place: block.place,
            is_static: false,
            period: 1.0,
        });
        Ok(())
    }

    /// `*STATIC`, whose second number is the time of the step.
    pub(super) fn statics(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        if block.parameter("RIKS").is_some() {
            return Err(source.error(
                block.place,
                "*STATIC, RIKS isn't read; expected *STATIC: loads are given here",
            ));
        }
        let row = match block.data.first() {
            Some(data) => numbers(source, data, "a time")?,
            None => Vec::new(),
        };
        let Some(open) = &mut self.open else {
            return Err(source.error(
                block.place,
                "*STATIC stands in no step; expected *STEP before it",
            ));
        };
        let period = row.get(1).copied().unwrap_or_default();
        if period < 0.0 {
            let message = format!("the time of the step is {period}; expected more than 0");
            return Err(source.error(block.place, message));
        }
        open.is_static = true;
        open.period = row
            .get(1)
            .copied()
            .filter(|&period| period > 0.0)
            .unwrap_or(1.0);
        Ok(())
    }

    /// A block of supports or loads.
    pub(super) fn read(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        let amplitude = block.parameter("AMPLITUDE").map(str::to_uppercase);
        if let Some(name) = amplitude
            .as_ref()
            .filter(|name| !self.amplitudes.contains_key(*name))
        {
            let message = format!("there is no amplitude '{}'", name::shown(name));
            return Err(places.source.error(block.place, message));
        }
        if !self.is_open() && block.keyword != "BOUNDARY" {
            let message = format!(
                "*{} stands in no step; expected it behind *STEP",
                block.keyword
            );
            return Err(places.source.error(block.place, message));
        }
        let step = if self.is_open() {
            self.done.len() + 1
        } else {
            0
        };
        let origin = Origin {
            place: block.place,
            step,
            amplitude,
        };
        self.add(places, block, &origin)
    }

    /// Adds a block; with `OP=NEW` earlier loads of its kind end.
    fn add(
        &mut self,
        places: &mut Places,
        block: &Block,
        origin: &Origin,
    ) -> Result<(), InputError> {
        let op = block.parameter("OP");
        let is_new = op.is_some_and(|op| op.eq_ignore_ascii_case("NEW"));
        let loads = &mut self.loads;
        let step = origin.step;
        let mut lines = block.data.iter();
        match block.keyword.as_str() {
            "BOUNDARY" => {
                if is_new {
                    loads.supports.begin(step);
                }
                loads.boundary(places, block, origin)
            }
            "CLOAD" => {
                if is_new {
                    loads.forces.begin(step);
                }
                loads.concentrated(places, block, origin)
            }
            "DLOAD" => {
                if is_new {
                    loads.faces.begin(step);
                    loads.bodies.begin(step);
                }
                lines.try_for_each(|data| loads.distributed(places, data, origin))
            }
            "DSLOAD" => {
                if is_new {
                    loads.surfaces.begin(step);
                    loads.tractions.begin(step);
                }
                lines.try_for_each(|data| loads.on_surface(places, data, origin))
            }
            _ => {
                if is_new {
                    loads.temperatures.begin(step);
                }
                lines.try_for_each(|data| loads.temperature(places, data, origin))
            }
        }
    }

    /// `*END STEP`.
    pub(super) fn end(&mut self, places: &Places) -> Result<(), InputError> {
        let Some(open) = self.open.take() else {
            return Ok(());
        };
        if !open.is_static {
            return Err(places
                .source
                .error(open.place, "the step has no *STATIC; expected it"));
        }
        let at = |in_step: f64| DeckTime {
            in_step,
            total: self.total_time + in_step,
        };
        let (start, end) = (at(0.0), at(open.period));
        self.total_time = end.total;
        let loads = &mut self.loads;
        let amplitudes = &self.amplitudes;
        let local = Local {
            places,
            systems: &self.systems,
        };
        let bend = (loads.supports.bend(amplitudes, start, end))
            .or_else(|| loads.forces.bend(amplitudes, start, end))
            .or_else(|| loads.faces.bend(amplitudes, start, end))
            .or_else(|| loads.surfaces.bend(amplitudes, start, end))
            .or_else(|| loads.tractions.bend(amplitudes, start, end))
            .or_else(|| loads.bodies.bend(amplitudes, start, end))
            .or_else(|| loads.temperatures.bend(amplitudes, start, end));
        self.bend = self.bend.or(bend);
        let [(held_references, held), (loaded_references, forces)] =
            [&loads.supports, &loads.forces].map(|table| {
                let values = table.at(amplitudes, end).into_iter();
                let (of_references, of_bodies): (Vec<_>, Vec<_>) =
                    values.partition(|((node, _), _)| loads.references.contains_key(node));
                (of_references, BTreeMap::from_iter(of_bodies))
            });
        let (supports, turned) = local.supports(&held);
        self.done.push(LoadStep {
            name: open.name,
            place: open.place,
            time: end.total,
            references: AtReference::all(loaded_references, held_references),
            supports,
            turned,
            forces: local.forces(&forces),
            faces: loads.faces.at(amplitudes, end),
            surfaces: loads.surfaces.at(amplitudes, end),
            tractions: loads.tractions.at(amplitudes, end),
            bodies: loads.bodies.at(amplitudes, end),
            temperatures: loads.temperatures.at(amplitudes, end),
        });
        loads.supports.hold(amplitudes, end);
        loads.forces.hold(amplitudes, end);
        loads.faces.hold(amplitudes, end);
        loads.surfaces.hold(amplitudes, end);
        loads.tractions.hold(amplitudes, end);
        loads.bodies.hold(amplitudes, end);
        loads.temperatures.hold(amplitudes, end);
        Ok(())
    }
}

/// Nodes with local axes.
struct Local<'a> {
    places: &'a Places<'a>,
    systems: &'a BTreeMap<u32, System>,
}

impl Local<'_> {
    /// Displacements along the scene's axes, and those along other local axes.
    fn supports(&self, values: &BTreeMap<NodeAxis, f64>) -> (Held, BTreeMap<NodeAxis, f64>) {
        let dim = self.places.dim();
        let mut by_node = Held::new();
        let mut turned = BTreeMap::new();
        for (&(node, axis), &value) in values {
            by_node.entry(node).or_default()[axis] = Some(value);
        }
        for (&node, held) in &mut by_node {
            let Some(system) = self.systems.get(&node) else {
                continue;
            };
            let axes = system.at(self.places.deck.points[node as usize]);
            if held[..dim].iter().all(Option::is_some) {
                *held = [0, 1, 2].map(|i| {
                    let along = (0..dim).map(|p| axes[p][i] * held[p].unwrap_or_default());
                    (i < dim).then(|| along.sum())
                });
                continue;
            }
            let mut global = [None; 3];
            for (p, value) in
                (held.iter().enumerate()).filter_map(|(p, value)| Some((p, (*value)?)))
            {
                match (0..3).find(|&i| axes[p][i].abs() > 1.0 - 1e-12) {
                    Some(i) => global[i] = Some(value * axes[p][i].signum()),
                    None => _ = turned.insert((node, p), value),
                }
            }
            *held = global;
        }
        (by_node, turned)
    }

    /// Forces along the scene's axes.
    fn forces(&self, values: &BTreeMap<NodeAxis, f64>) -> BTreeMap<u32, [f64; 3]> {
        let mut by_node: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
        for (&(node, axis), &value) in values.iter().filter(|(_, value)| **value != 0.0) {
            let force = by_node.entry(node).or_default();
            let direction = match self.systems.get(&node) {
                Some(system) => system.at(self.places.deck.points[node as usize])[axis],
                None => [0, 1, 2].map(|k| f64::from(u8::from(k == axis))),
            };
            (0..3).for_each(|k| force[k] += value * direction[k]);
        }
        by_node
    }
}
