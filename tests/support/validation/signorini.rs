//! A manufactured solution of Signorini's problem.

use super::super::blocks::{Blocks, jittered};
use super::super::scenes::model;
use super::super::solution::Solution;
use super::super::sorts::sort;
use super::exact::Exact;
use super::{Case, Family, Figure, Gate, Posed, falling, plain};

const TEXT: &str = "\
u_x = −y A'(x), u_y = A(x) + y B(x) with A = 1e-3 cos 2x and B = −1e-2 max(½ − x, 0)³, E = 200, ν = 0.3,
plane strain. On y = 0 the shear is 0, and σ_yy = (λ + 2μ) B is a pressure for x < ½ and 0 beyond. With the
gap A + 1e-3 max(x − ½, 0)² to a rigid plane the left half is closed, the right half open. Body force and
tractions follow from u. *Pressure*: largest error over the largest pressure; *wrong*: nodes more than a
cell from x = ½ whose status is wrong.

Mesh: the square [0, 1] × [−1, 0] in irregular cells, u prescribed on the left and below, tractions on
the right. `quad8` are squares: in cells other than parallelograms they lose their order (D. N. Arnold, D. Boffi, R. S. Falk, *Approximation by quadrilateral finite elements*, Math. Comp.
71 (2002)).
";

const YOUNG: f64 = 200.0;
const POISSON: f64 = 0.3;

/// λ and μ.
fn lame() -> [f64; 2] {
    [
        YOUNG * POISSON / (1.0 + POISSON) / (1.0 - 2.0 * POISSON),
        YOUNG / 2.0 / (1.0 + POISSON),
    ]
}

/// B and B'.
fn b(x: f64) -> [f64; 2] {
    let w = (0.5 - x).max(0.0);
    [-1e-2 * w.powi(3), 3e-2 * w * w]
}

fn exact() -> Exact {
    let [l, m] = lame();
    Exact::Plane(Box::new(move |[x, y]: [f64; 2]| {
        let bending = -y * (-4e-3 * (2.0 * x).cos());
        let [b, slope] = b(x);
        [
            (l + 2.0 * m) * bending + l * b,
            l * bending + (l + 2.0 * m) * b,
            m * y * slope,
        ]
    }))
}

/// The scene: b_x = (λ + 2μ) y A''' − (λ + μ) B', b_y = λ A'' − μ y B''.
fn scene() -> String {
    let [l, m] = lame();
    let third = "8e-3*sin(2*x)";
    let w = "max(0.5 - x, 0)";
    let force = [
        format!("{}*y*{third} - {}*3e-2*{w}^2", l + 2.0 * m, l + m),
        format!("-{l}*4e-3*cos(2*x) + {m}*y*6e-2*{w}"),
    ];
    format!(
        "plane = 'strain'
        materials.steel = {{young = {YOUNG}, poisson = {POISSON}}}
        bodies.block = {{material = 'steel', body_force = ['{}', '{}']}}
        [[displacement]]
        on = ['block left', 'block bottom']
        x = '2e-3*y*sin(2*x)'
        y = '1e-3*cos(2*x) - 1e-2*y*{w}^3'
        [[contact]]
        name = 'contact'
        sides = ['block top']
        obstacle = {{point = [0, 0], normal = [0, -1]}}
        gap = '1e-3*cos(2*x) + 1e-3*max(x - 0.5, 0)^2'",
        force[0], force[1],
    )
}

/// The scene on n × n squares, or in irregular cells if these have the same order of convergence.
pub fn posed(name: &str, n: usize) -> Posed {
    let blocks = Blocks::new().rectangle("block", [0.0, 1.0], [-1.0, 0.0], [n, n]);
    let amount = if name == "quad8" { 0.0 } else { 0.1 };
    let mesh = sort(name).of(&jittered(blocks.mesh, amount / n as f64, 3));
    let mut model = model(&scene(), mesh);
    let exact = exact();
    exact.load(&mut model, &[("block right", [1.0, 0.0])]);
    Posed {
        model,
        exact,
        figures: Box::new(move |solution| of_contact(solution, n)),
    }
}

/// Errors of the pressure and of the closed part of the side in n cells.
fn of_contact(solution: &Solution, n: usize) -> Vec<Figure> {
    let [l, m] = lame();
    let largest = -(l + 2.0 * m) * b(0.0)[0];
    let points = &solution.contacts["contact"];
    let errors = points.iter().map(|point| {
        let pressure = -(l + 2.0 * m) * b(point.position[0])[0];
        (point.pressure - pressure).abs() / largest
    });
    let wrong = points.iter().filter(|point| {
        let beyond = point.position[0] - 0.5;
        beyond.abs() > 1.0 / n as f64 + 1e-9 && point.closed != (beyond < 0.0)
    });
    vec![
        falling("pressure", errors.fold(0.0, f64::max)),
        plain("wrong", wrong.count() as f64),
    ]
}

/// The manufactured solution in all kinds of cells.
pub fn case() -> Case {
    let family = |name: &'static str| {
        let order = if sort(name).is_quadratic { 1.9 } else { 0.95 };
        Family {
            name: name.into(),
            run: Box::new(move |level| posed(name, 6 << level).measured()),
            meshes: [3, 4],
            gates: vec![Gate::Order("energy", order), Gate::AtMost("pressure", 0.1)],
        }
    };
    Case {
        title: "Manufactured solution of Signorini's problem",
        text: TEXT,
        families: ["triangle3", "quad4", "triangle6", "quad8", "quad9"]
            .map(family)
            .into(),
    }
}
