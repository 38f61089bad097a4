//! Line contact of two equal cylinders: one on its plane of symmetry, and both.

use std::f64::consts::PI;

use contact_dd_partition::example;
use contact_dd_partition::mesh::Mesh;
use nalgebra::Complex;

use super::super::blocks::{Blocks, joined};
use super::super::scenes::model;
use super::super::solution::{ContactPoint, Solution};
use super::super::sorts::{Sort, sort};
use super::exact::Exact;
use super::{Case, Family, Figure, Gate, Measured, Posed, falling, gather, measured, plain};

/// Side of the squares cut out of the half planes.
const SIDE: f64 = 2.0;

/// The exponent of graded meshes; quadratic cells need more than 4/3.
pub const GRADING: f64 = 1.6;

const ON_AN_OBSTACLE: &str = "\
Two equal cylinders, R = 8, E = 200, ν = 0.3, P = 10 per unit of length, plane strain; one of them on the
plane of symmetry: a² = 4 P R/(π E*) with E* = E/(1 − ν²), so that a = 0.68078; pressure
p₀ √(1 − x²/a²), p₀ = 2 P/(π a) = 9.35135. Stresses of the half plane y ≤ 0, with z = x + i y and
Z = −p₀/a (√(a² − z²) − i z): σ_xx = Re Z − y Im Z', σ_yy = Re Z + y Im Z', σ_xy = −y Re Z'.

Source: K. L. Johnson, *Contact Mechanics*, Cambridge University Press 1985, chapter 4.

Mesh: the square [0, 2] × [−2, 0] of the built-in scene `hertz`, tractions of the half plane on its right
and lower side, gap x²/16 to a rigid plane; *graded* towards x = a and y = 0 with the 1.6th power. Only
contact supports the body vertically.

*p₀*: pressure at x = 0; in uniform linear triangles it oscillates from node to node, as four and eight
triangles meet there by turns. *Half-width*: number of cells between x = a and the last closed node.
*Resultant*: sum of the contact forces.
";

const BODY_ON_BODY: &str = "\
Both cylinders: two squares with matching nodes and the gap x²/8. Neither is supported vertically.

Source and mesh: as above, mirrored.
";

const UNEVEN: &str = "\
The same bodies, 3 cells above for 2 below: only nodes at x = 0, a and 2 match; paired by `mortar`, the
lower side being side a.

Source and mesh: as above.
";

/// The half-width of the contact.
fn half_width() -> f64 {
    (1.456 / PI).sqrt()
}

/// The pressure at the centre.
fn peak() -> f64 {
    20.0 / (PI * half_width())
}

/// The stress of the half plane y ≤ 0, mirrored where y > 0.
pub fn half_plane([x, y]: [f64; 2]) -> [f64; 3] {
    let (a, i) = (half_width(), Complex::i());
    let z = Complex::new(x, -y.abs());
    let root = (Complex::from(a * a) - z * z).sqrt();
    let factor = -peak() / a;
    let value = (root - i * z) * factor;
    let slope = (-z / root - i) * factor;
    let y = -y.abs();
    [
        value.re - y * slope.im,
        value.re + y * slope.im,
        -y * slope.re,
    ]
}

fn exact() -> Exact {
    Exact::Plane(Box::new(|[x, y]: [f64; 2]| {
        let [xx, yy, xy] = half_plane([x, y]);
        [xx, yy, if y > 0.0 { -xy } else { xy }]
    }))
}

/// A square below or above a contact of half-width `a`: its pieces `under` it and `beside` it, with lines at distances
/// from its end and from the contact that grow with a power of their number.
pub fn square([body, row]: [&str; 2], n: usize, grading: f64, a: f64) -> Mesh {
    let graded = move |s: f64| s.powf(grading);
    let height = move |t: f64| match row {
        "above" => SIDE * graded(t),
        _ => -SIDE * graded(1.0 - t),
    };
    let blocks = Blocks::new()
        .mapped(&format!("{body} under"), [5 * n, 7 * n], |[s, t]| {
            [a * (1.0 - graded(1.0 - s)), height(t)]
        })
        .mapped(&format!("{body} beside"), [4 * n, 7 * n], |[s, t]| {
            [a + (SIDE - a) * graded(s), height(t)]
        });
    blocks.glued(|_, _| true).mesh
}

/// Errors of the pressure at the centre and of the half-width.
fn of_contact(solution: &Solution) -> Vec<Figure> {
    let mut points: Vec<&ContactPoint> = solution.contacts["contact"].iter().collect();
    points.sort_by(|p, q| p.position[0].total_cmp(&q.position[0]));
    let last = points.iter().rposition(|point| point.closed).unwrap();
    assert!(points[..last].iter().all(|point| point.closed));
    let at = |i: usize| points[i].position[0];
    // The end of the contact may lie in either of the cells at the last closed point.
    let cell = (at(last + 1) - at(last)).max(at(last) - at(last - 1));
    let total: f64 = points.iter().map(|point| point.force).sum();
    vec![
        falling("p₀", points[0].pressure / peak() - 1.0),
        plain("half-width, cells", (at(last) - half_width()) / cell),
        plain("resultant", total / 5.0 - 1.0),
    ]
}

fn families(make: fn(Sort, usize, f64) -> Measured, names: &[&str]) -> Vec<Family> {
    let mut families = Vec::new();
    for name in names {
        let sort = sort(name);
        let [uniform, graded] = match sort.is_quadratic {
            true => [1.45, 1.9],
            false => [0.95, 0.95],
        };
        families.push(family(sort, 1.0, make, uniform));
        families.push(family(sort, GRADING, make, graded));
    }
    families
}

/// A body on its plane of symmetry.
pub fn on_an_obstacle() -> Case {
    Case {
        title: "Hertz: a cylinder on a plane",
        text: ON_AN_OBSTACLE,
        families: families(
            solve_on_an_obstacle,
            &["triangle3", "quad4", "triangle6", "quad8", "quad9"],
        ),
    }
}

/// Both bodies.
pub fn body_on_body() -> Case {
    let mut families = families(solve_body_on_body, &["triangle3", "triangle6"]);
    // Two bodies have twice as many dofs.
    for family in families
        .iter_mut()
        .filter(|f| f.name != "triangle6, graded")
    {
        family.meshes[0] = 0;
    }
    Case {
        title: "Hertz: a cylinder on a cylinder",
        text: BODY_ON_BODY,
        families,
    }
}

/// Both bodies with nodes that don't match.
pub fn uneven_bodies() -> Case {
    let mut families = families(
        solve_uneven_bodies,
        &["triangle3", "quad4", "triangle6", "quad9"],
    );
    for family in &mut families {
        let is_tested = ["quad4, graded", "triangle6, graded"].contains(&family.name.as_str());
        family.meshes = [if is_tested { 2 } else { 0 }, 3];
    }
    Case {
        title: "Hertz: a cylinder on a cylinder, nodes that don't match",
        text: UNEVEN,
        families,
    }
}

fn family(sort: Sort, grading: f64, make: fn(Sort, usize, f64) -> Measured, order: f64) -> Family {
    let is_graded = grading > 1.0;
    let mut gates = vec![
        Gate::Order("energy", order),
        Gate::AtMost("half-width, cells", 1.0 + 1e-9),
        Gate::AtMost("resultant", 1e-9),
    ];
    if is_graded && sort.is_quadratic {
        gates.push(Gate::AtMost("energy", 2e-3));
        gates.push(Gate::AtMost("p₀", 5e-4));
    }
    // The other meshes appear only in the document.
    let tested = match (sort.name, is_graded) {
        ("quad8", _) | ("quad4" | "quad9", false) => 0,
        _ => 3,
    };
    // Linear cells need twice as many per side for equally many dofs.
    let finer = if sort.is_quadratic { 1 } else { 2 };
    Family {
        name: format!(
            "{}, {}",
            sort.name,
            if is_graded { "graded" } else { "uniform" }
        ),
        run: Box::new(move |level| make(sort, finer << level, grading)),
        meshes: [tested, 4],
        gates,
    }
}

/// A body on its plane of symmetry, with lines graded by a power of their number.
pub fn posed_on_an_obstacle(sort: Sort, n: usize, grading: f64) -> Posed {
    let mut mesh = sort.of(&square(["body", "below"], n, grading, half_width()));
    for (name, of) in [
        ("cylinder", &["body under", "body beside"][..]),
        ("top", &["body under top", "body beside top"]),
        ("bottom", &["body under bottom", "body beside bottom"]),
        ("axis", &["body under left"]),
        ("right", &["body beside right"]),
    ] {
        gather(&mut mesh, name, of);
    }
    Posed {
        model: model(example::find("hertz").unwrap().scene, mesh),
        exact: exact(),
        figures: Box::new(of_contact),
    }
}

fn solve_on_an_obstacle(sort: Sort, n: usize, grading: f64) -> Measured {
    posed_on_an_obstacle(sort, n, grading).measured()
}

fn solve_body_on_body(sort: Sort, n: usize, grading: f64) -> Measured {
    solve_bodies(sort, [n, n], grading)
}

fn solve_uneven_bodies(sort: Sort, n: usize, grading: f64) -> Measured {
    solve_bodies(sort, [2 * n, 3 * n], grading)
}

fn solve_bodies(sort: Sort, n: [usize; 2], grading: f64) -> Measured {
    let bodies = [("lower", "below", n[0]), ("upper", "above", n[1])];
    let [lower, upper] = bodies.map(|(body, row, n)| {
        let mut mesh = sort.of(&square([body, row], n, grading, half_width()));
        let pieces = ["under", "beside"].map(|piece| format!("{body} {piece}"));
        gather(&mut mesh, body, &[&pieces[0], &pieces[1]]);
        mesh
    });
    let text = "plane = 'strain'
        materials.steel = {young = 200, poisson = 0.3}
        bodies.lower.material = 'steel'
        bodies.upper.material = 'steel'
        [[bilateral]]
        on = ['lower under left', 'upper under left']
        [[contact]]
        name = 'contact'
        sides = [
            ['lower under top', 'lower beside top'],
            ['upper under bottom', 'upper beside bottom'],
        ]
        gap = 'x^2/8'";
    let mut model = model(text, joined(lower, upper));
    exact().load(
        &mut model,
        &[
            ("lower beside right", [1.0, 0.0]),
            ("upper beside right", [1.0, 0.0]),
            ("lower under bottom", [0.0, -1.0]),
            ("lower beside bottom", [0.0, -1.0]),
            ("upper under top", [0.0, 1.0]),
            ("upper beside top", [0.0, 1.0]),
        ],
    );
    measured(model, exact(), of_contact)
}
