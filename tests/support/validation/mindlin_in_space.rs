//! Two equal balls pressed together and then pushed along their contact.

use std::f64::consts::{FRAC_PI_4, PI};

use contact_dd_partition::element::ElementKind::{self, Hexahedron8, Hexahedron27};
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use super::super::blocks::{glued, joined, named};
use super::super::scenes::model;
use super::super::solids::moved;
use super::super::solution::Solution;
use super::indentation::{SIDE, cylinder};
use super::{Case, Family, Figure, Gate, Measured, figured_steps, gather, plain};

const TEXT: &str = "\
Two equal balls of radius R = 8, E = 200, ν = 0, μ = 0.5, are pressed on each other by P and then pushed along the contact
by Q. They stick where r < c = a (1 − Q/μP)^(1/3), at Q = ½ μP c/a = 0.7937; the shear stress is μ p₀/a (√(a² − r²) −
√(c² − r²)), along the push. With the P and Q of the solution, a³ = 3 P R/(4 E): by ν = 0 that is exact for half spaces,
and pushing leaves P as it is.

Source: R. D. Mindlin, *Compliance of elastic bodies in contact*, J. Appl. Mech. 16 (1949); K. L. Johnson, chapter 7.

Mesh: halves of two cylinders of radius 2 and height 2, gap r²/8, with matching nodes; their ends are moved towards each other, and the
upper one is pushed with half of μP of a solution without Q.

*Push*: Q/μP against ½; *zone*: how far the farthest node that sticks or slips where it shouldn't is from r = c, in cells; *share*: c/a with c
from the area that sticks, against the exact one, which jumps with every node; *shear*: Σ|error of the tangential force| over μP.
";

const FRICTION: f64 = 0.5;
/// Radius of the part of the contact with cells of one size.
const FINE: f64 = 0.9;

/// The half of a cylinder below the contact where y ≥ 0.
fn half(kind: ElementKind, n: usize) -> Mesh {
    let quarter = || cylinder(kind, [n, 2 * n], 1.0, FINE);
    let first = quarter();
    let mut second = moved(quarter(), |[x, y, z]| [-y, x, z]);
    let groups = std::mem::take(&mut second.groups);
    second.groups = (groups.into_iter())
        .map(|(name, group)| (format!("{name} left"), group))
        .collect();
    let mut mesh = glued(joined(first, second), |_| true);
    for name in ["body", "top", "low"] {
        gather(&mut mesh, name, &[name, &format!("{name} left")]);
    }
    gather(&mut mesh, "front", &["y = 0", "x = 0 left"]);
    mesh.groups
        .retain(|name, _| ["body", "top", "low", "front"].contains(&name.as_str()));
    mesh
}

fn posed(kind: ElementKind, n: usize, push: f64) -> Model {
    let lower = named(half(kind, n), "lower");
    // The upper half is rotated about y.
    let upper = named(moved(half(kind, n), |[x, y, z]| [-x, y, -z]), "upper");
    let text = format!(
        "materials.steel = {{young = 200, poisson = 0.0}}
        bodies.'lower body'.material = 'steel'
        bodies.'upper body'.material = 'steel'
        [[bilateral]]
        on = ['lower front', 'upper front']
        [[displacement]]
        on = 'lower low'
        x = 0
        y = 0
        z = 0.06
        [[displacement]]
        on = 'upper low'
        z = -0.06
        [[traction]]
        on = 'upper low'
        value = [{push:e}, 0, 0]
        [[contact]]
        name = 'contact'
        sides = ['lower top', 'upper top']
        gap = '(x^2+y^2)/8'
        friction = {FRICTION}
        [[step]]
        scale = {{traction = 0}}
        [[step]]"
    );
    model(&text, joined(lower, upper))
}

fn solved(kind: ElementKind, n: usize) -> Measured {
    // Pushing doesn't change P, as ν = 0.
    let pressed = figured_steps(&posed(kind, n, 0.0), |solutions| {
        let points = &solutions[0].contacts["contact"];
        vec![plain("P", points.iter().map(|p| p.force).sum())]
    });
    // Linear cells replace the round side by chords.
    let angle = FRAC_PI_4 / n as f64;
    let chords = if kind.is_linear() {
        angle.sin() / angle
    } else {
        1.0
    };
    let end = 0.5 * PI * SIDE * SIDE * chords;
    let push = 0.5 * FRICTION * pressed.figures[0].value / end;
    let nodes = if kind.is_linear() { 1 } else { 2 };
    // Cell size across the ring.
    let cell = 0.5 * FINE / (2 * n * nodes) as f64;
    figured_steps(&posed(kind, n, push), |solutions| {
        figures(&solutions[1], cell)
    })
}

fn figures(solution: &Solution, cell: f64) -> Vec<Figure> {
    let points = &solution.contacts["contact"];
    // Twice the force on half of the contact.
    let force = 2.0 * points.iter().map(|p| p.force).sum::<f64>();
    let push = 2.0 * points.iter().map(|p| p.tangential_force[0]).sum::<f64>();
    let a = (0.75 * force * 8.0 / 200.0).cbrt();
    let share = (1.0 - push.abs() / (FRICTION * force)).cbrt();
    let away = |p: [f64; 3]| p[0].hypot(p[1]);
    let closed = points.iter().filter(|p| p.closed);
    let wrong = closed
        .clone()
        .filter(|p| p.slipping != (away(p.position) > share * a));
    let farthest = wrong.map(|p| (away(p.position) - share * a).abs());
    let area = |p: &super::super::solution::ContactPoint| p.force / p.pressure;
    let sticks: f64 = closed
        .clone()
        .filter(|p| !p.slipping && p.pressure > 0.0)
        .map(area)
        .sum();
    let largest = FRICTION * 1.5 * force / (PI * a * a);
    let within = |w: f64, r: f64| (w * w - r * r).max(0.0).sqrt();
    let off = closed.filter(|p| p.pressure > 0.0).map(|p| {
        let r = away(p.position);
        let exact = largest / a * (within(a, r) - within(share * a, r));
        let x = exact * area(p) * push.signum();
        (p.tangential_force[0] - x).hypot(p.tangential_force[1])
    });
    vec![
        plain("push", 2.0 * push / (FRICTION * force) - 1.0),
        plain("zone, cells", farthest.fold(0.0, f64::max) / cell),
        plain("share", (2.0 * sticks / PI).sqrt() / (share * a) - 1.0),
        plain("shear", 2.0 * off.sum::<f64>() / (FRICTION * force)),
    ]
}

/// Two balls.
pub fn case() -> Case {
    let family = |(name, kind, n, tested): (&str, ElementKind, usize, usize)| Family {
        name: name.into(),
        run: Box::new(move |level| solved(kind, n << level)),
        meshes: [tested, 2],
        gates: vec![
            Gate::AtMost("push", 1e-2),
            Gate::AtMost("zone, cells", 1.0),
            Gate::AtMost("share", 1e-1),
            Gate::AtMost("shear", 0.2),
        ],
    };
    Case {
        title: "Mindlin in space: balls pushed along their contact",
        text: TEXT,
        families: [
            ("hexahedron8", Hexahedron8, 2, 1),
            ("hexahedron27", Hexahedron27, 1, 0),
        ]
        .map(family)
        .into(),
    }
}
