//! Two equal cylinders pressed together and then pushed back and forth along their contact.

use std::f64::consts::PI;

use contact_dd_partition::mesh::Group;
use contact_dd_partition::model::{InitialStress, Model, ModelStep};
use nalgebra::Complex;

use super::super::blocks::{Blocks, joined};
use super::super::scenes::model;
use super::super::solution::{ContactPoint, Solution};
use super::super::sorts::{Sort, sort};
use super::exact::Exact;
use super::{Case, Family, Figure, Gate, figured_steps, gather, plain};

const TEXT: &str = "\
Two equal cylinders as in Hertz's case with μ = 0.5: pressed by P and then pushed along the contact by Q, which goes to
¾ μP, back to −¾ μP and forth again. First they stick where |x| < c = a √(1 − Q/μP), at Q = ½ μP c/a = 0.7071, and the
shear stress is μ p₀/a (√(a² − x²) − √(c² − x²)). Going back from Q* a zone slips the other way, down to
a √(1 − (Q* − Q)/(2 μP)), with twice that shear less; forth again likewise. As shear doesn't move equal bodies' surfaces
apart, pressure stays Hertz's. Stresses of every w in such a sum, with Z = μ p₀/a (√(w² − z²) − i z), y ≤ 0:
σ_xx = 2 Im Z + y Re Z', σ_yy = −y Re Z', σ_xy = Re Z − y Im Z'; 2G u_x = 2(1 − ν) Im ∫Z + y Re Z,
2G u_y = −(1 − 2ν) Re ∫Z − y Im Z.

Source: C. Cattaneo, 1938; R. D. Mindlin, *Compliance of elastic bodies in contact*, J. Appl. Mech. 16 (1949); R. D.
Mindlin and H. Deresiewicz, *Elastic spheres in contact under varying oblique forces*, J. Appl. Mech. 20 (1953), here
for line contact; K. L. Johnson, *Contact Mechanics*, chapter 7.

Mesh: the squares [−2, 2] × [−2, 0] and [−2, 2] × [0, 2], even cells where |x| < a, with the exact tractions of every
load step around both; three displacements of the lower corners are held, the upper body is held by contact alone.

*Zone*: distance of the ends of the sticking zone from where they have to be, in cells, the largest of all load steps.
*Shear*: ∫|error of the shear stress| over μ P. *Displacement*: the largest error of the displacement of
(0, 2) against (0, −2) over the largest: the curve of Q over displacement with its loop.
";

const YOUNG: f64 = 200.0;
const POISSON: f64 = 0.3;
const FRICTION: f64 = 0.5;
const SIDE: f64 = 2.0;
/// The largest Q.
const TURN: f64 = 0.75;
/// Q over μ P of every load step.
const LOADS: [f64; 14] = [
    0.0, 0.25, 0.5, TURN, 0.5, 0.0, -0.25, -0.5, -TURN, -0.5, 0.0, 0.25, 0.5, TURN,
];
/// The load steps at which Q reverses.
const TURNS: [usize; 2] = [3, 8];

fn half_width() -> f64 {
    (1.456 / PI).sqrt()
}

/// μ p₀.
fn largest_shear() -> f64 {
    FRICTION * 20.0 / (PI * half_width())
}

/// The shear stress of a load step as a sum of μ p₀/a √(w² − x²): factors and w; the last w is that of the sticking
/// zone.
fn shears(step: usize) -> Vec<[f64; 2]> {
    let (a, load) = (half_width(), LOADS[step]);
    let stuck = |share: f64| a * (1.0 - share).sqrt();
    let back = |from: f64, to: f64, sign: f64| {
        let stuck = stuck((to - from).abs() / 2.0);
        [[2.0 * sign, a], [-2.0 * sign, stuck]]
    };
    let first = if step > TURNS[0] { TURN } else { load };
    let mut sum = vec![[1.0, a], [-1.0, stuck(first)]];
    if step > TURNS[0] {
        sum.extend(back(TURN, if step > TURNS[1] { -TURN } else { load }, -1.0));
    }
    if step > TURNS[1] {
        sum.extend(back(-TURN, load, 1.0));
    }
    sum
}

/// Z, Z' and ∫Z of one of these terms in the lower half plane.
fn potentials(z: Complex<f64>, w: f64) -> [Complex<f64>; 3] {
    let i = Complex::i();
    let factor = largest_shear() / half_width();
    let root = (Complex::from(w * w) - z * z).sqrt();
    let whole = (z * root + (z / w).asin() * (w * w)) * 0.5 - i * z * z * 0.5;
    [root - i * z, -z / root - i, whole].map(|value| value * factor)
}

/// The stress in both half planes.
fn exact(step: usize) -> Exact {
    let shears = shears(step);
    Exact::Plane(Box::new(move |[x, y]: [f64; 2]| {
        // The upper half plane is the lower one rotated by 180°.
        let [x, y] = if y > 0.0 { [-x, -y] } else { [x, y] };
        let mut stress = super::hertz::half_plane([x, y]);
        for &[sign, w] in &shears {
            let [value, slope, _] = potentials(Complex::new(x, y), w);
            stress[0] += sign * (2.0 * value.im + y * slope.re);
            stress[1] -= sign * y * slope.re;
            stress[2] += sign * (value.re - y * slope.im);
        }
        stress
    }))
}

/// The displacement of (0, 2) along x relative to (0, −2), with the lower corners at the same height.
fn approach(step: usize) -> f64 {
    let shear_modulus = YOUNG / (2.0 * (1.0 + POISSON));
    let displacement = |[x, y]: [f64; 2]| {
        shears(step).iter().fold([0.0; 2], |[ux, uy], &[sign, w]| {
            let [value, _, whole] = potentials(Complex::new(x, y), w);
            let factor = sign / (2.0 * shear_modulus);
            [
                ux + factor * (2.0 * (1.0 - POISSON) * whole.im + y * value.re),
                uy - factor * ((1.0 - 2.0 * POISSON) * whole.re + y * value.im),
            ]
        })
    };
    let turned = displacement([SIDE, -SIDE])[1] / SIDE;
    -2.0 * displacement([0.0, -SIDE])[0] + 2.0 * SIDE * turned
}

fn posed(sort: Sort, n: usize) -> Model {
    let a = half_width();
    let graded = |s: f64| s.powf(1.6);
    let [lower, upper] = [("lower", -1.0), ("upper", 1.0)].map(|(body, sign)| {
        let y = move |t: f64| match sign < 0.0 {
            true => -SIDE * graded(1.0 - t),
            false => SIDE * graded(t),
        };
        let blocks = Blocks::new()
            .mapped(&format!("{body} left"), [2 * n, 5 * n], |[s, t]| {
                [-a - (SIDE - a) * graded(1.0 - s), y(t)]
            })
            .mapped(&format!("{body} middle"), [6 * n, 5 * n], |[s, t]| {
                [a * (2.0 * s - 1.0), y(t)]
            })
            .mapped(&format!("{body} right"), [2 * n, 5 * n], |[s, t]| {
                [a + (SIDE - a) * graded(s), y(t)]
            });
        sort.of(&blocks.glued(|_, _| true).mesh)
    });
    let mut mesh = joined(lower, upper);
    for body in ["lower", "upper"] {
        let pieces = ["left", "middle", "right"].map(|piece| format!("{body} {piece}"));
        gather(&mut mesh, body, &pieces.each_ref().map(String::as_str));
        for side in ["top", "bottom"] {
            let pieces = pieces.each_ref().map(|piece| format!("{piece} {side}"));
            let names = pieces.each_ref().map(String::as_str);
            gather(&mut mesh, &format!("{body} {side}"), &names);
        }
    }
    for (name, x) in [("left corner", -SIDE), ("right corner", SIDE)] {
        let at = |p: &[f64; 3]| (p[0] - x).hypot(p[1] + SIDE) < 1e-9;
        let node = mesh.points.iter().position(at).unwrap() as u32;
        let members = vec![node];
        mesh.groups.insert(name.into(), Group { dim: 0, members });
    }
    let text = format!(
        "plane = 'strain'
        materials.steel = {{young = {YOUNG:?}, poisson = {POISSON}}}
        bodies.lower.material = 'steel'
        bodies.upper.material = 'steel'
        [[displacement]]
        on = 'left corner'
        x = 0.0
        y = 0.0
        [[displacement]]
        on = 'right corner'
        y = 0.0
        [[contact]]
        name = 'contact'
        sides = ['lower top', 'upper bottom']
        gap = 'x^2/8'
        friction = {FRICTION}"
    );
    let mut model = model(&text, mesh);
    let sides = [
        ("lower left left", [-1.0, 0.0]),
        ("upper left left", [-1.0, 0.0]),
        ("lower right right", [1.0, 0.0]),
        ("upper right right", [1.0, 0.0]),
        ("lower bottom", [0.0, -1.0]),
        ("upper top", [0.0, 1.0]),
    ];
    for step in 0..LOADS.len() {
        let mut loaded = model.clone();
        loaded.forces.clear();
        exact(step).load(&mut loaded, &sides);
        model.steps.push(ModelStep {
            name: (step + 1).to_string(),
            time: (step + 1) as f64,
            supports: vec![0.0; model.supports.len()],
            forces: loaded.forces.iter().map(|(_, force)| *force).collect(),
            initial_stress: InitialStress::default(),
            absent_bodies: Vec::new(),
            absent_contacts: Vec::new(),
        });
        if step == 0 {
            model.forces = loaded.forces;
        }
    }
    model
}

/// Errors of all load steps.
fn of_contact(model: &Model, solutions: &[Solution], cell: f64) -> Vec<Figure> {
    let (a, shear) = (half_width(), largest_shear());
    let at = |x: f64, y: f64| {
        let place = |p: &[f64; 3]| (p[0] - x).hypot(p[1] - y) < 1e-9;
        model.mesh.node_tags[model.mesh.points.iter().position(place).unwrap()]
    };
    let ends = [at(0.0, SIDE), at(0.0, -SIDE)];
    let (mut zone, mut stress, mut moved, mut largest) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    for (step, solution) in solutions.iter().enumerate() {
        let shears = shears(step);
        let stuck = shears[shears.len() - 1][1];
        let mut points: Vec<&ContactPoint> = solution.contacts["contact"].iter().collect();
        points.sort_by(|p, q| p.position[0].total_cmp(&q.position[0]));
        let sticks = |p: &&&ContactPoint| p.closed && !p.slipping;
        let first = points.iter().position(|p| sticks(&p)).unwrap();
        let last = points.iter().rposition(|p| sticks(&p)).unwrap();
        assert!(
            points[first..=last].iter().all(|p| sticks(&p)),
            "step {step}"
        );
        if step > 0 {
            for (within, beyond) in [(first, first - 1), (last, last + 1)] {
                let [within, beyond] = [within, beyond].map(|i| points[i].position[0].abs());
                zone = zone.max(((within + beyond) / 2.0 - stuck).abs() / cell);
            }
        }
        let mut off = 0.0;
        for (point, area) in points.iter().zip(areas(model)) {
            let x = point.position[0];
            let exact: f64 = shears
                .iter()
                .map(|&[sign, w]| sign * shear / a * (w * w - x * x).max(0.0).sqrt())
                .sum();
            // Side a is the lower body, which the upper one drags along.
            off += (point.tangential_force[0] - exact * area).abs() / (FRICTION * 10.0);
        }
        stress = stress.max(off);
        let [upper, lower] = ends.map(|tag| solution.displacement[&tag][0]);
        moved = moved.max((upper - lower - approach(step)).abs());
        largest = largest.max(approach(step).abs());
    }
    vec![
        plain("zone, cells", zone),
        plain("shear", stress),
        plain("displacement", moved / largest),
    ]
}

/// Areas of the points along x.
fn areas(model: &Model) -> Vec<f64> {
    let mut points: Vec<_> = model.contacts[0].points.iter().collect();
    points.sort_by(|p, q| p.position[0].total_cmp(&q.position[0]));
    points.iter().map(|point| point.area).collect()
}

/// Both cylinders in linear and quadratic cells.
pub fn case() -> Case {
    let family = |name: &'static str| {
        let sort = sort(name);
        let finer = if sort.is_quadratic { 2 } else { 4 };
        Family {
            name: name.into(),
            run: Box::new(move |level| {
                let n = finer << level;
                let model = posed(sort, n);
                let nodes = if sort.is_quadratic { 2 } else { 1 };
                let cell = 2.0 * half_width() / (6 * n * nodes) as f64;
                figured_steps(&model, |solutions| of_contact(&model, solutions, cell))
            }),
            meshes: [1, 3],
            gates: vec![
                Gate::AtMost("zone, cells", 1.0),
                Gate::AtMost("shear", 3e-2),
                Gate::AtMost("displacement", 5e-3),
            ],
        }
    };
    Case {
        title: "Cattaneo and Mindlin: cylinders pushed to and fro",
        text: TEXT,
        families: ["triangle3", "quad4", "quad9"].map(family).into(),
    }
}
