//! The gallery: every built-in scene has a page, whose commands reproduce the numbers of its table.
//!
//! A page shows a part of its scene as `toml`, commands, and a table with the columns number, found, theory, off and
//! where. *Found* agrees to within one unit in its last digit; where *theory* has a number, the result deviates from it
//! by at most *off*. *Where* is a path in the report, with entries of lists by their names or numbers, or a dataset
//! below VTKHDF of the result, whose largest length or absolute value is the number.

mod expected;
mod numbers;
mod page;

use std::collections::BTreeSet;
use std::path::Path;

use contact_dd_partition::example::{self, EXAMPLES};
use libtest_mimic::Trial;

use crate::trial;

use page::Page;

pub fn trials() -> Vec<Trial> {
    let mut trials = vec![
        trial("every_scene_has_a_page", every_scene_has_a_page),
        trial(
            "numbers_are_found_to_their_last_digit",
            expected::to_the_last_digit,
        ),
        trial("numbers_that_are_off_fail", expected::off),
    ];
    for (page, name) in page::all() {
        trials.push(trial(
            format!("{name}::its_scene_is_the_built_in_one"),
            move || scene_is_built_in(&page, &name),
        ));
    }
    trials
}

/// Fails unless the results of the page `name` in a folder agree with the numbers of its table; only pages of scenes
/// have any.
pub fn numbers_hold(name: &str, folder: &Path) {
    let of_scenes = page::all();
    let is_meant = |scene: &str| name == format!("partition/src/example/{scene}/README.md");
    if let Some((page, _)) = of_scenes.iter().find(|(_, scene)| is_meant(scene)) {
        numbers::has_numbers(folder, &page.expected);
    }
}

fn every_scene_has_a_page() {
    let pages: BTreeSet<String> = page::all().into_iter().map(|(_, name)| name).collect();
    let scenes: BTreeSet<String> = EXAMPLES.iter().map(|e| e.name.to_owned()).collect();
    assert_eq!(pages, scenes);
    let index = page::folder().join("../../../docs/gallery/README.md");
    let index = std::fs::read_to_string(index).unwrap();
    for name in scenes {
        let picture = page::folder().join(format!("{name}/{name}.png"));
        let bytes = std::fs::metadata(picture).unwrap().len();
        assert!(bytes < 300_000, "{name}.png has {bytes} bytes");
        for link in [
            format!("/{name}/README.md)"),
            format!("/{name}/{name}.png)"),
        ] {
            assert!(
                index.contains(&link),
                "docs/gallery/README.md has no {link}; scripts/gallery makes its table"
            );
        }
    }
}

/// The scene on a page is part of the built-in one, line by line.
fn scene_is_built_in(page: &Page, name: &str) {
    let scene = example::find(name).unwrap().scene;
    assert!(
        !page.scene.is_empty(),
        "{name}.md shows nothing of its scene"
    );
    for part in &page.scene {
        assert!(
            scene.contains(part.as_str()),
            "{name}.md: not in the scene that --write-scene writes:\n{part}"
        );
    }
}
