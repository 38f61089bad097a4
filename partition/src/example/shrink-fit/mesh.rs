//! A hub shrunk onto a shaft: half a meridian section around the axis.

use super::Shape;
use super::pattern::Pattern;
use super::squares::{Square, quadrilateral};

pub(super) const ABOUT: &str =
    "a hub shrunk onto a shaft and pushed along it, around an axis, partial slip";
pub(super) const SUBDOMAINS: usize = 6;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Radii of shaft and hub (mm).
const RADII: [f64; 2] = [50.0, 100.0];

/// Length of the shaft, and position of the hub (mm).
const SHAFT: f64 = 120.0;
const HUB: [f64; 2] = [20.0, 100.0];

/// Size of the cells (mm).
const SIZE: f64 = 5.0;

fn rectangle(body: &str, x: [f64; 2], y: [f64; 2], sides: [Option<&str>; 4]) -> Square {
    let corners = [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
    let [columns, rows] = [x, y].map(|[from, to]| ((to - from) / SIZE) as usize);
    Square::new(
        body,
        Pattern::Grid(columns, rows),
        quadrilateral(corners),
        sides,
    )
}

fn squares() -> Vec<Square> {
    let [bore, outside] = RADII;
    let of_shaft = [
        Some("shaft bottom"),
        Some("shaft surface"),
        Some("shaft top"),
        None,
    ];
    let of_hub = [
        Some("hub bottom"),
        Some("hub outside"),
        Some("hub top"),
        Some("bore"),
    ];
    vec![
        rectangle("shaft", [0.0, bore], [0.0, SHAFT], of_shaft),
        rectangle("hub", [bore, outside], HUB, of_hub),
    ]
}
