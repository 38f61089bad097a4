//! docs/scene.md: its examples are valid, and it documents every key.

#![expect(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "what fails here fails the test"
)]

use std::fs;
use std::path::Path;

use contact_dd_partition::scene::Scene;

fn page() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/scene.md");
    fs::read_to_string(path).unwrap()
}

/// The parts of a scene that the page shows, those of couplings and sectors, which are of space, or all others.
fn shown(page: &str, of_space: bool) -> String {
    let above = page.split("## A crack").next().unwrap();
    let blocks = above.split("```toml\n").skip(1);
    blocks
        .map(|block| block.split("```").next().unwrap())
        .filter(|part| {
            let is_of_space = ["[[coupling]]", "[[cyclic]]", "coupling = "]
                .iter()
                .any(|key| part.contains(key));
            is_of_space == of_space
        })
        .collect()
}

/// The parts of a plane scene that the page shows, together.
fn parts(page: &str) -> String {
    let parts = shown(page, false);
    assert!(!parts.is_empty());
    format!("mesh = 'a.msh'\nplane = 'strain'\n{parts}")
}

/// The words that a message lists as known.
fn known(text: &str) -> Vec<String> {
    let message = Scene::parse(text).unwrap_err().to_string();
    let (_, known) = message
        .split_once("Known here: ")
        .expect("a list of what is known");
    known.split(", ").map(str::to_owned).collect()
}

#[test]
fn the_parts_that_the_page_shows_make_a_scene() {
    let scene = Scene::parse(&parts(&page())).unwrap();
    assert_eq!((scene.materials.len(), scene.bodies.len()), (2, 2));
    assert_eq!((scene.displacement.len(), scene.bilateral.len()), (1, 1));
    assert_eq!((scene.pressure.len(), scene.traction.len()), (1, 1));
    assert_eq!(scene.contact.len(), 9);
}

#[test]
fn the_couplings_that_the_page_shows_make_a_scene_of_space() {
    let body = "[materials.a]\nyoung = 1\npoisson = 0\n[bodies.b]\nmaterial = 'a'\n";
    let couplings = shown(&page(), true);
    let scene = Scene::parse(&format!("mesh = 'a.msh'\n{body}{couplings}")).unwrap();
    assert_eq!((scene.coupling.len(), scene.step.len()), (2, 1));
    assert_eq!(scene.cyclic.len(), 1);
}

#[test]
fn the_page_names_every_key_and_every_function() {
    let page = page();
    let scene = "mesh = 'a.msh'\nplane = 'strain'\n";
    let material = "[materials.a]\nyoung = 1\npoisson = 0\n[bodies.b]\nmaterial = 'a'\n";
    for text in [
        "nonsense = 1".to_owned(),
        format!("{scene}[materials.a]\nnonsense = 1"),
        format!("{scene}{material}nonsense = 1"),
        format!("{scene}{material}[[contact]]\nnonsense = 1"),
        format!(
            "{scene}{material}[[contact]]\nname = 'c'\nsides = ['s']\nobstacle = {{nonsense = 1}}"
        ),
        format!("{scene}{material}[[pressure]]\non = 'p'\nvalue = 'nonsense'"),
        format!("{scene}{material}[solver]\nnonsense = 1"),
    ] {
        for word in known(&text) {
            // The third direction is that of scenes in space, which aren't read yet.
            let is_word = |c: char| !(c.is_alphanumeric() || c == '_');
            let names = page.split(is_word).any(|other| other == word);
            assert!(
                names || word == "z" || word == "PI",
                "{word} isn't on the page"
            );
        }
    }
}
