//! A flat rigid punch with sharp corners, half of it by symmetry.

use std::f64::consts::PI;

use nalgebra::Complex;

use super::super::scenes::model;
use super::super::solution::Solution;
use super::super::sorts::sort;
use super::exact::Exact;
use super::hertz::square;
use super::{Case, Family, Figure, Gate, Measured, falling, gather, measured, plain};

const TEXT: &str = "\
A flat rigid punch of half-width a = 1, load P = 10 per unit of length, on a half plane with E = 200,
ν = 0.3, plane strain: pressure P/(π √(a² − x²)). Stresses as for Hertz with
Z = −P/(π √(a² − z²)). *Resultant*: the sum of the contact forces against P/2; *pressure*: the largest
error where x ≤ 0.8 a.

Source: K. L. Johnson, *Contact Mechanics*, Cambridge University Press 1985, chapter 2.

Mesh: the square [0, 2] × [−2, 0] with the tractions of the half plane on its right and lower side, graded
(3rd power) towards the corner of the punch, which is singular: expected orders are 1 and 1.5.
";

const LOAD: f64 = 10.0;

const SCENE: &str = "
    plane = 'strain'
    materials.steel = {young = 200, poisson = 0.3}
    bodies.body.material = 'steel'
    [[bilateral]]
    on = 'body under left'
    [[contact]]
    name = 'punch'
    sides = ['body under top']
    obstacle = {point = [0, 0], normal = [0, -1]}";

fn exact() -> Exact {
    Exact::Plane(Box::new(|[x, y]: [f64; 2]| {
        let z = Complex::new(x, y);
        let root = (Complex::from(1.0) - z * z).sqrt();
        let value = -(LOAD / PI) / root;
        let slope = -(LOAD / PI) * z / (root * root * root);
        [
            value.re - y * slope.im,
            value.re + y * slope.im,
            -y * slope.re,
        ]
    }))
}

fn solved(name: &str, n: usize) -> Measured {
    let mut mesh = sort(name).of(&square(["body", "below"], n, 3.0, 1.0));
    gather(&mut mesh, "body", &["body under", "body beside"]);
    let mut model = model(SCENE, mesh);
    let exact = exact();
    exact.load(
        &mut model,
        &[
            ("body under bottom", [0.0, -1.0]),
            ("body beside bottom", [0.0, -1.0]),
            ("body beside right", [1.0, 0.0]),
        ],
    );
    measured(model, exact, of_punch)
}

fn of_punch(solution: &Solution) -> Vec<Figure> {
    let points = &solution.contacts["punch"];
    let total: f64 = points.iter().map(|point| point.force).sum();
    let inside = points.iter().filter(|point| point.position[0] <= 0.8);
    let error = inside.map(|point| {
        let x = point.position[0];
        (point.pressure * PI * (1.0 - x * x).sqrt() / LOAD - 1.0).abs()
    });
    vec![
        falling("pressure", error.fold(0.0, f64::max)),
        plain("resultant", total / (0.5 * LOAD) - 1.0),
    ]
}

/// The punch on linear and quadratic cells.
pub fn case() -> Case {
    let family = |name: &'static str| {
        let is_quadratic = sort(name).is_quadratic;
        let order = if is_quadratic { 1.4 } else { 0.9 };
        let finer = if is_quadratic { 1 } else { 2 };
        Family {
            name: name.into(),
            run: Box::new(move |level| solved(name, finer << level)),
            meshes: [3, 4],
            gates: vec![
                Gate::Order("energy", order),
                Gate::AtMost("pressure", 2e-2),
                Gate::AtMost("resultant", 1e-4),
            ],
        }
    };
    Case {
        title: "Flat rigid punch",
        text: TEXT,
        families: ["triangle3", "quad4", "triangle6", "quad9"]
            .map(family)
            .into(),
    }
}
