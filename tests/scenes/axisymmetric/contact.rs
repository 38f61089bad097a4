//! Axisymmetric contact.

use std::f64::consts::PI;

use contact_dd_partition::element::ElementKind::Hexahedron27;
use contact_dd_partition::model::Model;

use super::{BODY, POISSON, YOUNG, rectangle};
use crate::support::blocks::{Blocks, jittered, joined};
use crate::support::close::close;
use crate::support::comparison::{compare, judged};
use crate::support::monolithic::Monolithic;
use crate::support::scenes::model;
use crate::support::solids::solid;
use crate::support::solver::{Case, solve, solve_steps};
use crate::support::sorts::{SORTS, sort};

/// Two bodies on a floor under uniform pressure all around, with `text` for the joint between them.
fn pressed(upper: &str) -> String {
    format!(
        "
plane = 'axisymmetric'
materials.rock = {{young = 20e9, poisson = 0.25}}
bodies.lower.material = 'rock'
bodies.upper.material = 'rock'
[[pressure]]
on = ['upper top', 'lower right', 'upper right'{upper}]
value = 1e6
[[contact]]
name = 'joint'
sides = ['lower top', 'upper bottom']
[[contact]]
name = 'floor'
sides = ['lower bottom']
obstacle = {{point = [0, 0], normal = [0, 1]}}
"
    )
}

#[test]
fn uniform_compression_goes_through_conical_joints_of_all_cells() {
    let strain = -1e6 * (1.0 - 2.0 * POISSON) / YOUNG;
    for (inner, slope) in [(0.0, 0.0), (0.5, 0.0), (0.5, 0.3)] {
        let height = |s: f64| 1.0 + slope * s;
        let block = |name: &str, n, ends: [f64; 2]| {
            let blocks = Blocks::new().mapped(name, n, |[s, t]| {
                let (low, high) = if ends[0] == 0.0 {
                    (0.0, height(s))
                } else {
                    (height(s), 2.0)
                };
                [inner + s, low * (1.0 - t) + high * t]
            });
            jittered(blocks.mesh, 0.02, 5)
        };
        let inside = if inner > 0.0 {
            ", 'lower left', 'upper left'"
        } else {
            ""
        };
        for sort in SORTS {
            for upper in [5, 8] {
                let lower = sort.of(&block("lower", [5, 4], [0.0, 1.0]));
                let upper = sort.of(&block("upper", [upper, 4], [1.0, 2.0]));
                let model = model(&pressed(inside), joined(lower, upper));
                let solution = solve(&model, 4);
                solution.check_stress([-1e6, -1e6, -1e6, 0.0, 0.0, 0.0], 1e-10 * 1e6);
                for (tag, x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
                    let u = solution.displacement[tag];
                    (0..2).for_each(|k| close(u[k], strain * x[k], 1e-10 * strain.abs()));
                }
                for point in solution.points() {
                    assert!(point.closed, "{point:?}");
                    close(point.pressure, 1e6, 1e-9 * 1e6);
                }
                let area = PI * ((inner + 1.0).powi(2) - inner * inner);
                for contact in solution.report["contacts"].as_array().unwrap() {
                    let found = contact["force"].as_array().unwrap();
                    close(found[0].as_f64().unwrap(), 0.0, 0.0);
                    close(found[1].as_f64().unwrap().abs(), 1e6 * area, 1e-4 * area);
                }
            }
        }
    }
}

/// The pressure between shrink-fitted rings, with free or prevented axial expansion of each.
fn fit(delta: f64, [inner, joint, outer]: [f64; 3], held: bool) -> f64 {
    let (young, poisson) = match held {
        true => (YOUNG / (1.0 - POISSON * POISSON), POISSON / (1.0 - POISSON)),
        false => (YOUNG, POISSON),
    };
    let ratio = |a: f64, b: f64| (b * b + a * a) / (b * b - a * a);
    delta * young / joint / (ratio(joint, outer) + poisson + ratio(inner, joint) - poisson)
}

fn shrunk(count: [usize; 2], name: &str, friction: &str) -> Model {
    let sort = sort(name);
    let inner = sort.of(&rectangle("inner", [1.0, 2.0], [0.0, 0.5], [12, count[0]]));
    let outer = sort.of(&rectangle("outer", [2.0, 3.0], [0.0, 0.5], [12, count[1]]));
    let text = format!(
        "
plane = 'axisymmetric'
materials.rock = {{young = {YOUNG}, poisson = {POISSON}}}
bodies.inner.material = 'rock'
bodies.outer.material = 'rock'
[[bilateral]]
on = ['inner bottom', 'inner top', 'outer bottom', 'outer top']
[[contact]]
name = 'fit'
sides = ['inner right', 'outer left']
gap = -1e-4
interference = true
{friction}"
    );
    model(&text, joined(inner, outer))
}

#[test]
fn rings_pressed_into_each_other_press_as_lame_says() {
    let exact = fit(1e-4, [1.0, 2.0, 3.0], true);
    for (name, slack) in [("quad4", 1e-3), ("triangle6", 5e-4), ("quad9", 1e-5)] {
        for count in [[4, 4], [3, 5]] {
            let solution = solve(&shrunk(count, name, ""), 4);
            for point in solution.points() {
                close(point.pressure, exact, slack * exact);
            }
        }
    }
}

/// A ring in a rigid tube that is too narrow by δ, pushed along the axis: friction holds it up to μ times the normal
/// force.
#[test]
fn friction_holds_a_ring_in_a_tube_up_to_its_bound() {
    let mesh = || sort("quad9").of(&rectangle("ring", [1.0, 2.0], [0.0, 0.5], [8, 6]));
    let text = |push: f64| {
        format!(
            "{BODY}
[[contact]]
name = 'tube'
sides = ['ring right']
obstacle = {{point = [1.999, 0], normal = [-1, 0]}}
interference = true
friction = 0.2
[[traction]]
on = 'ring top'
value = [0.0, {push}]
"
        )
    };
    let quiet = solve(&model(&text(0.0), mesh()), 3);
    let normal: f64 = quiet.points().map(|point| point.force).sum();
    // Like a free ring under plane stress: without friction the pressure is uniform along the axis.
    let area = PI * (4.0 - 1.0);
    for share in [0.3, 0.9] {
        let push = share * 0.2 * normal / area;
        let model = model(&text(push), mesh());
        let solution = solve(&model, 3);
        let up: f64 = solution
            .points()
            .map(|point| point.tangential_force[1])
            .sum();
        close(up, -push * area, 1e-10 * push * area);
        let findings = judged(&model, &solve_steps(&model, 2));
        assert!(findings.difference <= Some(1e-11), "{findings:?}");
        let mut faults = findings.faults();
        // Around an axis radial forces are self-equilibrated.
        faults.retain(|fault| !fault.starts_with("balance"));
        assert!(faults.is_empty(), "{faults:?}");
    }
    let pushed = Case::of(&model(&text(2.0 * 0.2 * normal / area), mesh()), 3).run(&[]);
    assert_ne!(pushed.code(), 0);
}

/// A ring on a wider disc, pressed on a part of its top: the joint is partly open.
fn partly_open(name: &str, upper: usize) -> Model {
    let sort = sort(name);
    let lower = sort.of(&rectangle("lower", [0.0, 2.0], [0.0, 1.0], [8, 4]));
    let upper = sort.of(&rectangle("upper", [0.0, 1.5], [1.0, 2.0], [upper, 5]));
    let text = "
plane = 'axisymmetric'
materials.rock = {young = 20e9, poisson = 0.25}
materials.wood = {stiffness = [[3e9, 1e9, 0.5e9, 0], [1e9, 5e9, 1e9, 0], [0.5e9, 1e9, 4e9, 0], [0, 0, 0, 1e9]]}
bodies.lower.material = 'rock'
bodies.lower.body_force = ['1e3*x', -2e4]
bodies.upper.material = 'wood'
[[displacement]]
on = 'lower bottom'
x = 0.0
y = 0.0
[[pressure]]
on = 'upper top'
value = '1e6*(1.3-x)'
[[contact]]
name = 'joint'
sides = ['upper bottom', 'lower top']
";
    model(text, joined(lower, jittered(upper, 0.02, 7)))
}

#[test]
fn partly_open_joints_around_an_axis_are_the_monolithic_solution() {
    for (name, upper) in [
        ("triangle3", 6),
        ("quad4", 7),
        ("triangle6", 7),
        ("quad8", 6),
        ("quad9", 5),
    ] {
        let model = partly_open(name, upper);
        let solution = solve(&model, 5);
        let closed = solution.closed();
        assert!(0 < closed && closed < solution.points().count(), "{name}");
        compare(&model, &Monolithic::new(&model), &solution);
        assert!(
            model.contacts[0]
                .points
                .iter()
                .all(|point| point.area > 0.0),
            "{name}"
        );
        // On the axis they can only approach axially.
        let on_axis = solution
            .points()
            .find(|point| point.position[0] == 0.0)
            .unwrap();
        assert_eq!(on_axis.normal, [0.0, -1.0, 0.0], "{name}");
    }
}

/// The same rings as a meridian section and as a sector of 30° in space, whose curved faces quadratic cells approximate
/// closely.
#[test]
fn a_section_is_what_a_sector_in_space_is() {
    let scene = |top: &str, supports: &str| {
        format!(
            "
materials.rock = {{young = 20e9, poisson = 0.25}}
bodies.lower.material = 'rock'
bodies.upper.material = 'rock'
{supports}
[[pressure]]
on = '{top}'
value = '1e6*(1.28-hypot(x,{}))'
",
            if top == "upper z1" { "y" } else { "0" }
        )
    };
    let section = {
        let lower = rectangle("lower", [1.0, 2.0], [0.0, 1.0], [6, 4]);
        let upper = rectangle("upper", [1.0, 1.5], [1.0, 2.0], [3, 4]);
        let text = scene("upper top", "[[bilateral]]\non = 'lower bottom'\n");
        let joint = "[[contact]]\nname = 'joint'\nsides = ['upper bottom', 'lower top']\n";
        let text = format!("plane = 'axisymmetric'\n{text}{joint}");
        model(&text, sort("quad9").of(&joined(lower, upper)))
    };
    let sector = {
        let ring = |name, n: [usize; 3], outer: f64, low: f64| {
            solid(name, Hexahedron27, n, move |[s, t, h]| {
                let (r, angle) = (1.0 + s * (outer - 1.0), t * PI / 6.0);
                [r * angle.cos(), r * angle.sin(), low + h]
            })
        };
        let meshes = joined(
            ring("lower", [6, 3, 4], 2.0, 0.0),
            ring("upper", [3, 3, 4], 1.5, 1.0),
        );
        let sides =
            "[[bilateral]]\non = ['lower z0', 'lower y0', 'lower y1', 'upper y0', 'upper y1']\n";
        let joint = "[[contact]]\nname = 'joint'\nsides = ['upper z0', 'lower z1']\n";
        model(&format!("{}{joint}", scene("upper z1", sides)), meshes)
    };
    let (flat, full) = (solve(&section, 3), solve(&sector, 4));
    let mut of_section = Vec::new();
    for point in flat.points() {
        of_section.push((point.position[0], point.pressure, point.closed));
    }
    let largest = of_section.iter().map(|of| of.1).fold(0.0, f64::max);
    let mut closed = 0;
    for point in full.points() {
        let [x, y, _] = point.position;
        let (_, pressure, is_closed) = (of_section.iter())
            .find(|of| (of.0 - x.hypot(y)).abs() < 1e-9)
            .unwrap();
        assert_eq!(point.closed, *is_closed, "{point:?}");
        close(point.pressure, *pressure, 1e-2 * largest);
        closed += usize::from(point.closed);
    }
    assert!(0 < closed && closed < full.points().count(), "{closed}");
    let [area, sum] = [&flat, &full].map(|s| s.points().map(|p| p.force).sum::<f64>());
    close(12.0 * sum, area, 1e-3 * area);
    let nodes: Vec<([f64; 3], [f64; 3])> = (section.mesh.node_tags.iter())
        .zip(&section.mesh.points)
        .map(|(tag, &x)| (x, flat.displacement[tag]))
        .collect();
    let size = flat.largest_displacement();
    for (tag, &[x, y, z]) in sector.mesh.node_tags.iter().zip(&sector.mesh.points) {
        let r = x.hypot(y);
        let u = full.displacement[tag];
        let radial = (u[0] * x + u[1] * y) / r;
        let there = nodes
            .iter()
            .filter(|(at, _)| (at[0] - r).hypot(at[1] - z) < 1e-9);
        // At the joint two nodes coincide.
        let off = there.map(|(_, of)| (of[0] - radial).hypot(of[1] - u[2]));
        let off = off.fold(f64::INFINITY, f64::min);
        assert!(off < 1e-3 * size, "{x} {y} {z}: {off:e} of {size:e}");
    }
}
