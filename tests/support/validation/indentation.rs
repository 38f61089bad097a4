//! A ball, a flat round punch and a force on the half space in space.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use contact_dd_partition::element::ElementKind::{
    self, Hexahedron8, Hexahedron20, Hexahedron27, Tetrahedron4, Tetrahedron10,
};
use contact_dd_partition::mesh::{Group, Mesh};

use super::super::blocks::{glued, joined};
use super::super::scenes::model;
use super::super::solids::solid;
use super::super::solution::Solution;
use super::half_space::{LOAD, STIFFNESS, depth, of_ball, of_force, of_punch, peak, radius, space};
use super::{Case, Family, Figure, Gate, Measured, falling, gather, measured, plain};

const BALL: &str = "\
The ball around its axis, in space: a quarter of the half space between two planes of symmetry.

Source: as there.

Mesh: the quarter of a cylinder of radius 2 and height 2 with the tractions of the half space on its lower and its round
side, gap r²/16, graded towards r = a and z = 0 with the 1.6th power, edges of quadratic cells curved. Only contact
supports the body vertically. *p₀*: 4/3 Σ F p/Σ F over the contact forces F; *axis*: the pressure on the axis against
p₀, in which cells of 20 nodes are less accurate; *radius*: how far the farthest node whose status is
wrong is from r = a, in cells; *resultant*: sum of the contact forces.
";

const PUNCH: &str = "\
The flat round punch, in space. *Force*: what goes with the depth between the middle of the punch and the middle of the
lower side, against P.

Source and mesh: as above with a = 1, graded with the 3rd power.
";

const FORCE: &str = "\
A force P = 10 on the half space, E = 200, ν = 0.3, far from the force: stresses as above with F = −P/(2π R). *Depth*: how
much deeper the surface goes at R = 1 than at R = 4, against P/(π E\\*) (1 − 1/4).

Source: J. Boussinesq, 1885; K. L. Johnson, chapter 3.

Mesh: the part between the spheres R = 1 and R = 4 and two planes of symmetry, with the exact tractions on both, edges of
quadratic cells curved. A node holds it vertically.
";

/// Radius and height of the meshed part of a half space.
pub const SIDE: f64 = 2.0;

/// The part of a length covered by the part `s` of its cells, whose sizes grow with a power of their number; midside
/// nodes lie in the middle.
fn graded(s: f64, cells: usize, power: f64) -> f64 {
    let at = |i: f64| (i / cells as f64).powf(power);
    let first = (s * cells as f64).min(cells as f64 - 1.0).floor();
    let within = s * cells as f64 - first;
    at(first) * (1.0 - within) + at(first + 1.0) * within
}

/// Position of a point (x, y) of the unit disc at the fraction w of the height.
type Place<'a> = &'a dyn Fn([f64; 2], f64) -> [f64; 3];

/// The quarter of a unit disc: a `core` and two pieces of a ring around it, `n` cells along each of their edges but
/// `2n` across the ring, graded outward by a power; `tall` cells high.
fn disc(name: &str, kind: ElementKind, [n, tall]: [usize; 2], grading: f64, place: Place) -> Mesh {
    let core = |[s, t]: [f64; 2]| {
        [
            0.5 * s * (1.0 - 0.15 * t * t),
            0.5 * t * (1.0 - 0.15 * s * s),
        ]
    };
    let ring = |from: [f64; 2], angle: f64, part: f64| {
        let part = 1.0 - graded(1.0 - part, 2 * n, grading);
        let to = [angle.cos(), angle.sin()];
        [0, 1].map(|i| from[i] * (1.0 - part) + to[i] * part)
    };
    let pieces = [
        solid(&format!("{name} core"), kind, [n, n, tall], |[s, t, w]| {
            place(core([s, t]), w)
        }),
        solid(
            &format!("{name} east"),
            kind,
            [2 * n, n, tall],
            |[r, t, w]| place(ring(core([1.0, t]), FRAC_PI_4 * t, r), w),
        ),
        solid(
            &format!("{name} north"),
            kind,
            [n, 2 * n, tall],
            |[s, r, w]| place(ring(core([s, 1.0]), FRAC_PI_2 - FRAC_PI_4 * s, r), w),
        ),
    ];
    let mut mesh = pieces.into_iter().reduce(joined).unwrap();
    let all = |side: &str| ["core", "east", "north"].map(|piece| format!("{name} {piece}{side}"));
    for (group, of) in [
        (name.to_owned(), all("").to_vec()),
        (format!("{name} low"), all(" z0").to_vec()),
        (format!("{name} high"), all(" z1").to_vec()),
        (
            format!("{name} round"),
            vec![format!("{name} east x1"), format!("{name} north y1")],
        ),
        (
            format!("{name} x = 0"),
            vec![format!("{name} core x0"), format!("{name} north x0")],
        ),
        (
            format!("{name} y = 0"),
            vec![format!("{name} core y0"), format!("{name} east y0")],
        ),
    ] {
        let of: Vec<&str> = of.iter().map(String::as_str).collect();
        gather(&mut mesh, &group, &of);
    }
    mesh
}

/// The part of a half space below a disc of radius a, `under` it and `beside` it, `tall` cells high.
pub fn cylinder(kind: ElementKind, [n, tall]: [usize; 2], grading: f64, a: f64) -> Mesh {
    let height = |w: f64| -SIDE * graded(1.0 - w, tall, grading);
    let under = disc("under", kind, [n, tall], grading, &|[x, y], w| {
        [a * x, a * y, height(w)]
    });
    let beside = |angle: f64, part: f64, w: f64| {
        let r = a + (SIDE - a) * graded(part, 2 * n, grading);
        [r * angle.cos(), r * angle.sin(), height(w)]
    };
    let pieces = [
        solid("east", kind, [2 * n, n, tall], |[r, t, w]| {
            beside(FRAC_PI_4 * t, r, w)
        }),
        solid("north", kind, [n, 2 * n, tall], |[s, r, w]| {
            beside(FRAC_PI_2 - FRAC_PI_4 * s, r, w)
        }),
    ];
    let mesh = pieces.into_iter().fold(under, joined);
    let mut mesh = glued(mesh, |_| true);
    gather(&mut mesh, "body", &["under", "east", "north"]);
    gather(&mut mesh, "x = 0", &["under x = 0", "north x0"]);
    gather(&mut mesh, "y = 0", &["under y = 0", "east y0"]);
    gather(&mut mesh, "low", &["under low", "east z0", "north z0"]);
    gather(&mut mesh, "round", &["east x1", "north y1"]);
    gather(&mut mesh, "top", &["under high", "east z1", "north z1"]);
    mesh
}

const OUTSIDE: [(&str, [f64; 3]); 2] = [("low", [0.0, 0.0, -1.0]), ("round", [1.0, 1.0, 0.0])];

const BODY: &str = "
    materials.steel = {young = 200, poisson = 0.3}
    bodies.body.material = 'steel'
    [[bilateral]]
    on = ['x = 0', 'y = 0']
";

const CONTACT: &str = "
    [[contact]]
    name = 'contact'
    obstacle = {point = [0, 0, 0], normal = [0, 0, -1]}
";

fn solve_ball(kind: ElementKind, n: usize) -> Measured {
    let text = format!("{BODY}{CONTACT}sides = ['top']\ngap = '(x^2+y^2)/16'");
    let mut model = model(&text, cylinder(kind, [n, 3 * n], 1.6, radius()));
    let exact = space(of_ball);
    exact.load(&mut model, &OUTSIDE);
    measured(model, exact, of_contact)
}

fn away(x: [f64; 3]) -> f64 {
    x[0].hypot(x[1])
}

fn of_contact(solution: &Solution) -> Vec<Figure> {
    let a = radius();
    let mut points = solution.contacts["contact"].clone();
    points.sort_by(|p, q| away(p.position).total_cmp(&away(q.position)));
    let along: Vec<f64> = (points.iter())
        .filter(|point| point.position[1].abs() < 1e-9)
        .map(|point| point.position[0])
        .collect();
    let at = along.iter().position(|x| (x - a).abs() < 1e-9).unwrap();
    let cell = (along[at + 1] - a).max(a - along[at - 1]);
    let wrong = points
        .iter()
        .filter(|point| point.closed != (away(point.position) < a + 1e-9));
    let farthest = wrong
        .map(|point| (away(point.position) - a).abs())
        .fold(0.0, f64::max);
    let total: f64 = points.iter().map(|point| point.force).sum();
    let mean: f64 = points
        .iter()
        .map(|point| point.force * point.pressure)
        .sum();
    vec![
        falling("p₀", 4.0 / 3.0 * mean / total / peak() - 1.0),
        plain("axis", points[0].pressure / peak() - 1.0),
        plain("radius, cells", farthest / cell),
        plain("resultant", 4.0 * total / LOAD - 1.0),
    ]
}

/// Difference in depth of two points.
fn deeper(solution: &Solution, mesh: &Mesh, from: [f64; 3], to: [f64; 3]) -> f64 {
    let tag = |at: [f64; 3]| {
        let is_there = |x: &[f64; 3]| (0..3).all(|i| (x[i] - at[i]).abs() < 1e-9);
        mesh.node_tags[mesh.points.iter().position(is_there).unwrap()]
    };
    solution.displacement[&tag(to)][2] - solution.displacement[&tag(from)][2]
}

fn solve_punch(kind: ElementKind, n: usize) -> Measured {
    let text = format!("{BODY}{CONTACT}sides = ['under high']\ngap = 0.0");
    let mut model = model(&text, cylinder(kind, [n, 3 * n], 3.0, 1.0));
    let exact = space(of_punch);
    exact.load(&mut model, &OUTSIDE);
    let mesh = model.mesh.clone();
    measured(model, exact, move |solution| {
        let deep = deeper(solution, &mesh, [0.0; 3], [0.0, 0.0, -SIDE]);
        let points = &solution.contacts["contact"];
        let total: f64 = points.iter().map(|point| point.force).sum();
        vec![
            falling("force", (depth(0.0) - depth(SIDE)) / deep - 1.0),
            plain("resultant", 4.0 * total / LOAD - 1.0),
        ]
    })
}

fn solve_force(kind: ElementKind, n: usize) -> Measured {
    let place = |[x, y]: [f64; 2], w: f64| {
        let far = 4.0_f64.powf(w);
        let r = x.hypot(y);
        let turn = FRAC_PI_2 * r;
        let aside = if r > 0.0 { turn.sin() / r } else { 0.0 };
        [far * aside * x, far * aside * y, -far * turn.cos()]
    };
    let mut mesh = glued(disc("body", kind, [n, 2 * n], 1.0, &place), |_| true);
    gather(&mut mesh, "x = 0", &["body x = 0"]);
    gather(&mut mesh, "y = 0", &["body y = 0"]);
    let node = mesh.points.iter().position(|x| (x[0] - 4.0).abs() < 1e-9);
    let members = vec![node.unwrap() as u32];
    mesh.groups.insert("rest".into(), Group { dim: 0, members });
    let mut model = model(&format!("{BODY}[[displacement]]\non = 'rest'\nz = 0"), mesh);
    let exact = space(of_force);
    let sides = [
        ("body low", [-1.0, -1.0, 1.0]),
        ("body high", [1.0, 1.0, -1.0]),
    ];
    exact.load(&mut model, &sides);
    let mesh = model.mesh.clone();
    measured(model, exact, move |solution| {
        let deep = deeper(solution, &mesh, [1.0, 0.0, 0.0], [4.0, 0.0, 0.0]);
        let expected = 0.75 * LOAD / (PI * STIFFNESS);
        vec![falling("depth", deep / expected - 1.0)]
    })
}

const KINDS: [(&str, ElementKind); 5] = [
    ("tetrahedron4", Tetrahedron4),
    ("hexahedron8", Hexahedron8),
    ("tetrahedron10", Tetrahedron10),
    ("hexahedron20", Hexahedron20),
    ("hexahedron27", Hexahedron27),
];

fn families(
    solve: fn(ElementKind, usize) -> Measured,
    gates: impl Fn(ElementKind) -> Vec<Gate>,
    tested: &[ElementKind],
) -> Vec<Family> {
    let family = |(name, kind): (&str, ElementKind)| Family {
        name: name.into(),
        // Linear cells need twice as many per edge for equally many dofs.
        run: Box::new(move |level| solve(kind, if kind.is_linear() { 2 } else { 1 } << level)),
        meshes: [if tested.contains(&kind) { 2 } else { 0 }, 3],
        gates: gates(kind),
    };
    KINDS.map(family).into()
}

/// A ball on a plane.
pub fn ball() -> Case {
    let gates = |kind: ElementKind| {
        vec![
            Gate::Order("energy", if kind.is_linear() { 0.9 } else { 1.7 }),
            Gate::AtMost("p₀", 1e-2),
            Gate::AtMost("axis", if kind == Hexahedron27 { 1e-2 } else { 5e-2 }),
            Gate::AtMost("radius, cells", 1.0 + 1e-9),
            Gate::AtMost("resultant", 1e-9),
        ]
    };
    Case {
        title: "Hertz in space: a ball on a plane",
        text: BALL,
        families: families(solve_ball, gates, &[Hexahedron8, Hexahedron27]),
    }
}

/// A flat punch.
pub fn punch() -> Case {
    let gates = |kind: ElementKind| {
        vec![
            Gate::Order("energy", if kind.is_linear() { 0.85 } else { 1.3 }),
            Gate::AtMost("force", 1e-2),
            Gate::AtMost("resultant", 1e-9),
        ]
    };
    Case {
        title: "Flat round punch in space",
        text: PUNCH,
        families: families(solve_punch, gates, &[Hexahedron8, Hexahedron20]),
    }
}

/// A force.
pub fn force() -> Case {
    let gates = |kind: ElementKind| {
        vec![
            Gate::Order("energy", if kind.is_linear() { 0.9 } else { 1.8 }),
            Gate::AtMost("depth", if kind.is_linear() { 2e-2 } else { 1e-3 }),
        ]
    };
    Case {
        title: "Half space far from a force",
        text: FORCE,
        families: families(solve_force, gates, &[Tetrahedron10, Hexahedron8]),
    }
}
