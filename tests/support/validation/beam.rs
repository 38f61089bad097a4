//! A cantilever, without contact.

use super::super::blocks::Blocks;
use super::super::scenes::model;
use super::super::sorts::sort;
use super::exact::Exact;
use super::{Case, Family, Gate, Measured, falling, measured};

const TEXT: &str = "\
A cantilever of length L = 8 and height D = 2, E = 200, ν = 0.3, plane stress, shear force P = 1 at its
end: σ_xx = −P (L − x) y/I, σ_xy = P/(2I) (D²/4 − y²), I = D³/12, deflection of the end
P/(6EI) ((4 + 5ν) D² L/4 + 2 L³).

Source: S. P. Timoshenko and J. N. Goodier, *Theory of Elasticity*; tractions at both ends:
C. E. Augarde and A. J. Deeks, *The use of Timoshenko's exact solution for a cantilever beam in adaptive
analysis*, Finite Elem. Anal. Des. 44 (2008).

Mesh: rectangles, halved for triangles; exact displacement at x = 0, exact traction at x = L.
";

const LENGTH: f64 = 8.0;
const INERTIA: f64 = 8.0 / 12.0;
const POISSON: f64 = 0.3;

/// P/(6EI).
const FACTOR: f64 = 1.0 / (6.0 * 200.0 * INERTIA);

fn solved(name: &str, n: usize) -> Measured {
    let blocks = Blocks::new().rectangle("beam", [0.0, LENGTH], [-1.0, 1.0], [4 * n, n]);
    let mesh = sort(name).of(&blocks.mesh);
    let tip = mesh
        .points
        .iter()
        .position(|p| p[0] == LENGTH && p[1].abs() < 1e-12);
    let tip = mesh.node_tags[tip.unwrap()];
    let text = format!(
        "plane = 'stress'
        materials.steel = {{young = 200, poisson = {POISSON}}}
        bodies.beam.material = 'steel'
        [[displacement]]
        on = 'beam left'
        x = '-{FACTOR}*y*{}*(y^2 - 1)'
        y = '{FACTOR}*{}*y^2'",
        2.0 + POISSON,
        3.0 * POISSON * LENGTH,
    );
    let mut model = model(&text, mesh);
    let exact = Exact::Plane(Box::new(|[x, y]: [f64; 2]| {
        [
            -(LENGTH - x) * y / INERTIA,
            0.0,
            (1.0 - y * y) / (2.0 * INERTIA),
        ]
    }));
    exact.load(&mut model, &[("beam right", [1.0, 0.0])]);
    let deflection = FACTOR * ((4.0 + 5.0 * POISSON) * LENGTH + 2.0 * LENGTH.powi(3));
    measured(model, exact, move |solution| {
        let found = solution.displacement[&tip][1];
        vec![falling("deflection", found / deflection - 1.0)]
    })
}

/// The cantilever in all kinds of cells.
pub fn case() -> Case {
    let family = |name: &'static str| {
        let is_quadratic = sort(name).is_quadratic;
        let (order, deflection) = if is_quadratic {
            (1.95, 1e-4)
        } else {
            (0.95, 2e-2)
        };
        Family {
            name: name.into(),
            run: Box::new(move |level| solved(name, 4 << level)),
            meshes: [3, 4],
            gates: vec![
                Gate::Order("energy", order),
                Gate::AtMost("deflection", deflection),
            ],
        }
    };
    Case {
        title: "Cantilever",
        text: TEXT,
        families: ["triangle3", "quad4", "triangle6", "quad8", "quad9"]
            .map(family)
            .into(),
    }
}
