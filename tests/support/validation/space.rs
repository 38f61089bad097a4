//! Bodies in space: a ball on a plate, a ball on a ball, and a thick sphere in two layers.

use std::f64::consts::{FRAC_PI_4, PI};

use contact_dd_partition::element::ElementKind::{
    self, Hexahedron8, Hexahedron20, Hexahedron27, Tetrahedron4, Tetrahedron10,
};
use contact_dd_partition::element::geometry::{difference, length};
use contact_dd_partition::example;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use super::super::blocks::{joined, named};
use super::super::scenes::model;
use super::super::solids::{moved, solid};
use super::super::solution::ContactPoint;
use super::{Case, Family, Figure, Gate, Measured, falling, figured, plain};

const BALL: &str = "\
A ball of radius R = 8, E = 200, ν = 0.3, squeezed between two rigid plates by 0.08 each. With the force P of the
solution a = (3 P R/(4 E\\*))^(1/3), E\\* = E/(1 − ν²), p₀ = 3 P/(2π a²). *Peak*: the pressure at the pole against p₀.
*Radius*: √(5/2 Σ F r²/Σ F) over the contact forces F, which is a for Hertz' pressure, against a, here a tenth of R, which
is as far as the theory of half spaces reaches. *Edge*: how far the farthest node whose status is wrong is from r = a, over
the distance of the two nodes on the edge y = 0 that a is between.

Source: K. L. Johnson, *Contact Mechanics*, Cambridge University Press 1985, chapter 4.

Mesh: the built-in scene `sphere`.
";

const BALLS: &str = "\
That ball on one of radius 5, moved towards each other by 0.11 in all: 1/R = 1/8 + 1/5, E\\* = E/(2 (1 − ν²)).

Source: as above.

Mesh: those of the scene `sphere`, the smaller one to the scale of 5 : 8 and turned over, both curved and matching in no
node but the pole (`mortar`).
";

const LAYERS: &str = "\
A thick sphere under pressure from inside in two layers that only touch, from r = 1 to 1.5 and to 2, E = 200, ν = 0.3,
p = 1: u = p a³/(E (b³ − a³)) ((1 − 2ν) r + (1 + ν) b³/(2 r²)), pressure p a³/(b³ − a³) (b³/r³ − 1) where they touch.
*Displacement*: the largest error over the largest displacement; *pressure*: the largest error.

Source: G. Lamé, 1852; S. P. Timoshenko and J. N. Goodier, *Theory of Elasticity*.

Mesh: the part between four planes of symmetry; faces of the layers don't match (`mortar`) and are curved where cells
are quadratic.
";

/// E/(1 − ν²).
const STIFFNESS: f64 = 200.0 / 0.91;

fn solved_ball(kind: ElementKind, level: usize) -> Measured {
    let example = example::find("sphere").unwrap();
    let mesh = example.mesh_of(kind, level as u32).unwrap();
    figured(&model(example.scene, mesh), |solution| {
        against_hertz(&solution.contacts["plate"], 8.0, STIFFNESS)
    })
}

const TWO_BALLS: &str = "
    materials.steel = {young = 200, poisson = 0.3}
    bodies.'upper ball'.material = 'steel'
    bodies.'lower ball'.material = 'steel'
    [[bilateral]]
    on = ['upper x = 0', 'upper y = 0', 'lower x = 0', 'lower y = 0']
    [[displacement]]
    on = 'upper equator'
    z = -0.05
    [[displacement]]
    on = 'lower equator'
    z = 0.06
    [[contact]]
    name = 'contact'
    sides = ['lower pole', 'upper pole']";

/// An eighth of a ball of radius 8 on one of radius 5.
pub fn two_balls(kind: ElementKind, level: usize) -> Model {
    let mesh = || (example::find("sphere").unwrap().mesh_of(kind, level as u32)).unwrap();
    let upper = named(mesh(), "upper");
    let lower = named(
        moved(mesh(), |[x, y, z]| [x, y, -z].map(|c| 0.625 * c)),
        "lower",
    );
    model(TWO_BALLS, joined(lower, upper))
}

fn solved_balls(kind: ElementKind, level: usize) -> Measured {
    figured(&two_balls(kind, level), |solution| {
        against_hertz(&solution.contacts["contact"], 40.0 / 13.0, STIFFNESS / 2.0)
    })
}

/// Errors against Hertz for the radius R and the stiffness E*, from a quarter of a contact.
fn against_hertz(points: &[ContactPoint], radius: f64, stiffness: f64) -> Vec<Figure> {
    let force: f64 = 4.0 * points.iter().map(|point| point.force).sum::<f64>();
    let radius = (0.75 * force * radius / stiffness).cbrt();
    let peak = 1.5 * force / (PI * radius * radius);
    let away = |position: [f64; 3]| position[0].hypot(position[1]);
    let pole = points
        .iter()
        .min_by(|p, q| away(p.position).total_cmp(&away(q.position)));
    let moment: f64 = points
        .iter()
        .map(|point| point.force * away(point.position).powi(2))
        .sum();
    let mut along: Vec<f64> = (points.iter())
        .filter(|point| point.position[1].abs() < 1e-9)
        .map(|point| point.position[0])
        .collect();
    along.sort_by(f64::total_cmp);
    let beyond = along.partition_point(|x| *x < radius);
    let wrong = points
        .iter()
        .map(|point| (away(point.position), point.closed))
        .filter(|(away, closed)| *closed != (*away < radius));
    let farthest = wrong
        .map(|(away, _)| (away - radius).abs())
        .fold(0.0, f64::max);
    vec![
        plain("peak", pole.unwrap().pressure / peak - 1.0),
        plain("radius", (10.0 * moment / force).sqrt() / radius - 1.0),
        plain("edge", farthest / (along[beyond] - along[beyond - 1])),
    ]
}

fn families(
    solve: fn(ElementKind, usize) -> Measured,
    kinds: &[(&str, ElementKind, [usize; 2], f64)],
) -> Vec<Family> {
    let family = |&(name, kind, meshes, peak): &(&str, ElementKind, [usize; 2], f64)| Family {
        name: name.into(),
        run: Box::new(move |level| solve(kind, level)),
        meshes,
        gates: vec![
            Gate::AtMost("peak", peak),
            Gate::AtMost("radius", 5e-2),
            Gate::AtMost("edge", 1.0),
        ],
    };
    kinds.iter().map(family).collect()
}

/// A ball on a plate.
pub fn ball() -> Case {
    let kinds = [
        ("hexahedron8", Hexahedron8, [1, 2], 2e-2),
        ("hexahedron20", Hexahedron20, [1, 2], 1e-2),
        ("hexahedron27", Hexahedron27, [0, 2], 2e-2),
        ("tetrahedron10", Tetrahedron10, [0, 2], 5e-2),
    ];
    Case {
        title: "Ball on a plate",
        text: BALL,
        families: families(solved_ball, &kinds),
    }
}

/// A ball on a ball.
pub fn balls() -> Case {
    let kinds = [
        ("hexahedron8", Hexahedron8, [1, 2], 2e-2),
        ("hexahedron20", Hexahedron20, [0, 2], 2e-2),
        ("hexahedron27", Hexahedron27, [0, 1], 2e-2),
        ("tetrahedron10", Tetrahedron10, [0, 1], 5e-2),
    ];
    Case {
        title: "Ball on a ball",
        text: BALLS,
        families: families(solved_balls, &kinds),
    }
}

const SPHERE: &str = "
    materials.steel = {young = 200, poisson = 0.3}
    bodies.inner.material = 'steel'
    bodies.outer.material = 'steel'
    [[bilateral]]
    on = ['inner x0', 'inner x1', 'inner y0', 'inner y1', 'outer x0', 'outer x1', 'outer y0', 'outer y1']
    [[pressure]]
    on = 'inner z0'
    value = 1.0
    [[contact]]
    name = 'layers'
    sides = ['inner z1', 'outer z0']
    gap = 0.0";

/// Radii of the sphere: inner, at the interface of the layers, outer.
const RADII: [f64; 3] = [1.0, 1.5, 2.0];

/// A layer bounded by the planes x = 0, y = 0, x = z and y = z.
fn layer(name: &str, kind: ElementKind, n: usize, deep: usize, [from, to]: [f64; 2]) -> Mesh {
    solid(name, kind, [n, n, deep], move |[s, t, r]| {
        let direction = [(FRAC_PI_4 * s).tan(), (FRAC_PI_4 * t).tan(), 1.0];
        let radius = from * (1.0 - r) + to * r;
        direction.map(|c| c * radius / length(direction))
    })
}

fn solved_layers(kind: ElementKind, level: usize) -> Measured {
    let [a, c, b] = RADII;
    let finer = 1 << level;
    let mesh = joined(
        layer("inner", kind, 2 * finer, finer, [a, c]),
        layer("outer", kind, 3 * finer, finer, [c, b]),
    );
    let model = model(SPHERE, mesh);
    let tagged = model.mesh.node_tags.iter().zip(&model.mesh.points);
    let exact: Vec<(i64, [f64; 3])> = tagged
        .map(|(&tag, &x)| {
            let r = length(x);
            let cube = b.powi(3);
            let u = a.powi(3) / (200.0 * (cube - a.powi(3))) * (0.4 * r + 0.65 * cube / (r * r));
            (tag, x.map(|x| u * x / r))
        })
        .collect();
    figured(&model, |solution| {
        let largest = exact.iter().map(|(_, u)| length(*u)).fold(0.0, f64::max);
        let off = exact
            .iter()
            .map(|(tag, u)| length(difference(solution.displacement[tag], *u)));
        let pressure = a.powi(3) / (b.powi(3) - a.powi(3)) * ((b / c).powi(3) - 1.0);
        let points = solution.contacts["layers"].iter();
        let error = points.map(|point| (point.pressure / pressure - 1.0).abs());
        vec![
            falling("displacement", off.fold(0.0, f64::max) / largest),
            falling("pressure", error.fold(0.0, f64::max)),
        ]
    })
}

/// A thick sphere in two layers.
pub fn layers() -> Case {
    let family = |(name, kind, order): (&str, ElementKind, f64)| {
        let (pressure, tested) = match (kind, kind.is_linear()) {
            (Tetrahedron4, _) => (0.2, 0),
            (_, true) => (0.05, 3),
            _ => (0.03, 2),
        };
        Family {
            name: name.into(),
            run: Box::new(move |level| solved_layers(kind, level)),
            meshes: [tested, 3],
            gates: vec![
                Gate::Order("displacement", order),
                Gate::AtMost("pressure", pressure),
            ],
        }
    };
    Case {
        title: "Thick sphere in two layers",
        text: LAYERS,
        families: [
            ("tetrahedron4", Tetrahedron4, 1.3),
            ("tetrahedron10", Tetrahedron10, 2.0),
            ("hexahedron8", Hexahedron8, 1.7),
            ("hexahedron20", Hexahedron20, 1.3),
            ("hexahedron27", Hexahedron27, 2.5),
        ]
        .map(family)
        .into(),
    }
}
