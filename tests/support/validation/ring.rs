//! Axisymmetric balls and a flat punch, on the half space.

use std::f64::consts::PI;

use contact_dd_partition::mesh::Mesh;

use super::super::blocks::joined;
use super::super::scenes::model;
use super::super::solution::{ContactPoint, Solution};
use super::super::sorts::{Sort, sort};
use super::half_space::{LOAD, depth, of_ball, of_punch, peak, radius, ring};
use super::hertz::square;
use super::{Case, Family, Figure, Gate, Measured, falling, gather, measured, plain};

const BALL: &str = "\
A ball of radius R = 8, E = 200, ν = 0.3 on a rigid plane, P = 10, around its axis: a³ = 3 P R/(4 E\\*) with
E\\* = E/(1 − ν²), so that a = 0.64871; pressure p₀ √(1 − r²/a²), p₀ = 3 P/(2π a²) = 11.3462. Stresses of the half
space z ≥ 0 from a harmonic F with F_z the pressure at z = 0: σ_zz = −F_z + z F_zz, σ_rz = z F_rz and so on, F_z =
−p₀/a Im(z ln(R + ζ) − R), R² = r² + ζ², ζ = z + i a.

Source: K. L. Johnson, *Contact Mechanics*, Cambridge University Press 1985, chapter 3; A. E. Green and W. Zerna,
*Theoretical Elasticity*, Oxford 1968.

Mesh: half a section [0, 2] × [−2, 0] with the tractions of the half space on its right and lower side, gap r²/16,
graded towards r = a and y = 0 with the 1.6th power. Only contact supports the body. *p₀*: pressure on the axis, where
that of linear cells is less accurate than elsewhere; *radius*: number of cells between r = a and the last closed
node; *resultant*: sum of the contact forces.

By their order, linear cells come to 0.2 % of p₀ from some 220 000 dofs (`quad4`) or 550 000 (`triangle3`) on.
";

const BALLS: &str = "\
Two such balls on each other, gap r²/8, 3 cells above for 2 below (`mortar`), the lower side being side a.

Source and mesh: as above.
";

const PUNCH: &str = "\
A flat rigid punch of radius a = 1, P = 10, on a half space with E = 200, ν = 0.3, around its axis: pressure
P/(2π a²) (1 − r²/a²)^(−1/2), depth P/(2 a E\\*). Stresses as above with F_z = −P/(2π a) Im(1/R).
*Depth*: between the middle of the punch and the middle of the lower side, against the exact difference;
*pressure*: the largest error where r ≤ 0.8 a.

Source: I. N. Sneddon, 1946; K. L. Johnson, chapter 3.

Mesh: as above with a = 1, graded with the 3rd power: the edge of the punch is singular, and expected orders are 1 and
1.5.
";

/// The section of a body in cells of a sort.
fn section(sort: Sort, [body, row]: [&str; 2], n: usize, grading: f64, a: f64) -> Mesh {
    let mut mesh = sort.of(&square([body, row], n, grading, a));
    let pieces = ["under", "beside"].map(|piece| format!("{body} {piece}"));
    gather(&mut mesh, body, &[&pieces[0], &pieces[1]]);
    mesh
}

const OUTSIDE: [(&str, [f64; 2]); 3] = [
    ("lower beside right", [1.0, 0.0]),
    ("lower under bottom", [0.0, -1.0]),
    ("lower beside bottom", [0.0, -1.0]),
];

const SCENE: &str = "
    plane = 'axisymmetric'
    materials.steel = {young = 200, poisson = 0.3}
    bodies.lower.material = 'steel'
    [[contact]]
    name = 'contact'
    obstacle = {point = [0, 0], normal = [0, -1]}
";

fn solve_ball(sort: Sort, n: usize) -> Measured {
    let text = format!("{SCENE}sides = [['lower under top', 'lower beside top']]\ngap = 'x^2/16'");
    let mesh = section(sort, ["lower", "below"], n, 1.6, radius());
    let mut model = model(&text, mesh);
    ring(of_ball).load(&mut model, &OUTSIDE);
    measured(model, ring(of_ball), of_contact)
}

fn solve_balls(sort: Sort, n: usize) -> Measured {
    let text = "
        plane = 'axisymmetric'
        materials.steel = {young = 200, poisson = 0.3}
        bodies.lower.material = 'steel'
        bodies.upper.material = 'steel'
        [[contact]]
        name = 'contact'
        sides = [
            ['lower under top', 'lower beside top'],
            ['upper under bottom', 'upper beside bottom'],
        ]
        gap = 'x^2/8'";
    let lower = section(sort, ["lower", "below"], 2 * n, 1.6, radius());
    let upper = section(sort, ["upper", "above"], 3 * n, 1.6, radius());
    let mut model = model(text, joined(lower, upper));
    let above = [
        ("upper beside right", [1.0, 0.0]),
        ("upper under top", [0.0, 1.0]),
        ("upper beside top", [0.0, 1.0]),
    ];
    ring(of_ball).load(&mut model, &[&OUTSIDE[..], &above].concat());
    measured(model, ring(of_ball), of_contact)
}

fn solve_punch(sort: Sort, n: usize) -> Measured {
    let text = format!("{SCENE}sides = ['lower under top']");
    let mesh = section(sort, ["lower", "below"], n, 3.0, 1.0);
    let mut model = model(&text, mesh);
    ring(of_punch).load(&mut model, &OUTSIDE);
    let tag_at = |y: f64| {
        let points = model.mesh.points.iter();
        let place = points.zip(&model.mesh.node_tags);
        let mut found = place.filter(|(x, _)| x[0] == 0.0 && (x[1] - y).abs() < 1e-9);
        *found.next().unwrap().1
    };
    let tags = [tag_at(0.0), tag_at(-2.0)];
    measured(model, ring(of_punch), move |solution| {
        let points = &solution.contacts["contact"];
        let inside = points.iter().filter(|point| point.position[0] <= 0.8);
        let error = inside.map(|point| {
            let r = point.position[0];
            let exact = LOAD / (2.0 * PI) / (1.0 - r * r).sqrt();
            (point.pressure / exact - 1.0).abs()
        });
        let [top, bottom] = tags.map(|tag| -solution.displacement[&tag][1]);
        let deep = depth(0.0) - depth(2.0);
        vec![
            falling("depth", (top - bottom) / deep - 1.0),
            plain("pressure", error.fold(0.0, f64::max)),
            resultant(points),
        ]
    })
}

fn resultant(points: &[ContactPoint]) -> Figure {
    let total: f64 = points.iter().map(|point| point.force).sum();
    plain("resultant", total / LOAD - 1.0)
}

fn of_contact(solution: &Solution) -> Vec<Figure> {
    let mut points = solution.contacts["contact"].clone();
    points.sort_by(|p, q| p.position[0].total_cmp(&q.position[0]));
    let at = |i: usize| points[i].position[0];
    assert_eq!(at(0), 0.0);
    let last = points.iter().rposition(|point| point.closed).unwrap();
    let cell = (at(last + 1) - at(last)).max(at(last) - at(last - 1));
    vec![
        falling("p₀", points[0].pressure / peak() - 1.0),
        plain("radius, cells", (at(last) - radius()) / cell),
        resultant(&points),
    ]
}

fn family(
    name: &str,
    solve: fn(Sort, usize) -> Measured,
    gates: impl Fn(bool) -> Vec<Gate>,
    meshes: [usize; 2],
) -> Family {
    let sort = sort(name);
    // Linear cells need twice as many per side for equally many dofs.
    let finer = if sort.is_quadratic { 1 } else { 2 };
    Family {
        name: name.into(),
        run: Box::new(move |level| solve(sort, finer << level)),
        meshes,
        gates: gates(sort.is_quadratic),
    }
}

fn gates_of_balls(is_quadratic: bool) -> Vec<Gate> {
    let (order, peak) = match is_quadratic {
        true => (1.9, 2e-3),
        false => (0.95, 2e-2),
    };
    vec![
        Gate::Order("energy", order),
        Gate::AtMost("p₀", peak),
        Gate::AtMost("radius, cells", 1.0 + 1e-9),
        Gate::AtMost("resultant", 1e-9),
    ]
}

/// A ball on a plane.
pub fn ball() -> Case {
    let family = |name| family(name, solve_ball, gates_of_balls, [3, 4]);
    Case {
        title: "Hertz around an axis: a ball on a plane",
        text: BALL,
        families: ["triangle3", "quad4", "triangle6", "quad8", "quad9"]
            .map(family)
            .into(),
    }
}

/// A ball on a ball.
pub fn balls() -> Case {
    let family = |name| family(name, solve_balls, gates_of_balls, [2, 2]);
    Case {
        title: "Hertz around an axis: a ball on a ball, nodes that don't match",
        text: BALLS,
        families: ["quad4", "triangle6", "quad9"].map(family).into(),
    }
}

/// A flat punch.
pub fn punch() -> Case {
    let gates = |is_quadratic| {
        let (order, depth) = match is_quadratic {
            true => (1.4, 2e-4),
            false => (0.9, 5e-3),
        };
        vec![
            Gate::Order("energy", order),
            Gate::AtMost("depth", depth),
            Gate::AtMost("pressure", 1e-2),
            Gate::AtMost("resultant", 1e-9),
        ]
    };
    let family = |name| family(name, solve_punch, gates, [3, 4]);
    Case {
        title: "Flat round punch",
        text: PUNCH,
        families: ["triangle3", "quad4", "triangle6", "quad9"]
            .map(family)
            .into(),
    }
}
