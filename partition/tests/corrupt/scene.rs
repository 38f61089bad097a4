//! Scenes broken at random.

use contact_dd_partition::scene::Scene;
use proptest::prelude::*;

use super::{SCENE, breaks, broken, cases, is_said, partition};

/// Scenes with their meshes.
const SCENES: [(&str, &[u8]); 2] = [
    (SCENE, MESH),
    (
        include_str!("corpus/good-in-space.toml"),
        include_bytes!("corpus/good-in-space.msh"),
    ),
];
const MESH: &[u8] = include_bytes!("../library/gmsh/files/version4.1-ascii.msh");

proptest! {
    #![proptest_config(cases(1500))]

    #[test]
    fn a_broken_scene_is_refused_in_words_or_makes_a_problem(at in 0..SCENES.len(), breaks in breaks()) {
        let (scene, mesh) = SCENES[at];
        let text = broken(scene.as_bytes(), &breaks);
        let text = String::from_utf8_lossy(&text);
        if let Err(error) = Scene::parse(&text) {
            let message = error.to_string();
            prop_assert!(message.starts_with("line "), "{message}");
        }
        if let Err(error) = partition(&text, mesh) {
            is_said(&error)?;
        }
    }

    #[test]
    fn noise_is_no_scene(text in "[ -~\n\"'=\\[\\]{}.#]{0,300}", breaks in breaks()) {
        let text = broken(text.as_bytes(), &breaks);
        let text = String::from_utf8_lossy(&text);
        is_said(&partition(&text, MESH).unwrap_err())?;
    }
}

#[test]
fn the_scene_is_good_before_it_is_broken() {
    partition(SCENE, MESH).unwrap();
}
