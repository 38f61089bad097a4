//! One scene along each axis of difficulty, everything else as it was.

use std::time::Instant;

use contact_dd_partition::model::Model;

use super::random::{Ran, Runs};
use crate::support::blocks::{Blocks, moved};
use crate::support::scenes::{built_in_model, model};
use crate::support::stress::trial::Trial;
use crate::support::stress::{Drawn, scale};

/// A row of the table: where it stands on its axis, and how it went.
pub struct Row {
    pub axis: &'static str,
    pub value: String,
    pub ran: Ran,
}

/// A layer between two blocks, the upper one narrower and pressed at its left, pulled at its right.
#[derive(Clone, Copy)]
struct Layers {
    /// Young's modulus of the layer over that of the blocks.
    ratio: f64,
    poisson: f64,
    /// Length of the cells over their height.
    aspect: f64,
    load: f64,
    /// Size of random gaps (m); the compression is about 1e-4 m.
    roughness: f64,
    /// Thickness of the layer (m); the blocks are 1 m high.
    thickness: f64,
}

const USUAL: Layers = Layers {
    ratio: 1.0,
    poisson: 0.3,
    aspect: 1.0,
    load: 1.0,
    roughness: 0.0,
    thickness: 0.25,
};

impl Layers {
    fn model(&self) -> Model {
        let level = 1.0 + self.thickness;
        let rows = (8.0 * self.thickness).ceil() as usize;
        let blocks = Blocks::new()
            .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [16, 8])
            .rectangle("layer", [0.0, 2.0], [1.0, level], [16, rows])
            .rectangle("upper", [0.5, 1.5], [level, level + 1.0], [8, 8]);
        let mesh = moved(blocks.mesh, |[x, y]| [x * self.aspect, y]);
        let (young, poisson) = (20e9 * self.ratio, self.poisson);
        let (rough, aspect) = (self.roughness, self.aspect);
        let text = format!(
            "plane = 'strain'
            materials.rock = {{young = 20e9, poisson = {poisson}}}
            materials.seam = {{young = {young:e}, poisson = {poisson}}}
            bodies.lower.material = 'rock'
            bodies.layer.material = 'seam'
            bodies.upper.material = 'rock'
            [[displacement]]
            on = 'lower bottom'
            x = 0.0
            y = 0.0
            [[displacement]]
            on = 'layer left'
            x = 0.0
            [[displacement]]
            on = 'upper left'
            x = 0.0
            [[pressure]]
            on = 'upper top'
            value = '1e6*(1.95-1.9*x/{aspect:e})'
            [[contact]]
            name = 'below'
            sides = ['layer bottom', 'lower top']
            gap = '{rough:e}*sin(1e4*x/{aspect:e})'
            [[contact]]
            name = 'above'
            sides = ['upper bottom', 'layer top']
            gap = '{rough:e}*sin(1e4*x/{aspect:e}+2)'"
        );
        let mut model = model(&text, mesh);
        scale(&mut model, self.load);
        model
    }
}

/// Runs all rows.
pub fn table(runs: &Runs) -> Vec<Row> {
    let mut table = Table {
        runs,
        rows: Vec::new(),
    };
    let with = |change: &dyn Fn(&mut Layers)| {
        let mut layers = USUAL;
        change(&mut layers);
        layers.model()
    };
    for ratio in [1e-8, 1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6, 1e8] {
        let model = with(&|layers| layers.ratio = ratio);
        table.row(
            "stiffness of the layer over that of the blocks",
            format!("{ratio:e}"),
            model,
            7,
            0,
        );
    }
    for poisson in [0.0, 0.3, 0.49, 0.499, 0.4999, 0.499_999, 0.499_999_9] {
        let model = with(&|layers| layers.poisson = poisson);
        table.row("Poisson's ratio", poisson.to_string(), model, 7, 0);
    }
    for aspect in [1.0, 10.0, 100.0, 1000.0] {
        let model = with(&|layers| layers.aspect = aspect);
        table.row("aspect ratio of the cells", aspect.to_string(), model, 7, 0);
    }
    for load in [1e-100, 1e-30, 1e-8, 1e8, 1e30, 1e100] {
        let model = with(&|layers| layers.load = load);
        table.row("load, × 1 MPa", format!("{load:e}"), model, 7, 0);
    }
    for roughness in [0.0, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3] {
        let model = with(&|layers| layers.roughness = roughness);
        table.row("random gaps, m", format!("{roughness:e}"), model, 7, 0);
    }
    for thickness in [1.0, 0.1, 1e-2, 1e-3, 1e-4] {
        for ratio in [1e-3, 1.0, 1e3] {
            let model = with(&|layers| {
                layers.thickness = thickness;
                layers.ratio = ratio;
            });
            let value = format!("{thickness:e}, {ratio:e}");
            table.row(
                "thickness of the layer, m, and its stiffness",
                value,
                model,
                7,
                0,
            );
        }
    }
    for count in [2, 4, 8, 20, 50, 100, 200] {
        let granite = built_in_model("granite", 0);
        table.row("granite: subdomains", count.to_string(), granite, count, 0);
    }
    for refine in 0..=3 {
        let granite = built_in_model("granite", refine);
        let value = ["h", "h/2", "h/4", "h/8"][refine as usize];
        table.row("granite: mesh size", value.into(), granite, 8, 0);
    }
    for ranks in 2..=4 {
        let granite = built_in_model("granite", 0);
        table.row(
            "granite: ranks, with the bits of one",
            ranks.to_string(),
            granite,
            8,
            ranks,
        );
    }
    table.rows
}

struct Table<'a> {
    runs: &'a Runs,
    rows: Vec<Row>,
}

impl Table<'_> {
    fn row(
        &mut self,
        axis: &'static str,
        value: String,
        model: Model,
        subdomains: usize,
        ranks: usize,
    ) {
        let began = Instant::now();
        let drawn = Drawn {
            seed: 0,
            family: axis,
            cells: "triangle3",
            text: String::new(),
            manufactured: false,
            factor: 1.0,
            model,
            equilibrium: Some(true),
            subdomains,
            ranks,
            friction: None,
            determined: false,
        };
        let trial = Trial::of(&drawn, &self.runs.binary, self.runs.limit, None);
        let ran = Ran::new(&drawn, trial, began);
        println!("{axis} {value}: {}", ran.line());
        self.rows.push(Row { axis, value, ran });
    }
}
