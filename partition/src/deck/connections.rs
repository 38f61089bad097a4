//! `*TIE` and `*EQUATION`.

use std::collections::BTreeMap;

use super::axes::System;
use super::document::{Document, quoted};
use super::groups::Groups;
use super::loads::item;
use super::place::Places;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace, Of};
use crate::name;

/// Parameters of `*TIE` that are something else than sides which hang together.
const REFUSED: [&str; 3] = ["MULTISTAGE", "FLUID PERIODIC", "FLUID CYCLIC"];

/// A tie of two surfaces, by name in capitals.
struct Tie {
    name: String,
    slave: String,
    master: String,
    tolerance: Option<f64>,
    adjust: bool,
}

/// A term of an equation: a node, an axis and a factor.
type Term = (u32, usize, f64);

/// An equation between displacements whose sum is 0.
struct Equation {
    place: LinePlace,
    terms: Vec<Term>,
}

/// All ties and equations of a deck.
#[derive(Default)]
pub(super) struct Connections {
    ties: Vec<Tie>,
    equations: Vec<Equation>,
}

/// A tie in the words of the scene: its name, its sides, and what its table says beside them.
pub(super) struct SceneTie {
    pub(super) name: String,
    pub(super) sides: [String; 2],
    pub(super) tolerance: Option<f64>,
    pub(super) adjust: bool,
}

/// An equation in the words of the scene: groups, axes and factors.
pub(super) struct SceneEquation(Vec<(String, usize, f64)>);

impl Connections {
    /// Reads a block.
    pub(super) fn read(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
        match block.keyword.as_str() {
            "TIE" => self.tie(places, block),
            _ => self.equation(places, block),
        }
    }

    fn tie(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        if let Some(key) = REFUSED.iter().find(|key| block.parameter(key).is_some()) {
            let message = format!("*TIE with {key} isn't read; expected sides that hang together");
            return Err(source.error(block.place, message));
        }
        let tolerance = block.parameter("POSITION TOLERANCE");
        let tolerance = tolerance
            .map(|value| source.real(block.place, value, "a distance"))
            .transpose()?;
        let adjust = block.parameter("ADJUST").unwrap_or("YES");
        for data in &block.data {
            let [slave, master] = [0, 1].map(|place| item(source, data, place).to_uppercase());
            places.check_surface(data.place, &slave)?;
            places.check_surface(data.place, &master)?;
            let plain = format!("{slave} on {master}");
            self.ties.push(Tie {
                name: block.parameter("NAME").map_or(plain, str::to_owned),
                slave,
                master,
                tolerance: tolerance.filter(|&tolerance| tolerance > 0.0),
                adjust: !adjust.eq_ignore_ascii_case("NO"),
            });
        }
        Ok(())
    }

    fn equation(&mut self, places: &mut Places, block: &Block) -> Result<(), InputError> {
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
                        Ok(freedom @ 1..=3) if freedom <= places.dim() => freedom - 1,
                        _ => {
                            let freedom = name::shown(freedom);
                            let message = format!(
                                "the degree of freedom {freedom} is no displacement; expected 1 to {}",
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

    /// Takes an equation for every node of the one term that is of a set.
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
                Some((node?, *axis, *factor)).filter(|(.., factor)| *factor != 0.0)
            };
            self.equations.push(Equation {
                place,
                terms: terms.iter().filter_map(of_term).collect(),
            });
        }
        Ok(())
    }

    /// The ties, with the groups that their surfaces make.
    pub(super) fn ties(&self, groups: &mut Groups) -> Vec<SceneTie> {
        let tie = |tie: &Tie| SceneTie {
            name: tie.name.clone(),
            sides: [&tie.slave, &tie.master].map(|side| groups.of_surface(side)),
            tolerance: tie.tolerance,
            adjust: tie.adjust,
        };
        self.ties.iter().map(tie).collect()
    }

    /// The equations, with the groups of their nodes, whose `systems` turn none of them.
    ///
    /// # Errors
    /// A node that no body has, or that `*TRANSFORM` turns.
    pub(super) fn equations(
        &self,
        groups: &mut Groups,
        systems: &BTreeMap<u32, System>,
    ) -> Result<Vec<SceneEquation>, InputError> {
        let mut all = Vec::new();
        for equation in &self.equations {
            let mut terms = Vec::new();
            for &(node, axis, factor) in &equation.terms {
                if systems.contains_key(&node) {
                    let message = "an equation of a node with *TRANSFORM isn't read; expected displacements along x, y and z";
                    return Err(groups.error(equation.place, message));
                }
                let Some(group) = groups.of_nodes(&[node], "equation") else {
                    let message = "the equation has a node that is none of a body; expected nodes of elements";
                    return Err(groups.error(equation.place, message));
                };
                terms.push((group, axis, factor));
            }
            all.push(SceneEquation(terms));
        }
        Ok(all)
    }
}

impl SceneTie {
    /// Writes the tie under a `name` that no other has.
    pub(super) fn write(&self, name: &str, document: &mut Document) {
        let [slave, master] = &self.sides;
        document.table("[[tie]]");
        document.key("name", quoted(name));
        document.key("sides", format!("[{}, {}]", quoted(slave), quoted(master)));
        if let Some(tolerance) = self.tolerance {
            document.key("tolerance", format!("{tolerance:?}"));
        }
        if self.adjust {
            document.key("adjust", "true");
        }
    }
}

impl SceneEquation {
    /// Writes the equation.
    pub(super) fn write(&self, document: &mut Document) {
        let term = |(group, axis, factor): &(String, usize, f64)| {
            let component = ["x", "y", "z"][*axis];
            format!(
                "{{ at = {}, component = \"{component}\", factor = {factor:?} }}",
                quoted(group)
            )
        };
        let terms: Vec<String> = self.0.iter().map(term).collect();
        document.table("[[equation]]");
        document.key("terms", format!("[\n    {},\n]", terms.join(",\n    ")));
    }
}
