//! Invalid ties and equations.

use contact_dd_partition::mesh::{Group, Mesh};
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solver::{Case, solve};

use super::{LOADED, ROCK, WELD};

fn apart(gap: f64) -> Mesh {
    Blocks::new()
        .rectangle("lower", [0.0, 1.0], [0.0, 1.0], [4, 4])
        .rectangle("upper", [0.0, 1.0], [1.0 + gap, 2.0 + gap], [5, 4])
        .mesh
}

fn refused(text: &str, mesh: Mesh) -> String {
    let scene = Scene::parse(&format!("mesh = 'here.msh'\n{text}"));
    match scene.and_then(|scene| Model::new(&scene, mesh)) {
        Ok(model) => {
            let ended = Case::of(&model, 4).run(&[]);
            assert_eq!(ended.code(), 2, "{}", ended.stderr);
            ended.stderr
        }
        Err(error) => error.to_string(),
    }
}

#[test]
fn sides_that_are_apart() {
    let message = refused(&format!("{ROCK}{LOADED}{WELD}"), apart(0.1));
    assert!(
        message.contains("tie 'weld': its sides are 0.1 m apart at least"),
        "{message}"
    );
    let reaches = format!("{ROCK}{LOADED}{WELD}tolerance = 0.2\n");
    let tied = model(&reaches, apart(0.1));
    assert_eq!(tied.contacts[0].points.len(), 6);
    let kept = |warning: &&String| warning.contains("gaps of up to 0.1 m are kept");
    assert_eq!(
        tied.warnings.iter().filter(kept).count(),
        1,
        "{:?}",
        tied.warnings
    );
}

/// Moved nodes leave no gap, and forces are in equilibrium.
#[test]
fn adjusted_sides_touch() {
    let text = format!("{ROCK}{LOADED}{WELD}tolerance = 0.2\nadjust = true\n");
    let tied = model(&text, apart(0.1));
    let touch = model(&format!("{ROCK}{LOADED}{WELD}"), {
        let mut mesh = apart(0.1);
        for point in mesh
            .points
            .iter_mut()
            .filter(|point| (point[1] - 1.1).abs() < 1e-9)
        {
            point[1] = 1.0;
        }
        mesh
    });
    for (found, expected) in tied.mesh.points.iter().zip(&touch.mesh.points) {
        (0..3).for_each(|k| close(found[k], expected[k], 1e-13));
    }
    solve(&tied, 4);
}

#[test]
fn supports_that_hold_both_sides_apart() {
    let mesh = Blocks::new()
        .rectangle("lower", [0.0, 1.0], [0.0, 1.0], [4, 4])
        .rectangle("upper", [0.0, 1.0], [1.0, 2.0], [4, 4])
        .mesh;
    let text = format!(
        "{ROCK}{WELD}
[[displacement]]
on = 'lower top'
x = 0.0
y = 0.0
[[displacement]]
on = 'upper bottom'
x = 0.0
y = 1e-3
"
    );
    let message = refused(&text, mesh.clone());
    assert!(message.contains("tie 'weld': at node"), "{message}");
    assert!(message.contains("contradict it, by 1.000e-3"), "{message}");
    // With the sides in contact the scene is valid.
    let case = Case::of(&model(&text.replace("1e-3", "0.0"), mesh), 4);
    assert_eq!(case.run(&[]).code(), 0);
}

#[test]
fn an_equation_that_supports_contradict() {
    let mut mesh = Blocks::new()
        .rectangle("lower", [0.0, 1.0], [0.0, 1.0], [2, 2])
        .mesh;
    mesh.groups.insert(
        "A".into(),
        Group {
            dim: 0,
            members: vec![0],
        },
    );
    let text = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.22}
bodies.lower.material = 'rock'
[[displacement]]
on = 'lower bottom'
x = 0.0
y = 0.0
[[equation]]
name = 'wrong'
terms = [{at = 'A', component = 'y'}]
value = 1e-3
";
    let message = refused(text, mesh.clone());
    assert!(message.contains("equation 'wrong': at node 1"), "{message}");
    let unknown = refused(&text.replace("'A'", "'nowhere'"), mesh.clone());
    assert!(
        unknown.contains("equation[1]: the mesh has no physical group 'nowhere'"),
        "{unknown}"
    );
    let none = refused(
        &text.replace(
            "component = 'y'}",
            "component = 'y'}, {at = 'A', component = 'y', factor = -1.0}",
        ),
        mesh,
    );
    assert!(none.contains("its terms cancel"), "{none}");
}
