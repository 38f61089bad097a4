//! Axes of parts: they turn with the instances.

use super::{read, step};
use contact_dd_partition::scene::Scene;
use contact_dd_partition::scene::condition::ForceAmount;
use contact_dd_partition::scene::material::Elasticity;

/// A cube as a part, with `more` in it, and two instances, of which the second is turned by 90° about z.
fn deck(more: &str, section: &str, acts: &str) -> String {
    format!(
        "*PART, NAME=Cube\n*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n5, 0., 0., 1.\n\
         6, 1., 0., 1.\n7, 1., 1., 1.\n8, 0., 1., 1.\n*ELEMENT, TYPE=C3D8, ELSET=Solid\n1, 1, 2, 3, 4, 5, 6, 7, 8\n\
         *NSET, NSET=Foot\n1, 2, 3, 4\n*NSET, NSET=Top\n5, 6, 7, 8\n{more}\
         *SOLID SECTION, ELSET=Solid, MATERIAL=M{section}\n*END PART\n*ASSEMBLY, NAME=A\n\
         *INSTANCE, NAME=One, PART=Cube\n*END INSTANCE\n\
         *INSTANCE, NAME=Two, PART=Cube\n5., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n*END INSTANCE\n\
         *NSET, NSET=Ground\nOne.Foot, Two.Foot\n*END ASSEMBLY\n\
         *MATERIAL, NAME=M\n*ELASTIC, TYPE=ORTHO\n14., 6., 15., 6., 6., 16., 4., 4.\n4.\n*BOUNDARY\nGround, 1, 3\n{}",
        step(acts)
    )
}

#[test]
fn axes_of_a_material_turn_with_the_instance() {
    let axes = "*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0.\n";
    let deck = deck(axes, ", ORIENTATION=O", "*CLOAD\nTwo.Top, 1, 2.5");
    let scene = Scene::parse(&read(&deck).unwrap().scene).unwrap();
    assert_eq!(scene.bodies.len(), 2);
    let mut along: Vec<[i64; 2]> = (scene.materials.values())
        .map(|material| match material {
            Elasticity::Anisotropic { stiffness, .. } => {
                let rows = stiffness.rows::<6>();
                [rows[0][0].round() as i64, rows[1][1].round() as i64]
            }
            other => panic!("{other:?}"),
        })
        .collect();
    along.sort_unstable();
    assert_eq!(along, [[14, 15], [15, 14]]);
}

#[test]
fn axes_of_nodes_turn_with_the_instance() {
    let axes = "*TRANSFORM, NSET=Top\n1., 0., 0., 0., 1., 0.\n";
    let deck = deck(axes, "", "*CLOAD\nOne.Top, 1, 2.5\nTwo.Top, 1, 2.5");
    let scene = Scene::parse(&read(&deck).unwrap().scene).unwrap();
    let mut forces: Vec<[i64; 3]> = (scene.force.iter())
        .map(|force| match &force.amount {
            ForceAmount::Each(each) => each
                .at([0.0; 3])
                .unwrap()
                .map(|component| (10.0 * component).round() as i64),
            other => panic!("{other:?}"),
        })
        .collect();
    forces.sort_unstable();
    assert_eq!(forces, [[0, 25, 0], [25, 0, 0]]);
}
