//! `*CYCLIC SYMMETRY MODEL` and its `*TIE, CYCLIC SYMMETRY`: sectors of a ring.

use super::axes::numbers;
use super::document::{Document, Names, quoted, vector};
use super::groups::Groups;
use super::loads::item;
use super::place::Places;
use crate::element::geometry::difference;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, LinePlace};
use crate::name;

/// A tie of the sides of a sector.
struct CyclicTie {
    place: LinePlace,
    /// Its name in capitals, like those of surfaces.
    name: String,
    slave: String,
    master: String,
}

/// A model of a sector.
struct CyclicModel {
    place: LinePlace,
    /// The tie, by name in capitals.
    tie: Option<String>,
    sectors: u32,
    /// Two points of the axis (m).
    axis: [[f64; 3]; 2],
}

/// All ties and models of sectors of a deck.
#[derive(Default)]
pub(super) struct Sectors {
    ties: Vec<CyclicTie>,
    models: Vec<CyclicModel>,
}

/// A cyclic symmetry in the syntax of the scene.
pub(super) struct SceneCyclic {
    name: String,
    sides: [String; 2],
    point: [f64; 3],
    axis: [f64; 3],
    sectors: u32,
    dim: usize,
}

impl Sectors {
    /// `*TIE, CYCLIC SYMMETRY`: the slave and the master surface.
    pub(super) fn tie(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        for data in &block.data {
            let slave = places.surface(data.place, item(source, data, 0))?;
            let master = places.surface(data.place, item(source, data, 1))?;
            self.ties.push(CyclicTie {
                place: block.place,
                name: block.parameter("NAME").unwrap_or_default().to_uppercase(),
                slave,
                master,
            });
        }
        Ok(())
    }

    /// `*CYCLIC SYMMETRY MODEL`: the number of sectors, and two points of the axis.
    pub(super) fn model(&mut self, places: &Places, block: &Block) -> Result<(), InputError> {
        let source = places.source;
        let sectors = source.real(
            block.place,
            source.required(block, "N")?,
            "a number of sectors",
        )?;
        if sectors.fract() != 0.0 || !(2.0..=1e6).contains(&sectors) {
            let message =
                format!("*CYCLIC SYMMETRY MODEL of {sectors} sectors; expected a number from 2 on");
            return Err(source.error(block.place, message));
        }
        let row = match block.data.first() {
            Some(data) => numbers(source, data, "a coordinate of the axis")?,
            None => Vec::new(),
        };
        let &[x, y, z, p, q, r] = &row[..] else {
            let message = "*CYCLIC SYMMETRY MODEL has no axis; expected the coordinates of two of its points in a line behind it";
            return Err(source.error(block.place, message));
        };
        self.models.push(CyclicModel {
            place: block.place,
            tie: block.parameter("TIE").map(str::to_uppercase),
            sectors: sectors as u32,
            axis: [[x, y, z], [p, q, r]],
        });
        Ok(())
    }

    /// The cyclic symmetries, with the groups of their sides and names that aren't in `names`.
    ///
    /// # Errors
    /// A model without its tie, a tie without a model, an axis without a direction, or one in the plane of a plane
    /// model.
    pub(super) fn in_scene(
        &self,
        groups: &mut Groups,
        names: &mut Names,
    ) -> Result<Vec<SceneCyclic>, InputError> {
        let is_of = |model: &CyclicModel, tie: &CyclicTie| {
            model
                .tie
                .as_ref()
                .map_or(self.ties.len() == 1, |name| *name == tie.name)
        };
        let lonely = |tie: &&CyclicTie| !self.models.iter().any(|model| is_of(model, tie));
        if let Some(tie) = self.ties.iter().find(lonely) {
            let message = format!(
                "*TIE, CYCLIC SYMMETRY has no *CYCLIC SYMMETRY MODEL, TIE={}; expected it",
                name::shown(&tie.name)
            );
            return Err(groups.error(tie.place, &message));
        }
        let mut all = Vec::with_capacity(self.models.len());
        for model in &self.models {
            let dim = groups.dim();
            let Some(tie) = self.ties.iter().find(|tie| is_of(model, tie)) else {
                let message = "*CYCLIC SYMMETRY MODEL names no *TIE with CYCLIC SYMMETRY; expected TIE= its NAME";
                return Err(groups.error(model.place, message));
            };
            let [from, to] = model.axis;
            let axis = difference(to, from);
            let is_plane = dim == 2 && axis[..2] != [0.0; 2];
            if axis == [0.0; 3] || is_plane {
                let message = "*CYCLIC SYMMETRY MODEL: the axis has no direction, or lies in the plane; expected two points, in the \
                               plane one above the other";
                return Err(groups.error(model.place, message));
            }
            let plain = match &tie.name[..] {
                "" => "sector",
                name => name,
            };
            all.push(SceneCyclic {
                name: names.unique(plain),
                sides: [&tie.slave, &tie.master].map(|side| groups.of_surface(side)),
                point: from,
                axis,
                sectors: model.sectors,
                dim,
            });
        }
        Ok(all)
    }
}

impl SceneCyclic {
    /// Writes the symmetry.
    pub(super) fn write(&self, document: &mut Document) {
        let [a, b] = [0, 1].map(|side| quoted(&self.sides[side]));
        document.table("[[cyclic]]");
        document.key("name", quoted(&self.name));
        document.key("sides", format!("[{a}, {b}]"));
        document.key("point", vector(&self.point, self.dim));
        if self.dim == 3 {
            document.key("axis", vector(&self.axis, 3));
        }
        document.key("sectors", self.sectors);
    }
}
