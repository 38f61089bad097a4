//! Friction on compliant contacts: sticking sides move by shear stress over tangential stiffness, if there is one.

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::mesh::Mesh;

use crate::support::blocks::{Blocks, joined};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::{between, solid};
use crate::support::solution::{datasets, difference};
use crate::support::solver::{Case, solve_steps};

const YOUNG: f64 = 20e9;
const PRESSURE: f64 = 3e6;
const STIFFNESS: f64 = 5e10;

/// A block on a wall, or on a fixed plate, under pressure and a traction along its bottom: uniform stresses.
fn sheared(dim: usize, friction: f64, tangential: Option<f64>) -> String {
    let keys = tangential.map_or(String::new(), |k| format!(", tangential = {k:?}"));
    let (plane, held, sides, top) = match dim {
        2 => (
            "plane = 'strain'\n",
            "x = 0.0\ny = 0.0",
            ["upper bottom", "lower top"],
            "upper top",
        ),
        _ => (
            "",
            "x = 0.0\ny = 0.0\nz = 0.0",
            ["upper z0", "lower z1"],
            "upper z1",
        ),
    };
    let load = match dim {
        2 => format!("[{:?}, {:?}]", 0.2 * PRESSURE, -PRESSURE),
        _ => format!(
            "[{:?}, {:?}, {:?}]",
            0.12 * PRESSURE,
            0.16 * PRESSURE,
            -PRESSURE
        ),
    };
    format!(
        "{plane}materials.rock = {{young = {YOUNG:?}, poisson = 0.0}}
bodies.lower.material = 'rock'
bodies.upper.material = 'rock'
[[contact]]
name = 'joint'
sides = ['{}', '{}']
friction = {friction:?}
stiffness = {{ normal = {STIFFNESS:?}{keys} }}
[[displacement]]
on = 'lower'
{held}
[[traction]]
on = '{top}'
value = {load}
",
        sides[0], sides[1]
    )
    .replace("on = 'lower'", &format!("on = {}", all_sides(dim)))
}

/// The sides of the lower block, which contain all of its nodes.
fn all_sides(dim: usize) -> &'static str {
    match dim {
        2 => "['lower bottom', 'lower top']",
        _ => "['lower z0', 'lower z1']",
    }
}

fn blocks(dim: usize, of_upper: usize) -> Mesh {
    match dim {
        2 => {
            Blocks::new()
                .rectangle("lower", [-0.5, 1.5], [-0.2, 0.0], [8, 1])
                .rectangle("upper", [0.0, 1.0], [0.0, 0.1], [of_upper, 1])
                .mesh
        }
        _ => {
            let lower = solid(
                "lower",
                Hexahedron8,
                [4, 4, 1],
                between([-0.5, -0.5, -0.2], [1.5, 1.5, 0.0]),
            );
            let upper = solid(
                "upper",
                Hexahedron8,
                [of_upper, of_upper, 1],
                between([0.0; 3], [1.0, 1.0, 0.01]),
            );
            joined(lower, upper)
        }
    }
}

/// The resultant displacement of sticking points is force over stiffness, whatever the rotation and bending.
#[test]
fn what_sticks_moves_by_shear_stress_over_stiffness() {
    let tangential = 2e10;
    for (dim, of_upper) in [(2, 4), (2, 7), (3, 2), (3, 3)] {
        let solutions = solve_steps(
            &model(&sheared(dim, 0.6, Some(tangential)), blocks(dim, of_upper)),
            3,
        );
        let solution = &solutions[0];
        let mut work = 0.0;
        for point in solution.points().filter(|point| point.closed) {
            assert!(!point.slipping);
            work += point.force;
            let area = point.force / point.pressure;
            let u = solution.displacement[&point.tags[0]];
            // Except for the spring's part the jump vanishes: nothing slides.
            for (k, u) in u.iter().enumerate().take(dim - 1) {
                close(
                    *u,
                    -point.tangential_force[k] / (tangential * area),
                    1e-9 * PRESSURE / tangential,
                );
                close(point.slip[k], 0.0, 1e-9 * PRESSURE / tangential);
            }
        }
        close(work, PRESSURE, 1e-8 * PRESSURE);
    }
}

/// Without tangential stiffness sticking points don't move, and at the bound they slip.
#[test]
fn what_is_rigid_along_tangents_sticks_and_slips_as_ever() {
    for (dim, of_upper) in [(2, 4), (3, 2)] {
        let solution = &solve_steps(&model(&sheared(dim, 0.6, None), blocks(dim, of_upper)), 3)[0];
        for point in solution
            .points()
            .filter(|point| point.closed && !point.slipping)
        {
            let u = solution.displacement[&point.tags[0]];
            (0..dim - 1).for_each(|k| close(u[k], 0.0, 1e-9 * PRESSURE / STIFFNESS));
        }
        let text = sheared(dim, 0.6, None).replace("friction = 0.6", "friction = 0.3")
            + "[[step]]\n[[step]]\nscale = 0.5\n";
        let steps = solve_steps(&model(&text, blocks(dim, of_upper)), 3);
        assert!(
            steps
                .iter()
                .all(|step| step.points().any(|point| point.closed))
        );
    }
}

#[test]
fn ranks_and_solvers_make_no_difference() {
    for (dim, of_upper, tangential) in [(2, 7, Some(2e10)), (2, 4, None), (3, 3, Some(2e10))] {
        let model = model(&sheared(dim, 0.25, tangential), blocks(dim, of_upper));
        let case = Case::in_clusters(&model, 5, 3);
        case.solve(&[]);
        let direct = case.folder().join("direct.vtkhdf");
        std::fs::rename(case.result(), &direct).unwrap();
        let expected = datasets(&direct);
        for ranks in [2, 3, 4] {
            let ended = case.run_on(ranks, &[]);
            assert_eq!(ended.code(), 0, "{}", ended.stderr);
            assert!(datasets(&case.result()) == expected, "{ranks} ranks");
        }
        case.solve(&["--interface", "iterative"]);
        let (apart, at) = difference(&direct, &case.result());
        assert!(apart < 1e-8, "{apart:e} in {at}");
    }
}
