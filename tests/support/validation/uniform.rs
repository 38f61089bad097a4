//! Fields that every mesh represents exactly: uniform compression through contacts.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::example;

use super::super::blocks::{Blocks, jittered};
use super::super::scenes::model;
use super::super::solution::Solution;
use super::super::sorts::sort;
use super::super::uneven::{PRESSURE, turned_pressure, two_sorts};
use super::exact::Exact;
use super::{Case, Family, Figure, Gate, KINDS, measured, plain};

const PATCH: &str = "\
Two blocks with an inclined joint, pressure p = 1 MPa from above and from the right: σ = −p I in the plane,
contact pressure p, exact on every mesh.

Source: after R. L. Taylor and P. Papadopoulos, *On a patch test for contact problems in two
dimensions*, in P. Wriggers and W. Wagner (eds.), *Nonlinear Computational Mechanics*, Springer 1991.

Mesh: the blocks of the built-in scene `patch` in irregular cells.
";

const UNEVEN: &str = "\
Two blocks, E = 210 and 20 GPa, ν = 0.3 and 0.22, non-matching nodes, p = 1 MPa on the upper one:
σ = −p n nᵀ with n the normal of the joint, contact pressure p, exact on every mesh. The upper
side is side a.

Source: as above; dual multipliers on segments: B. I. Wohlmuth, *A mortar finite element method using
dual spaces for the Lagrange multiplier*, SIAM J. Numer. Anal. 38 (2000).

Mesh: blocks of 2 × 1 m turned by 0.4, 3 cells of unequal widths along the joint below and 7 above, refined
by halving.
";

const JUNCTION: &str = "\
Four blocks, three contacts that meet in a point, rollers on the left and below, 1 MPa from the right and
from above: σ = −p I, pressure p on every contact.

Source: equilibrium.

Mesh: the built-in scene `junction`.
";

/// Largest relative error of the contact pressure from `p`.
fn pressure_error(solution: &Solution, p: f64) -> Vec<Figure> {
    let errors = solution
        .points()
        .map(|point| (point.pressure / p - 1.0).abs());
    let open = solution.points().filter(|point| !point.closed).count();
    vec![
        plain("pressure", errors.fold(0.0, f64::max)),
        plain("open contacts", open as f64),
    ]
}

fn compression() -> Exact {
    Exact::Plane(Box::new(|_| [-1e6, -1e6, 0.0]))
}

fn gates() -> Vec<Gate> {
    vec![
        Gate::AtMost("energy", 1e-10),
        Gate::AtMost("pressure", 1e-10),
        Gate::AtMost("open contacts", 0.0),
    ]
}

/// The patch test with matching nodes.
pub fn patch() -> Case {
    let scene = "
        plane = 'strain'
        materials.rock = {young = 20e9, poisson = 0.25}
        bodies.lower.material = 'rock'
        bodies.upper.material = 'rock'
        [[bilateral]]
        on = ['lower bottom', 'lower left', 'upper left']
        [[pressure]]
        on = ['upper top', 'lower right', 'upper right']
        value = 1e6
        [[contact]]
        name = 'joint'
        sides = ['lower top', 'upper bottom']
        gap = 0";
    let family = |name: &'static str| Family {
        name: name.into(),
        run: Box::new(move |level| {
            let [left, right] = [[0.0, 0.8], [2.0, 1.2]];
            let n = 4 << level;
            let blocks = Blocks::new()
                .quadrilateral("lower", [[0.0, 0.0], [2.0, 0.0], right, left], [n, n / 2])
                .quadrilateral("upper", [left, right, [2.0, 2.0], [0.0, 2.0]], [n, n / 2]);
            let mesh = sort(name).of(&jittered(blocks.mesh, 0.2 / n as f64, 7));
            let model = model(scene, mesh);
            measured(model, compression(), |solution| {
                pressure_error(solution, 1e6)
            })
        }),
        meshes: [2, 3],
        gates: gates(),
    };
    let kinds = ["triangle3", "quad4", "triangle6", "quad8", "quad9"];
    Case {
        title: "Patch test: matching nodes",
        text: PATCH,
        families: kinds.into_iter().map(family).collect(),
    }
}

/// The patch test with non-matching nodes, every kind of cells on every other.
pub fn uneven() -> Case {
    const ANGLE: f64 = 0.4;
    let family = |lower: &'static str, upper: &'static str| Family {
        name: match lower == upper {
            true => upper.into(),
            false => format!("{upper} on {lower}"),
        },
        run: Box::new(move |level| {
            let n = [3, 7].map(|n| n << level);
            let model = two_sorts([lower, upper].map(sort), n, 3 << level, ANGLE, false);
            let exact = Exact::Plane(Box::new(|_| turned_pressure(ANGLE)));
            measured(model, exact, |solution| pressure_error(solution, PRESSURE))
        }),
        meshes: if lower == upper { [2, 3] } else { [1, 1] },
        gates: gates(),
    };
    let alone = KINDS.map(|(name, _)| family(name, name));
    let pairs = KINDS
        .iter()
        .flat_map(|(lower, _)| KINDS.iter().map(move |(upper, _)| (*lower, *upper)));
    let mixed = pairs.filter(|(lower, upper)| lower != upper);
    Case {
        title: "Patch test: nodes that don't match",
        text: UNEVEN,
        families: alone
            .into_iter()
            .chain(mixed.map(|(lower, upper)| family(lower, upper)))
            .collect(),
    }
}

/// Three contacts that meet.
pub fn junction() -> Case {
    let family = |(name, kind): (&str, ElementKind)| Family {
        name: name.into(),
        run: Box::new(move |level| {
            let example = example::find("junction").unwrap();
            let mesh = example.mesh_of(kind, level as u32).unwrap();
            let model = model(example.scene, mesh);
            measured(model, compression(), |solution| {
                pressure_error(solution, 1e6)
            })
        }),
        meshes: [1, 2],
        gates: gates(),
    };
    Case {
        title: "Junction",
        text: JUNCTION,
        families: KINDS.map(family).into(),
    }
}
