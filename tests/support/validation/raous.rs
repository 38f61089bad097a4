//! Raous' plate on a rigid floor, open, slipping and sticking.

use contact_dd_partition::model::Model;

use super::super::blocks::Blocks;
use super::super::scenes::model;
use super::super::solution::{ContactPoint, Solution};
use super::super::sorts::sort;
use super::{Case, Family, Figure, Gate, Measured, figured, plain};

const TEXT: &str = "\
Half of a plate, 40 mm × 40 mm, E = 130 GPa, ν = 0.2, plane strain, on a rigid floor with μ = 1: 50 MPa from above,
150 MPa from the left, u_x = 0 on the right. Seen from the left the contact is open to 3.3 mm, slips to 29.8 mm and
sticks beyond; u_x at x = 0, 1.25, 5, 7.5 and 11.25 mm is 28.60, 27.23, 22.87, 19.81 and 15.41 µm (mean of several
programs on coarse meshes: 28.6, 27.2, 22.8, 19.8, 15.0 µm), and the floor carries 2 MN/m and, along it, 1.4054 MN/m.

Source: M. Raous, P. Chabrand, F. Lebon, *Numerical methods for frictional contact problems and applications*, J.
Theor. Appl. Mech. 7 (1988); Code_Aster SSNV128. The values are those of meshes of up to 128 × 128 bilinear squares
by another program.

Mesh: squares, or each cut in two triangles. *Displacement*: the largest relative error at the five points. *Ends* of the
zones: half-way between nodes, their distance from 3.3 and 29.8 mm in cells. *Resultant* and *friction*: forces of the
floor.
";

const SIDE: f64 = 0.04;
/// x and u_x (m).
const POINTS: [[f64; 2]; 5] = [
    [0.0, 2.860e-5],
    [1.25e-3, 2.723e-5],
    [5e-3, 2.287e-5],
    [7.5e-3, 1.981e-5],
    [11.25e-3, 1.541e-5],
];
/// Ends of the open and of the slipping zone (m).
const ENDS: [f64; 2] = [3.3e-3, 29.8e-3];

fn posed(name: &str, n: usize) -> Model {
    let blocks = Blocks::new().rectangle("plate", [0.0, SIDE], [0.0, SIDE], [n, n]);
    let text = "plane = 'strain'
        materials.steel = {young = 1.3e11, poisson = 0.2}
        bodies.plate.material = 'steel'
        [[displacement]]
        on = 'plate right'
        x = 0.0
        [[pressure]]
        on = 'plate top'
        value = 5e7
        [[pressure]]
        on = 'plate left'
        value = 15e7
        [[contact]]
        name = 'floor'
        sides = ['plate bottom']
        obstacle = { point = [0.0, 0.0], normal = [0.0, 1.0] }
        friction = 1.0";
    model(text, sort(name).of(&blocks.mesh))
}

fn of_plate(solution: &Solution, cell: f64) -> Vec<Figure> {
    let mut points: Vec<&ContactPoint> = solution.contacts["floor"].iter().collect();
    points.sort_by(|p, q| p.position[0].total_cmp(&q.position[0]));
    let displacement = |x: f64| {
        let nearest = points.iter().min_by(|p, q| {
            let [p, q] = [p, q].map(|point| (point.position[0] - x).abs());
            p.total_cmp(&q)
        });
        solution.displacement[&nearest.unwrap().tags[0]][0]
    };
    let errors = POINTS.map(|[x, u]| (displacement(x) / u - 1.0).abs());
    let end = |is_within: &dyn Fn(&ContactPoint) -> bool| {
        let count = points.iter().take_while(|point| is_within(point)).count();
        assert!(count > 0 && points[count..].iter().all(|point| !is_within(point)));
        (points[count - 1].position[0] + points[count].position[0]) / 2.0
    };
    let ends = [
        end(&|point| !point.closed),
        end(&|point| !point.closed || point.slipping),
    ];
    let off = [0, 1].map(|i| (ends[i] - ENDS[i]).abs() / cell);
    let normal: f64 = points.iter().map(|point| point.force).sum();
    let along: f64 = points.iter().map(|point| point.tangential_force[0]).sum();
    vec![
        plain("displacement", errors.into_iter().fold(0.0, f64::max)),
        plain("end of the open zone, cells", off[0]),
        plain("end of the slipping zone, cells", off[1]),
        plain("resultant", normal / 2e6 - 1.0),
        plain("friction", along.abs() / 1.4054e6 - 1.0),
    ]
}

/// The plate in squares and in triangles.
pub fn case() -> Case {
    let family = |name: &'static str| {
        let run = move |level: usize| -> Measured {
            let n = 32 << level;
            let model = posed(name, n);
            let nodes = if sort(name).is_quadratic { 2 } else { 1 };
            let cell = SIDE / (n * nodes) as f64;
            figured(&model, move |solution| of_plate(solution, cell))
        };
        Family {
            name: name.into(),
            run: Box::new(run),
            meshes: [2, 3],
            gates: vec![
                Gate::AtMost("displacement", 3e-3),
                Gate::AtMost("end of the open zone, cells", 1.0),
                Gate::AtMost("end of the slipping zone, cells", 1.0),
                Gate::AtMost("resultant", 1e-10),
                Gate::AtMost("friction", 3e-3),
            ],
        }
    };
    Case {
        title: "Raous' plate",
        text: TEXT,
        families: ["quad4", "triangle3"].map(family).into(),
    }
}
