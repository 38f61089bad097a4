//! Quantities of interest, and their derivatives.

mod bars;
mod mesh_error;
mod slipping;
mod study;
mod tips;
mod values;

use std::collections::BTreeMap;

use contact_dd_partition::element::ElementKind::{Hexahedron8, Tetrahedron10};
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;
use serde_json::Value;

use crate::support::blocks::{Blocks, joined};
use crate::support::scenes::model;
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::Case;
use crate::support::sorts::sort;

/// A number in a scene: its placeholder in the text, its value, a small change of it, and the name of its parameter.
struct Knob(&'static str, f64, f64, &'static str);

const KNOBS: [Knob; 9] = [
    Knob("@weight@", 1.0, 1e-5, "bodies.low.body_force"),
    Knob("@press@", 1.0, 1e-5, "pressure[1] on 'high top'"),
    Knob("@push@", 1.0, 1e-5, "traction[1] on 'high right'"),
    Knob("@rock@", 2e10, 2e5, "materials.rock.young"),
    Knob("@steel@", 8e10, 8e5, "materials.steel.young"),
    Knob("@gap@", 0.0, 1e-9, "contact 'joint': gap"),
    Knob("@play@", 1e-6, 1e-9, "contact 'wall': gap"),
    Knob("@shift@", 2e-5, 1e-9, "displacement[1] on 'low bottom': x"),
    Knob("@settle@", 1e-5, 1e-9, "displacement[1] on 'low bottom': y"),
];

const FRICTION: Knob = Knob("@friction@", 0.3, 1e-5, "contact 'joint': friction");

const SCENE: &str = "
materials.rock = {young = @rock@, poisson = 0.25}
materials.steel = {young = @steel@, poisson = 0.3}
bodies.low = {material = 'rock', body_force = [0, '-@weight@*2.5e5']}
bodies.high.material = 'steel'
[[displacement]]
on = 'low bottom'
x = @shift@
y = @settle@
[[pressure]]
on = 'high top'
value = '@press@*1e6*(1+0.3*x)'
[[traction]]
on = 'high right'
value = ['-@push@*3e5', 0]
[[contact]]
name = 'joint'
sides = ['high bottom', 'low top']
gap = @gap@
@law@
[[contact]]
name = 'wall'
sides = ['high left']
obstacle = {point = [0.4, 0], normal = [1, 0]}
gap = @play@
[[quantity]]
name = 'sag'
kind = 'displacement'
direction = [1, -2]
at = [1.0, 2.0]
[[quantity]]
name = 'mean stress'
kind = 'mean_stress'
body = 'low'
component = 'yy'
[[quantity]]
name = 'support'
kind = 'reaction'
on = 'low bottom'
direction = 'y'
[[quantity]]
name = 'pressed'
kind = 'contact_force'
contact = 'joint'
[[quantity]]
name = 'sheared'
kind = 'contact_force'
contact = 'joint'
direction = 'x'
[[quantity]]
name = 'mean'
kind = 'mean_pressure'
contact = 'wall'
[[quantity]]
name = 'peak'
kind = 'largest_pressure'
contact = 'joint'
[[quantity]]
name = 'smooth'
kind = 'largest_pressure'
contact = 'joint'
over = 0.3
[[quantity]]
name = 'tilt'
kind = 'contact_moment'
contact = 'joint'
about = [0.3, 0.9]
[[quantity]]
name = 'mouth'
kind = 'opening'
contact = 'wall'
at = [0.4, 1.0]
[[quantity]]
name = 'stored'
kind = 'energy'
";

/// The scene in the plane.
fn plane() -> String {
    format!("plane = 'strain'\n{SCENE}")
}

/// The placeholders of the plane scene, with the sides of solids in place of those of rectangles.
fn on_solids(text: &str) -> String {
    text.replace("low bottom", "low z0")
        .replace("high bottom", "high z0")
        .replace("low top", "low z1")
        .replace("high top", "high z1")
        .replace("high right", "high x1")
        .replace("high left", "high x0")
        .replace("': y", "': z")
}

/// The scene in space, with an additional shear out of its plane.
fn space() -> String {
    on_solids(SCENE)
        .replace("y = @settle@", "y = 0\nz = @settle@")
        .replace("[0, '-@weight@", "[0, 0, '-@weight@")
        .replace("3e5', 0]", "3e5', '@push@*2.5e5', 0]")
        .replace(
            "point = [0.4, 0], normal = [1, 0]",
            "point = [0.4, 0, 0], normal = [1, 0, 0]",
        )
        .replace("[1, -2]", "[1, 1, -2]")
        .replace("[1.0, 2.0]", "[0.8, 0.9, 2.0]")
        .replace("[0.4, 1.0]", "[0.4, 0.1, 1.0]")
        .replace("[0.3, 0.9]", "[0.3, 0.1, 0.9]\ndirection = [1, -2, 0.5]")
        .replace("'yy'", "'zz'")
        .replace("direction = 'y'", "direction = 'z'")
}

fn in_plane(cells: &str) -> Mesh {
    let blocks = Blocks::new()
        .rectangle("low", [0.0, 2.0], [0.0, 1.0], [12, 6])
        .rectangle("high", [0.4, 1.6], [1.0, 2.0], [8, 6]);
    sort(cells).of(&blocks.mesh)
}

fn in_space(kind: contact_dd_partition::element::ElementKind, fine: usize) -> Mesh {
    joined(
        solid(
            "low",
            kind,
            [4 * fine, 2 * fine, 2],
            between([0.0; 3], [2.0, 1.0, 1.0]),
        ),
        solid(
            "high",
            kind,
            [3 * fine, 2 * fine, 2],
            between([0.4, 0.1, 1.0], [1.6, 0.9, 2.0]),
        ),
    )
}

/// The model of a scene with a law for its joint and the numbers of `knobs`, one of them changed.
fn varied(
    text: &str,
    law: &str,
    mesh: &Mesh,
    knobs: &[&Knob],
    changed: Option<(usize, f64)>,
) -> Model {
    let mut text = text.replace("@law@", law);
    for (k, Knob(word, value, ..)) in knobs.iter().enumerate() {
        let change = changed.filter(|&(of, _)| of == k).map_or(0.0, |(_, by)| by);
        text = text.replace(word, &format!("{:?}", value + change));
    }
    model(&text, mesh.clone())
}

/// The quantities of a report by name.
fn quantities(report: &Value) -> BTreeMap<String, Value> {
    let all = report["quantities"].as_array().unwrap().iter();
    all.map(|of| (of["name"].as_str().unwrap().to_owned(), of.clone()))
        .collect()
}

/// The derivative of a quantity with respect to a parameter.
#[track_caller]
fn derivative(quantity: &Value, parameter: &str) -> f64 {
    let all = quantity["derivatives"].as_array().unwrap();
    let one = all.iter().find(|one| one["parameter"] == parameter);
    let one = one.unwrap_or_else(|| panic!("{parameter}: {all:?}"));
    one["derivative"].as_f64().unwrap()
}

/// Compares all derivatives with central differences of complete runs.
#[track_caller]
fn check_differences(text: &str, law: &str, mesh: &Mesh, args: &[&str]) {
    let knobs = KNOBS.iter().chain([&FRICTION]);
    let knobs: Vec<&Knob> = knobs
        .filter(|knob| text.contains(knob.0) || law.contains(knob.0))
        .collect();
    let solved = |changed: Option<(usize, f64)>| {
        let model = varied(text, law, mesh, &knobs, changed);
        let case = match args.is_empty() {
            true => Case::of(&model, 6),
            false => Case::in_clusters(&model, 10, 7),
        };
        case.solve(args).report
    };
    let report = solved(None);
    assert_eq!(report["without_derivatives"], Value::Null);
    assert_eq!(
        report["about_to_change"].as_array().unwrap().len(),
        0,
        "{}",
        report["about_to_change"]
    );
    let all = quantities(&report);
    assert_eq!(all.len(), text.matches("[[quantity]]").count());
    if !law.is_empty() {
        let of = &report["friction"];
        assert!(of["sticking"] != 0 && of["slipping"] != 0, "{of}");
    }
    let is_solid = text.contains("low z0");
    for (k, &&Knob(.., step, parameter)) in knobs.iter().enumerate() {
        let parameter = match is_solid {
            true => on_solids(parameter),
            false => parameter.to_owned(),
        };
        let [ahead, back] = [step, -step].map(|by| quantities(&solved(Some((k, by)))));
        for (name, quantity) in &all {
            let value = |of: &BTreeMap<String, Value>| of[name]["value"].as_f64().unwrap();
            let change = value(&ahead) - value(&back);
            let expected = 2.0 * step * derivative(quantity, &parameter);
            let slack = 1e-6 * expected.abs() + 2e-11 * value(&all).abs();
            assert!(
                (change - expected).abs() <= slack,
                "{name}, {parameter}: {change:e}, by derivative {expected:e}, of {:e}",
                value(&all)
            );
        }
    }
}

const COULOMB: &str = "friction = @friction@";

#[test]
fn derivatives_are_differences_of_runs_without_friction() {
    for cells in ["quad4", "triangle6"] {
        check_differences(&plane(), "", &in_plane(cells), &[]);
    }
}

#[test]
fn derivatives_are_differences_of_runs_with_friction() {
    for law in [COULOMB, "friction = @friction@\ncohesion = 2e4"] {
        check_differences(&plane(), law, &in_plane("quad4"), &[]);
    }
}

/// The upper block in two, tied, whose points at the seam share the contact force.
#[test]
fn derivatives_are_differences_of_runs_across_a_seam() {
    let mut mesh = Blocks::new()
        .rectangle("low", [0.0, 2.0], [0.0, 1.0], [12, 6])
        .rectangle("high", [0.4, 1.15], [1.0, 2.0], [5, 6])
        .rectangle("more", [1.15, 1.6], [1.0, 2.0], [3, 6])
        .mesh;
    for side in ["bottom", "right", "top"] {
        let other = mesh.groups.remove(&format!("more {side}")).unwrap();
        let own = mesh.groups.entry(format!("high {side}")).or_default();
        match side {
            "right" => {
                let seam = std::mem::replace(own, other);
                mesh.groups.insert("seam".into(), seam);
            }
            _ => own.members.extend(other.members),
        }
    }
    let steel = "bodies.high.material = 'steel'";
    let scene = plane().replace(steel, &format!("{steel}\nbodies.more.material = 'steel'"))
        + "[[tie]]\nname = 'seam'\nsides = ['seam', 'more left']\n";
    for law in ["", COULOMB] {
        check_differences(&scene, law, &sort("quad4").of(&mesh), &[]);
    }
    check_differences(&scene, "", &mesh, &["--interface", "iterative"]);
}

#[test]
fn derivatives_are_differences_of_runs_around_an_axis() {
    let scene = plane()
        .replace("'strain'", "'axisymmetric'")
        .replace("x = @shift@\n", "")
        .replace("direction = 'x'", "direction = 'y'")
        .replace("kind = 'contact_moment'", "kind = 'contact_force'")
        .replace("about = [0.3, 0.9]\n", "");
    for law in ["", COULOMB] {
        check_differences(&scene, law, &in_plane("quad8"), &[]);
    }
}

#[test]
fn derivatives_are_differences_of_runs_in_space() {
    let held = "[[bilateral]]\non = 'high y0'\n[[quantity]]";
    let scene = space().replacen("[[quantity]]", held, 1);
    check_differences(&scene, "", &in_space(Tetrahedron10, 1), &[]);
    check_differences(&space(), COULOMB, &in_space(Hexahedron8, 1), &[]);
}

#[test]
fn derivatives_are_differences_of_iterative_runs() {
    let iterative = ["--interface", "iterative"];
    for law in ["", COULOMB] {
        check_differences(&plane(), law, &in_plane("quad4"), &iterative);
    }
}

#[test]
fn derivatives_have_the_same_bits_on_any_number_of_ranks() {
    let knobs: Vec<&Knob> = KNOBS.iter().chain([&FRICTION]).collect();
    let case = Case::of(
        &varied(&plane(), COULOMB, &in_plane("quad4"), &knobs, None),
        6,
    );
    let found = |ranks: usize| {
        let ended = case.run_on(ranks, &[]);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        assert!(ended.stdout.contains("mean stress"), "{}", ended.stdout);
        Solution::read_report(&case.result())["quantities"].clone()
    };
    let alone = found(0);
    for ranks in [1, 2, 3] {
        assert_eq!(found(ranks), alone, "{ranks}");
    }
}
