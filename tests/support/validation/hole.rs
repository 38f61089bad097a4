//! A quarter of a plate with a hole, without contact.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::example;

use super::super::scenes::model;
use super::exact::Exact;
use super::{Case, Family, Gate, KINDS, Measured, falling, measured};

const TEXT: &str = "\
An infinite plate with a hole of radius a under the tension T = 100 MPa along x, plane stress: with
c2 = cos 2θ, c4 = cos 4θ, s2, s4 likewise and q = a²/r², σ_xx = T (1 − q (3/2 c2 + c4) + 3/2 q² c4),
σ_yy = T (−q (1/2 c2 − c4) − 3/2 q² c4), σ_xy = T (−q (1/2 s2 + s4) + 3/2 q² s4); 3 T beside the hole.
*Peak*: the recovered stress there.

Source: G. Kirsch, 1898; S. P. Timoshenko and J. N. Goodier, *Theory of Elasticity*.

Mesh: the built-in scene `plain` with the exact tractions on the outer sides; quadratic edges are curved.
";

const RADIUS: f64 = 0.01;
const TENSION: f64 = 100e6;

const SCENE: &str = "
    plane = 'stress'
    materials.steel = {young = 210e9, poisson = 0.3}
    bodies.plate.material = 'steel'
    [[bilateral]]
    on = 'horizontal axis'
    [[bilateral]]
    on = 'vertical axis'";

fn exact() -> Exact {
    Exact::Plane(Box::new(|[x, y]: [f64; 2]| {
        let angle = y.atan2(x);
        let q = RADIUS * RADIUS / (x * x + y * y);
        let ((s2, c2), (s4, c4)) = ((2.0 * angle).sin_cos(), (4.0 * angle).sin_cos());
        [
            1.0 - q * (1.5 * c2 + c4) + 1.5 * q * q * c4,
            -q * (0.5 * c2 - c4) - 1.5 * q * q * c4,
            -q * (0.5 * s2 + s4) + 1.5 * q * q * s4,
        ]
        .map(|s| TENSION * s)
    }))
}

fn solved(kind: ElementKind, level: usize) -> Measured {
    let mesh = example::find("plain").unwrap().mesh_of(kind, level as u32);
    let mut model = model(SCENE, mesh.unwrap());
    let exact = exact();
    exact.load(&mut model, &[("right", [1.0, 0.0]), ("top", [0.0, 1.0])]);
    let at = |p: &[f64; 3]| p[0].hypot(p[1] - RADIUS) < 1e-9;
    let peak = model.mesh.points.iter().position(at).unwrap();
    let peak = model.mesh.node_tags[peak];
    measured(model, exact, move |solution| {
        let found = solution.nodal_stress[&peak][0];
        vec![falling("peak", found / (3.0 * TENSION) - 1.0)]
    })
}

/// The plate in all kinds of cells.
pub fn case() -> Case {
    let family = |(name, kind): (&str, ElementKind)| {
        let (order, peak) = match kind.is_linear() {
            true => (0.95, 5e-2),
            false => (1.9, 1e-2),
        };
        // Other meshes are too large for the tests.
        let tested = if name.starts_with("triangle") { 2 } else { 0 };
        Family {
            name: name.into(),
            run: Box::new(move |level| solved(kind, level)),
            meshes: [tested, 3],
            gates: vec![Gate::Order("energy", order), Gate::AtMost("peak", peak)],
        }
    };
    Case {
        title: "Plate with a hole",
        text: TEXT,
        families: KINDS.map(family).into(),
    }
}
