//! Stress intensity factors as quantities: their values agree with the report, their derivatives with differences of
//! runs.

use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;
use serde_json::Value;

use super::quantities;
use crate::crack_tips::plate;
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve};

/// Factors of the body force, the traction and the pressure, of the stiffness, the increment of the gap (m), the
/// coefficient of friction.
type Numbers = [f64; 6];

/// Small changes of these, and the prefixes of the parameters' names.
const KNOBS: [(f64, &str); 6] = [
    (1e-5, "bodies.plate.body_force"),
    (1e-5, "traction[1]"),
    (1e-5, "pressure[1]"),
    (1e-5, "materials.rock"),
    (1e-9, "contact 'crack': gap"),
    (1e-5, "contact 'crack': friction"),
];

fn isotropic(factor: f64) -> String {
    format!("{{young = {:?}, poisson = 0.25}}", 2e10 * factor)
}

fn orthotropic(factor: f64) -> String {
    let rows = [[90e9, 8e9, 2e9], [8e9, 30e9, -1e9], [2e9, -1e9, 9e9]];
    format!(
        "{{stiffness = {:?}}}",
        rows.map(|row| row.map(|c| factor * c))
    )
}

/// An edge crack along x, fixed below, with pressure and shear above.
fn scene(
    material: fn(f64) -> String,
    [weight, push, press, stiff, gap, friction]: Numbers,
) -> String {
    let law = match friction {
        0.0 => String::new(),
        _ => format!("friction = {friction:?}"),
    };
    let quantities = [
        ("K_I", "k_i"),
        ("K_II", "k_ii"),
        ("J", "energy_release_rate"),
    ];
    let quantities = quantities.map(|(name, kind)| {
        format!("[[quantity]]\nname = '{name}'\nkind = '{kind}'\ntip = 'crack, tip 1'\n")
    });
    format!(
        "plane = 'strain'
        materials.rock = {}
        [bodies.plate]
        material = 'rock'
        body_force = [{:?}, {:?}]
        initial_stress = [0, '1e5*x', 0, 2e5]
        [[displacement]]
        on = ['crack below bottom', 'rest below bottom']
        x = 0
        y = 0
        [[traction]]
        on = ['crack above top', 'rest above top']
        value = [{:?}, 0]
        [[pressure]]
        on = ['crack above top', 'rest above top']
        value = '{:?}*(1+0.05*x)'
        [[contact]]
        name = 'crack'
        sides = ['crack below top', 'crack above bottom']
        gap = {gap:?}
        {law}
        {}",
        material(stiff),
        3e5 * weight,
        -1e5 * weight,
        4e6 * push,
        1e7 * press,
        quantities.concat()
    )
}

fn solved(mesh: &Mesh, text: &str) -> Value {
    solve(&model(text, mesh.clone()), 5).report
}

/// Compares the values with the report, and all derivatives with central differences of complete runs.
#[track_caller]
fn check(cells: &str, material: fn(f64) -> String, numbers: Numbers) {
    let mesh = plate(3.0, cells, 1);
    let report = solved(&mesh, &scene(material, numbers));
    assert_eq!(report["without_derivatives"], Value::Null);
    let all = quantities(&report);
    let value = |of: &Value| of["value"].as_f64().unwrap();
    let (tip, size) = (
        &report["crack_tips"][0],
        value(&all["K_I"]).hypot(value(&all["K_II"])),
    );
    close(
        value(&all["K_I"]),
        tip["k_i"].as_f64().unwrap(),
        1e-12 * size,
    );
    close(
        value(&all["K_II"]),
        tip["k_ii"].as_f64().unwrap(),
        1e-12 * size,
    );
    let rate = tip["energy_release_rate"].as_f64().unwrap();
    close(value(&all["J"]), rate, 1e-12 * rate);
    assert_eq!(all["J"]["node"], tip["node"]);
    for (k, (step, parameter)) in KNOBS.into_iter().enumerate() {
        if parameter.ends_with("friction") && numbers[k] == 0.0 {
            continue;
        }
        let [ahead, back] = [step, -step].map(|by| {
            let mut changed = numbers;
            changed[k] += by;
            quantities(&solved(&mesh, &scene(material, changed)))
        });
        for (name, quantity) in &all {
            let change = value(&ahead[name]) - value(&back[name]);
            let derivatives = quantity["derivatives"].as_array().unwrap().iter();
            let is_it = |of: &&Value| of["parameter"].as_str().unwrap().starts_with(parameter);
            let found: Vec<&Value> = derivatives.filter(is_it).collect();
            assert_eq!(found.len(), 1, "{parameter}");
            let factor = match parameter {
                "materials.rock" => found[0]["at"].as_f64().unwrap(),
                // The derivative is that with respect to a factor of the current load.
                "pressure[1]" => 1.0 / numbers[k],
                _ => 1.0,
            };
            let expected = 2.0 * step * factor * found[0]["derivative"].as_f64().unwrap();
            let size = if name == "J" { rate } else { size };
            assert!(
                (change - expected).abs() <= 1e-6 * expected.abs() + 2e-11 * size,
                "{name}, {parameter}: {change:e}, by derivative {expected:e}, of {size:e}"
            );
        }
    }
}

#[test]
fn factors_of_an_open_crack_are_those_of_the_report_and_their_derivatives_differences() {
    let pulled = [1.0, 1.0, -1.0, 1.0, 0.0, 0.0];
    check("quad4", isotropic, pulled);
    check("triangle6", orthotropic, pulled);
}

#[test]
fn factors_of_a_closed_crack_that_slips_are_those_of_the_report_and_their_derivatives_differences()
{
    check("quad4", orthotropic, [1.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    check("triangle6", isotropic, [1.0, 1.0, 1.0, 1.0, 0.0, 0.2]);
}

#[test]
fn factors_have_the_same_bits_on_any_number_of_ranks_without_stresses_too() {
    let text = scene(isotropic, [1.0, 1.0, 1.0, 1.0, 0.0, 0.2]);
    let case = Case::of(&model(&text, plate(3.0, "quad4", 1)), 6);
    let found = |ranks: usize, args: &[&str]| {
        let ended = case.run_on(ranks, args);
        assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
        assert!(ended.stdout.contains("K_II"), "{}", ended.stdout);
        Solution::read_report(&case.result())["quantities"].clone()
    };
    let alone = found(0, &[]);
    for ranks in [1, 2, 3] {
        assert_eq!(found(ranks, &["--no-stress"]), alone, "{ranks}");
    }
}

#[test]
fn a_tip_that_is_none_is_refused_with_those_there_are() {
    let numbers = [1.0, 1.0, 1.0, 1.0, 0.0, 0.0];
    let refused = |from: &str, to: &str| {
        let text =
            format!("mesh = 'here.msh'\n{}", scene(isotropic, numbers)).replacen(from, to, 1);
        match Scene::parse(&text) {
            Ok(scene) => Model::new(&scene, plate(3.0, "quad4", 1))
                .unwrap_err()
                .to_string(),
            Err(error) => error.to_string(),
        }
    };
    for (from, to, expected) in [
        (
            "'crack, tip 1'",
            "'crack, tip 2'",
            "did you mean 'crack, tip 1'",
        ),
        (
            "'crack, tip 1'",
            "'crack, tip 1'\nnode = 3",
            "a stress intensity factor has 'tip'",
        ),
        (
            "tip = 'crack, tip 1'",
            "contact = 'crack'",
            "a stress intensity factor has 'tip'",
        ),
        (
            "'strain'",
            "'axisymmetric'",
            "which are of straight cracks in the plane",
        ),
    ] {
        let message = refused(from, to);
        assert!(message.contains(expected), "{to}: {message}");
        assert!(message.contains("quantity"), "{message}");
    }
}
