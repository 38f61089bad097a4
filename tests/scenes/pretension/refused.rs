//! Invalid pretensions.

use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use super::{bar, bolt, with_cut};
use crate::support::blocks::Blocks;

#[test]
fn what_tightens_nothing_is_refused() {
    let mesh = Blocks::new()
        .rectangle("bar", [0.0, 0.6], [0.0, 1.5], [4, 6])
        .mesh;
    let whole = with_cut(mesh.clone(), |x| (x[1] - 0.75).abs() < 1e-9);
    let half = with_cut(mesh, |x| (x[1] - 0.75).abs() < 1e-9 && x[0] < 0.35);
    let plane = format!("plane = 'strain'\n{}", bar(0.3, ["bar bottom", "bar top"]));
    let force = bolt("force = 1.0");
    for (mesh, text, expected) in [
        (
            &half,
            force.clone(),
            "don't part the cells around them into two",
        ),
        (
            &whole,
            force.replace("'cut'", "'bar left'"),
            "isn't between two cells",
        ),
        (
            &whole,
            bolt("force = 1.0\ndirection = [1.0, 0.0]"),
            "lie along the direction",
        ),
        (
            &whole,
            bolt("force = 1.0\ndirection = [1.0, 0.0, 0.0]"),
            "vectors of two components",
        ),
        (&whole, bolt(""), "either 'force' or 'shortening'"),
        (
            &whole,
            bolt("force = 1.0\nshortening = 1.0"),
            "either 'force' or 'shortening'",
        ),
        (
            &whole,
            force.clone() + &force,
            "there is another 'bolt' already",
        ),
        (
            &whole,
            force.clone() + "[[step]]\npretension.bolt = { lock = true }",
            "there is no force to lock",
        ),
        (
            &whole,
            force.clone() + "[[step]]\npretension.bolt = { shortening = 1.0 }",
            "as [[pretension]] gives a force",
        ),
        (
            &whole,
            force.clone() + "[[step]]\npretension.nut = { force = 1.0 }",
            "there is no pretension 'nut'",
        ),
        (
            &whole,
            force.clone() + "[[step]]\n[[step]]\npretension.bolt = { lock = true, force = 1.0 }",
            "expected one of",
        ),
    ] {
        let text = format!("mesh = 'm'\n{plane}{text}");
        let error = match Scene::parse(&text) {
            Err(error) => error.to_string(),
            Ok(scene) => Model::new(&scene, mesh.clone()).unwrap_err().to_string(),
        };
        assert!(error.contains(expected), "{error}");
    }
}
