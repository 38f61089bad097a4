//! Friction on a plane of symmetry, whose nodes slip along one line.

use contact_dd_partition::element::ElementKind::{Hexahedron8, Hexahedron20};

use crate::support::blocks::joined;
use crate::support::scenes::model;
use crate::support::solids::{between, moved, solid};
use crate::support::solver::solve_steps;

const SCENE: &str = "
materials.rock = {young = 20e9, poisson = 0.22}
bodies.lower.material = 'rock'
bodies.upper.material = 'rock'
[[displacement]]
on = 'lower z0'
x = 0
y = 0
z = 0
[[bilateral]]
on = ['lower y0', 'upper y0']
[[contact]]
name = 'joint'
sides = ['lower z1', 'upper z0']
gap = 0.0
friction = 0.3
[[pressure]]
on = 'upper z1'
value = 1e6
[[step]]
[[step.traction]]
on = 'upper x1'
value = [5.5e5, 0.0, 0.0]
[[step]]
[[step.traction]]
on = 'upper x1'
value = [-5e5, 0.0, 0.0]
";

/// Perturbation of nodes: none, or so small that normals leave the plane of symmetry, and neighbouring nodes take part
/// in the jumps at nodes on it, by a multiple of the perturbation.
const OFF: [f64; 2] = [0.0, 3e-5];

#[test]
fn a_mesh_that_is_nearly_symmetric_slips_as_one_that_is() {
    for kind in [Hexahedron8, Hexahedron20] {
        let solved = OFF.map(|off| {
            let wave = |[x, y, z]: [f64; 3]| {
                let height = off * (7.0 * x + 3.0 * y).sin() * (1.0 - (z - 1.0).abs());
                [x, y, z + height]
            };
            let beside = |[x, y, z]: [f64; 3]| {
                let inside = x * (2.0 - x) * y * (1.0 - y) * (2.0 - z);
                [x + off * inside, y - 2.0 * off * inside, z]
            };
            let lower = solid("lower", kind, [4, 3, 2], between([0.0; 3], [2.0, 1.0, 1.0]));
            let to = between([0.0, 0.0, 1.0], [2.0, 1.0, 2.0]);
            let upper = moved(solid("upper", kind, [4, 3, 2], to), beside);
            solve_steps(&model(SCENE, moved(joined(lower, upper), wave)), 2)
        });
        for (exact, near) in solved[0].iter().zip(&solved[1]) {
            assert_eq!(near.slipping(), exact.slipping());
            assert!(near.slipping() > 0);
            let largest = exact.largest_force();
            for (exact, near) in exact.points().zip(near.points()) {
                for k in 0..3 {
                    let apart = near.tangential_force[k] - exact.tangential_force[k];
                    assert!(
                        apart.abs() <= 1e-3 * largest,
                        "{kind:?}: {apart:e} of {largest:e}"
                    );
                }
                if near.position[1] == 0.0 {
                    assert!(near.tangential_force[1].abs() <= 1e-12 * largest);
                }
            }
        }
    }
}
