//! Initial stress of bodies: residual and thermal stress.

use contact_dd_partition::element::ElementKind::{Hexahedron20, Tetrahedron4, Tetrahedron10};
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use crate::support::blocks::{Blocks, jittered};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::{between, shaken, solid};
use crate::support::solution::{Solution, datasets};
use crate::support::solver::{Case, solve, solve_steps};
use crate::support::sorts::{SORTS, sort};

const YOUNG: f64 = 20e9;
const POISSON: f64 = 0.25;
const EXPANSION: f64 = 1.2e-5;
const HEAT: f64 = 80.0;

const BODY: &str = "
materials.rock = {young = 20e9, poisson = 0.25}
bodies.block = {material = 'rock', thermal = {expansion = 1.2e-5, temperature = 80}}
";

/// Fails unless the displacements of all nodes are `exact`, to within `slack`.
#[track_caller]
fn is_displaced(
    model: &Model,
    solution: &Solution,
    slack: f64,
    exact: impl Fn([f64; 3]) -> [f64; 3],
) {
    for (tag, &x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
        let found = solution.displacement[tag].iter();
        found.zip(exact(x)).for_each(|(u, e)| close(*u, e, slack));
    }
}

fn square() -> Mesh {
    Blocks::new()
        .rectangle("block", [0.0, 1.0], [0.0, 1.0], [5, 4])
        .mesh
}

#[test]
fn heat_without_support_makes_no_stress() {
    let strain = EXPANSION * HEAT;
    let thermal_stress = YOUNG * strain;
    for (plane, factor, out_of_plane) in [
        ("strain", 1.0 + POISSON, -thermal_stress),
        ("stress", 1.0, 0.0),
        ("axisymmetric", 1.0, 0.0),
    ] {
        let held = match plane {
            "axisymmetric" => "'block bottom'",
            _ => "'block bottom', 'block left'",
        };
        let text = format!("plane = '{plane}'{BODY}[[bilateral]]\non = [{held}]\n");
        for sort in SORTS {
            let mesh = jittered(sort.of(&jittered(square(), 0.03, 3)), 0.01, 4);
            let model = model(&text, mesh);
            for count in [1, 4] {
                let solution = solve(&model, count);
                solution.check_stress(
                    [0.0, 0.0, out_of_plane, 0.0, 0.0, 0.0],
                    1e-10 * thermal_stress,
                );
                is_displaced(&model, &solution, 1e-10 * strain, |x| {
                    x.map(|x| factor * strain * x)
                });
                assert_eq!(
                    solution.report["error_estimate"]["relative"]
                        .as_f64()
                        .map(|e| e < 1e-9),
                    Some(true)
                );
            }
        }
    }
}

#[test]
fn heat_without_support_makes_no_stress_in_space() {
    let strain = EXPANSION * HEAT;
    for kind in [Tetrahedron4, Tetrahedron10, Hexahedron20] {
        let mesh = shaken(
            solid("block", kind, [2, 2, 2], between([0.0; 3], [1.0; 3])),
            0.03,
        );
        let text = format!("{BODY}[[bilateral]]\non = ['block x0', 'block y0', 'block z0']\n");
        let model = model(&text, mesh);
        let solution = solve(&model, 3);
        solution.check_stress([0.0; 6], 1e-10 * YOUNG * strain);
        is_displaced(&model, &solution, 1e-10 * strain, |x| x.map(|x| strain * x));
    }
}

/// T = g x bends a free sheet to u = αg (x²/2 − y²/2, x y).
#[test]
fn heat_that_grows_linearly_bends_quadratic_cells_without_stress() {
    let text = format!(
        "plane = 'stress'{}\n[[displacement]]\non = 'block left'\nx = '-0.6e-5*80*y^2'\ny = 0.0\n",
        BODY.replace("80", "'80*x'")
    );
    for sort in SORTS.into_iter().filter(|sort| sort.is_quadratic) {
        let model = model(&text, sort.of(&square()));
        let solution = solve(&model, 4);
        let g = EXPANSION * HEAT;
        is_displaced(&model, &solution, 1e-10 * g, |[x, y, _]| {
            [0.5 * g * (x * x - y * y), g * x * y, 0.0]
        });
        solution.check_stress([0.0; 6], 1e-9 * YOUNG * g);
    }
}

#[test]
fn a_clamped_bar_is_pressed_by_the_heat_alone() {
    let text = format!(
        "plane = 'stress'{BODY}[[bilateral]]\non = ['block left', 'block right', 'block bottom']\n"
    );
    for sort in SORTS {
        let model = model(&text, jittered(sort.of(&square()), 0.01, 4));
        let solution = solve(&model, 3);
        let strain = EXPANSION * HEAT;
        let mut stress = [0.0; 6];
        stress[0] = -YOUNG * strain;
        solution.check_stress(stress, 1e-10 * YOUNG * strain);
        is_displaced(&model, &solution, 1e-10 * strain, |[_, y, _]| {
            [0.0, (1.0 + POISSON) * strain * y, 0.0]
        });
    }
}

/// Stresses of two bodies of one material with common nodes are recovered separately.
#[test]
fn the_stress_of_a_hot_body_doesnt_leak_into_a_cold_one() {
    let mesh = Blocks::new()
        .rectangle("block", [0.0, 1.0], [0.0, 1.0], [4, 4])
        .rectangle("cold", [1.0, 2.0], [0.0, 1.0], [4, 4])
        .glued(|x, _| x == 1.0)
        .mesh;
    let text = format!(
        "plane = 'stress'{BODY}bodies.cold.material = 'rock'
[[displacement]]
on = ['block', 'cold']
x = 0.0
y = 0.0\n"
    );
    let solution = solve(&model(&text, mesh), 3);
    let hot = -YOUNG * EXPANSION * HEAT / (1.0 - POISSON);
    for (centre, stress) in &solution.cells {
        let expected = if centre[0] < 1.0 { hot } else { 0.0 };
        close(stress[0], expected, 1e-12 * hot.abs());
        close(stress[1], expected, 1e-12 * hot.abs());
    }
}

const ROCK: &str = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.25}
bodies.lower = {material = 'rock', body_force = [0, -25e3], initial_stress = ['12.5e3*(y-2)', '25e3*(y-2)', '10e3*(y-2)', 0]}
bodies.upper = {material = 'rock', body_force = [0, -25e3], initial_stress = ['12.5e3*(y-2)', '25e3*(y-2)', '10e3*(y-2)', 0]}
[[bilateral]]
on = ['lower left', 'lower right', 'lower bottom', 'upper left', 'upper right']
[[contact]]
name = 'joint'
sides = ['upper bottom', 'lower top']
friction = 0.3
";

/// The initial stress is in equilibrium with the weight: nothing moves, and the joint carries the weight above it.
#[test]
fn ground_under_its_own_weight_rests() {
    let mesh = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [8, 5])
        .rectangle("upper", [0.0, 2.0], [1.0, 2.0], [8, 5])
        .mesh;
    for sort in SORTS {
        let model = model(ROCK, sort.of(&mesh));
        for count in [2, 5] {
            let solution = solve(&model, count);
            // The weight alone would compress the ground by 2.5 µm.
            is_displaced(&model, &solution, 1e-16, |_| [0.0; 3]);
            for (tag, x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
                let weight = 25e3 * (x[1] - 2.0);
                let expected = [0.5 * weight, weight, 0.4 * weight, 0.0, 0.0, 0.0];
                let found = solution.nodal_stress[tag].iter();
                found.zip(expected).for_each(|(s, e)| close(*s, e, 1e-4));
            }
            for point in solution.points() {
                assert!(point.closed && !point.slipping, "{point:?}");
                close(point.pressure, 25e3, 1e-4);
            }
            assert_eq!(solution.report["error_estimate"]["relative"], 0.0);
            let reactions = solution.report["reactions"].as_array().unwrap();
            let carried: f64 = reactions
                .iter()
                .map(|r| r["force"][1].as_f64().unwrap())
                .sum();
            close(carried, 25e3 * 4.0, 1e-4);
        }
    }
}

/// A pressure supports the wall of a round hole in stressed ground, and is then removed (Lamé).
#[test]
fn a_hole_closes_when_its_support_goes() {
    let (p, inner, outer) = (1e6, 1.0_f64, 3.0_f64);
    let text = "
plane = 'axisymmetric'
materials.rock = {young = 20e9, poisson = 0.25}
bodies.block = {material = 'rock', initial_stress = [-1e6, -1e6, -1e6, 0]}
[[bilateral]]
on = ['block bottom', 'block top', 'block right']
[[pressure]]
on = 'block left'
value = 1e6
[[step]]
name = 'held'
[[step]]
name = 'let go'
scale = {pressure = 0}
";
    let mesh = Blocks::new()
        .rectangle("block", [inner, outer], [0.0, 0.5], [16, 3])
        .mesh;
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    let lambda = 2.0 * shear * POISSON / (1.0 - 2.0 * POISSON);
    // u = A r + B/r, u(outer) = 0, and the stress of the strain at the wall is p.
    let stiff = 2.0 * (lambda + shear);
    let a = p / (stiff + 2.0 * shear * (outer / inner).powi(2));
    let b = -a * outer * outer;
    let model = model(text, sort("quad9").of(&mesh));
    let steps = solve_steps(&model, 3);
    let scale = a.abs() * outer;
    is_displaced(&model, &steps[0], 1e-12 * scale, |_| [0.0; 3]);
    steps[0].check_stress([-p, -p, -p, 0.0, 0.0, 0.0], 1e-9 * p);
    is_displaced(&model, &steps[1], 2e-4 * scale, |[r, ..]| {
        [a * r + b / r, 0.0, 0.0]
    });
    for (tag, [r, ..]) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
        let spread = 2.0 * shear * b / (r * r);
        let stress = steps[1].nodal_stress[tag];
        close(stress[0], -p + stiff * a - spread, 1e-2 * p);
        close(stress[1], -p + 2.0 * lambda * a, 1e-2 * p);
        close(stress[2], -p + stiff * a + spread, 1e-2 * p);
    }
}

/// A ring that cools on a hub exerts the pressure of Lamé's formulas, in plane strain.
#[test]
fn a_ring_shrinks_on_its_hub() {
    let (hole, joint, outer) = (0.5_f64, 1.0_f64, 2.0_f64);
    let text = "
plane = 'axisymmetric'
materials.rock = {young = 20e9, poisson = 0.25}
bodies.hub.material = 'rock'
bodies.ring = {material = 'rock', thermal = {expansion = 1.2e-5, temperature = -80}}
[[bilateral]]
on = ['hub bottom', 'hub top', 'ring bottom', 'ring top']
[[contact]]
name = 'fit'
sides = ['hub right', 'ring left']
[[step]]
scale = 0.5
[[step]]
scale = {thermal = 2}
[[step]]
temperature = {ring = -80.0}
";
    let mesh = Blocks::new()
        .rectangle("hub", [hole, joint], [0.0, 0.5], [8, 4])
        .rectangle("ring", [joint, outer], [0.0, 0.5], [12, 4])
        .mesh;
    let model = model(text, sort("quad8").of(&mesh));
    let compliance = |[a, b]: [f64; 2]| {
        let (a, b, r) = (a * a, b * b, joint * joint);
        // The hub is under external pressure p, the ring under internal pressure.
        ((1.0 - 2.0 * POISSON) * r + a) / (r - a) + ((1.0 - 2.0 * POISSON) * r + b) / (b - r)
    };
    let fit = (1.0 + POISSON) * EXPANSION * HEAT;
    let pressure = fit * YOUNG / ((1.0 + POISSON) * compliance([hole, outer]));
    for (solution, factor) in solve_steps(&model, 4).iter().zip([0.5, 2.0, 1.0]) {
        for point in solution.points() {
            close(point.pressure, factor * pressure, 1e-2 * pressure);
        }
        let force: f64 = solution.points().map(|point| point.force).sum();
        let area = std::f64::consts::PI * joint;
        close(force, factor * pressure * area, 1e-3 * pressure * area);
    }
}

#[test]
fn ranks_leave_no_trace_in_initial_stress() {
    let mesh = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [8, 5])
        .rectangle("upper", [0.0, 2.0], [1.0, 2.0], [8, 5])
        .mesh;
    let text = format!("{ROCK}[[step]]\nscale = 1.5\n[[step]]\nscale = {{initial_stress = 0.5}}\n");
    let case = Case::of(&model(&text, mesh), 5);
    let mut found = Vec::new();
    for ranks in [1, 3] {
        assert_eq!(case.run_on(ranks, &[]).code(), 0);
        found.push(datasets(&case.result()));
    }
    found
        .iter_mut()
        .for_each(|all| all.retain(|name, _| !name.contains("seconds")));
    assert_eq!(found[0], found[1]);
}
