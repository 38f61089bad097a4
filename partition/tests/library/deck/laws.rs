//! Materials and directions: equivalent notations have the same meaning.

use super::{CUBES, MODEL, read, scene, step};
use contact_dd_partition::scene::Scene;
use contact_dd_partition::scene::condition::ForceAmount;
use contact_dd_partition::scene::material::Elasticity;

/// The stiffness of a material in space.
fn stiffness(elastic: &str, section: &str, more: &str) -> Vec<Vec<f64>> {
    let deck = format!("{CUBES}{MODEL}{more}{}", step("*DLOAD\nUpper, P2, 1."));
    let deck = deck.replace("*ELASTIC\n210e3, 0.3", elastic);
    let deck = deck.replace("MATERIAL=STEEL", &format!("MATERIAL=STEEL{section}"));
    let scene = Scene::parse(&read(&deck).unwrap().scene).unwrap();
    match scene.materials.values().next().unwrap() {
        Elasticity::Anisotropic { stiffness, .. } => {
            let rows = stiffness.rows::<6>();
            rows.iter().map(|row| row.to_vec()).collect()
        }
        other => panic!("{other:?}"),
    }
}

#[track_caller]
fn same(one: &[Vec<f64>], other: &[Vec<f64>]) {
    for (a, b) in one.iter().flatten().zip(other.iter().flatten()) {
        assert!((a - b).abs() < 1e-9, "{one:?}\n{other:?}");
    }
}

#[test]
fn a_law_is_the_same_however_it_is_written() {
    // λ = 6, μ = 4 of an isotropic material, ν = 0.3 and E = 10.4.
    let constants = stiffness(
        "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n10.4, 10.4, 10.4, 0.3, 0.3, 0.3, 4., 4.\n4.",
        "",
        "",
    );
    let ortho = stiffness(
        "*ELASTIC, TYPE=ORTHO\n14., 6., 14., 6., 6., 14., 4., 4.\n4.",
        "",
        "",
    );
    let aniso = stiffness(
        "*ELASTIC, TYPE=ANISOTROPIC\n14., 6., 14., 6., 6., 14., 0., 0.\n0., 4., 0., 0., 0., 0., 4., 0.\n0., 0., 0., 0., 4.",
        "",
        "",
    );
    same(&constants, &ortho);
    same(&constants, &aniso);
    // An isotropic law is the same along all axes.
    let turned = "*ORIENTATION, NAME=O\n1., 2., 3., -1., 1., 0.\n2, 25.\n";
    let ortho = stiffness(
        "*ELASTIC, TYPE=ORTHO\n14., 6., 14., 6., 6., 14., 4., 4.\n4.",
        ", ORIENTATION=O",
        turned,
    );
    same(&constants, &ortho);
}

#[test]
fn components_go_where_the_scene_has_them() {
    let aniso = "*ELASTIC, TYPE=ANISO\n101., 2., 103., 4., 5., 106., 7., 8.\n9., 110., 11., 12., 13., 14., 115., 16.\n17., 18., 19., 20., 121.";
    // The order 11, 22, 33, 12, 13, 23 of decks, and xx, yy, zz, yz, xz, xy of scenes.
    let expected = [
        [101.0, 2.0, 4.0, 16.0, 11.0, 7.0],
        [2.0, 103.0, 5.0, 17.0, 12.0, 8.0],
        [4.0, 5.0, 106.0, 18.0, 13.0, 9.0],
        [16.0, 17.0, 18.0, 121.0, 20.0, 19.0],
        [11.0, 12.0, 13.0, 20.0, 115.0, 14.0],
        [7.0, 8.0, 9.0, 19.0, 14.0, 110.0],
    ];
    let expected: Vec<Vec<f64>> = expected.iter().map(|row| row.to_vec()).collect();
    same(&stiffness(aniso, "", ""), &expected);
    // The local axes x', y', z' are y, z, x: 11 of the material is yy of the scene, 23 is zx.
    let turned = "*ORIENTATION, NAME=O, SYSTEM=RECTANGULAR\n0., 1., 0., 0., 0., 1.\n";
    let found = stiffness(aniso, ", ORIENTATION=O", turned);
    for ((i, j), value) in [
        ((1, 1), 101.0),
        ((2, 2), 103.0),
        ((0, 0), 106.0),
        ((4, 4), 121.0),
        ((3, 3), 110.0),
    ] {
        assert!((found[i][j] - value).abs() < 1e-9, "{found:?}");
    }
    assert!((found[1][2] - 2.0).abs() < 1e-9, "{found:?}");
}

#[test]
fn nodes_with_axes_of_their_own_move_and_are_loaded_along_these() {
    let axes = "*TRANSFORM, NSET=Top, TYPE=R\n0., 1., 0., -1., 0., 0.\n";
    let scene = scene(&format!(
        "{axes}{}",
        step("*CLOAD\nTop, 1, 2.\n*BOUNDARY\nTop, 2, 2, 1e-3")
    ));
    let Some(held) = scene
        .displacement
        .iter()
        .find(|held| held.on.iter().eq(["Top"]))
    else {
        panic!("{scene:?}");
    };
    // The local axis 1 is y, the local axis 2 is -x.
    let values = held
        .components
        .each_ref()
        .map(|value| value.as_ref().map(|value| value.at([0.0; 3]).unwrap()));
    assert_eq!(values, [Some(-1e-3), None, None]);
    let ForceAmount::Each(force) = &scene.force[0].amount else {
        panic!("{scene:?}");
    };
    assert_eq!(force.at([0.0; 3]).unwrap(), [0.0, 2.0, 0.0]);
}

#[test]
fn a_turning_body_is_pulled_away_from_its_axis() {
    let scene = scene(&step(
        "*DLOAD\nUpper, CENTRIF, 1e4, 1., 0., 0., 0., 0., 2.\nUpper, BX, 3.",
    ));
    let force = scene.bodies["Upper"].body_force.as_ref().unwrap();
    let [x, y, z] = force.at([3.0, 5.0, 7.0]).unwrap();
    let factor = 7.8e-9 * 1e4;
    assert!((x - (2.0 * factor + 3.0)).abs() < 1e-12, "{x}");
    assert!((y - 5.0 * factor).abs() < 1e-12, "{y}");
    assert_eq!(z, 0.0);
}
