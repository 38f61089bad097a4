//! The estimated error of the mesh in a quantity, compared with the difference from a fine mesh.

use serde_json::Value;

use super::quantities;
use crate::support::blocks::Blocks;
use crate::support::scenes::model;
use crate::support::solver::solve;
use crate::support::sorts::sort;

/// Numbers of cells along sides relative to the coarsest mesh; the last one represents the exact solution.
const FINE: [usize; 4] = [1, 2, 4, 16];

/// A block between rollers that a smooth pressure presses down onto a curved obstacle.
fn scene(law: &str) -> String {
    format!(
        "plane = 'strain'
        materials.rock = {{young = 2e10, poisson = 0.25}}
        bodies.block.material = 'rock'
        [[displacement]]
        on = ['block left', 'block right']
        x = 0
        [[pressure]]
        on = 'block top'
        value = '1e7*(1+cos(pi*x/2))'
        [[contact]]
        name = 'ground'
        sides = ['block bottom']
        obstacle = {{point = [0, 0], normal = [0, 1]}}
        gap = '1e-4*x^2'
        {law}
        [[quantity]]
        name = 'smooth'
        kind = 'largest_pressure'
        contact = 'ground'
        over = 0.5
        [[quantity]]
        name = 'stored'
        kind = 'energy'
        [[quantity]]
        name = 'pressed'
        kind = 'contact_force'
        contact = 'ground'
        [[quantity]]
        name = 'point'
        kind = 'largest_pressure'
        contact = 'ground'"
    )
}

fn solved(law: &str, fine: usize) -> Value {
    let blocks = Blocks::new().rectangle("block", [0.0, 2.0], [0.0, 1.0], [8 * fine, 4 * fine]);
    let mesh = sort("quad4").of(&blocks.mesh);
    solve(&model(&scene(law), mesh), 4).report
}

#[test]
fn estimated_errors_of_quantities_are_those_of_meshes() {
    let number = |of: &Value, key: &str| of[key].as_f64().unwrap();
    for law in ["", "friction = 0.2"] {
        let all = FINE.map(|fine| quantities(&solved(law, fine)));
        let [meshes @ .., exact] = &all;
        for (mesh, fine) in meshes.iter().zip(FINE) {
            for name in ["smooth", "stored"] {
                let error = number(&mesh[name], "value") - number(&exact[name], "value");
                let share = number(&mesh[name], "error") / error;
                assert!(
                    0.7 < share && share < 1.6,
                    "{law}, {fine}, {name}: {share} of {error:e}"
                );
            }
            // The total force is exact on any mesh.
            let pressed = number(&mesh["pressed"], "value");
            assert!(number(&mesh["pressed"], "error").abs() < 1e-9 * pressed);
            assert_eq!(mesh["point"]["error"], Value::Null);
        }
    }
}
