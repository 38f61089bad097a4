//! A closed inclined crack, rotated so that it lies along x.

use std::f64::consts::PI;

use contact_dd_partition::model::Model;
use nalgebra::Complex;

use super::super::blocks::Blocks;
use super::super::scenes::model;
use super::super::solution::Solution;
use super::super::sorts::sort;
use super::exact::Exact;
use super::{Case, Family, Figure, Gate, Measured, falling, gather, measured, plain};

const TEXT: &str = "\
A crack of half-length b = 1 m at ψ = 20° to a pressure of σ = 100 MPa, E = 25 GPa, ν = 0.25, plane strain: t_N = −σ sin²ψ = −11.698 MPa, slip 4 (1 − ν²)/E σ sinψ cosψ √(b² − x²), at most
4.8209e-3 m. With Z = −σ sinψ cosψ z/√(z² − b²) the shear that the crack doesn't carry adds
σ_xx = 2 Im Z + y Re Z', σ_yy = −y Re Z', σ_xy = Re Z − y Im Z'.

Source: A.-V. Phan, J. A. L. Napier, L. J. Gray, T. Kaplan, *Symmetric-Galerkin BEM simulation of fracture
with frictional contact*, Int. J. Numer. Meth. Engng 57 (2003); stresses by Westergaard's function of
the second mode and K_II = σ sinψ cosψ √(πb), H. Tada, P. C. Paris, G. R. Irwin, *The Stress Analysis of Cracks Handbook*.

Mesh: the square [−3, 3]² with the exact tractions, graded (3rd power) towards both tips and the crack.
The tips are singular: expected orders are 1 for linear and 1.5 for quadratic cells.
";

const WITH_FRICTION: &str = "\
The same crack with Coulomb's friction, μ = 0.6: what its sides carry of the shear by μ |t_N| drops out of the slip,
4 (1 − ν²)/E σ (sinψ cosψ − μ sin²ψ) √(b² − x²), at most 3.7681e-3 m, of K_II, and of Z, and adds to σ_xy everywhere. Above
μ = cot ψ = 2.7475 nothing slips. *Sticking*: how many points don't slip.

Source and mesh: as above.
";

const HALF: f64 = 3.0;
const LOAD: f64 = 100e6;
/// The coefficient of friction in the case with friction.
const FRICTION: f64 = 0.6;
const SCENE: &str = "
    plane = 'strain'
    materials.rock = {young = 25e9, poisson = 0.25}
    bodies.plate.material = 'rock'
    [[contact]]
    name = 'crack'
    sides = ['middle above bottom', 'middle below top']
    gap = 0";

/// sinψ and cosψ.
fn inclination() -> [f64; 2] {
    let (sin, cos) = 20_f64.to_radians().sin_cos();
    [sin, cos]
}

/// Shear along the crack: the part that its sides carry, and the rest.
fn shears(friction: f64) -> [f64; 2] {
    let [sin, cos] = inclination();
    let whole = LOAD * sin * cos;
    let carried = (friction * LOAD * sin * sin).min(whole);
    [carried, whole - carried]
}

fn exact(friction: f64) -> Exact {
    let [sin, cos] = inclination();
    let [carried, slipping] = shears(friction);
    Exact::Plane(Box::new(move |[x, y]: [f64; 2]| {
        let z = Complex::new(x, y);
        let root = (z - 1.0).sqrt() * (z + 1.0).sqrt();
        let shear = -slipping;
        let value = z / root * shear;
        let slope = -shear / (root * root * root);
        [
            -LOAD * cos * cos + 2.0 * value.im + y * slope.re,
            -LOAD * sin * sin - y * slope.re,
            value.re - y * slope.im - carried,
        ]
    }))
}

/// The crack in cells of a kind, with a coefficient of friction and the loads of its exact solution.
fn posed(name: &str, n: usize, friction: f64) -> (Model, Exact) {
    let graded = |s: f64| s.powi(3);
    let outer = HALF - 1.0;
    let x = move |column: &str, s: f64| match column {
        "left" => -1.0 - outer * graded(1.0 - s),
        "right" => 1.0 + outer * graded(s),
        _ if s < 0.5 => -1.0 + graded(2.0 * s),
        _ => 1.0 - graded(2.0 - 2.0 * s),
    };
    let mut blocks = Blocks::new();
    for (column, cells) in [("left", n), ("middle", 2 * n), ("right", n)] {
        blocks = blocks
            .mapped(&format!("{column} below"), [cells, n], |[s, t]| {
                [x(column, s), -HALF * graded(1.0 - t)]
            })
            .mapped(&format!("{column} above"), [cells, n], |[s, t]| {
                [x(column, s), HALF * graded(t)]
            });
    }
    // The sides of the crack share only the nodes at the tips.
    let blocks = blocks.glued(|x, y| y != 0.0 || x.abs() > 1.0 - 1e-9);
    let mut mesh = sort(name).of(&blocks.mesh);
    let pieces =
        ["left", "middle", "right"].map(|c| ["below", "above"].map(|r| format!("{c} {r}")));
    let pieces: Vec<&str> = pieces.iter().flatten().map(String::as_str).collect();
    gather(&mut mesh, "plate", &pieces);
    let law = match friction {
        0.0 => String::new(),
        _ => format!("\nfriction = {friction}"),
    };
    let mut model = model(&(SCENE.to_owned() + &law), mesh);
    let exact = exact(friction);
    for column in ["left", "middle", "right"] {
        let ends = [
            format!("{column} below bottom"),
            format!("{column} above top"),
        ];
        exact.load(
            &mut model,
            &[(&ends[0], [0.0, -1.0]), (&ends[1], [0.0, 1.0])],
        );
    }
    for row in ["below", "above"] {
        let ends = [format!("left {row} left"), format!("right {row} right")];
        exact.load(
            &mut model,
            &[(&ends[0], [-1.0, 0.0]), (&ends[1], [1.0, 0.0])],
        );
    }
    (model, exact)
}

fn solved(name: &str, n: usize, friction: f64) -> Measured {
    let (model, exact) = posed(name, n, friction);
    measured(model, exact, move |solution| of_crack(solution, friction))
}

/// The sticking crack, and its uniform stress.
pub fn stuck(friction: f64) -> (Model, Exact) {
    posed("quad4", 8, friction)
}

/// Errors of the largest slip and of the pressure.
fn of_crack(solution: &Solution, friction: f64) -> Vec<Figure> {
    let [sin, _] = inclination();
    let slip = 4.0 * (1.0 - 0.25 * 0.25) / 25e9 * shears(friction)[1];
    let pressure = LOAD * sin * sin;
    let points = &solution.contacts["crack"];
    let largest = points.iter().map(|point| {
        let [a, b] = point.tags.map(|tag| solution.displacement[&tag][0]);
        (a - b).abs()
    });
    let errors = points
        .iter()
        .map(|point| (point.pressure / pressure - 1.0).abs());
    let factor = shears(friction)[1] * PI.sqrt();
    let tips = solution.stress_intensity();
    let off = |of_tip: &[f64; 2]| (of_tip[1].abs() / factor - 1.0).abs();
    let opening = tips.iter().map(|[opening, _]| (opening / factor).abs());
    let mut figures = vec![
        falling("slip", largest.fold(0.0, f64::max) / slip - 1.0),
        falling("K_II", tips.iter().map(off).fold(0.0, f64::max)),
        plain("K_I", opening.fold(0.0, f64::max)),
        plain("pressure", errors.fold(0.0, f64::max)),
    ];
    if friction > 0.0 {
        let sticking = points.iter().filter(|point| !point.slipping).count();
        figures.push(plain("sticking", sticking as f64));
    }
    figures
}

fn families(friction: f64, names: &[&'static str]) -> Vec<Family> {
    let family = |&name: &&'static str| {
        let is_quadratic = sort(name).is_quadratic;
        let order = if is_quadratic { 1.3 } else { 0.85 };
        let finer = if is_quadratic { 4 } else { 8 };
        let mut gates = vec![
            Gate::Order("energy", order),
            Gate::AtMost("slip", 3e-2),
            Gate::AtMost("K_II", if is_quadratic { 1e-3 } else { 1e-2 }),
            Gate::AtMost("K_I", 1e-3),
            Gate::AtMost("pressure", 1e-8),
        ];
        if friction > 0.0 {
            gates.push(Gate::AtMost("sticking", 0.0));
        }
        Family {
            name: name.into(),
            run: Box::new(move |level| solved(name, finer << level, friction)),
            meshes: [2, 4],
            gates,
        }
    };
    names.iter().map(family).collect()
}

/// The crack in linear and quadratic cells.
pub fn case() -> Case {
    Case {
        title: "Closed inclined crack",
        text: TEXT,
        families: families(0.0, &["triangle3", "quad4", "triangle6", "quad9"]),
    }
}

/// The crack with friction.
pub fn with_friction() -> Case {
    Case {
        title: "Closed inclined crack with friction",
        text: WITH_FRICTION,
        families: families(FRICTION, &["triangle3", "quad4", "triangle6", "quad9"]),
    }
}
