//! The NAFEMS contact roller: a steel cylinder on a block of aluminium whose nodes don't match.

use std::f64::consts::{FRAC_PI_4, PI};

use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use super::super::blocks::{Blocks, joined};
use super::super::scenes::model;
use super::super::solution::{ContactPoint, Solution};
use super::super::sorts::{Sort, sort};
use super::super::statics::reaction;
use super::{Case, Family, Figure, Gate, falling, figured, gather, plain};

const TEXT: &str = "\
A cylinder of steel, R = 50 mm, E = 210 GPa, is pressed by P = 35 kN/mm on a block of aluminium,
200 mm × 200 mm, E = 70 GPa; ν = 0.3, plane strain. By Hertz, for half planes,
a = √(4 P R/(π E*)) = 6.21 mm and p₀ = 2 P/(π a) = 3585 MPa with 1/E* = Σ (1 − ν²)/E.

Source: A. Konter, *Advanced Finite Element Contact Benchmarks*, NAFEMS R0094, 2006 (FENET D3613), the
first benchmark.

Mesh: half of both by symmetry, the block fixed at its bottom, the lower half of the cylinder under a uniform
pressure on its flat side. Graded towards the contact, 3 cells of the block for 2 of the cylinder, paired by
`mortar`; quadratic edges are curved.

*p₀* and *half-width*: (3π/8) Σ F p/Σ F and 2 √(Σ F x²/Σ F) over the contact forces F (p₀ and a of an
ellipse), against those of 1 257 604 dofs in `quad9`, 3590.30 MPa and 6.21309 mm. *From Hertz*: against
3585.37 MPa and 6.2146 mm; as the bodies are no half planes, 1.4e-3 and 2.5e-4 of this remain on any mesh.
*Resultant*: the vertical force against P/2.
";

const WITH_FRICTION: &str = "\
The same with μ = 0.1 between cylinder and block, which keeps the softer block from spreading under the cylinder.

Source: as above; Code_Aster SSNP154, which gives the benchmark's means of several programs: u_y = −1.3026 mm of the
block's middle and σ_yy = −3542.7 MPa there, and finds −1.2703 mm and −3643.6 MPa itself. They are of large
displacements.

Mesh: as above.

*Depth* and *p₀*: u_y of the block's middle and (3π/8) Σ F p/Σ F, against those of 1 257 604 dofs in `quad9`,
−1.269378 mm and 3631.97 MPa. *From Code_Aster*, *from NAFEMS*: against theirs.
";

const RADIUS: f64 = 50.0;
const SIDE: f64 = 200.0;
/// P (N/mm).
const LOAD: f64 = 35e3;

/// p₀ (MPa) and a (mm) of `quad9` on a mesh four times as fine as the finest here.
const REFERENCE: [f64; 2] = [3590.30, 6.213_09];

/// u_y of the block's middle (mm) and p₀ (MPa) with friction, likewise.
const FRICTION_REFERENCE: [f64; 2] = [-1.269_378, 3631.97];
/// Both figures by Code_Aster and by the benchmark, which has the stress instead of p₀.
const CODE_ASTER: [f64; 2] = [-1.270_310_97, 3_643.561_94];
const NAFEMS: [f64; 2] = [-1.302_635_6, 3_542.687_88];

/// p₀ (MPa) and a (mm) of half planes.
fn hertz() -> [f64; 2] {
    let stiffness = 1.0 / (0.91 / 210e3 + 0.91 / 70e3);
    let half_width = (4.0 * LOAD * RADIUS / (PI * stiffness)).sqrt();
    [2.0 * LOAD / (PI * half_width), half_width]
}

/// A graded coordinate from 0 to 1, slow at first.
fn graded(by: f64, s: f64) -> f64 {
    (by * s).sinh() / by.sinh()
}

/// The quarter of a disc to the right of its lowest point, which is the origin: one piece `below`, up to 45° from
/// there, one `beside` it, and one in the `middle`.
fn quarter(n: usize) -> Mesh {
    let arc = |part: f64| {
        let (sin, cos) = (FRAC_PI_4 * part).sin_cos();
        [RADIUS * sin, RADIUS * (1.0 - cos)]
    };
    let between = |p: [f64; 2], q: [f64; 2], w: f64| [0, 1].map(|i| p[i] + (q[i] - p[i]) * w);
    let [lowest, corner, side, centre] =
        [[0.0, 0.5], [0.4, 0.6], [0.5, 1.0], [0.0, 1.0]].map(|p| p.map(|c| c * RADIUS));
    let along = |s: f64| graded(4.0, s);
    let inward = |t: f64| graded(3.5, t);
    let blocks = Blocks::new()
        .mapped("below", [n, n], |[s, t]| {
            let s = along(s);
            between(arc(s), between(lowest, corner, s), inward(t))
        })
        .mapped("beside", [n / 2, n], |[s, t]| {
            between(arc(1.0 + s), between(corner, side, s), inward(t))
        })
        .mapped("middle", [n, n / 2], |[s, t]| {
            let s = along(s);
            between(between(lowest, corner, s), between(centre, side, s), t)
        });
    blocks.glued(|_, _| true).mesh
}

/// The right half of the block, `n` cells in each direction.
fn block(n: usize) -> Mesh {
    Blocks::new()
        .mapped("block", [n, n], |[s, t]| {
            let x = 0.5 * SIDE * graded(5.0, s);
            [x, -SIDE * graded(6.0, 1.0 - t)]
        })
        .mesh
}

/// Moves the nodes on a side of the disc onto its circle.
fn round(mesh: &mut Mesh, side: &str) {
    for &facet in &mesh.groups[side].members {
        for &node in mesh.facets.nodes_of(facet as usize) {
            let point = &mut mesh.points[node as usize];
            let (x, y) = (point[0], point[1] - RADIUS);
            let stretch = RADIUS / x.hypot(y);
            *point = [x * stretch, RADIUS + y * stretch, 0.0];
        }
    }
}

/// p₀ and a of an ellipse with the same mean of the pressure and of x² under the force.
fn ellipse(points: &[ContactPoint]) -> [f64; 2] {
    let mean = |of: fn(&ContactPoint) -> f64| -> f64 {
        let moment: f64 = points.iter().map(|point| point.force * of(point)).sum();
        moment / points.iter().map(|point| point.force).sum::<f64>()
    };
    [
        0.375 * PI * mean(|point| point.pressure),
        2.0 * mean(|point| point.position[0].powi(2)).sqrt(),
    ]
}

fn figures(solution: &Solution) -> Vec<Figure> {
    let points = &solution.contacts["contact"];
    let found = ellipse(points);
    let from = |other: [f64; 2], i: usize| found[i] / other[i] - 1.0;
    let vertical = reaction(points)[1].abs();
    vec![
        falling("p₀", from(REFERENCE, 0)),
        falling("half-width", from(REFERENCE, 1)),
        plain("p₀ from Hertz", from(hertz(), 0)),
        plain("half-width from Hertz", from(hertz(), 1)),
        plain("resultant", vertical / (0.5 * LOAD) - 1.0),
    ]
}

/// The scene, with these last lines of its contact and any after them.
fn posed(sort: Sort, n: usize, rest: &str) -> Model {
    let mut cylinder = sort.of(&quarter(6 * n));
    gather(&mut cylinder, "cylinder", &["below", "beside", "middle"]);
    round(&mut cylinder, "below bottom");
    round(&mut cylinder, "beside bottom");
    let text = format!(
        "plane = 'strain'
        materials.steel = {{young = 210e3, poisson = 0.3}}
        materials.aluminium = {{young = 70e3, poisson = 0.3}}
        bodies.cylinder.material = 'steel'
        bodies.block.material = 'aluminium'
        [[displacement]]
        on = 'block bottom'
        x = 0.0
        y = 0.0
        [[bilateral]]
        on = 'block left'
        [[bilateral]]
        on = ['below left', 'middle left']
        [[pressure]]
        on = ['beside right', 'middle top']
        value = {}
        [[contact]]
        name = 'contact'
        sides = ['below bottom', 'block top']
        pairing = 'mortar'
        {rest}",
        LOAD / (2.0 * RADIUS)
    );
    model(&text, joined(cylinder, sort.of(&block(9 * n))))
}

/// The roller in all kinds of cells.
pub fn case() -> Case {
    let family = |name: &'static str| {
        let sort = sort(name);
        let mut gates = match sort.is_quadratic {
            true => vec![Gate::AtMost("p₀", 1e-3), Gate::AtMost("half-width", 5e-4)],
            false => vec![
                Gate::Order("p₀", 1.5),
                Gate::AtMost("p₀", 5e-3),
                Gate::AtMost("half-width", 1e-3),
            ],
        };
        gates.extend([
            Gate::AtMost("p₀ from Hertz", 5e-3),
            Gate::AtMost("half-width from Hertz", 1e-3),
            Gate::AtMost("resultant", 1e-9),
        ]);
        Family {
            name: name.into(),
            run: Box::new(move |level| figured(&posed(sort, 2 << level, ""), figures)),
            meshes: match name {
                "quad8" => [0, 3],
                _ if sort.is_quadratic => [2, 3],
                _ => [3, 4],
            },
            gates,
        }
    };
    Case {
        title: "NAFEMS contact roller",
        text: TEXT,
        families: ["triangle3", "quad4", "triangle6", "quad8", "quad9"]
            .map(family)
            .into(),
    }
}

/// u_y of the block's centre (mm) and p₀ (MPa).
fn pressed(model: &Model, solution: &Solution) -> [f64; 2] {
    let all = model.mesh.points.iter().zip(&model.mesh.node_tags);
    let mut middles = all.filter(|(x, _)| **x == [0.0; 3]);
    // The block's nodes are the last.
    let depth = (middles.next_back()).map(|(_, tag)| solution.displacement[tag][1]);
    let [p_0, _] = ellipse(&solution.contacts["contact"]);
    [depth.unwrap_or(f64::NAN), p_0]
}

/// The roller with friction.
pub fn with_friction() -> Case {
    let family = |name: &'static str| {
        let sort = sort(name);
        let run = move |level: usize| {
            let model = posed(sort, 2 << level, "friction = 0.1");
            let of_model = model.clone();
            figured(&model, move |solution| {
                let found = pressed(&of_model, solution);
                let from = |other: [f64; 2], i: usize| found[i] / other[i] - 1.0;
                vec![
                    falling("depth", from(FRICTION_REFERENCE, 0)),
                    falling("p₀", from(FRICTION_REFERENCE, 1)),
                    plain("depth from Code_Aster", from(CODE_ASTER, 0)),
                    plain("p₀ from Code_Aster", from(CODE_ASTER, 1)),
                    plain("depth from NAFEMS", from(NAFEMS, 0)),
                    plain("p₀ from NAFEMS", from(NAFEMS, 1)),
                ]
            })
        };
        Family {
            name: name.into(),
            run: Box::new(run),
            meshes: match sort.is_quadratic {
                true => [2, 3],
                false => [3, 4],
            },
            gates: vec![
                Gate::AtMost("depth", 2e-3),
                Gate::AtMost("p₀", 5e-3),
                Gate::AtMost("depth from Code_Aster", 4e-3),
                Gate::AtMost("p₀ from Code_Aster", 8e-3),
                Gate::AtMost("depth from NAFEMS", 0.03),
                Gate::AtMost("p₀ from NAFEMS", 0.03),
            ],
        }
    };
    Case {
        title: "NAFEMS contact roller with friction",
        text: WITH_FRICTION,
        families: ["triangle3", "quad4", "triangle6", "quad9"]
            .map(family)
            .into(),
    }
}
