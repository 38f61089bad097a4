//! Derivatives where all points slip, so that forces turn with their slip.

use std::collections::BTreeMap;

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::mesh::Mesh;
use serde_json::Value;

use super::{Knob, derivative, in_space, quantities, varied};
use crate::support::blocks::joined;
use crate::support::solids::{between, solid};
use crate::support::solver::Case;

/// A block that nothing but friction holds, at points that slip outward from its middle: forces that turn with the slip
/// resist its motions.
const SLIPPING: &str = "
materials.rock = {young = @rock@, poisson = 0.25}
materials.steel = {young = @steel@, poisson = 0.3}
bodies.low.material = 'rock'
bodies.high.material = 'steel'
[[bilateral]]
on = 'low z0'
[[displacement]]
on = 'low z0'
x = 0
y = 0
[[pressure]]
on = 'high z1'
value = '@press@*1e6*(1+0.3*x+0.2*y)'
[[contact]]
name = 'joint'
sides = ['high z0', 'low z1']
friction = @friction@
[[quantity]]
name = 'sway'
kind = 'displacement'
direction = [1, -2, 0.5]
at = [0.8, 0.9, 2.0]
[[quantity]]
name = 'peak'
kind = 'largest_pressure'
contact = 'joint'
";

#[test]
fn derivatives_are_differences_where_no_point_sticks() {
    check_slipping(SLIPPING, &in_space(Hexahedron8, 1));
}

/// The upper block in two, tied: forces of both points at the seam turn with their slip.
#[test]
fn derivatives_are_differences_where_no_point_sticks_at_a_seam() {
    let block = |name: &str, cells: usize, [low, high]: [[f64; 3]; 2]| {
        solid(name, Hexahedron8, [cells, 2, 2], between(low, high))
    };
    let high = block("high", 2, [[0.4, 0.1, 1.0], [1.2, 0.9, 2.0]]);
    let more = block("more", 1, [[1.2, 0.1, 1.0], [1.6, 0.9, 2.0]]);
    let low = solid(
        "low",
        Hexahedron8,
        [4, 2, 2],
        between([0.0; 3], [2.0, 1.0, 1.0]),
    );
    let mut mesh = joined(joined(low, high), more);
    for side in ["z0", "z1"] {
        let other = mesh.groups.remove(&format!("more {side}")).unwrap();
        let own = mesh.groups.get_mut(&format!("high {side}")).unwrap();
        own.members.extend(other.members);
    }
    let steel = "bodies.high.material = 'steel'";
    let scene = SLIPPING.replace(steel, &format!("{steel}\nbodies.more.material = 'steel'"))
        + "[[tie]]\nname = 'seam'\nsides = ['high x1', 'more x0']\n";
    check_slipping(&scene, &mesh);
}

/// Compares the derivatives with central differences where all points slip.
fn check_slipping(text: &str, mesh: &Mesh) {
    let knobs = [
        &Knob("@press@", 1.0, 1e-5, "pressure[1] on 'high z1'"),
        &Knob("@rock@", 2e10, 2e5, "materials.rock.young"),
        &Knob("@steel@", 8e10, 8e5, "materials.steel.young"),
        &Knob("@friction@", 0.02, 1e-6, "contact 'joint': friction"),
    ];
    let solved = |changed: Option<(usize, f64)>| {
        let model = varied(text, "", mesh, &knobs, changed);
        Case::of(&model, 6).solve(&[]).report
    };
    let report = solved(None);
    assert_eq!(report["without_derivatives"], Value::Null);
    let of = &report["friction"];
    assert!(of["sticking"] == 0 && of["slipping"] != 0, "{of}");
    assert!(report["condition_number"].as_f64().unwrap() < 1e7);
    let all = quantities(&report);
    for (k, &&Knob(.., step, parameter)) in knobs.iter().enumerate() {
        let [ahead, back] = [step, -step].map(|by| quantities(&solved(Some((k, by)))));
        for (name, quantity) in &all {
            let value = |of: &BTreeMap<String, Value>| of[name]["value"].as_f64().unwrap();
            let change = value(&ahead) - value(&back);
            let expected = 2.0 * step * derivative(quantity, parameter);
            let slack = 1e-6 * expected.abs() + 2e-11 * value(&all).abs();
            assert!(
                (change - expected).abs() <= slack,
                "{name}, {parameter}: {change:e}, by derivative {expected:e}, of {:e}",
                value(&all)
            );
        }
    }
}
