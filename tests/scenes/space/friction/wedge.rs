//! A rock wedge between two planes that dip to each other, under its weight.
//!
//! Let the line in which the planes meet plunge by α, and the planes rise from it by δ across it. What slides along the
//! line is held by tan α cos δ of friction (E. Hoek, J. W. Bray, *Rock slope engineering*, 1981). Friction across the line
//! could press the wedge between the planes, and as a rigid body it stays from a smaller coefficient on, that divided by
//! √(1 + tan²α sin²δ). But in between nothing presses it there: deformed as it is by its weight, it slides.

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::model::Model;

use super::vector;
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::solid;
use crate::support::solver::Case;

const PLUNGE: f64 = std::f64::consts::FRAC_PI_6;
const RISE: f64 = std::f64::consts::FRAC_PI_4;
const WEIGHT: f64 = 26e3;

/// The vector `x` down the line, `y` across it and `z` up from it.
fn along([x, y, z]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = PLUNGE.sin_cos();
    [cos * x + sin * z, y, cos * z - sin * x]
}

/// A wedge without the edge at the line, as wide at its upper end as `upper` times at its lower one, with these cells;
/// friction is a `share` of that which holds it.
fn wedge(share: f64, upper: f64, n: [usize; 3]) -> Model {
    let (sin, cos) = RISE.sin_cos();
    let mesh = solid("rock", Hexahedron8, n, |[x, y, z]| {
        let wide = upper + (1.0 - upper) * x;
        let half = wide * (0.15 + 0.85 * z);
        along([2.0 * x, half * (2.0 * y - 1.0), half * RISE.tan()])
    });
    let mut text = format!(
        "materials.rock = {{young = 20e9, poisson = 0.25}}
        bodies.rock = {{material = 'rock', body_force = [0.0, 0.0, -{WEIGHT:e}]}}\n"
    );
    for (side, across) in [("y0", sin), ("y1", -sin)] {
        text += &format!(
            "[[contact]]
            name = '{side}'
            sides = ['rock {side}']
            obstacle = {{point = [0.0, 0.0, 0.0], normal = {}}}
            gap = 0.0
            friction = {:e}\n",
            vector(along([0.0, across, cos])),
            share * PLUNGE.tan() * cos,
        );
    }
    model(&text, mesh)
}

#[test]
fn a_wedge_slides_down_its_line_until_friction_along_it_holds_its_weight() {
    // As a rigid body it stays above a share of 0.9258.
    for (upper, n) in [(1.0, [4, 3, 3]), (0.1, [5, 3, 3])] {
        for share in [0.85, 0.9258, 0.9259, 0.95, 0.99, 0.999] {
            let case = Case::of(&wedge(share, upper, n), 2);
            for ranks in 1..=3 {
                let ended = case.run_on(ranks, &[]);
                assert_eq!(ended.code(), 4, "{upper}, {share}: {}", ended.stderr);
                let says = "body 'rock' slides along (0.8660, 0.0000, -0.5000)";
                assert!(ended.stderr.contains(says), "{}", ended.stderr);
            }
        }
    }
}

#[test]
fn a_wedge_that_friction_along_its_line_holds_is_in_equilibrium() {
    for (upper, n) in [(1.0, [4, 3, 3]), (0.1, [5, 3, 3])] {
        for share in [1.001, 1.05, 1.5] {
            let model = wedge(share, upper, n);
            let solution = Case::of(&model, 2).solve(&[]);
            let weight: f64 = model.forces.iter().map(|(_, force)| force[2]).sum();
            let down = along([1.0, 0.0, 0.0]);
            let held: f64 = (solution.points())
                .map(|p| (0..3).map(|k| p.tangential_force[k] * down[k]).sum::<f64>())
                .sum();
            close(held, weight * PLUNGE.sin(), 1e-10 * weight.abs());
            let friction = share * PLUNGE.tan() * RISE.cos();
            for point in solution.points() {
                let size = point.tangential_force.iter().map(|f| f * f).sum::<f64>();
                assert!(size.sqrt() <= friction * point.force * (1.0 + 1e-9));
            }
        }
    }
}
