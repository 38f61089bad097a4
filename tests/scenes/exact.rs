//! Scenes whose exact answer is known.

use contact_dd_partition::element::ElementKind::Quad4;
use contact_dd_partition::example;
use contact_dd_partition::mesh::Mesh;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::scenes::{
    BODIES, JOINT, SUPPORTS, built_in, built_in_model, model, two_blocks,
};
use crate::support::solution::Solution;
use crate::support::solver::solve;
use crate::support::sorts::{Sort, sort};
use crate::support::statics::{balanced, reaction};

/// Pressure, Young's modulus and Poisson's ratio of a uniform compression.
type Compression = [f64; 3];

/// u = −p (1+ν)(1−2ν)/E · (x − x_0).
fn compressed([p, young, poisson]: Compression, x_0: f64, x: [f64; 3]) -> [f64; 2] {
    let strain = -p * (1.0 + poisson) * (1.0 - 2.0 * poisson) / young;
    [strain * (x[0] - x_0), strain * (x[1] - x_0)]
}

/// Fails unless stress and contact pressure are those of the compression everywhere, with every
/// contact closed, all to within `slack`.
#[track_caller]
fn is_compressed(solution: &Solution, [p, _, poisson]: Compression, slack: f64) {
    for (_, stress) in &solution.cells {
        let expected = [-p, -p, -2.0 * poisson * p, 0.0, 0.0, 0.0];
        for (s, e) in stress.iter().zip(expected) {
            close(*s, e, 10.0 * slack * p);
        }
    }
    for point in solution.points() {
        close(point.pressure, p, 10.0 * slack * p);
        close(point.gap, 0.0, slack * solution.largest_displacement());
        assert!(point.closed, "{point:?}");
    }
}

#[test]
fn uniform_compression_through_an_inclined_contact_is_exact() {
    let model = built_in_model("patch", 0);
    let compression = [1e6, 20e9, 0.25];
    for count in [2, 4, 7] {
        let solution = solve(&model, count);
        is_compressed(&solution, compression, 1e-12);
        let slack = 1e-12 * solution.largest_displacement();
        for (tag, &x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
            let expected = compressed(compression, 0.0, x);
            for (u, e) in solution.displacement[tag].iter().zip(expected) {
                close(*u, e, slack);
            }
        }
    }
}

/// The wedge may slide on the base and let the right block down, which costs nothing: the answer
/// has no part in that motion, the uniform compression has.
#[test]
fn three_contacts_that_meet_leave_uniform_compression_alone() {
    let model = built_in_model("junction", 0);
    let compression = [1e6, 100e6, 0.3];
    let motions = [
        ("base", [0.0, 0.0]),
        ("left block", [0.0, 0.0]),
        ("right block", [0.0, -3.0]),
        ("wedge", [5.0, -3.0]),
    ];
    for count in [4, 9] {
        let solution = solve(&model, count);
        is_compressed(&solution, compression, 1e-10);
        let slack = 1e-10 * solution.largest_displacement();
        let mut nodes: Vec<(usize, [f64; 2])> = Vec::new();
        for (body, motion) in motions {
            let cells = model.mesh.groups[body].members.iter();
            let all = cells.flat_map(|&cell| model.mesh.cells.nodes_of(cell as usize));
            nodes.extend(all.map(|&node| (node as usize, motion)));
        }
        nodes.sort_by_key(|&(node, _)| node);
        nodes.dedup_by_key(|&mut (node, _)| node);
        let u = |node: usize| solution.displacement[&model.mesh.node_tags[node]];
        let along = |f: &dyn Fn(usize) -> [f64; 2]| -> f64 {
            let terms = nodes
                .iter()
                .map(|&(node, z)| f(node)[0] * z[0] + f(node)[1] * z[1]);
            terms.sum()
        };
        let exact = |node: usize| compressed(compression, -5.0, model.mesh.points[node]);
        let length: f64 = nodes.iter().map(|(_, z)| z[0] * z[0] + z[1] * z[1]).sum();
        let part = along(&exact) / length;
        for &(node, z) in &nodes {
            for ((u, e), z) in u(node).into_iter().zip(exact(node)).zip(z) {
                close(u, e - part * z, slack);
            }
        }
        let warnings = &solution.report["warnings"];
        assert_eq!(warnings.as_array().unwrap().len(), 1, "{warnings:#}");
    }
}

/// A plate with a crack from (−1, 0) to (1, 0) of `cells` cells, graded away from it.
fn cracked_plate(cells: usize) -> Mesh {
    const HALF: f64 = 20.0;
    let graded = |t: f64| (HALF - 1.0) * (0.15 * t + 0.85 * t.powi(3));
    let x = |column: &str, s: f64| match column {
        "left" => -1.0 - graded(1.0 - s),
        "middle" => 2.0 * s - 1.0,
        _ => 1.0 + graded(s),
    };
    let mut blocks = Blocks::new();
    for (column, n) in [("left", cells / 2), ("middle", cells), ("right", cells / 2)] {
        let up = |t: f64| HALF * (0.05 * t + 0.95 * t.powi(3));
        blocks = blocks
            .mapped(&format!("{column} below"), [n, cells], |[s, t]| {
                [x(column, s), -up(1.0 - t)]
            })
            .mapped(&format!("{column} above"), [n, cells], |[s, t]| {
                [x(column, s), up(t)]
            });
    }
    blocks.glued(|x, y| y != 0.0 || x.abs() > 1.0 - 1e-9).mesh
}

/// Largest slip over the exact one, and largest error of the pressure over the exact one.
fn closed_crack(cells: usize, sort: Sort) -> [f64; 2] {
    let (young, poisson, load, psi) = (25e9, 0.25, 100e6, 20_f64.to_radians());
    let (sin, cos) = psi.sin_cos();
    let stress = [-cos * cos, -sin * sin, -sin * cos].map(|s| load * s);
    let [xx, yy, xy] = stress;
    let sides = |side: &str, names: [&str; 3]| {
        let list: Vec<String> = names.iter().map(|n| format!("'{n} {side}'")).collect();
        list.join(", ")
    };
    let bodies = ["left", "middle", "right"]
        .map(|c| format!("bodies.'{c} below'.material = 'm'\nbodies.'{c} above'.material = 'm'\n"))
        .concat();
    let across = ["left", "middle", "right"];
    let text = format!(
        "plane = 'strain'
        materials.m = {{young = {young}, poisson = {poisson}}}
        {bodies}
        [[traction]]
        on = ['right below right', 'right above right']
        value = [{xx}, {xy}]
        [[traction]]
        on = ['left below left', 'left above left']
        value = [{}, {}]
        [[traction]]
        on = [{}]
        value = [{xy}, {yy}]
        [[traction]]
        on = [{}]
        value = [{}, {}]
        [[contact]]
        name = 'crack'
        sides = ['middle above bottom', 'middle below top']",
        -xx,
        -xy,
        sides("above top", across),
        sides("below bottom", across),
        -xy,
        -yy,
    );
    let solution = solve(&model(&text, sort.of(&cracked_plate(cells))), 6);
    let exact = 4.0 * (1.0 - poisson * poisson) / young * load * sin * cos;
    let pressure = load * sin * sin;
    close(exact, 4.8209e-3, 1e-7);
    close(pressure, 11.698e6, 1e3);
    let points = &solution.contacts["crack"];
    let edges = if sort.is_quadratic { 2 * cells } else { cells };
    assert_eq!(points.len(), edges - 1);
    let mut slip = 0.0_f64;
    let mut error = 0.0_f64;
    for point in points {
        assert!(point.closed);
        let [a, b] = point.tags.map(|tag| solution.displacement[&tag][0]);
        slip = slip.max((a - b).abs());
        error = error.max((point.pressure / pressure - 1.0).abs());
    }
    [slip / exact, error]
}

#[test]
fn built_in_line_contact_is_hertzs() {
    let (a, peak): (f64, f64) = (0.68078, 9.35135);
    for count in [1, 4] {
        let solution = solve(&built_in_model("hertz", 0), count);
        close(solution.points().map(|p| p.force).sum(), 5.0, 1e-9);
        for point in solution.points() {
            let x = point.position[0];
            assert_eq!(point.closed, x < a + 1e-3, "{point:?}");
            let exact = peak * (1.0 - x * x / a / a).max(0.0).sqrt();
            close(point.pressure, exact, 0.02 * peak);
        }
    }
}

#[test]
fn the_built_in_crack_carries_its_pressure_and_slips() {
    let solution = solve(&built_in_model("crack", 0), 6);
    let mut slip = 0.0_f64;
    for point in solution.points() {
        close(point.pressure, 11.698e6, 1e3);
        let [a, b] = point.tags.map(|tag| solution.displacement[&tag][0]);
        slip = slip.max((a - b).abs());
    }
    close(slip, 4.8209e-3, 0.1 * 4.8209e-3);
}

/// Sneddon's crack: a fluid's pressure p in it opens it by 4 (1−ν²) p b/E; where the plate is pressed by more than
/// that, the crack is closed under the rest.
#[test]
fn pressure_in_a_crack_opens_it_or_takes_from_its_contact_pressure() {
    let (text, mesh) = built_in("crack", 0);
    let (bodies, _) = text.split_once("[[traction]]").unwrap();
    let (_, contact) = text.split_once("# At its tips").unwrap();
    let pressed = |sort: Sort, outside: f64| {
        let scene = format!(
            "{bodies}
            [[pressure]]
            on = ['crack upper', 'crack lower']
            value = 1e7
            [[pressure]]
            on = ['left', 'right', 'top', 'bottom']
            value = {outside:e}
            # At its tips{contact}"
        );
        solve(&model(&scene, sort.of(&mesh)), 6)
    };
    let exact = 4.0 * (1.0 - 0.25 * 0.25) * 1e7 / 25e9;
    for (name, slack) in [("triangle3", 6e-2), ("triangle6", 2e-2)] {
        let open = pressed(sort(name), 0.0);
        let widest = open.points().map(|point| point.gap).fold(0.0, f64::max);
        assert!(
            (widest / exact - 1.0).abs() < slack,
            "{name}: {widest:e}, {exact:e}"
        );
        assert_eq!(open.closed(), 0);
    }
    for point in pressed(sort("triangle3"), 3e7).points() {
        assert!(
            point.closed && (point.pressure / 2e7 - 1.0).abs() < 1e-9,
            "{point:?}"
        );
    }
}

#[test]
fn a_closed_inclined_crack_slips_as_the_formula_says() {
    let errors = [12, 24, 48].map(|cells| {
        let [slip, pressure] = closed_crack(cells, sort("triangle3"));
        assert!(pressure < 1e-9, "{pressure}");
        (slip - 1.0).abs()
    });
    assert!(errors[1] < 0.6 * errors[0], "{errors:?}");
    assert!(errors[2] < 0.6 * errors[1], "{errors:?}");
    assert!(errors[2] < 0.03, "{errors:?}");
}

#[test]
fn a_closed_crack_of_quadratic_cells_bears_uniform_pressure_up_to_its_tips() {
    for name in ["triangle6", "quad8", "quad9"] {
        let [slip, pressure] = closed_crack(12, sort(name));
        assert!(pressure < 1e-9, "{name}: {pressure}");
        assert!((slip - 1.0).abs() < 0.03, "{name}: {slip}");
    }
}

#[test]
fn rollers_press_as_hertz_says_of_the_forces_they_carry() {
    let mesh = example::find("rollers").unwrap().mesh_of(Quad4, 0);
    let model = model(example::find("rollers").unwrap().scene, mesh.unwrap());
    let stiffness = 1.0 / (0.91 / 210e9 + 0.91 / 70e9);
    let solution = solve(&model, 8);
    assert_eq!(solution.report["warnings"].as_array().unwrap().len(), 0);
    let mut total = [0.0; 2];
    for (roller, x) in [("left", -0.12), ("middle", 0.0), ("right", 0.12)] {
        let [below, above] =
            ["below", "above"].map(|side| &solution.contacts[&format!("{roller} roller {side}")]);
        let (on_plate, on_roller) = (reaction(below), reaction(above));
        balanced(on_plate, on_roller, 1e-9 * on_plate[1].abs());
        let force = -on_plate[1];
        total = [total[0] + force, total[1] - on_plate[2]];
        close(on_plate[2], -force * x, 1e-4 * force);
        let largest = (force * stiffness / (std::f64::consts::PI * 0.05)).sqrt();
        for points in [below, above] {
            let found = points.iter().fold(0.0, |m: f64, p| m.max(p.pressure));
            close(found, largest, 0.02 * largest);
        }
    }
    // ∫ p dx and ∫ p x dx of the pressure on the upper plate.
    close(total[0], 40e6, 1e-9 * 40e6);
    close(
        total[1],
        1e8 / 0.4 * 2.0 * 0.2_f64.powi(3) / 3.0,
        1e-6 * 1e6,
    );
}

#[test]
fn blocks_held_by_contact_alone_carry_their_weight() {
    let model = built_in_model("stack", 0);
    for count in [4, 6, 11] {
        let solution = solve(&model, count);
        let warnings = solution.report["warnings"].to_string();
        assert!(warnings.contains("middle block") || warnings.contains("upper block"));
        for (name, load) in [
            ("upper joint", 25e3 * 2.0 + 2e6),
            ("lower joint", 25e3 * 5.0 + 2e6),
        ] {
            let forces = solution.contacts[name].iter().map(|p| p.force);
            close(forces.sum(), load, 1e-11 * load);
        }
    }
}

#[test]
fn reactions_of_a_joint_are_its_load() {
    let text = format!(
        "{}{SUPPORTS}
        [[traction]]
        on = 'upper top'
        value = ['0', '-1e6*x^2']
        {JOINT}",
        BODIES
    );
    let solution = solve(&model(&text, two_blocks().mesh), 5);
    let load = 1e6 / 3.0 * (1.5_f64.powi(3) - 0.5_f64.powi(3));
    close(solution.points().map(|p| p.force).sum(), load, 1e-12 * load);
}
