//! Contact across a tie: two tied blocks press on a third as one block does.

use crate::support::blocks::{Blocks, moved};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solver::solve_steps;

const SCENE: &str = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.22}
bodies.base.material = 'rock'
bodies.left.material = 'rock'
bodies.right.material = 'rock'
[[displacement]]
on = 'base bottom'
x = 0.0
y = 0.0
[[step]]
[[step.pressure]]
on = ['left top', 'right top']
value = 1e6
[[step]]
[[step.pressure]]
on = ['left top', 'right top']
value = 1e6
[[step.traction]]
on = 'left left'
value = [3e5, 1e5]
[[contact]]
name = 'rests'
sides = [['left bottom', 'right bottom'], ['base top']]
";

const SEAM: &str = "
[[tie]]
name = 'seam'
sides = ['left right', 'right left']
";

/// Both points at the seam have the pressure and the friction of the one point of a single block, also where measured
/// gaps differ by round-off, as in a scene that is turned.
#[test]
fn both_sides_of_a_seam_carry_the_pressure_of_one_block() {
    let (sin, cos) = 0.3_f64.sin_cos();
    for turned in [false, true] {
        let two = Blocks::new()
            .rectangle("left", [0.6, 1.4], [1.0, 2.0], [4, 5])
            .rectangle("right", [1.4, 2.0], [1.0, 2.0], [3, 5]);
        let one = two.clone().glued(|x, _| (x - 1.4).abs() < 1e-9);
        let [two, one] =
            [two, one].map(|blocks| blocks.rectangle("base", [0.0, 3.0], [0.0, 1.0], [15, 4]));
        let turn = |mesh| match turned {
            true => moved(mesh, |[x, y]| [cos * x - sin * y, sin * x + cos * y]),
            false => mesh,
        };
        for law in [
            "friction = 0.3",
            "friction = 0.2\ncohesion = 5e4",
            "tresca = 3e5",
        ] {
            let tied = model(&format!("{SCENE}{law}\n{SEAM}"), turn(two.mesh.clone()));
            let glued = model(&format!("{SCENE}{law}\n"), turn(one.mesh.clone()));
            let expected = solve_steps(&glued, 3);
            for (solution, expected) in solve_steps(&tied, 5).iter().zip(&expected) {
                solution.check_certificate();
                let (points, known) = (&solution.contacts["rests"], &expected.contacts["rests"]);
                assert_eq!(points.len(), known.len() + 1);
                for point in points {
                    let near = known.iter().find(|other| {
                        (0..3).all(|k| (other.position[k] - point.position[k]).abs() < 1e-9)
                    });
                    let near = near.unwrap_or_else(|| panic!("no point at {:?}", point.position));
                    close(point.pressure, near.pressure, 1e-6 * 1e6);
                    assert_eq!(point.closed, near.closed, "{law}");
                }
            }
        }
    }
}
